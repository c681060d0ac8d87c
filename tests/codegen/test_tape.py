"""Tapes: the same values and derivatives as the trees they were recorded from, each shared part once."""

from __future__ import annotations

from typing import Any

import pytest
import sympy as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from geocosserat.codegen.tape import Tape, jacobian, record
from tests.codegen.symbolic import NAMES, close, evaluate, point, trees

x, y, z = sp.symbols(NAMES)
several = st.lists(trees, min_size=1, max_size=4)
seeds = st.integers(0, 10**6)


def named(expressions: list[sp.Expr]) -> dict[str, sp.Expr]:
    return {f"out_{i + 1}": e for i, e in enumerate(expressions)}


def run(tape: Tape, values: dict[sp.Symbol, Any]) -> dict[str, Any]:
    """The outputs of a tape, step by step, each from what is known by then."""
    known = dict(values)
    for name, e in tape.steps:
        known[name] = evaluate(e, known)
    return {name: evaluate(e, known) for name, e in tape.outputs}


@given(several, seeds)
@settings(max_examples=40, deadline=None)
def test_a_tape_has_the_values_of_its_trees(expressions: list[sp.Expr], seed: int) -> None:
    """To 30 digits at a random place; no step uses a later one."""
    at = point(seed)
    found = run(record(named(expressions)), at)
    for e, value in zip(expressions, found.values(), strict=True):
        close(value, evaluate(e, at))


@pytest.mark.slow
@given(several, seeds)
@settings(max_examples=40, deadline=None)
def test_the_jacobian_of_a_tape_has_the_derivatives_of_its_trees(expressions: list[sp.Expr], seed: int) -> None:
    """To 30 digits; entries that are left out are zero."""
    at = point(seed)
    found = run(jacobian(record(named(expressions)), (x, y, z), "J"), at)
    for i, e in enumerate(expressions):
        for j, s in enumerate((x, y, z)):
            close(found.get(f"J_{i + 1}_{j + 1}", 0), evaluate(e.diff(s), at))


@given(several, seeds)
@settings(max_examples=30, deadline=None)
def test_given_intermediate_results_are_steps_with_their_names(expressions: list[sp.Expr], seed: int) -> None:
    """Outputs that use a result by name have the value and the derivatives of the result put in."""
    at, force = point(seed), sp.Symbol("force")
    inner = expressions[0]
    tape = record({"a": force * x, "b": sp.sin(force) + y}, given={"force": inner})
    assert force in {name for name, _ in tape.steps}
    assert "force" not in tape.inputs
    found = run(tape, at)
    close(found["a"], evaluate(inner * x, at))
    close(found["b"], evaluate(sp.sin(inner) + y, at))
    slopes = run(jacobian(tape, (x, y, z), "J"), at)
    close(slopes.get("J_1_1", 0), evaluate((inner * x).diff(x), at))
    close(slopes.get("J_2_2", 0), evaluate((sp.sin(inner) + y).diff(y), at))


def test_a_shared_part_is_computed_once() -> None:
    """Operations count what a tape does, not what its trees would."""
    tape = record({"a": (x + y) ** 2 + sp.sin(x + y), "b": x + y})
    assert tape.operations == 4  # the sum once; square, sine and sum
    assert record({"a": x * y * z}).operations == 2
    assert record({"a": x}).operations == 0
    tree = (x + y) ** 2
    for _ in range(20):
        tree = tree * tree + sp.sin(tree)
    assert record({"a": tree}).operations < 100


def test_inputs_are_what_comes_from_outside() -> None:
    """Neither steps nor outputs are inputs, and names that drop out are not needed."""
    assert record({"a": (x + y) ** 2 + (x + y)}).inputs == {"x", "y"}
    assert record({"a": x - x + z}).inputs == {"z"}
    assert Tape((), ()).inputs == frozenset()


def test_a_jacobian_keeps_no_step_that_nothing_needs() -> None:
    """Values that no derivative uses are dropped."""
    tape = jacobian(record({"a": sp.exp(x) * y, "b": sp.sin(x * y) + sp.sin(x * y) ** 2}), (x,), "J")
    used = {s for _, e in (*tape.steps, *tape.outputs) for s in e.free_symbols}
    assert {name for name, _ in tape.steps} <= used
    shared = jacobian(record({"a": (x * y + z) * z, "b": (x * y + z) * y}), (x,), "J")
    assert shared.steps == ()  # the sum they share has the slope y; its value is not needed
    linear = jacobian(record({"a": 3 * x + y}), (x, y), "J")
    assert linear == Tape((), (("J_1_1", sp.Integer(3)), ("J_1_2", sp.Integer(1))))


def test_recording_is_deterministic() -> None:
    """The same expressions make the same tape, however often."""
    e = {"a": sp.sin(x + y) * sp.cos(x + y) / (1 + z**2), "b": (1 + z**2) * (x + y)}
    assert len({record(e) for _ in range(5)}) == 1
