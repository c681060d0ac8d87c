"""The semi-discrete rod once more, slowly and independently, with 40 digits: what every kernel must compute.

Nothing of the package is used but the records of a scene and the element edges. Quadrature comes from exact
polynomials, brackets from cross products, a planar rod is a spatial one that stays in its plane (so its operators
are not written twice), rotations in space come from the Gauss collocation in Butcher's form, places from r' = R h by
the quadrature of each element, and what effects do is written out once more from their physics.

With half lengths h, Gauss weights w, lumped masses m, and D, B slope and value at the Gauss points:

    A(E) V = D V / h + [E, B V]
    -A^T (h w S) + end loads + m wrench + m drag + what holds the ends = 0,   drag = -friction (V - V of the medium)
    dE/dt = A V, of frozen modes 0 = A V - d(reference)/dt - slack S
    0 = law(E, dE/dt) - S for the stress S of viscous modes, which the state holds after the turn
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache
from typing import Any, NamedTuple

import mpmath
import numpy as np
import sympy as sp
from numpy.typing import NDArray

from geocosserat.model.printing import to_text
from geocosserat.model.records import RodModel, Scene
from geocosserat.model.tree import Binary, Call, Expression, Negate, Number, Symbol

Array = NDArray[Any]
DIGITS = 40
MP = mpmath.MPContext()
MP.dps = DIGITS
ASIDE = MP.mpf("1e-25")
"""How far beside a node a field is looked at, to see the value on that side of a step."""


def numbers(values: Any) -> Array:
    """Doubles, exactly, as 40-digit numbers."""
    flat = [MP.mpf(float(x)) for x in np.ravel(np.asarray(values, dtype=float))]
    out = np.empty(len(flat), dtype=object)
    out[:] = flat
    return out.reshape(np.shape(values))


def zeros(*shape: int) -> Array:
    return numbers(np.zeros(shape))


def floats(values: Array) -> NDArray[np.float64]:
    return np.array(values, dtype=float)


# expressions


def _heaviside(x: Any) -> Any:
    return MP.mpf(1) if x > 0 else MP.mpf(0) if x < 0 else MP.mpf("0.5")


FUNCTIONS: dict[str, Callable[[Any], Any]] = {
    **{name: getattr(MP, name) for name in ("sin", "cos", "tan", "exp", "log", "sqrt", "tanh", "sinh", "cosh")},
    "abs": abs,
    "heaviside": _heaviside,
}


def value(e: Expression, names: Mapping[str, Any]) -> Any:
    """A user's expression with 40 digits."""
    match e:
        case Number(number):
            return MP.mpf(number)
        case Symbol(name):
            return names[name]
        case Negate(operand):
            return -value(operand, names)
        case Call(function, argument):
            return FUNCTIONS[function](value(argument, names))
        case Binary(operator, left, right):
            a, b = value(left, names), value(right, names)
            match operator:
                case "+":
                    return a + b
                case "-":
                    return a - b
                case "*":
                    return a * b
                case "/":
                    return a / b
                case "**":
                    return a**b
    raise TypeError(f"expected an expression, found {e!r}")


# one element


def _roots(polynomial: sp.Expr, x: sp.Symbol) -> list[Any]:
    found = sp.Poly(sp.expand(polynomial), x).nroots(n=DIGITS + 10, maxsteps=200) if polynomial.has(x) else []
    return sorted(MP.mpf(str(root)) for root in found)


def _lagrange(places: Sequence[Any]) -> list[list[Any]]:
    """Coefficients, constant first, of the polynomials that are 1 at one place and 0 at the others."""
    found = []
    for i, own in enumerate(places):
        polynomial = [MP.mpf(1)]
        for j, other in enumerate(places):
            if j != i:
                shifted, same = [MP.mpf(0), *polynomial], [*polynomial, MP.mpf(0)]
                polynomial = [(a - other * b) / (own - other) for a, b in zip(shifted, same, strict=True)]
        found.append(polynomial)
    return found


def _at(polynomial: Sequence[Any], x: Any) -> Any:
    return MP.polyval(list(reversed(polynomial)), x) if polynomial else MP.mpf(0)


