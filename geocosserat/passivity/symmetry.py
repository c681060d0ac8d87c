"""Which rotations, reflections and reversals leave a law as it is, and what moduli a linear law of that class has.

P. Curie, J. Phys. Theor. Appl. 3, 393 (1894). A law is invariant under E -> A E if stress(A E) = A stress(E) for all E;
rotations by any angle are decided by their generator G, with (d stress / dE) G E = G stress(E).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any, Final

import numpy as np
import sympy as sp

from geocosserat.algebra.groups import Group
from geocosserat.derivation.convert import exact, to_sympy
from geocosserat.derivation.notation import symbol
from geocosserat.model.evaluation import walk
from geocosserat.model.expressions import Call, ExpressionError, evaluate, fixed
from geocosserat.model.law import Law, Vector, rates
from geocosserat.passivity.sections import ANY, Array, about_axis, action, class_name, elements_of, moduli, spin
from geocosserat.passivity.tangent import Grade, names_in, tangent_of, with_values
from geocosserat.passivity.vanish import Answer, vanishes

OBJECTIVE: Final = (
    "objective by construction: the stress is given in the moving frame as a function of the turn phi^-1 phi', which a "
    "rigid motion of the world does not change; a stress that sees the pose cannot be written in this format"
)
PLACES: Final = "reversal is that of the section: u and t are kept"
AXES: Final = "mirror planes and transverse axes are looked for along e2 and e3 only"

_ROUNDING: Final = 1e-8
_SECONDS: Final = 0.6  # for each normal form
_SLOPE: Final = "tan_of_half_the_angle"


@dataclass(frozen=True)
class Invariance:
    """Whether a law is left as it is by an element. ``invariant`` None: not decided. ``reverses``: whether the element
    runs the rod backwards. ``how``: in words; with what shows that it is not, if it is not."""

    name: str
    words: str
    reverses: bool
    invariant: bool | None
    grade: Grade | None
    how: str


@dataclass(frozen=True)
class SymmetryAnswer:
    """The class of a law's section.

    ``elements``: all that were looked at. ``name``: Schoenflies', with e1 as axis; ``words``: the same in words.
    ``grade``: the least of those of the elements. ``even``, ``odd``: numbers of symmetric and antisymmetric moduli that
    a linear law of the class has. ``used_odd``: antisymmetric entries of the tangent at the reference that are not
    zero, as (row, column, half the difference T_ij - T_ji), None if the tangent has no value there.
    """

    elements: tuple[Invariance, ...]
    name: str
    words: str
    grade: Grade
    even: int
    odd: int
    used_odd: tuple[tuple[str, str, str], ...] | None
    objective: str
    assumptions: tuple[str, ...]

    def fields(self) -> dict[str, Any]:
        """The same as numbers, texts, lists and dictionaries."""
        return {
            "name": self.name,
            "words": self.words,
            "grade": self.grade,
            "elements": [
                {
                    "name": e.name, "words": e.words, "reverses": e.reverses, "invariant": e.invariant,
                    "grade": e.grade, "how": e.how,
                }
                for e in self.elements
            ],
            "even": self.even,
            "odd": self.odd,
            "used_odd": None if self.used_odd is None else [list(entry) for entry in self.used_odd],
            "objective": self.objective,
            "assumptions": list(self.assumptions),
        }  # fmt: skip


def symmetry(law: Law) -> SymmetryAnswer | None:
    """The symmetry class of a law's stress; None if it has none.

    An element counts if it is proved, or probable, to leave the stress as it is for all strains, rates and values of
    the open parameters.
    """
    if law.stress is None:
        return None
    checked = _Stress(law)
    elements = tuple(checked.elements())
    found = {e.name for e in elements if e.invariant}
    name, words = class_name(law.group, found)
    even, odd = moduli(law.group, frozenset(found))
    assumptions = [PLACES] if names_in(law.stress) & {"u", "t"} else []
    if law.group.rotations == 3:
        assumptions.append(AXES)
    if law.open:
        assumptions.append(f"for all values of {', '.join(law.open)}; some values may have more symmetry")
    undecided = [e.name for e in elements if e.invariant is None]
    if undecided:
        assumptions.append(f"not decided, and taken not to hold: {', '.join(undecided)}")
    return SymmetryAnswer(
        elements=elements,
        name=name,
        words=words,
        grade="proved" if all(e.grade == "proved" for e in elements) else "probable",
        even=even,
        odd=odd,
        used_odd=_odd_entries(law),
        objective=OBJECTIVE,
        assumptions=tuple(assumptions),
    )


class _Stress:
    """The stress of a law, in floats for a first look and in exact symbols for the decision."""

    def __init__(self, law: Law) -> None:
        self.group: Group = law.group
        self.law = law
        self.written: Vector = with_values(law, law.stress or ())
        self.exact: Any = None  # list of d expressions
        self.trouble = ""
        try:
            self.exact = [to_sympy(e) for e in self.written]
        except ExpressionError as error:
            self.trouble = str(error)
        self.positive = tuple(name for name, sign in law.open.items() if sign == "positive")
        self.rated = bool(names_in(self.written) & set(rates(self.group)))
        self.smooth = not any(
            isinstance(node, Call) and node.function in ("abs", "heaviside") for e in self.written for node in walk(e)
        )
        self.points = self._points()

    def _points(self) -> dict[str, Any]:
        """Random values of all names, near the reference: (N,)."""
        chance = np.random.default_rng(1)
        law, count = self.law, 24
        env = {
            name: rest + chance.uniform(-0.4, 0.4, count)
            for name, rest in zip(self.group.strain, law.reference, strict=True)
        }
        env |= {name: chance.uniform(-1, 1, count) for name in rates(self.group)}
        env |= {name: chance.uniform(0.2, 1.8, count) for name in (*law.open, "u", "t")}
        return env

    def elements(self) -> Iterable[Invariance]:
        """All elements of the group, those last that follow from others."""
        known: dict[str, Answer] = {}
        if self.group.rotations == 3:
            words = "rotations about e1 by any angle"
            known[ANY] = self._any_angle()
            yield _said(ANY, words, False, known[ANY])
        for e in elements_of(self.group):
            known[e.name] = self._implied(e.name, known) or self._under(action(self.group, e.frame, e.reverses))
            yield _said(e.name, e.words, e.reverses, known[e.name])

    def _implied(self, name: str, known: Mapping[str, Answer]) -> Answer | None:
        """What follows from elements already decided, as they are a group; None if nothing does."""
        def value(other: str) -> bool | None:
            return known[other].value if other in known else None

        def grade(*others: str) -> Grade:
            return "proved" if all(known[o].grade == "proved" for o in others) else "probable"

        if name in ("C2", "C3", "C4", "C6") and value(ANY):
            return Answer(True, grade(ANY), "follows from rotations by any angle")
        for power in _POWERS.get(name, ()):
            if value(power) is False:
                return Answer(False, grade(power), f"would make {power} hold, a power of it")
        for triple in _TRIPLES[self.group.rotations]:
            if name in triple:
                others = [o for o in triple if o != name]
                held = {value(o) for o in others}
                if held == {True}:
                    return Answer(True, grade(*others), f"follows from {' and '.join(others)}")
                if held == {True, False}:
                    return Answer(False, grade(*others), f"would make {' and '.join(others)} hold together")
        return None

    def _under(self, matrix: Array, numbers: Array | None = None) -> Answer:
        """Whether stress(A E) = A stress(E), with the rates going as E does; ``numbers``: A for a first look."""
        numbers = matrix if numbers is None else numbers
        strain = self.group.strain
        if self.exact is None:
            return Answer(None, None, self.trouble)
        moved = {name: _row(row, strain) for name, row in zip(strain, matrix, strict=True)}
        if self.rated:
            dotted = rates(self.group)
            moved |= {name: _row(row, dotted) for name, row in zip(dotted, matrix, strict=True)}
        replaced = {symbol(name): e for name, e in moved.items()}

        def off(i: int) -> sp.Expr:
            return self.exact[i].xreplace(replaced) - sum(a * e for a, e in zip(matrix[i], self.exact, strict=True))

        return self._decided(off, self._look(np.array(numbers, dtype=np.float64)))

    def _any_angle(self) -> Answer:
        """By the generator; where the stress has kinks or steps, by a rotation with the angle left open."""
        look = self._look(np.array(self._turned(math.cos(1.0), math.sin(1.0)), dtype=np.float64))
        if self.exact is None:
            return Answer(None, None, self.trouble)
        if not self.smooth:
            if look is not None:
                return self._under(self._turned(sp.Rational(5, 13), sp.Rational(12, 13)))
            slope = symbol(_SLOPE)
            bottom = 1 + slope**2
            half = self._turned((1 - slope**2) / bottom, 2 * slope / bottom)
            return self._under(half, self._turned(math.cos(1.0), math.sin(1.0)))
        generator = spin(self.group)
        names = [self.group.strain] + ([rates(self.group)] if self.rated else [])

        def off(i: int) -> sp.Expr:
            along = [
                self.exact[i].diff(symbol(name)) * _row(row, group)
                for group in names for name, row in zip(group, generator, strict=True)
            ]  # fmt: skip
            return sum(along) - sum(int(a) * e for a, e in zip(generator[i], self.exact, strict=True))

        return self._decided(off, look)

    def _turned(self, cosine: Any, sine: Any) -> Array:
        return action(self.group, about_axis(cosine, sine), False)

    def _decided(self, off: Callable[[int], sp.Expr], look: int | None) -> Answer:
        """Whether all entries vanish; the one that seems not to is tried alone, as it then is enough."""
        near = {
            name: Fraction(repr(rest)) for name, rest in zip(self.group.strain, self.law.reference, strict=True) if rest
        }
        if look is not None:
            alone = vanishes([off(look)], self.positive, near, seconds=_SECONDS)
            if alone.value is False:
                return replace(alone, entry=look, how=alone.how.replace("entry 1", self.group.stress[look]))
        return vanishes([off(i) for i in range(self.group.dimension)], self.positive, near, seconds=_SECONDS)

    def _look(self, matrix: Array) -> int | None:
        """The entry that is most off at random points in floats, None if none is: which to decide exactly."""
        env = dict(self.points)
        for group in (self.group.strain, rates(self.group)):
            values = matrix @ np.array([self.points[name] for name in group])
            env |= dict(zip(group, values, strict=True))
        here, there = (
            np.array([np.broadcast_to(evaluate(e, at), 24) for e in self.written]) for at in (self.points, env)
        )
        with np.errstate(all="ignore"):
            right = matrix @ here
            off = np.abs(there - right) / (np.abs(there) + np.abs(right) + 1e-300)
            size = np.nanmax(np.where(np.isfinite(here), np.abs(here), 0.0), initial=1e-300)
            off = np.where(np.isfinite(off) & (np.abs(there - right) > _ROUNDING * size), off, 0.0).max(axis=1)
        return int(off.argmax()) if off.max() > _ROUNDING else None


# of which each two make the third
_TRIPLES: Final[dict[int, tuple[tuple[str, str, str], ...]]] = {
    1: (("C2", "m", "mh"),),
    3: (
        ("C6", "C2", "C3"), ("C2", "m12", "m13"), ("D2", "mh", "m12"), ("D3", "mh", "m13"), ("i", "mh", "C2"),
        ("D3", "D2", "C2"), ("i", "D2", "m13"), ("i", "D3", "m12"), ("S4", "mh", "C4"),
    ),
}  # fmt: skip
_POWERS: Final[dict[str, tuple[str, ...]]] = {"C4": ("C2",), "C6": ("C2", "C3"), "S4": ("C2",)}


def _said(name: str, words: str, reverses: bool, answer: Answer) -> Invariance:
    how = answer.how
    if answer.value is False and answer.point:
        how += f", for example at {', '.join(f'{k} = {v}' for k, v in answer.point.items())}"
    return Invariance(name, words, reverses, answer.value, answer.grade, how)


def _row(row: Sequence[Any], names: Sequence[str]) -> sp.Expr:
    return sp.Add(*(x * symbol(name) for x, name in zip(row, names, strict=True)))


def _odd_entries(law: Law) -> tuple[tuple[str, str, str], ...] | None:
    """Half of T_ij - T_ji at the reference, for i < j, where it is not zero."""
    tangent = tangent_of(law)
    if tangent is None:
        return None
    strain = law.group.strain
    pairs = [(i, j) for i in range(len(strain)) for j in range(i + 1, len(strain))]
    found = []
    for i, j in pairs:
        e = tangent.matrix[i][j] - tangent.matrix[j][i]
        if tangent.matrix[i][j] is tangent.matrix[j][i]:
            continue
        for r in tangent.ranges:
            e = fixed(e, r.name, r.rest)
        try:
            value = to_sympy(e) * exact(0.5)
        except ExpressionError:
            return None
        if value != 0 and vanishes([value], tuple(n for n, s in law.open.items() if s == "positive")).value is not True:
            found.append((strain[i], strain[j], str(value)))
    return tuple(found)
