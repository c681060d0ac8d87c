"""What a law stores: its energy as an expression for the kernels of a rod, and the part of the stress that has none."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from geocosserat.model.effects.law_wrench import LawWrench
from geocosserat.model.expressions import Expression, Number, derivative, evaluate
from geocosserat.model.law import Law, at_rest
from geocosserat.model.records import RodModel
from geocosserat.passivity.energy import Split
from geocosserat.passivity.readable import to_expression
from geocosserat.passivity.stress import StressAnswer, check_stress
from geocosserat.passivity.wrench import wrench_answer

_POINTS: Final = 20


def stored(model: RodModel) -> RodModel:
    """The rod with what its law stores: the energy of its stress, and whether its wrench has a potential."""
    law = None if model.law is None else storing(model.law)
    effects = [_potential(e) if isinstance(e, LawWrench) else e for e in model.effects]
    return replace(model, law=law, effects=tuple(effects))


def _potential(effect: LawWrench) -> LawWrench:
    answer = wrench_answer(effect.law)
    exact = answer is not None and answer.exact and answer.grade == "proved" and not answer.timed
    return replace(effect, gives=not exact)


def storing(law: Law) -> Law:
    """The law with its energy and the remainder of its stress at rest, as far as they were found; as it is if it has an
    energy.

    They are looked for with all parameters open, so that a kernel serves every value of them, and else for their
    values. Where nothing is found, all that the stress does counts as lost.
    """
    if law.stress is None or law.energy is not None:
        return law
    general = replace(law, parameters={}, open={**law.open, **dict.fromkeys(law.parameters, "real")})
    for question in (general, law) if law.parameters else (law,):
        found = _parts(check_stress(question))
        if found is not None:
            stored = replace(law, energy=found[0], remainder=found[1])
            if _adds_up(stored):
                return stored
    return law


def _adds_up(law: Law) -> bool:
    """Whether gradient and remainder add up to the stress at rest, in double precision, around the reference."""
    assert law.stress is not None
    assert law.energy is not None
    chance = np.random.default_rng(1)
    at = np.array(law.reference)[:, None] + chance.uniform(-0.3, 0.3, (len(law.reference), _POINTS))
    values = {**law.parameters, **dict(zip(law.group.strain, at, strict=True)), "u": 0.3, "t": 0.7}
    rest = law.remainder or (Number(0.0),) * len(law.stress)
    for name, stress, remainder in zip(law.group.strain, law.stress, rest, strict=True):
        parts = [np.broadcast_to(evaluate(e, values), at.shape[1:]) for e in (derivative(law.energy, name), remainder)]
        expected = np.broadcast_to(evaluate(at_rest(stress, law.group), values), at.shape[1:])
        known = np.isfinite(expected)
        size = 1e-300 + sum(np.abs(part) for part in (*parts, expected))
        if not np.all(np.abs(sum(parts) - expected)[known] <= 1e-9 * size[known]):
            return False
    return True


def _parts(answer: StressAnswer) -> tuple[Expression, tuple[Expression, ...]] | None:
    """Energy and remainder; no remainder where the stress is conservative for certain."""
    if answer.conservative and answer.grade == "proved" and answer.density_expression is not None:
        return answer.density_expression, ()
    return None if answer.split is None else _of_split(answer.split)


def _of_split(split: Split) -> tuple[Expression, tuple[Expression, ...]] | None:
    energy, *remainder = (to_expression(e) for e in (split.energy, *split.remainder))
    if energy is None or None in remainder:
        return None
    rest = tuple(Number(0.0) if e is None else e for e in remainder)
    return energy, rest if any(e != Number(0.0) for e in rest) else ()
