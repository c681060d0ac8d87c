"""The zoo: no verdict is wrong, hardly any is missing, and `run` confirms what the witnesses say."""

from __future__ import annotations

import json
from collections.abc import Iterable
from functools import cache
from typing import Any

import mpmath
import numpy as np
import pytest
import sympy as sp

import geocosserat
from geocosserat.derivation.convert import to_sympy
from geocosserat.derivation.notation import symbol
from geocosserat.model.expressions import evaluate
from geocosserat.model.law import load_law
from geocosserat.model.scene import load_scene
from geocosserat.passivity.check import Check, check
from geocosserat.passivity.loop import Loop
from geocosserat.passivity.verdict import GRADES
from tests.passivity.zoo import ZOO

QUICK = ("odd, shear and bend", "vortex", "couple", "flow in space")
"""Witnesses that are run each time; the others are slow in sum."""

VISCOUS = ("Kelvin-Voigt, negative", "Kelvin-Voigt, quadratic")
"""Active by their rates alone: no loop of strain shows it."""

WORKING = [
    name for name, known in ZOO.items()
    if known.verdict == "active" and "stress" in known.law and name not in VISCOUS
]  # fmt: skip
DRIVEN = [
    name for name, known in ZOO.items()
    if known.verdict == "driven" and "wrench" in known.law and "sin(t)" not in str(known.law) and name != "motor"
]  # fmt: skip


def _marked(names: Iterable[str], slow: Iterable[str]) -> list[Any]:
    late = set(slow)
    return [pytest.param(name, marks=pytest.mark.slow) if name in late else name for name in names]


SLOW = [name for name, known in ZOO.items() if known.slow]


@cache
def found(name: str) -> Check:
    """What is found of a law of the zoo."""
    return check(load_law({"name": name, **ZOO[name].law}))


def confirmed(text: str, work: float) -> None:
    """The ledger of the scene has the certified work as negative dissipation; nothing stays stored, the grips gain."""
    ended = geocosserat.run(text, settings=["run.backend=numpy"])
    ledger = ended.ledger
    assert ledger["dissipated"] == pytest.approx(-work, rel=1e-6, abs=0)
    most = max(work, float(np.ptp(ended.solution.energy)))
    assert abs(ledger["stored"]) <= 1e-6 * work + 1e-11 * most
    assert abs(ledger["work"] + work) <= 1e-6 * work + 1e-11 * most


def test_the_zoo_is_large_and_at_most_two_of_it_are_undecided() -> None:
    """The verdicts are those that each law is held to below; every kind of verdict is there in number."""
    verdicts = [known.verdict for known in ZOO.values()]
    assert len(verdicts) >= 100
    assert verdicts.count("undecided") <= 2
    assert min(verdicts.count(v) for v in ("passive", "active", "driven")) >= 12
    assert all(known.why and known.why.strip() for known in ZOO.values())


@pytest.mark.parametrize("name", _marked(ZOO, SLOW))
def test_the_verdict_is_the_known_one(name: str) -> None:
    """Verdict, grade (at least), conditions; what is not passive says so in some part, what is passive has no scene."""
    known, answer = ZOO[name], found(name)
    assert answer.verdict == known.verdict, [part.why for part in answer.parts]
    assert not answer.failed
    if known.grade is None:
        assert answer.grade is None
    else:
        assert answer.grade is not None
        assert GRADES.index(answer.grade) >= GRADES.index(known.grade)
    assert all(text in " ".join(answer.conditions) for text in known.conditions), answer.conditions
    if known.verdict == "passive":
        assert not answer.scenes
        assert not answer.conditions
    json.dumps(answer.fields, allow_nan=False)


OPENED = [n for n in ZOO if any(isinstance(x, dict) for x in ZOO[n].law.get("parameters", {}).values())]


@pytest.mark.parametrize("name", _marked(OPENED, SLOW))
def test_where_a_condition_holds_the_law_is_passive(name: str) -> None:
    """With values that satisfy what is said, however the others are chosen, nothing gives energy any more."""
    answer = found(name)
    parts = [part for part in (answer.stress and answer.stress.conditions, answer.wrench and answer.wrench.exact_if)]
    claimed = [text for text in answer.conditions if "only if" not in text.replace("if and only if", "")]
    for conditions in parts:
        for alternative in conditions.alternatives if conditions and claimed else ():
            values = {name: 0.37 + 0.21 * k for k, name in enumerate(answer.law.open)}
            chosen = {symbol(key): x for key, x in values.items()}
            for left, right in alternative:
                assert left.is_Symbol
                values[left.name] = float(right.subs(chosen))
            closed = check(load_law(ZOO[name].law, values), brief=True)
            assert closed.verdict == "passive", (values, [part.why for part in closed.parts])