def _slope(polynomial: Sequence[Any]) -> list[Any]:
    return [k * c for k, c in enumerate(polynomial)][1:]


def _integral(polynomial: Sequence[Any], x: Any) -> Any:
    """From -1 to x."""
    whole = [MP.mpf(0), *(c / (k + 1) for k, c in enumerate(polynomial))]
    return _at(whole, x) - _at(whole, MP.mpf(-1))


class Element:
    """Gauss-Lobatto nodes and masses, Gauss points and weights, slopes D, values B and integrals, on [-1, 1]."""

    def __init__(self, degree: int) -> None:
        x = sp.Symbol("x")
        legendre = sp.legendre(degree, x)
        nodes = [MP.mpf(-1), *_roots(legendre.diff(x), x), MP.mpf(1)]
        points = _roots(legendre, x)
        on_nodes, on_points = _lagrange(nodes), _lagrange(points)

        def table(function: Callable[[Any, Any], Any], rows: Sequence[Any], columns: Sequence[Any]) -> Array:
            out = np.empty((len(rows), len(columns)), dtype=object)
            for i, j in np.ndindex(out.shape):
                out[i, j] = function(columns[j], rows[i])
            return out

        one = MP.mpf(1)
        self.degree = degree
        self.nodes, self.points = np.array(nodes, dtype=object), np.array(points, dtype=object)
        self.masses = np.array([_integral(c, one) for c in on_nodes], dtype=object)
        self.weights = np.array([_integral(c, one) for c in on_points], dtype=object)
        self.values = table(_at, points, on_nodes)
        self.slopes = table(_at, points, [_slope(c) for c in on_nodes])
        self.running = table(_integral, nodes, on_points)
        self.inner = table(_integral, points, on_points)


@lru_cache(maxsize=16)
def element(degree: int) -> Element:
    return Element(degree)


# rigid motions: vectors of six components, also in the plane


def cross(a: Array, b: Array) -> Array:
    return np.array([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]], dtype=object)


def bracket(E: Array, V: Array) -> Array:
    """[E, V], components: translation Pi x v + h x Omega, rotation Pi x Omega; (6,) or (6, n)."""
    return np.concatenate([cross(E[3:], V[:3]) + cross(E[:3], V[3:]), cross(E[3:], V[3:])])


def pulled(E: Array, S: Array) -> Array:
    """The dual of it: <pulled(E, S), V> = <S, [E, V]>."""
    return np.concatenate([cross(S[:3], E[3:]), cross(S[:3], E[:3]) + cross(S[3:], E[3:])])


def hat(v: Array) -> Array:
    o = MP.mpf(0)
    return np.array([[o, -v[2], v[1]], [v[2], o, -v[0]], [-v[1], v[0], o]], dtype=object)


def turned(q: Array) -> Array:
    """The rotation of a quaternion of any norm."""
    H = hat(q[1:])
    return numbers(np.eye(3)) + (q[0] * H + H @ H) * (2 / (q @ q))


def about_normal(angle: Any) -> Array:
    c, s, o, i = MP.cos(angle), MP.sin(angle), MP.mpf(0), MP.mpf(1)
    return np.array([[c, -s, o], [s, c, o], [o, o, i]], dtype=object)


def solve(A: Array, b: Array) -> Array:
    """A x = b, (n, n) and (n, m), by elimination of rows."""
    n = len(A)
    rows = np.concatenate([A, b], axis=1)
    for k in range(n):
        best = k + max(range(n - k), key=lambda i: abs(rows[k + i, k]))
        rows[[k, best]] = rows[[best, k]]
        for i in range(k + 1, n):
            if rows[i, k] != 0:
                rows[i, k:] = rows[i, k:] - rows[i, k] / rows[k, k] * rows[k, k:]
    for k in range(n - 1, -1, -1):
        rows[k, n:] = (rows[k, n:] - rows[k, k + 1 : n] @ rows[k + 1 :, n:]) / rows[k, k]
    return rows[:, n:]


