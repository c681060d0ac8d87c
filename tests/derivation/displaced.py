"""Rods displaced by a finite amount, and the slope by that amount of what their equations say."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence
from typing import Any

import mpmath as mp
import numpy as np
import sympy as sp
from numpy.typing import NDArray

from geocosserat.algebra.groups import SE2, SE3, Group
from geocosserat.derivation.linear import linearise
from geocosserat.derivation.notation import T, U, field, fields, is_field
from geocosserat.derivation.orientation import rotation
from geocosserat.derivation.records import FieldEquations
from geocosserat.model.effects.effect import Effect
from geocosserat.model.records import RodModel
from geocosserat.model.scene import load_scene
from tests.derivation.charted import SWEPT
from tests.derivation.rods import RODS
from tests.derivation.scenes import BASE, FROZEN, FULL, diagonal, vector
from tests.derivation.test_effects import every

Array = NDArray[Any]
Numbers = dict[sp.Expr, sp.Expr]
DIGITS = 90
STEP = mp.ldexp(1, -80)
CLOSE = sp.Float("1e-30")
HERE = (sp.Rational(3, 7), sp.Rational(5, 11))


def with_effect(group: Group, effect: Effect) -> RodModel:
    """A straight rod under one effect."""
    return dataclasses.replace(BASE[group], effects=(effect,))


def of_law(motion: str, stress: dict[str, str], **rod: Any) -> RodModel:
    """A rod of a law with numbers for its parameters."""
    law = {"motion": motion, "stress": stress, "parameters": {"c": 0.75}}
    friction = [1.0, 2.0, 0.5] if motion == "planar" else [1.0, 2.0, 2.5, 0.5, 0.25, 0.125]
    table = {"motion": motion, "length": 1.0, "law": law, "friction": friction, **rod}
    return load_scene({"rod": table, "run": {"until": 1.0}}).model


PLANAR_LAW = {"F1": "h1**2 - 1 + c*h2*Pi", "F2": "2*h2 - c*Pi", "M": "tanh(Pi) + h2**3*(1 + u)"}
SPATIAL_LAW = {
    "F1": "h1**2 - 1 + c*h2*Pi2", "F2": "2*h2 - c*Pi1", "F3": "h3*(2 + u) + Pi3**2",
    "M1": "tanh(Pi1) + h2**3", "M2": "Pi2 - c*h3*Pi1", "M3": "Pi3*exp(Pi3)",
}  # fmt: skip
MODELS: dict[str, RodModel] = {
    **RODS,
    **{f"{group.name} {name}": with_effect(group, e) for group in BASE for name, e in every(group).items()},
    **{f"{group.name} all effects": model for group, model in FULL.items()},
    **{f"{group.name} swept": model for group, model in SWEPT.items()},
    **{name: FROZEN[name] for name in list(FROZEN)[::4]},
    "planar law": of_law("planar", PLANAR_LAW),
    "spatial law": of_law("spatial", SPATIAL_LAW),
    "law, frozen": of_law("planar", PLANAR_LAW, frozen=["h2"]),
    "stepped": dataclasses.replace(
        BASE[SE2],
        stiffness=diagonal("k1", "k2", "k3*(1 - heaviside(u - 0.7)/2)"),
        friction=diagonal(1, "1 + u + heaviside(u - 0.2)", 1),
        reference=vector("1 + heaviside(u - 0.2)", 0, "u"),
    ),
    "swimmer": dataclasses.replace(BASE[SE2], reference=vector("1 + a*sin(u - t)", "u*t", "b*cos(u - t)")),
    "spatial swimmer, frozen": dataclasses.replace(
        BASE[SE3], reference=vector("1 + a*sin(u - t)", 0, "u*t", "b*t", "b*cos(u - t)", 0), frozen=("h1", "Pi1", "Pi2")
    ),
}
"""One rod for each thing that linear equations may have."""


def precise(e: sp.Expr, known: Numbers, u: sp.Rational = HERE[0], t: sp.Rational = HERE[1]) -> sp.Expr:
    """e with numbers for its fields and for derivatives of these, each its own."""
    slopes = {f: x for f, x in known.items() if isinstance(f, sp.Derivative)}
    return e.xreplace(slopes).xreplace(known).xreplace({U: u, T: t, **parameters_of(e, known)}).evalf(DIGITS)


def parameters_of(e: sp.Expr, known: Numbers) -> Numbers:
    """Numbers for the parameters of any of the rods, the same everywhere."""
    named = [s for s in e.free_symbols if s not in (U, T)]
    return {s: known.get(s, sp.Rational(sum(map(ord, s.name)) % 37 + 5, 23)) for s in named}


def random(rng: np.random.Generator, *shape: int) -> Array:
    """Rational numbers of size one."""
    return np.vectorize(lambda n: mp.mpf(int(n)) / 64, otypes=[object])(rng.integers(-90, 90, shape))


class Displaced:
    """A rod at one point: its configuration with all the derivatives that equations of motion have, and a
    displacement from it. Everything in numbers, everything else follows by products of matrices.

    Frozen modes are at their reference, and the displacement leaves them there.
    """

    def __init__(self, equations: FieldEquations, seed: int) -> None:
        rng = np.random.default_rng(seed)
        group, held = equations.group, equations.model.held
        d = group.dimension
        self.equations, self.group = equations, group
        self._known: dict[Any, Numbers] = {}
        self.E, self.E_u, self.V, self.eta, self.eta_u, self.eta_uu, self.eta_t = random(rng, 7, d)
        self.E[0] += 2
        for a in np.flatnonzero(held):
            reference = equations.turn[a]
            self.E[a], self.E_u[a] = (_number(precise(e, {})) for e in (reference, reference.diff(U)))
        self.stress, self.stress_u, self.lam, self.lam_u = random(rng, 4, d)
        self.angle = random(rng, 1)[0]
        with mp.workdps(DIGITS):
            g = _configuration(group, random(rng, group.space), self.angle, random(rng, 3))
            hat = group.hat
            self.g = g
            self.g_u, self.g_t = g @ hat(self.E), g @ hat(self.V)
            self.g_uu = self.g_u @ hat(self.E) + g @ hat(self.E_u)
            for a in np.flatnonzero(held):
                self.eta_u[a] = -group.bracket(self.E, self.eta)[a]
            for a in np.flatnonzero(held):
                turning = group.bracket(self.E_u, self.eta) + group.bracket(self.E, self.eta_u)
                self.eta_uu[a] = -turning[a]

    def at(self, size: Any) -> Numbers:
        """Numbers for all fields of the equations, of the rod displaced by ``size`` times the displacement."""
        if size not in self._known:
            with mp.workdps(DIGITS):
                self._known[size] = self._at(size)
        return self._known[size]

    def _at(self, size: Any) -> Numbers:
        group, equations, hat = self.group, self.equations, self.group.hat
        one = np.eye(group.size, dtype=int).astype(object)
        x, x_u, x_uu, x_t = (size * hat(e) for e in (self.eta, self.eta_u, self.eta_uu, self.eta_t))
        g = self.g @ (one + x)
        g_u = self.g_u @ (one + x) + self.g @ x_u
        g_uu = self.g_uu @ (one + x) + 2 * self.g_u @ x_u + self.g @ x_uu
        g_t = self.g_t @ (one + x) + self.g @ x_t
        back = np.array(mp.inverse(mp.matrix(g.tolist())).tolist(), dtype=object)
        E, V = group.vee(back @ g_u), group.vee(back @ g_t)
        E_u = group.vee(back @ g_uu - back @ g_u @ back @ g_u)
        known = _fields(zip((*fields(group.strain), *fields(group.twist)), (*E, *V), strict=True))
        known |= _fields((f.diff(U), y) for f, y in zip(fields(group.strain), E_u, strict=True))
        known |= _fields((field(axis), y) for axis, y in zip("xyz", group.position(g), strict=False))
        R, R_0 = group.rotation(g), group.rotation(self.g)
        if group.space == 2:
            turned = R_0.T @ R
            known |= _fields([(field("theta"), self.angle + mp.atan2(turned[1, 0], turned[0, 0]))])
        else:
            known |= _fields((f, R[index]) for index, f in np.ndenumerate(rotation(group)))
        S, S_u = self.stress + size * self.lam, self.stress_u + size * self.lam_u
        for f, a, b in zip(fields(group.stress), S, S_u, strict=True):
            if f in equations.multipliers:
                known |= _fields([(f, a), (f.diff(U), b)])
        for law in equations.stress_law:
            value, slope = law.right, law.right.diff(U).replace(sp.DiracDelta, lambda *_: sp.S.Zero)
            known |= {law.left: precise(value, known), law.left.diff(U): precise(slope, known)}
        return known

    def slope(self, of: Callable[[Numbers], Sequence[sp.Expr]]) -> list[sp.Expr]:
        """The derivative by the size of the displacement, at none."""
        after, before = of(self.at(STEP)), of(self.at(-STEP))
        return [(a - b) * 2**79 for a, b in zip(after, before, strict=True)]

    @property
    def unknowns(self) -> Numbers:
        """The displacement and the multipliers' changes, with their derivatives."""
        base = linearise(self.equations).base
        jets = zip(base.displacement, self.eta, self.eta_u, self.eta_uu, self.eta_t, strict=True)
        known = {}
        for f, x, x_u, x_uu, x_t in jets:
            known |= _fields([(f, x), (f.diff(U), x_u), (f.diff((U, 2)), x_uu), (f.diff(T), x_t)])
        for a in base.frozen:
            f = base.stress_change[a]
            known |= _fields([(f, self.lam[a]), (f.diff(U), self.lam_u[a])])
        return known


def _configuration(group: Group, position: Array, angle: Any, vector_: Array) -> Array:
    if group.space == 2:
        c, s = mp.cos(angle), mp.sin(angle)
        return group.pose(position, np.array([[c, -s], [s, c]], dtype=object))
    x = mp.matrix(SE3.hat(np.concatenate([0 * vector_, vector_]))[1:, 1:].tolist())
    return group.pose(position, np.array(mp.expm(x).tolist(), dtype=object))


def _fields(pairs: Any) -> Numbers:
    return {f: sp.Float(mp.nstr(x, DIGITS), DIGITS) for f, x in pairs if is_field(f)}


def _number(x: sp.Expr) -> Any:
    with mp.workdps(DIGITS):
        return mp.mpf(str(x))
