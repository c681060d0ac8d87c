"""The semi-discrete rod once more, slowly and independently, with 40 digits: what every kernel must compute.

Nothing of the package is used but the records of a scene and the element edges. Quadrature comes from exact
polynomials, brackets from cross products, a planar rod is a spatial one that stays in its plane (so its operators
are not written twice), rotations in space come from the Gauss collocation in Butcher's form.

With half lengths h, Gauss weights w, lumped masses m, and D, B slope and value at the Gauss points:

    A(E) V = D V / h + [E, B V],   G = -A^T (h w S) + end wrenches + m weight,   V = friction^-1 G / m,   dE/dt = A V
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache
from typing import Any

import mpmath
import numpy as np
import sympy as sp
from numpy.typing import NDArray

from geocosserat.model.records import End, RodModel, Scene
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
    """A x = b, (n, n) and (n, m)."""
    found = MP.lu_solve(MP.matrix(A.tolist()), MP.matrix(b.tolist()))
    return np.array([[found[i, j] for j in range(found.cols)] for i in range(found.rows)], dtype=object)


def solve_wide(A: Array, b: Array) -> Array:
    """The same for several right-hand sides."""
    return np.stack([solve(A, b[:, [k]])[:, 0] for k in range(b.shape[1])], axis=1)


# the rod


class Rod:
    """The rate of a scene's semi-discrete rod on elements with these edges.

    base: orientation of the end that poses are marched from, an angle or a matrix by rows, as the kernels take it.
    """

    def __init__(self, scene: Scene, edges: Sequence[float], degree: int, base: Array) -> None:
        self.model = model = scene.model
        self.table = element(degree)
        self.planar = model.group.rotations == 1
        self.edges, self.base = numbers(edges), numbers(base)
        self.half = (self.edges[1:] - self.edges[:-1]) / 2
        self.n, self.p, self.d = len(self.half), degree, model.group.dimension
        self.Q = self.n * self.p
        self.N = self.Q + 1
        self.kept = np.array([0, 1, 5] if self.planar else range(6))
        """Which of the six components there are."""
        self.parameters = {name: MP.mpf(x) for name, x in model.parameters.items()}
        middles = (self.edges[1:] + self.edges[:-1]) / 2
        self.u_point = np.concatenate([c + h * self.table.points for c, h in zip(middles, self.half, strict=True)])
        self.u_local = [
            c + h * self.table.nodes * (1 - ASIDE) for c, h in zip(middles, self.half, strict=True)
        ]
        self.mass = self.gather([self.table.masses for _ in range(self.n)])
        self.stiffness = [self.matrix(model.stiffness, {"u": u}) for u in self.u_point]
        self.reference = np.stack([self.vector(model.reference, {"u": u}) for u in self.u_point], axis=1)
        self.friction = self._friction(model)
        base_kind = "left" if model.left.kind == "clamped" else "right" if model.right.kind == "clamped" else "carried"
        self.base_kind = base_kind
        self.carried = 0 if base_kind != "carried" else 3 if self.planar else 7

    def gather(self, local: Sequence[Array]) -> Array:
        """Sum over elements of half length times a local field on their nodes (last axis)."""
        total = zeros(*local[0].shape[:-1], self.N)
        for e, values in enumerate(local):
            total[..., e * self.p : e * self.p + self.p + 1] += self.half[e] * values
        return total

    def vector(self, entries: Sequence[Expression], names: Mapping[str, Any]) -> Array:
        return np.array([value(e, {**self.parameters, **names}) for e in entries], dtype=object)

    def matrix(self, rows: Sequence[Sequence[Expression]], names: Mapping[str, Any]) -> Array:
        return np.stack([self.vector(row, names) for row in rows])

    def _friction(self, model: RodModel) -> Array:
        """(N, d, d): the mean over a node's two sides, by mass."""
        local = [
            np.stack([self.matrix(model.friction, {"u": u}) for u in places], axis=-1) * self.table.masses
            for places in self.u_local
        ]
        return np.moveaxis(self.gather(local) / self.mass, -1, 0)

    def six(self, few: Array) -> Array:
        """All six components, (6, ...), from those there are."""
        out = zeros(6, *few.shape[1:])
        out[self.kept] = few
        return out

    def frames(self, E: Array, pose: Array) -> Array:
        """Rotation matrices at the nodes, (N, 3, 3)."""
        if self.planar:
            gained = [h * (self.table.running @ E[2, self.own(e)]) for e, h in enumerate(self.half)]
            angle = zeros(self.N)
            for e in range(self.n):
                angle[e * self.p : e * self.p + self.p + 1] = angle[e * self.p] + gained[e]
            angle = angle + self.base[0] + (pose[2] if self.carried else 0)
            angle = angle - (angle[-1] - self.base[0] if self.base_kind == "right" else 0)
            return np.stack([about_normal(a) for a in angle])
        R = np.empty((self.N, 3, 3), dtype=object)
        R[0] = numbers(np.eye(3))
        for e, h in enumerate(self.half):
            R[e * self.p : e * self.p + self.p + 1] = self.collocate(R[e * self.p], h * E[3:, self.own(e)])
        base = self.base.reshape(3, 3)
        start = base @ turned(pose[3:]) if self.carried else base @ R[-1].T if self.base_kind == "right" else base
        return np.stack([start @ Rn for Rn in R])

    def collocate(self, start: Array, bend: Array) -> Array:
        """Rotations at the nodes of an element: R_q = R_0 + sum a_qj R_j hat(bend_j), and likewise at the nodes."""
        p, table = self.p, self.table
        hats = [hat(bend[:, q]) for q in range(p)]
        # transposed: R_q^T - sum_j a_qj hat_j^T R_j^T = R_0^T
        system = numbers(np.eye(3 * p))
        for q, j in np.ndindex(p, p):
            system[3 * q : 3 * q + 3, 3 * j : 3 * j + 3] -= table.inner[q, j] * hats[j].T
        stages = solve_wide(system, np.concatenate([start.T] * p))
        rates = [stages[3 * q : 3 * q + 3].T @ hats[q] for q in range(p)]
        return np.stack([start + sum(row[q] * rates[q] for q in range(p)) for row in table.running])

    def own(self, e: int) -> slice:
        return slice(e * self.p, (e + 1) * self.p)

    def nodes(self, e: int) -> slice:
        return slice(e * self.p, e * self.p + self.p + 1)

    def stress(self, E: Array) -> Array:
        strain = E - self.reference
        return np.stack([K @ strain[:, q] for q, K in enumerate(self.stiffness)], axis=1)

    def energy(self, y: Array) -> Any:
        """Stored energy: the Gauss sum of strain . K strain / 2."""
        E = y[: self.d * self.Q].reshape(self.d, self.Q)
        density = ((E - self.reference) * self.stress(E)).sum(axis=0) / 2
        return sum(h * (self.table.weights @ density[self.own(e)]) for e, h in enumerate(self.half))

    def strain_rate(self, E: Array, V: Array) -> Array:
        """A(E) V: (6, Q) from (6, N)."""
        parts = []
        for e, h in enumerate(self.half):
            here = V[:, self.nodes(e)]
            parts.append(here @ self.table.slopes.T / h + bracket(E[:, self.own(e)], here @ self.table.values.T))
        return np.concatenate(parts, axis=1)

    def nodal(self, E: Array, S: Array) -> Array:
        """A(E)^T h w S: (6, N) from (6, Q)."""
        total = zeros(6, self.N)
        for e, h in enumerate(self.half):
            weighted = S[:, self.own(e)] * self.table.weights
            total[:, self.nodes(e)] += (
                weighted @ self.table.slopes + h * pulled(E[:, self.own(e)], weighted) @ self.table.values
            )
        return total

    def wrench(self, end: End, t: Any) -> Array:
        group = self.model.group
        force = self.vector(end.force, {"t": t}) if end.force else zeros(group.translations)
        torque = self.vector(end.torque, {"t": t}) if end.torque else zeros(group.rotations)
        return self.six(np.concatenate([force, torque]))

    def weight(self, t: Any) -> Array:
        """(3, N) world force of the weight on the nodes, each side of a node with its own mass."""
        local = []
        for places in self.u_local:
            total = zeros(3, self.p + 1)
            for effect in self.model.effects:
                for k, u in enumerate(places):
                    total[: self.model.group.translations, k] += self.vector(effect.force, {"u": u, "t": t})
            local.append(total * self.table.masses)
        return self.gather(local)

    def loads(self, t: Any, E: Array, pose: Array) -> Array:
        """(6, N) wrenches on the nodes, in the moving frame."""
        model = self.model
        total = zeros(6, self.N)
        world = zeros(6, self.N)
        for node, end in ((0, model.left), (self.N - 1, model.right)):
            (world if end.frame == "world" else total)[:, node] += self.wrench(end, t)
        world[:3] += self.weight(t)
        if any(x != 0 for x in world.ravel()):
            for n, R in enumerate(self.frames(E, pose)):
                total[:3, n] += R.T @ world[:3, n]
                total[3:, n] += R.T @ world[3:, n]
        return total

    def move(self, t: float, y: Array) -> tuple[Array, Array, Array]:
        """Turn (6, Q), applied wrenches (6, N) in the moving frame, and the twist (6, N) they and the stress drive."""
        y = y if y.dtype == object else numbers(y)
        d, Q = self.d, self.Q
        E, pose = y[: d * Q].reshape(d, Q), y[d * Q : d * Q + self.carried]
        applied = self.loads(MP.mpf(t), E, pose)
        E6 = self.six(E)
        drive = ((applied - self.nodal(E6, self.six(self.stress(E)))) / self.mass)[self.kept]
        V = np.stack([solve(G, drive[:, [n]])[:, 0] for n, G in enumerate(self.friction)], axis=1)
        for node, end in ((0, self.model.left), (self.N - 1, self.model.right)):
            if end.kind == "clamped":
                V[:, node] = 0
        return E6, applied, self.six(V)

    def rate(self, t: float, y: Array) -> Array:
        """dy/dt with 40 digits, of a state of doubles or of 40-digit numbers, in the layout of the kernels."""
        y = y if y.dtype == object else numbers(y)
        E, applied, V = self.move(t, y)
        few, d, Q = V[self.kept], self.d, self.Q
        lost = sum(self.mass[n] * (few[:, n] @ G @ few[:, n]) for n, G in enumerate(self.friction))
        gained = (applied * V).sum()
        moved = self.pose_rate(y[d * Q : d * Q + self.carried], V[:, 0])
        return np.concatenate([self.strain_rate(E, V)[self.kept].ravel(), moved, np.array([lost, gained])])

    def pose_rate(self, pose: Array, V: Array) -> Array:
        """How the left end's pose, relative to its start, follows its twist (6,)."""
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
