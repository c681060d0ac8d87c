"""Whether the wrench of a law has a potential: closed by the group's own fields, exact by a potential or by topology.

A wrench j is the one-form j_a on the group, in the basis dual to the left-invariant fields X_a. It is closed if and
only if X_a[j_b] - X_b[j_a] = C_abc j_c (Maurer and Cartan), and exact if j = -X[U] for a function U of the
configuration. SE(2) is R^2 x S^1: a closed form that is regular everywhere is exact if and only if its work over a full
turn is zero. SE(3) is R^3 x SO(3), whose loops close after two rounds: there a closed form that is regular everywhere
is exact.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any, Final

import sympy as sp

from geocosserat.derivation.notation import symbol
from geocosserat.model.expressions import symbols
from geocosserat.model.law import Law
from geocosserat.passivity.balls import precision
from geocosserat.passivity.conditions import Conditions, conditions
from geocosserat.passivity.configuration import CAYLEY, ConfigurationLoop, cayley
from geocosserat.passivity.points import enclosure
from geocosserat.passivity.potential import Potential, potential
from geocosserat.passivity.regular import Singular, factors, may_step, singular_factors, symbols_of
from geocosserat.passivity.vanish import Answer, Grade, vanishes
from geocosserat.passivity.wrench_form import THETA, Form, brackets, continuous, form_of, known_factors, over_a_turn
from geocosserat.passivity.wrench_loop import Worker, coordinates_at, near_zero, outward

_COUNTS: Final = "theta counts turns: the law is not of period 2 pi in theta, so it lives on the covering group"
_BITS: Final = 80
_DOUBTFUL: Final = 1e-4
_MOST_SINGULAR: Final = 4


@dataclass(frozen=True)
class Period:
    """Net work over a loop that cannot be drawn together. ``value`` None, with the expression in ``text``, if
    parameters are open; else low <= value <= high (force)."""

    words: str
    text: str
    value: float | None = None
    low: float | None = None
    high: float | None = None


@dataclass(frozen=True)
class WrenchAnswer:
    """closed: no work on small loops; exact: none on any. None: not decided, or if and only if ``conditions`` hold.

    grade: of these two, None if neither is decided. how: in words. conditions: on open parameters, for closed and for
    exact (None: no conditions, or not found; see closed, exact). potential: U with j = -X[U] (force) if a closed form
    was found; of a law that is closed but not exact it is one on the covering group. periods: work over loops that
    cannot be drawn together. witness: a loop on which the body gains work. timed: whether the law depends on t (at
    fixed t, closed and exact are meant). assumptions: what was assumed. singular: where the law is not smooth.
    """

    closed: bool | None
    exact: bool | None
    grade: Grade | None
    how: str
    closed_if: Conditions | None = None
    exact_if: Conditions | None = None
    potential: sp.Expr | None = None
    periods: tuple[Period, ...] = ()
    witness: ConfigurationLoop | None = None
    timed: bool = False
    assumptions: tuple[str, ...] = ()
    singular: tuple[Singular, ...] = ()

    @property
    def energy(self) -> str | None:
        """The potential as text."""
        return None if self.potential is None else str(self.potential)

    @property
    def conditions(self) -> tuple[str, ...]:
        """In words: when closed, when exact."""
        parts = (("closed", self.closed_if), ("exact", self.exact_if))
        joined = {
            word: f"{word} {'if and only if' if c.exact else 'if'} {c}"
            for word, c in parts if c is not None and (c.alternatives or c.exact)
        }  # fmt: skip
        if len(joined) == 2 and self.closed_if == self.exact_if and self.exact_if is not None:
            return (f"closed and exact {'if and only if' if self.exact_if.exact else 'if'} {self.exact_if}",)
        return tuple(joined.values())


def wrench_answer(law: Law) -> WrenchAnswer | None:
    """The answer for the wrench of a law; None if it has none.

    Raises ExpressionError if a component is nowhere defined, TypeError for functions that are not known.
    """
    form = form_of(law)
    if form is None:
        return None
    answer = _decided(form)
    return replace(_counted(form, answer), assumptions=(_COUNTS,)) if form.counted else answer


def _counted(form: Form, answer: WrenchAnswer) -> WrenchAnswer:
    """Theta counts turns, but for some values of open parameters it may be an angle: is the law exact for them too?"""
    turned = [over_a_turn(e) for e in form.components]
    opened = {x.name for e in turned for x in e.free_symbols} & set(form.opened)
    if not opened or answer.exact is not True:
        return answer
    found = conditions(turned, opened, form.positive)
    for alternative in () if found is None else found.alternatives:
        bound = {a: b for a, b in alternative if a.is_Symbol}
        components = tuple(e.subs(bound) for e in form.components)
        part = _closed(replace(form, components=components, counted=False), Answer(True, "proved", ""), False)
        if len(bound) < len(alternative) or part.exact is not True:
            break
    else:
        if found is not None and found.exact:
            return answer
    how = f"{answer.how}; but for some values of {', '.join(sorted(opened))} theta may be an angle"
    return replace(answer, exact=None, how=how)


def _decided(form: Form) -> WrenchAnswer:
    group, timed = form.group, form.timed
    equations = brackets(group, form.components)
    closed = vanishes(equations, form.positive)
    if closed.value is True:
        return _closed(form, closed)
    if closed.value is None:
        witness = _witness(form, None)
        if witness is not None:
            return WrenchAnswer(
                None, False, "proved", f"a loop does net work; closed: {closed.how}", witness=witness, timed=timed,
                singular=form.singular,
            )  # fmt: skip
        return WrenchAnswer(None, None, None, f"closed: {closed.how}", timed=timed, singular=form.singular)
    witness = _witness(form, closed)
    if not form.opened:
        how = f"not closed: {closed.how}" if witness is None else f"not closed: {closed.how}; a loop does net work"
        return WrenchAnswer(
            False, False, closed.grade, how, witness=witness, timed=timed, singular=form.singular
        )  # fmt: skip
    return _conditional(form, closed, equations, witness)


def _conditional(
    form: Form, closed: Answer, equations: Sequence[sp.Expr], witness: ConfigurationLoop | None
) -> WrenchAnswer:
    """Not closed for all values of the open parameters: for which, and exact for which of these?"""
    found = conditions(equations, form.opened, form.positive)
    common: dict[str, Any] = {"witness": witness, "timed": form.timed, "singular": form.singular}
    if found is None:
        how = f"not closed for all values: {closed.how}; conditions not found"
        return WrenchAnswer(None, None, None, how, **common)
    if not found.alternatives:
        if not found.exact:
            return WrenchAnswer(None, None, None, "not closed for any values that were found", **common)
        return WrenchAnswer(False, False, "proved", f"not closed for any values: {closed.how}", **common)
    exact_alternatives, necessary, surely, energies = [], found.exact, True, list[sp.Expr | None]()
    for alternative in found.alternatives:
        bound = {a: b for a, b in alternative if a.is_Symbol}
        if len(bound) != len(alternative):
            surely = False
            continue
        part = replace(form, components=tuple(e.subs(bound) for e in form.components))
        inner = _closed(part, Answer(True, "proved", "under the conditions"), witnesses=False)
        energies.append(inner.potential)
        if inner.exact is True:
            exact_alternatives.append(alternative)
        elif inner.exact is None and inner.exact_if is not None:
            necessary = necessary and inner.exact_if.exact
            exact_alternatives += [(*alternative, *more) for more in inner.exact_if.alternatives]
        elif inner.exact is None:
            surely = False
    # none found says that being closed, if it is, was not seen to be enough
    exact_if = Conditions(tuple(exact_alternatives), necessary and surely)
    never = exact_if.exact and not exact_if.alternatives
    return WrenchAnswer(
        None, False if never else None, "proved" if found.exact else None, f"not closed for all values: {closed.how}",
        closed_if=found, exact_if=exact_if, potential=energies[0] if len(energies) == 1 else None,
        **common,
    )  # fmt: skip


def _closed(form: Form, closed: Answer, witnesses: bool = True) -> WrenchAnswer:
    """Closed beside the steps and where it is defined; is it exact?"""
    group = form.group
    found = potential(group, form.components, form.positive)
    base = WrenchAnswer(
        True, None, closed.grade, f"closed: {closed.how}", timed=form.timed, singular=form.singular,
        potential=None if found is None else found.energy,
    )  # fmt: skip
    jumps = found is None or not continuous(group, found.energy) or may_step(found.energy, symbols_of(group))
    if form.steps and jumps:
        base = replace(base, closed=None, potential=None, how=f"{base.how}, beside its steps")
        return _tried(form, base, witnesses, "no continuous potential was found across the steps")
    if form.steps and _stays_on_steps(form):
        base = replace(base, closed=None, potential=None, how=f"{base.how}, beside its steps")
        return _tried(form, base, witnesses, "on a step itself the wrench may be other than the mean of both sides")
    if found is not None:
        base = replace(base, grade=_least(closed.grade, found.answer.grade))
        if form.holes and not singular_factors(found.energy, symbols_of(group)) <= known_factors(form):
            return _tried(form, base, witnesses, "the potential found is singular where the law is not")
        if form.holes and may_step(found.energy, symbols_of(group)):
            return _tried(form, base, witnesses, "the potential found may step where the law is singular")
        if form.counted or group.rotations == 3:
            return _exact(form, base, f"the potential is verified: {found.answer.how}", witnesses)
        return _turned(form, base, found, witnesses)
    if form.holes:
        return _tried(form, base, witnesses, "no potential was found, and there are holes to go round")
    if form.counted:
        return _exact(form, base, "the covering group is simply connected, the law regular everywhere", witnesses)
    if group.rotations == 3:
        return _exact(form, base, "SE(3) has no first cohomology, the law is regular everywhere", witnesses)
    m = form.components[-1].xreplace({symbol("x"): sp.S.Zero, symbol("y"): sp.S.Zero})
    for mirrored, words in ((m.xreplace({THETA: -THETA}), "odd in theta"),
                            (m.xreplace({THETA: THETA + sp.pi}), "of opposite sign after half a turn")):  # fmt: skip
        if vanishes([m + mirrored], form.positive).value is True:
            return _exact(form, base, f"no work over a full turn at the origin, where m is {words}", witnesses)
    return _tried(form, base, witnesses, "no potential was found, and the work over a full turn is not known")


def _stays_on_steps(form: Form) -> bool:
    """Whether a step is squared, or of a square: at zero, where it is one half, that is not the mean of both sides."""
    pose = set(symbols_of(form.group))
    for e in form.components:
        for step in e.atoms(sp.Heaviside):
            inside, one = step.args[0], sp.Dummy()
            if not inside.free_symbols & pose:
                continue
            marked = e.xreplace({step: one})
            if any(n % 2 == 0 for n in factors(inside).values()) or sp.diff(marked, one, 2) != 0:
                return True
    return False


def _turned(form: Form, base: WrenchAnswer, found: Potential, witnesses: bool) -> WrenchAnswer:
    """In the plane: the potential may change over a full turn."""
    loss = over_a_turn(found.energy)
    work = sp.expand(-loss)
    zero = vanishes([work], form.positive)
    if zero.value is True:
        return _exact(form, replace(base, grade=_least(base.grade, zero.grade)), "the potential is verified: "
                      f"{found.answer.how}", witnesses)  # fmt: skip
    words = "one full turn in the plane"
    if zero.value is None:
        return _tried(form, base, witnesses, f"the work over a full turn is not decided: {zero.how}")
    opened = {x.name for x in work.free_symbols} & set(form.opened)
    witness = _witness(form, zero) if witnesses else None
    if witness is None and any("theta" in symbols(s.zero) for s in form.holes):
        return replace(base, how=f"{base.how}; exact: not decided, the law may have no value somewhere on a full turn")
    if not opened:
        period = Period(words, str(work))
        if not work.free_symbols:
            with precision(_BITS):
                value = enclosure(work, {}, {})
                period = Period(words, str(work), float(value.mid()), *outward(value))
        how = f"{base.how}; not exact: work {work} over a full turn"
        return replace(base, exact=False, periods=(period,), witness=witness, how=how)
    met = conditions([work], opened, form.positive)
    if met is not None and not met.alternatives and met.exact:
        return replace(base, exact=False, periods=(Period(words, str(work)),), witness=witness,
                       how=f"{base.how}; not exact: work {work} over a full turn")  # fmt: skip
    return replace(base, exact_if=met, periods=(Period(words, str(work)),), witness=witness,
                   how=f"{base.how}; work {work} over a full turn")  # fmt: skip


def _exact(form: Form, base: WrenchAnswer, why: str, witnesses: bool) -> WrenchAnswer:
    """Exact, unless a loop says otherwise: then nothing is claimed."""
    if witnesses and not form.timed:
        worker = _worker(form)
        against = _witness(form, None, True, worker)
        if against is not None:
            return replace(base, closed=None, exact=False, grade="proved", potential=None, witness=against,
                           how=f"a loop does net work, although {why}")  # fmt: skip
        if worker.uncertain > _DOUBTFUL:
            return replace(base, exact=None, how=f"{base.how}; exact: {why}, but a loop seems to do net work")
    # at fixed t it is exact: whether it does work as t runs is for a loop to say
    witness = _witness(form, None) if form.timed and witnesses else None
    return replace(base, exact=True, witness=witness, how=f"{base.how}; exact: {why}")


def _tried(form: Form, base: WrenchAnswer, witnesses: bool, why: str) -> WrenchAnswer:
    """Exact is not proved; a loop that does work refutes it."""
    witness = _witness(form, None) if witnesses else None
    if witness is None:
        return replace(base, grade=base.grade if base.closed else None, how=f"{base.how}; exact: not decided, {why}")
    if base.closed is None:
        return replace(base, exact=False, grade="proved", witness=witness,
                       how=f"{base.how}; not exact: a loop does net work")  # fmt: skip
    period = Period(witness.words, f"{witness.work:.12g}", witness.work, witness.low, witness.high)
    return replace(base, exact=False, witness=witness, periods=(period,),
                   how=f"{base.how}; not exact: a loop does net work")  # fmt: skip


def _least(a: Grade | None, b: Grade | None) -> Grade | None:
    order: tuple[Grade | None, ...] = (None, "sampled", "probable", "proved")
    return order[min(order.index(a), order.index(b))]


# loops


def _worker(form: Form) -> Worker:
    return Worker(form.written, {}, form.timed)


def _witness(
    form: Form, refuted: Answer | None, quick: bool = False, worker: Worker | None = None
) -> ConfigurationLoop | None:
    """A loop on which the body gains work. ``quick``: only what floats see."""
    group = form.group
    worker = worker or _worker(form)
    names = sorted({*form.opened, "u"} & worker.names)
    tries: list[Mapping[str, float]] = [
        {name: 0.5 if name == "u" else 1.0 for name in names},
        {name: (0.3, 1.7, 0.6, 1.3)[k % 4] for k, name in enumerate(names)},
    ]
    centres: list[Sequence[float]] = [(0.0,) * group.dimension, _ASIDE[group.name]]
    for s in form.singular[:_MOST_SINGULAR]:
        there = near_zero(group, s.zero, {"t": 0.0, **tries[0]})
        if there is not None and there not in centres:
            centres.append(there)
    if quick:
        return worker.search(group, tries[:1], centres, False, not form.counted)
    if refuted is not None and refuted.point is not None:
        point = refuted.point
        rotation = None
        if group.rotations == 3:
            rotation = cayley(group, [point.get(c.name, Fraction(0)) for c in CAYLEY])
        centres.append(coordinates_at(group, point, rotation))
        tries.append({name: round(float(point.get(name, Fraction(1))), 3) or 1.0 for name in names})
    return worker.search(group, tries if names else tries[:1], centres, turns=not form.counted)


_ASIDE: Final = {"SE(2)": (0.7, 0.4, 0.5), "SE(3)": (0.7, 0.4, -0.3, 0.4, 0.3, -0.6)}