def collocate(table: Any, start: Array, bend: Array) -> tuple[list[Array], Array]:
    """Rotations at the points and at the nodes of an element: R_q = R_0 + sum a_qj R_j hat(bend_j), and likewise at the
    nodes."""
    p = bend.shape[1]
    hats = [hat(bend[:, q]) for q in range(p)]
    # transposed: R_q^T - sum_j a_qj hat_j^T R_j^T = R_0^T
    system = numbers(np.eye(3 * p))
    for q, j in np.ndindex(p, p):
        system[3 * q : 3 * q + 3, 3 * j : 3 * j + 3] -= table.inner[q, j] * hats[j].T
    stages = solve(system, np.concatenate([start.T] * p))
    inside = [stages[3 * q : 3 * q + 3].T for q in range(p)]
    rates = [inside[q] @ hats[q] for q in range(p)]
    return inside, np.stack([start + sum(row[q] * rates[q] for q in range(p)) for row in table.running])


# the rod


class Motion(NamedTuple):
    """A rod at an instant, six components: at the points its turn and stress; at the nodes what the stress makes of it
    (forces), the loads on its ends, the densities of wrench and drag, the twist of the medium, that relative to it, and
    its own."""

    turn: Array
    stress: Array
    force: Array
    load: Array
    wrench: Array
    medium: Array
    drag: Array
    slip: Array
    twist: Array


FIRM = ("free", "pinned", "clamped", "driven")
"""Poses are marched from the end whose kind comes last, the left one if both are alike."""