@pytest.mark.parametrize("name", [n for n in ZOO if ZOO[n].verdict == "passive" and n not in SLOW])
def test_a_passive_stress_has_an_energy(name: str) -> None:
    """A density, of which the differences are the stress at strains near the reference."""
    answer = found(name)
    if answer.stress is None:
        return
    assert answer.stress.energy is not None
    law, h = answer.law, 1e-5
    rest = [x + 0.05 * (k + 1) for k, x in enumerate(law.reference)]
    at = dict(zip(law.group.strain, rest, strict=True)) | {"u": 0.3, "t": 0.7, **dict.fromkeys(law.open, 0.8)}

    def density(**moved: float) -> float:
        return float(answer.stress.energy.density.subs({symbol(n): x for n, x in (at | moved).items()}))  # type: ignore[union-attr]

    for n, s in zip(law.group.strain, answer.stress.stress, strict=True):
        slope = (density(**{n: at[n] + h}) - density(**{n: at[n] - h})) / (2 * h)
        assert slope == pytest.approx(float(evaluate(s, at)), rel=1e-6, abs=1e-7)


@pytest.mark.parametrize("name", _marked(WORKING, {n for n in WORKING if n not in QUICK}))
def test_run_confirms_the_witness_of_a_stress(name: str) -> None:
    """Once round the loop, the ledger shows what was certified; faint work stands in its bounds only."""
    answer = found(name)
    assert answer.stress is not None
    loop = answer.stress.witness
    assert loop is not None
    assert 0 < loop.low <= loop.work <= loop.high
    text = answer.scenes["stress"]
    if ZOO[name].faint:
        load_scene(text)
    else:
        confirmed(text, loop.work)


def many_digits(answer: Check, loop: Loop, nodes: int = 96) -> Any:
    """Minus the sum of stress times step round a loop, in 80 digits: the trapezoidal rule, for smooth laws."""
    names = answer.law.group.strain
    assert answer.stress is not None
    stress = [sp.lambdify([symbol(n) for n in names], to_sympy(e), "mpmath") for e in answer.stress.stress]
    total = mpmath.mpf(0)
    for k in range(nodes):
        angle = 2 * mpmath.pi * k / nodes
        at = [mpmath.mpf(c.numerator) / c.denominator for c in loop.centre]
        (a, b) = (mpmath.mpf(r.numerator) / r.denominator for r in loop.radii)
        at[loop.first] += a * mpmath.cos(angle)
        at[loop.second] += b * mpmath.sin(angle)
        total += stress[loop.first](*at) * a * mpmath.sin(angle) - stress[loop.second](*at) * b * mpmath.cos(angle)
    return total * 2 * mpmath.pi / nodes


@pytest.mark.parametrize("name", _marked([n for n in ZOO if ZOO[n].faint], SLOW))
def test_faint_work_is_confirmed_in_many_digits(name: str) -> None:
    """What double precision cannot show, 80 digits and another rule of integration do: it is within the bounds."""
    answer = found(name)
    assert answer.stress is not None
    loop = answer.stress.witness
    assert loop is not None
    with mpmath.workdps(80):
        assert 0 < loop.low <= many_digits(answer, loop) <= loop.high


@pytest.mark.parametrize("name", _marked(DRIVEN, {n for n in DRIVEN if n not in QUICK}))
def test_run_confirms_the_witness_of_a_wrench(name: str) -> None:
    """A bead that is taken once round gains what was certified."""
    answer = found(name)
    assert answer.wrench is not None
    loop = answer.wrench.witness
    assert loop is not None
    assert 0 < loop.low <= loop.work <= loop.high
    confirmed(answer.scenes["wrench"], loop.work)


@pytest.mark.parametrize("name", DRIVEN)
def test_the_twist_of_a_wrench_witness_closes(name: str) -> None:
    """g' = g V from the scene's twist, in 400 steps of fourth order, comes back to where it began."""
    scene = load_scene(found(name).scenes["wrench"])
    twist = scene.model.left.twist
    assert twist is not None
    assert scene.model.right == scene.model.left
    group, steps = scene.model.group, 400

    def rate(t: float, g: Any) -> Any:
        return g @ group.hat(np.array([float(evaluate(e, {"t": t})) for e in twist]))

    g, h = group.identity(), 1 / steps
    for k in range(steps):
        t = k * h
        a = rate(t, g)
        b = rate(t + h / 2, g + h / 2 * a)
        c = rate(t + h / 2, g + h / 2 * b)
        g = g + h / 6 * (a + 2 * b + 2 * c + rate(t + h, g + h * c))
    np.testing.assert_allclose(g, group.identity(), atol=1e-6)
