"""Is a stress conservative? Whether its tangent is symmetric, what its steps and its singular sets do, its energy."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Final, TypeAlias

import sympy as sp

from geocosserat.derivation.convert import exact, to_sympy
from geocosserat.derivation.notation import symbol
from geocosserat.model.expressions import (
    Binary,
    Call,
    Expression,
    ExpressionError,
    Negate,
    Number,
    derivative,
    substitute,
    symbols,
)
from geocosserat.model.law import Law, Vector, at_rest
from geocosserat.passivity.balls import rational
from geocosserat.passivity.conditions import Conditions, conditions
from geocosserat.passivity.energy import Energy, Split, energy_of, split
from geocosserat.passivity.loop import Loop, Plane, find_loop
from geocosserat.passivity.ranges import ALL, Range, sign_on
from geocosserat.passivity.readable import readable, to_expression
from geocosserat.passivity.singular import Singular, singular_sets
from geocosserat.passivity.steps import Steps, continuous, steps_of
from geocosserat.passivity.vanish import Answer, Grade, vanishes

Curl: TypeAlias = tuple[Plane, sp.Expr]
"""(i, j), i < j, and d Sigma_j / d E_i - d Sigma_i / d E_j."""

_PARTING: Final = ("wall", "edge", "small")
"""Singular sets that leave every piece of the strains without holes."""


@dataclass(frozen=True)
class StressAnswer:
    """What is known of the elastic part of a stress.

    conservative: whether the stress is the gradient of an energy wherever it is regular, at fixed t; None if not
    decided. grade: of that answer. how: in words. curl: the entries of twice the antisymmetric part of the tangent that
    do not vanish. conditions: on open parameters; the stress then counts as conservative only if they hold always.
    energy: density whose gradient it is, and density_expression the same for a model, if it has a place there. split:
    of a stress that has none. witness: a loop with certified work. singular: where the law is singular. steps: its
    surfaces of steps and kinks. timed: whether the stress depends on t explicitly, and so is driven; None if that was
    not decided. viscous: whether rates were set to zero. stress: the elastic part as expressions, all values put in,
    and steps that lie outside the domain settled.
    """

    conservative: bool | None
    grade: Grade | None
    how: str
    curl: tuple[Curl, ...] = ()
    conditions: Conditions | None = None
    energy: Energy | None = None
    density_expression: Expression | None = None
    split: Split | None = None
    witness: Loop | None = None
    singular: tuple[Singular, ...] = ()
    steps: Steps | None = None
    timed: bool | None = False
    viscous: bool = False
    stress: Vector = ()


def elastic_stress(law: Law) -> Vector:
    """The stress at zero rates, with the values of the parameters that have one. Raises ValueError without stress."""
    if law.stress is None:
        raise ValueError(f"{law.name}: expected a law with a stress, found none; write [stress] or [energy]")
    return tuple(_elastic(e, law) for e in law.stress)


def strain_box(law: Law) -> dict[str, Range]:
    """The declared domain, without bound where nothing is declared."""
    box: dict[str, Range] = dict.fromkeys(law.group.strain, ALL)
    for name, (low, high) in law.domain.items():
        box[name] = (low if math.isinf(low) else rational(low), high if math.isinf(high) else rational(high))
    return box


def check_stress(law: Law) -> StressAnswer:
    """Whether the stress of a law is conservative, with a proof or a witness. Raises ValueError without stress."""
    answer = _checked(law)
    if answer.conservative is False and law.open and answer.conditions is None:
        # work of steps or around lines: no system to solve, so what is open is set to zero, one at a time
        real = [name for name, sign in law.open.items() if sign == "real"]
        zero = [name for name in real if _checked(_without(law, name)).conservative]
        found = tuple(((symbol(name), sp.S.Zero),) for name in zero)
        answer = replace(answer, conditions=Conditions(found, exact=False))
    elif answer.conservative is False and answer.conditions is not None:
        answer = replace(answer, conditions=_kept(law, answer, answer.conditions))
    return answer


def _kept(law: Law, answer: StressAnswer, found: Conditions) -> Conditions:
    """The conditions under which a symmetric tangent is enough: steps and lines may do work still."""
    question = _Question(law)
    steps = steps_of(question.exact, question.strain, question.positive, question.box)
    if steps.workless and all(s.shape in _PARTING for s in answer.singular):
        return found
    alternatives, exact = [], found.exact
    for alternative in found.alternatives:
        values = {a.name: to_expression(b) for a, b in alternative if a.is_Symbol}
        bound = {name: value for name, value in values.items() if value is not None}
        if len(bound) < len(alternative) or law.stress is None:
            exact = False
            continue
        opened = {name: sign for name, sign in law.open.items() if name not in bound}
        stress = tuple(substitute(e, bound) for e in law.stress)
        part = _checked(replace(law, stress=stress, energy=None, open=opened))
        if part.conservative:
            alternatives.append(alternative)
        elif part.conservative is None or any(symbols(e) & set(opened) for e in part.stress):
            exact = False
    return Conditions(tuple(alternatives), exact)


def _checked(law: Law) -> StressAnswer:
    try:
        return replace(_Question(law).answer(), viscous=law.viscous)
    except (ExpressionError, TypeError) as error:
        return StressAnswer(None, None, f"not decided: {error}", viscous=law.viscous)


def _without(law: Law, name: str) -> Law:
    opened = {other: sign for other, sign in law.open.items() if other != name}
    return replace(law, parameters={**law.parameters, name: 0.0}, open=opened)


def _elastic(e: Expression, law: Law) -> Expression:
    return substitute(at_rest(e, law.group), {name: Number(float(value)) for name, value in law.parameters.items()})


def _settled(e: Expression, box: Mapping[str, Range]) -> Expression:
    """Steps and moduli replaced whose argument keeps its sign in the box; x/abs(x) as a step, which it is but at 0."""
    match e:
        case Binary("/", Binary("*", left, right), Call("abs", argument)) if argument in (left, right):
            return _settled(right if argument == left else left, box) * _sign(argument, box)
        case Binary("/", left, Call("abs", argument)) if left == argument:
            return _sign(argument, box)
        case Call(function, argument):
            inner = _settled(argument, box)
            if function in ("abs", "heaviside") and symbols(inner) & set(box) and (sign := sign_on(inner, box)):
                if function == "abs":
                    return inner if sign > 0 else Negate(inner)
                return Number(1.0 if sign > 0 else 0.0)
            return Call(function, inner)
        case Binary(mark, left, right):
            return Binary(mark, _settled(left, box), _settled(right, box))
        case Negate(operand):
            return Negate(_settled(operand, box))
    return e


def _sign(e: Expression, box: Mapping[str, Range]) -> Expression:
    return 2 * _settled(Call("heaviside", e), box) - 1


class _Question:
    """One law, in the forms in which it is asked about."""

    def __init__(self, law: Law) -> None:
        self.law, self.names = law, law.group.strain
        self.box = strain_box(law)
        self.reference = tuple(rational(x) for x in law.reference)
        self.stress = elastic_stress(law)
        settled = tuple(_settled(e, self.box) for e in self.stress)
        self.strain = [symbol(name) for name in self.names]
        self.exact = [to_sympy(e) for e in settled]
        self.settled = settled
        n = len(self.names)
        self.planes: list[Plane] = [(i, j) for i in range(n) for j in range(i + 1, n)]
        self.curl = [
            to_sympy(derivative(settled[j], self.names[i])) - to_sympy(derivative(settled[i], self.names[j]))
            for i, j in self.planes
        ]
        self.positive = frozenset(name for name, sign in law.open.items() if sign == "positive") | {"u", "t"}
        self.near = {name: x for name, x in zip(self.names, self.reference, strict=True)} | {"u": Fraction(1, 2)}
        self.within = {
            name: (Fraction(low), Fraction(high))
            for name, (low, high) in self.box.items()
            if not math.isinf(low) and not math.isinf(high)
        }
        self.centre = {name: exact(float(x)) for name, x in zip(self.names, law.reference, strict=True)}

    def _vanish(self, entries: Sequence[sp.Expr]) -> Answer:
        return vanishes(entries, self.positive, self.near, self.within)

    def answer(self) -> StressAnswer:
        asked = self._vanish(self.curl)
        found = StressAnswer(None, None, asked.how, timed=self._timed(), stress=self.settled)
        if asked.value is None:
            return found
        singular = singular_sets(self.settled, self.names, self.box, self.positive, self.centre)
        found = replace(found, singular=singular)
        if not self._defined():
            return replace(found, how="not decided: the stress has a value at none of the random points")
        if asked.value is False:
            return self._curled(found, asked)
        return self._symmetric(found, asked)

    def _defined(self) -> bool:
        one = sp.Symbol("one", real=True)  # a function that vanishes nowhere, to be refuted where all have a value
        total = [*self.exact, one**2 + 1]
        return vanishes([sp.Add(*(e**2 for e in total))], self.positive, self.near, self.within).value is False

    def _timed(self) -> bool | None:
        now, later = symbol("t"), symbol("t_later")
        if not any(e.has(now) for e in self.exact):
            return False
        same = vanishes(
            [e - e.subs(now, later) for e in self.exact], self.positive | {"t_later"}, self.near, self.within
        ).value
        return None if same is None else not same

    def _curled(self, found: StressAnswer, asked: Answer) -> StressAnswer:
        """The tangent is not symmetric."""
        curl = tuple(
            (plane, readable(e, self.positive))
            for plane, e in zip(self.planes, self.curl, strict=True)
            if e != 0 and self._vanish([e]).value is not True
        )
        when = conditions(self.curl, self._open(), self.positive) if self._open() else None
        witness = self._loop([plane for plane, _ in curl], asked)
        how = f"the tangent is not symmetric: {asked.how}"
        if witness is not None:
            how += f"; a loop with net work {witness.work:.6g}, enclosed with {witness.bits} bits"
        parts = split(self.exact, self.strain, [self.centre[name] for name in self.names], self.positive)
        return replace(
            found, conservative=False, grade="proved", how=how, curl=curl, conditions=when, split=parts, witness=witness
        )

    def _open(self) -> frozenset[str]:
        return frozenset(x.name for e in self.exact for x in e.free_symbols) & frozenset(self.law.open)

    def _values(self, asked: Answer | None) -> list[dict[str, Fraction]]:
        """Choices of what is open, simple numbers first."""
        names = sorted({x.name for e in self.exact for x in e.free_symbols} - set(self.names))
        if not names:
            return [{}]
        fixed_ones = {name: Fraction(1, 2) for name in names if name in ("u", "t")}
        free = [name for name in names if name not in fixed_ones]
        choices = [dict.fromkeys(free, Fraction(1)) | fixed_ones] if len(free) <= 1 else []
        choices.append({name: Fraction(i + 1) for i, name in enumerate(free)} | fixed_ones)
        choices.append({name: Fraction(1, i + 1) for i, name in enumerate(free)} | fixed_ones)
        if asked is not None and asked.point is not None:
            choices.append({name: asked.point[name] for name in names if name in asked.point})
            choices[-1] |= {name: Fraction(1) for name in names if name not in choices[-1]}
        return choices

    def _loop(
        self,
        planes: Sequence[Plane],
        asked: Answer | None,
        centres: Sequence[Sequence[Fraction]] = (),
        deep: bool = True,
    ) -> Loop | None:
        at = list(centres)
        if asked is not None and asked.point is not None:
            at.append([asked.point.get(name, x) for name, x in zip(self.names, self.reference, strict=True)])
        values = self._values(asked)
        found = find_loop(self.settled, self.names, self.reference, self.box, planes, values, centres, deep=False)
        if found is None and (deep or at):
            found = find_loop(self.settled, self.names, self.reference, self.box, planes, values, at, deep)
        return found

    def _symmetric(self, found: StressAnswer, asked: Answer) -> StressAnswer:
        """The tangent is symmetric wherever the law is regular: is the stress a gradient?"""
        steps = steps_of(self.exact, self.strain, self.positive, self.box)
        found = replace(found, steps=steps)
        if steps.workless is not True:
            witness = self._loop(self.planes, None, self._on(steps.surfaces), deep=False)
            if witness is not None:
                how = f"symmetric tangent, but {steps.how}; a loop across it has net work {witness.work:.6g}"
                return replace(found, conservative=False, grade="proved", how=how, witness=witness)
            return replace(found, how=f"not decided: symmetric tangent, but {steps.how}")
        lines = [s for s in found.singular if s.shape == "line"]
        for line in lines:
            if (witness := self._around(line)) is not None:
                how = f"symmetric tangent, but a loop around {line.expression} = 0 has net work {witness.work:.6g}"
                parts = split(self.exact, self.strain, list(self.centre.values()), self.positive)
                return replace(found, conservative=False, grade="proved", how=how, witness=witness, split=parts)
        given = to_sympy(_elastic(self.law.energy, self.law)) if self.law.energy is not None else None
        if given is not None and given.has(sp.Heaviside, sp.sign):
            given = None  # its own steps are not seen by its slope
        energy = energy_of(
            self.exact, self.strain, list(self.centre.values()), self.positive, given,
            lambda density: self._as_regular(density, found.singular),
        )  # fmt: skip
        written = None if energy is None else to_expression(energy.density)
        found = replace(found, energy=energy, density_expression=written)
        holes = [s for s in found.singular if s.shape not in _PARTING]
        grade: Grade = "proved" if asked.grade == "proved" else "probable"
        how = f"symmetric tangent ({asked.how})" + (f"; steps: {steps.how}" if steps.surfaces else "")
        if any(s.shape == "essential" for s in found.singular):
            where = ", ".join(f"{s.expression} = 0" for s in found.singular if s.shape == "essential")
            why = f"the law may step across {where}; declare a domain without it"
            return replace(found, how=f"not decided: {how}, but {why}")
        if not holes:
            return replace(found, conservative=True, grade=grade, how=how)
        where = ", ".join(f"{s.expression} = 0 ({s.shape})" for s in holes)
        if energy is not None:
            grade = grade if energy.grade == "proved" else "probable"
            how += "; an energy without more singular sets than the stress"
            return replace(found, conservative=True, grade=grade, how=how)
        witness = self._loop(self.planes, None, deep=False)
        if witness is not None:
            how = f"symmetric tangent, but a loop has net work {witness.work:.6g}"
            return replace(found, conservative=False, grade="proved", how=how, witness=witness)
        why = f"singular at {where}, and no energy was found that is regular around it"
        return replace(found, how=f"not decided: {how}, but {why}")

    def _as_regular(self, density: sp.Expr, singular: Sequence[Singular]) -> bool:
        """Whether a density is continuous and regular wherever the stress is."""
        # an arctangent is regular where its argument is
        turning = [to_expression(part.args[0]) for part in density.atoms(sp.atan)]
        energy = to_expression(density.replace(sp.atan, lambda z: z))
        if energy is None or None in turning or not continuous(density, self.strain, self.positive):
            return False
        # it steps where its argument has a pole, and the stress may be finite there
        inside = [e for e in turning if e is not None]
        if singular_sets(inside, self.names, self.box, self.positive, self.centre):
            return False
        known = {str(s.expression) for s in singular}
        own = singular_sets([energy], self.names, self.box, self.positive, self.centre)
        return all(
            s.shape != "essential" and (str(s.expression) in known or str(-s.expression) in known) for s in own
        )

    def _on(self, surfaces: Sequence[sp.Expr]) -> list[list[Fraction]]:
        """Points on surfaces that are linear in a component, a little beside the reference."""
        points = []
        for p in surfaces:
            for k, x in enumerate(self.strain):
                slope = sp.diff(p, x)
                if not slope.is_Rational or slope == 0:
                    continue
                for offset in (Fraction(0), Fraction(1, 5)):
                    at = {
                        y: sp.Rational(c.numerator, c.denominator) + sp.Rational(offset.numerator, offset.denominator)
                        for y, c in zip(self.strain, self.reference, strict=True)
                    }
                    value = (x - p / slope).subs(x, 0).subs(at)
                    if value.is_Rational:
                        point = [Fraction(int(v.p), int(v.q)) for v in at.values()]
                        point[k] = Fraction(int(value.p), int(value.q))
                        points.append(point)
                break
        return points

    def _around(self, line: Singular) -> Loop | None:
        """A loop around a line, in a plane that crosses it."""
        if line.point is None:
            return None
        centre = [
            Fraction(int(v.p), int(v.q)) if (v := line.point.get(name)) is not None else x
            for name, x in zip(self.names, self.reference, strict=True)
        ]
        inside = [i for i, name in enumerate(self.names) if name in line.point]
        planes = [(i, j) for i, j in self.planes if i in inside and j in inside]
        return find_loop(
            self.settled, self.names, centre, self.box, planes, self._values(None), deep=False, wide=False
        )