class Rod:
    """The rate of a scene's semi-discrete rod on elements with these edges.

    base: pose at the start of the end that poses are marched from, an angle or a matrix by rows, then a position; what
    follows is not read. given: by name,
    how much frozen modes yield to their stress (slack_F1, ...), and of a far end that is held, where its place is and
    how fast it is drawn back there (right_home_x, ..., right_pull).
    """

    def __init__(
        self, scene: Scene, edges: Sequence[float], degree: int, base: Array, given: Mapping[str, float] | None = None
    ) -> None:
        self.model = model = scene.model
        self.wrench_of_law = model.law.wrench if model.law else ()
        self.table = element(degree)
        self.planar = model.group.rotations == 1
        self.space = model.group.translations
        self.edges, self.base = numbers(edges), numbers(base)
        self.half = (self.edges[1:] - self.edges[:-1]) / 2
        self.n, self.p, self.d = len(self.half), degree, model.group.dimension
        self.Q = self.n * self.p
        self.N = self.Q + 1
        self.kept = np.array([0, 1, 5] if self.planar else range(6))
        """Which of the six components there are."""
        self.turns = [c for c in self.kept if c >= 3]
        self.parameters = {name: MP.mpf(x) for name, x in model.parameters.items()}
        middles = (self.edges[1:] + self.edges[:-1]) / 2
        self.u_point = np.concatenate([c + h * self.table.points for c, h in zip(middles, self.half, strict=True)])
        self.u_local = [
            c + h * self.table.nodes * (1 - ASIDE) for c, h in zip(middles, self.half, strict=True)
        ]
        self.mass = self.gather([self.table.masses for _ in range(self.n)])
        self.frozen = [name in model.frozen for name in model.group.strain]
        self.given = {name: MP.mpf(x) for name, x in (given or {}).items()}
        self.slack = [self.given.get(f"slack_{name}", MP.mpf(0)) for name in model.group.stress]
        self.law: Any = model.law
        self.still = {f"{name}_dot": MP.mpf(0) for name in model.frozen}
        """Rates of strain that there are not."""
        self.viscous = [i for i in range(self.d) if model.law and not self.frozen[i] and self._viscous(i)]
        """The modes whose stress answers to rates of strain."""
        self.c = self.d + len(self.viscous)
        self.stiffness = [self.matrix(model.stiffness, {"u": u}) for u in self.u_point]
        self.friction = self._friction(model)
        """(N, 6, 6), zero where the plane has no component."""
        self.ends = () if model.joined else ((0, model.left), (self.N - 1, model.right))
        firmness = [FIRM.index(end.kind) for end in (model.left, model.right)]
        self.base_node = 0 if firmness[0] >= firmness[1] else self.N - 1
        base_kind = FIRM[max(firmness)]
        self.carried = 0 if base_kind in ("clamped", "driven") else 3 if self.planar else 7
        self.told = {node: end.twist for node, end in self.ends if end.kind == "driven"}
        """The twists of ends that move as they are told."""
        self._courses: dict[Any, tuple[Array, Array]] = {}
        start = [self.vector(scene.start.strain, {"u": u}) for u in self.u_point]
        self.start = self.poses(np.stack(start, axis=1), None)
        self._references: dict[Any, Array] = {}

    def _viscous(self, i: int) -> bool:
        free = (name for name, held in zip(self.model.group.strain, self.frozen, strict=True) if not held)
        return any(f"{name}_dot" in to_text(self.law.stress[i]) for name in free)

    def gather(self, local: Sequence[Array]) -> Array:
        """Sum over elements of half length times a local field on their nodes (last axis)."""
        return self.added([h * values for h, values in zip(self.half, local, strict=True)])

    def added(self, local: Sequence[Array]) -> Array:
        """Sum over elements of a local field; the two ends of a ring are one node, listed twice."""
        total = zeros(*local[0].shape[:-1], self.N)
        for e, values in enumerate(local):
            total[..., self.nodes(e)] += values
        if self.model.joined:
            total[..., 0] = total[..., -1] = total[..., 0] + total[..., -1]
        return total

    def vector(self, entries: Sequence[Expression], names: Mapping[str, Any]) -> Array:
        return np.array([value(e, {**self.parameters, **names}) for e in entries], dtype=object)

    def matrix(self, rows: Sequence[Sequence[Expression]], names: Mapping[str, Any]) -> Array:
        return np.stack([self.vector(row, names) for row in rows])

    def _friction(self, model: RodModel) -> Array:
        """The mean over a node's two sides, by mass."""
        local = [
            np.stack([self.matrix(model.friction, {"u": u}) for u in places], axis=-1) * self.table.masses
            for places in self.u_local
        ]
        out = zeros(self.N, 6, 6)
        out[:, self.kept[:, None], self.kept] = np.moveaxis(self.gather(local) / self.mass, -1, 0)
        for c in self.turns:
            if not any(out[:, c].ravel()):  # no friction is the limit of one with ever less
                out[:, c, c] = MP.mpf(1e-10) * self.edges[-1] ** 2 * out[:, 0, 0]
        return out

    def six(self, few: Array) -> Array:
        """All six components, (6, ...), from those there are."""
        out = zeros(6, *few.shape[1:])
        out[self.kept] = few
        return out

    def own(self, e: int) -> slice:
        return slice(e * self.p, (e + 1) * self.p)

    def nodes(self, e: int) -> slice:
        return slice(e * self.p, e * self.p + self.p + 1)

    # the state

    def reference(self, t: Any) -> Array:
        """(d, Q) the turn at rest."""
        if t not in self._references:
            found = [self.vector(self.model.reference, {"u": u, "t": t}) for u in self.u_point]
            self._references[t] = np.stack(found, axis=1)
        return self._references[t]

    def reference_rate(self, t: Any) -> Array:
        """How it changes in time, by differences (to 25 digits)."""
        step = MP.mpf("1e-13")
        return (self.reference(t + step) - self.reference(t - step)) / (2 * step)

    def unpack(self, t: Any, y: Array) -> tuple[Array, Array, tuple[Array, Array] | None]:
        """Turn and stress (d, Q), and how the base has moved since the start, if it may: frozen modes are at their
        reference; their stress is given, and that of viscous ones."""
        d, Q = self.d, self.Q
        given, rest = y[: d * Q].reshape(d, Q), self.reference(t)
        held = np.array(self.frozen)
        E = np.where(held[:, None], rest, given)
        S = np.empty((d, Q), dtype=object)
        for q, K in enumerate(self.stiffness):
            for i in range(d):
                strain = [K[i, j] * (E[j, q] - rest[j, q]) for j in range(d) if not held[j]]
                S[i, q] = given[i, q] if held[i] else sum(strain)
        if self.law:
            by_law = [i for i in range(d) if not held[i] and i not in self.viscous]
            for q, u in enumerate(self.u_point):
                known = {**self.names(E[:, q]), **self.still, "u": u, "t": t}
                S[by_law, q] = self.vector([self.law.stress[i] for i in by_law], known)
            S[self.viscous] = y[d * Q : self.c * Q].reshape(-1, Q)
        return E, S, self.moved(t, y[self.c * Q : self.c * Q + self.carried])

    def gaps(self, t: Any, E: Array, S: Array, rates: Array) -> Array:
        """(., Q) what the law says of the stress of viscous modes at a turn and its rates, less what it is."""
        said = [self.law.stress[i] for i in self.viscous]
        out = zeros(len(said), self.Q)
        for q, u in enumerate(self.u_point if said else ()):
            changing = {f"{name}_dot": x for name, x in self.names(rates[:, q]).items()}
            out[:, q] = self.vector(said, {**self.names(E[:, q]), **changing, **self.still, "u": u, "t": t})
        return out - S[self.viscous]

    def names(self, turn: Array) -> dict[str, Any]:
        """A turn (d,) by the names of its components."""
        return dict(zip(self.model.group.strain, turn, strict=True))

    def density(self, t: Any, E: Array) -> Array:
        """What a law says is stored at each point, if it knows."""
        if self.law.energy is None:
            return zeros(self.Q)
        points = enumerate(self.u_point)
        return np.array([self.vector([self.law.energy], {**self.names(E[:, q]), "u": u, "t": t})[0] for q, u in points])

    def conserved(self, t: Any, E: Array) -> tuple[Array, Array]:
        """The part of the stress of a law that stores energy (d, Q), and the power of what changes in time (Q,), by
        differences (to 25 digits)."""
        step, gradient = MP.mpf("1e-13"), []
        for i in range(self.d):
            away = zeros(*E.shape)
            away[i] += step
            gradient.append((self.density(t, E + away) - self.density(t, E - away)) / (2 * step))
        return np.stack(gradient), (self.density(t + step, E) - self.density(t - step, E)) / (2 * step)

    def energy(self, t: float, y: Array) -> Any:
        """Stored energy: the Gauss sum of strain . K strain / 2, or of what the law says."""
        t = MP.mpf(t)
        E, S, _ = self.unpack(t, numbers(y))
        if self.law:
            return self.integral(self.density(t, E))
        density = ((E - self.reference(t)) * S).sum(axis=0) / 2
        return self.integral(density)

    def integral(self, density: Array) -> Any:
        """Of values at the points."""
        return sum(h * (self.table.weights @ density[self.own(e)]) for e, h in enumerate(self.half))

    # poses

    def relative(self, E: Array) -> tuple[Array, Array]:
        """Rotations (N, 3, 3) and places (N, 3) of the nodes seen from the left end."""
        E6 = self.six(E)
        R, r = np.empty((self.N, 3, 3), dtype=object), zeros(self.N, 3)
        R[0] = numbers(np.eye(3))
        angle: Any = MP.mpf(0)
        for e, h in enumerate(self.half):
            here, first = E6[:, self.own(e)], e * self.p
            if self.planar:
                bend = h * here[5]
                inside = [about_normal(angle + a) for a in self.table.inner @ bend]
                R[self.nodes(e)] = np.stack([about_normal(angle + a) for a in self.table.running @ bend])
                angle = angle + self.table.running[-1] @ bend
            else:
                inside, R[self.nodes(e)] = collocate(self.table, R[first], h * here[3:])
            steps = [h * (inside[q] @ here[:3, q]) for q in range(self.p)]
            for k, row in enumerate(self.table.running):
                r[first + k] = r[first] + sum(row[q] * steps[q] for q in range(self.p))
        return R, r

    def moved(self, t: Any, pose: Array) -> tuple[Array, Array] | None:
        """Rotation (3, 3) and place (3,) of the base seen from where it started; None if it cannot move."""
        if self.base_node in self.told:
            return self.course(self.base_node, t)
        if not self.carried:
            return None
        gone = zeros(3)
        gone[: self.space] = pose[: self.space]
        return about_normal(pose[2]) if self.planar else turned(pose[3:]), gone

    def course(self, node: int, t: Any) -> tuple[Array, Array]:
        """The same of an end that moves as it is told: collocated in time as frames are along the rod, of order 16 in
        steps of at most an eighth, which is exact to 20 digits and more."""
        if (node, t) not in self._courses:
            self._courses[node, t] = self._course(node, t)
        return self._courses[node, t]

    def _course(self, node: int, t: Any) -> tuple[Array, Array]:
        table, steps = element(8), max(1, int(MP.ceil(8 * t)))
        half, R, r = MP.mpf(t) / (2 * steps), numbers(np.eye(3)), zeros(3)
        for k in range(steps):
            twists = [self.six(self.vector(self.told[node] or (), {"t": half * (2 * k + 1 + x)})) for x in table.points]
            step = half * np.stack(twists, axis=1)
            inside, nodes = collocate(table, R, step[3:])
            r = r + sum(w * (Rq @ v) for w, Rq, v in zip(table.weights, inside, step[:3].T, strict=True))
            R = nodes[-1]
        return R, r

    def poses(self, E: Array, moved: tuple[Array, Array] | None) -> tuple[Array, Array]:
        """Rotations (N, 3, 3) and places (N, 3) of the nodes in the world."""
        R, r = self.relative(E)
        base, place = zeros(3, 3), zeros(3)
        if self.planar:
            base = about_normal(self.base[0])
            place[:2] = self.base[1:3]
        else:
            base, place = self.base[:9].reshape(3, 3), self.base[9:12]
        if moved is not None:
            place = place + base @ moved[1]
            base = base @ moved[0]
        start = base if self.base_node == 0 else base @ R[-1].T
        first = place if self.base_node == 0 else place - start @ r[-1]
        return np.stack([start @ Rn for Rn in R]), np.stack([first + start @ rn for rn in r])

    # what acts on it

    def three(self, entries: Array) -> Array:
        """A vector of the plane, or of space, as three components."""
        out = zeros(3)
        out[: len(entries)] = entries
        return out

    def moment(self, entries: Array) -> Array:
        """One number about the normal of the plane, or three."""
        return self.three(entries) if len(entries) > 1 else np.array([MP.mpf(0), MP.mpf(0), entries[0]], dtype=object)

    def acting(self, effect: Any, names: Mapping[str, Any], R: Array, r: Array) -> tuple[Array, Array]:
        """Density of wrench, and twist of the medium, at a node with that pose."""
        wrench, medium = zeros(6), zeros(6)

        def read(key: str) -> Array:
            return self.vector(getattr(effect, key), names)

        match effect.kind:
            case "weight":
                wrench[:3] = R.T @ self.three(read("force"))
            case "follower":
                wrench[:3] = self.three(read("force"))
            case "couple":
                wrench[3:] = self.moment(read("torque"))
            case "field":
                wrench[3:] = cross(self.three(read("moment")), R.T @ self.three(read("field")))
            case "trap":
                wrench[:3] = R.T @ (read("stiffness")[0] * (self.three(read("centre")) - r))
            case "flow":
                G = zeros(3, 3)
                G[: self.space, : self.space] = read("gradient").reshape(self.space, self.space)
                vorticity = np.array([G[2, 1] - G[1, 2], G[0, 2] - G[2, 0], G[1, 0] - G[0, 1]], dtype=object)
                medium[:3] = R.T @ (self.three(read("velocity")) + G @ r)
                medium[3:] = R.T @ vorticity / 2
            case "law":
                seen = {axis: x for axis, x in zip("xyz", r, strict=True)}
                angle = MP.atan2(R[1, 0], R[0, 0])
                frame = {f"e{i + 1}{axis}": R[k, i] for k, axis in enumerate("xyz") for i in range(3)}
                law = self.vector(self.wrench_of_law, {**names, **seen, **frame, "theta": angle})
                wrench += self.six(law)
            case kind:
                raise TypeError(f"expected an effect known here, found {kind}")
        return wrench, medium

    def surroundings(self, t: Any, R: Array, r: Array) -> tuple[Array, Array, Array]:
        """Loads on the ends, density of wrench and twist of the medium, all (6, N) in the moving frame; each side of a
        node counts with its own mass."""
        load = zeros(6, self.N)
        wrenches, media = [], []
        for e, places in enumerate(self.u_local):
            wrench, medium = zeros(6, self.p + 1), zeros(6, self.p + 1)
            for k, u in enumerate(places):
                for effect in self.model.effects:
                    more = self.acting(effect, {"u": u, "t": t}, R[e * self.p + k], r[e * self.p + k])
                    wrench[:, k] += more[0]
                    medium[:, k] += more[1]
            wrenches.append(wrench * self.table.masses)
            media.append(medium * self.table.masses)
        for node, end in self.ends:
            force = self.three(self.vector(end.force or (), {"t": t}))
            torque = self.moment(self.vector(end.torque, {"t": t})) if end.torque else zeros(3)
            turn = R[node].T if end.frame == "world" else numbers(np.eye(3))
            load[:, node] = np.concatenate([turn @ force, turn @ torque])
        return load, self.gather(wrenches) / self.mass, self.gather(media) / self.mass

    def wrench_given(self, t: Any, E: Array, y: Array) -> Array:
        """(6, N) the density of wrench of a law, whose work is a loss of the rod."""
        _, _, moved = self.unpack(t, y)
        R, r = self.poses(E, moved)
        local = []
        for e, places in enumerate(self.u_local):
            wrench = zeros(6, self.p + 1)
            for k, u in enumerate(places):
                for effect in self.model.effects:
                    if effect.kind == "law":
                        wrench[:, k] += self.acting(effect, {"u": u, "t": t}, R[e * self.p + k], r[e * self.p + k])[0]
            local.append(wrench * self.table.masses)
        return self.gather(local) / self.mass

    def homing(self, t: Any, node: int, R: Array, r: Array) -> Array:
        """The twist by which an end that is held far from where poses are marched from goes back to its place, by as
        much as it strayed: a correction, no motion through the medium."""
        end, out = dict(self.ends)[node], zeros(6)
        if node == self.base_node:
            return out
        side = "left" if node == 0 else "right"
        if end.kind == "driven":
            turn, way = self.course(node, t)
            home, place = self.start[0][node] @ turn, self.start[1][node] + self.start[0][node] @ way
            out[:3] = self.given[f"{side}_pull"] * (R.T @ (place - r))
            turns = sum(cross(R[:, i], home[:, i]) for i in range(3)) / 2
            out[3:] = self.given[f"{side}_pull"] * (R.T @ turns)
        elif f"{side}_pull" in self.given:
            home = {name.removeprefix(f"{side}_home_"): x for name, x in self.given.items()}
            pull = self.given[f"{side}_pull"]
            place = self.three(np.array([home[axis] for axis in "xyz"[: self.space]], dtype=object))
            out[:3] = pull * (R.T @ (place - r))
            if end.kind == "clamped" and self.planar:
                out[5] = pull * (R[:, 0] @ about_normal(MP.pi / 2).T @ np.array([home["cos"], home["sin"], 0]))
            elif end.kind == "clamped":
                axes = [np.array([home[f"{i}{axis}"] for axis in "xyz"], dtype=object) for i in (1, 2, 3)]
                out[3:] = pull * R.T @ sum(cross(R[:, i], axes[i]) for i in range(3)) / 2
        return out

    # the scheme

    def strain_rate(self, E: Array, V: Array) -> Array:
        """A(E) V: (6, Q) from (6, N)."""
        parts = []
        for e, h in enumerate(self.half):
            here = V[:, self.nodes(e)]
            parts.append(here @ self.table.slopes.T / h + bracket(E[:, self.own(e)], here @ self.table.values.T))
        return np.concatenate(parts, axis=1)

    def nodal(self, E: Array, S: Array) -> Array:
        """A(E)^T h w S: (6, N) from (6, Q)."""
        local = []
        for e, h in enumerate(self.half):
            weighted = S[:, self.own(e)] * self.table.weights
            local.append(weighted @ self.table.slopes + h * pulled(E[:, self.own(e)], weighted) @ self.table.values)
        return self.added(local)

    def move(self, t: float, y: Array) -> Motion:
        """How the rod moves, and why."""
        t, y = MP.mpf(t), y if y.dtype == object else numbers(y)
        E, S, moved = self.unpack(t, y)
        E6, S6 = self.six(E), self.six(S)
        R, r = self.poses(E, moved)
        force = -self.nodal(E6, S6)
        load, wrench, medium = self.surroundings(t, R, r)
        drive = (force + load) / self.mass + wrench
        slip, homing = zeros(6, self.N), zeros(6, self.N)
        held = dict(self.ends)
        for n, G in enumerate(self.friction):
            kind = held[n].kind if n in held else "free"
            moving = {"free": list(self.kept), "pinned": self.turns}.get(kind, [])
            fixed = [c for c in self.kept if c not in moving]
            if fixed:  # what stands still is dragged along all the same
                slip[fixed, n] = -medium[fixed, n]
                homing[:, n] = self.homing(t, n, R[n], r[n])
            if kind == "driven":
                slip[:, n] += self.six(self.vector(held[n].twist or (), {"t": t})) + homing[:, n]
                homing[:, n] = 0
            if moving:
                rest = drive[moving, n] - G[np.ix_(moving, fixed)] @ slip[fixed, n]
                slip[moving, n] = solve(G[np.ix_(moving, moving)], rest[:, None])[:, 0]
        drag = -np.einsum("nij,jn->in", self.friction, slip)
        return Motion(E6, S6, force, load, wrench, medium, drag, slip, slip + medium + homing)

    def rate(self, t: float, y: Array) -> Array:
        """dy/dt with 40 digits, of a state of doubles or of 40-digit numbers, in the layout of the kernels."""
        y = y if y.dtype == object else numbers(y)
        m, Q = self.move(t, y), self.Q
        V, moving = m.twist, self.reference_rate(MP.mpf(t))
        S = m.stress[self.kept]
        rates = self.strain_rate(m.turn, V)[self.kept]
        for i in np.flatnonzero(self.frozen):
            rates[i] = rates[i] - moving[i] - self.slack[i] * S[i]
        nodes = slice(0, self.N - 1 if self.model.joined else self.N)
        lost = -(self.mass * m.drag * m.slip).sum(axis=0)[nodes].sum()
        own = (self.mass * self.wrench_given(MP.mpf(t), m.turn[self.kept], y) * V).sum(axis=0)[nodes].sum()
        lost -= own
        worked = (self.mass * (m.wrench * V + m.drag * m.medium) + m.load * V).sum(axis=0)[nodes].sum() - own
        for n, end in self.ends:
            if end.kind != "free":  # whatever holds it does the work that is missing from the balance
                worked -= (m.force + m.load + self.mass * m.wrench)[:, n] @ V[:, n]
                worked -= self.mass[n] * m.drag[:, n] @ (m.slip + m.medium)[:, n]
        if self.law:
            free, turn = ~np.array(self.frozen), m.turn[self.kept]
            storing, supplied = self.conserved(MP.mpf(t), turn)
            lost += self.integral(((S - storing) * rates)[free].sum(axis=0))
            worked += self.integral(supplied)
        else:
            worked -= self.integral((moving * S).sum(axis=0))
        gaps = self.gaps(MP.mpf(t), m.turn[self.kept], S, rates)
        pose = self.pose_rate(y[self.c * Q : self.c * Q + self.carried], V[:, self.base_node])
        return np.concatenate([rates.ravel(), gaps.ravel(), pose, np.array([lost, worked])])

    def pose_rate(self, pose: Array, V: Array) -> Array:
        """How the base's pose, relative to its start, follows its twist (6,)."""
        if not self.carried:
            return zeros(0)
        if self.planar:
            return np.append((about_normal(pose[2]) @ V[:3])[:2], V[5])
        q, w = pose[3:], V[3:]
        product = np.concatenate([[-(q[1:] @ w)], q[0] * w + cross(q[1:], w)])
        return np.concatenate([turned(q) @ V[:3], product / 2])

    def derivative(self, t: float, y: NDArray[np.float64], direction: NDArray[np.float64]) -> Array:
        """d rate / dy in a direction: with 40 digits a plain difference has 18."""
        step = MP.mpf("1e-20")
        exact = numbers(y)
        return (self.rate(t, exact + step * numbers(direction)) - self.rate(t, exact)) / step
