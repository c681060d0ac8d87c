"""The record of a run refuses what does not fit together and cannot be changed."""

from __future__ import annotations

import pickle
from dataclasses import FrozenInstanceError, fields, replace

import numpy as np
import pytest

from geocosserat.results.solution import SHAPES, Solution
from tests.results.motions import rolling, unrolling, unwinding


@pytest.mark.parametrize("make", [rolling, unrolling, unwinding])
def test_a_solution_equals_its_copy_and_no_other(make) -> None:
    """Equality is by content; a copy through pickle, as worker processes make it, is the same."""
    solution = make()
    assert solution == make()
    assert pickle.loads(pickle.dumps(solution)) == solution
    assert solution != make(until=1.0)
    assert solution != "a solution"


@pytest.mark.parametrize("name", sorted(SHAPES))
def test_one_bit_of_one_number_makes_another_solution(name: str) -> None:
    """Every array counts in the comparison, to the last bit."""
    solution = rolling()
    array = np.array(getattr(solution, name))
    array.flat[-1] = np.nextafter(array.flat[-1], np.inf)
    assert replace(solution, **{name: array}) != solution


def test_equality_tells_the_zeros_apart_and_takes_nan_for_itself() -> None:
    """Bit for bit means the sign of zero too, and that a run which broke down equals its copy."""
    zero, minus, nan = (np.full(41, x) for x in (0.0, -0.0, np.nan))
    assert rolling(work=zero) != rolling(work=minus)
    assert rolling(work=nan, estimated=np.nan) == rolling(work=nan, estimated=np.nan)
    assert rolling(estimated=0.0) != rolling(estimated=-0.0)


@pytest.mark.parametrize(
    ("name", "value"),
    [("requested", None), ("estimated", 1e-5), ("reached", False), ("reason", "x"), ("scene", "y"), ("unknowns", 5),
     ("evaluations", {"rate": 1, "jacobian": 7, "steps": 31}), ("contents", {"fields": []}), ("provenance", {})],
)
def test_every_other_field_counts_in_the_comparison(name: str, value: object) -> None:
    """A difference outside the arrays is a difference as well."""
    assert replace(rolling(), **{name: value}) != rolling()


def test_a_solution_cannot_be_changed() -> None:
    """Neither its fields nor the numbers in its arrays; and the arrays are its own."""
    mine = np.zeros(41)
    solution = rolling(work=mine)
    mine[:] = 1.0
    assert np.all(solution.work == 0.0)
    with pytest.raises(ValueError, match="read-only"):
        solution.work[0] = 1.0
    with pytest.raises(FrozenInstanceError):
        solution.title = "another"  # type: ignore[misc]


def test_numbers_of_numpy_become_plain_ones() -> None:
    """A solver may hand over numpy's scalars; JSON and the files want Python's."""
    solution = rolling(
        length=np.float64(1.0), elements=np.int64(2), unknowns=np.int32(36), requested=np.float32(0.5),
        reached=np.True_, evaluations={"rate": np.int64(3), "jacobian": 1, "steps": 2},
        seconds={"derive": np.float64(1), "compile": 0, "plan": 0, "solve": 0},
    )
    assert {type(getattr(solution, name)) for name in ("length", "requested")} == {float}
    assert {type(getattr(solution, name)) for name in ("elements", "unknowns")} == {int}
    assert {type(value) for value in solution.seconds.values()} == {float}
    assert type(solution.evaluations["rate"]) is int
    assert solution.reached is True


@pytest.mark.parametrize(
    ("make", "name"), [(make, name) for make in (rolling, unwinding) for name in sorted(SHAPES)
                       if (make, name) != (unwinding, "angle")]
)
def test_an_array_of_the_wrong_shape_is_refused(make, name: str) -> None:
    """One number too few along any dimension of any array is noticed, and the array is named."""
    solution = make()
    array = getattr(solution, name)
    for axis in range(array.ndim):
        with pytest.raises(ValueError, match=r"solution\.\w+: expected .*found"):
            replace(solution, **{name: np.delete(array, 0, axis=axis)})


def test_the_angle_belongs_to_the_plane() -> None:
    """A planar solution must have it and a spatial one cannot."""
    with pytest.raises(ValueError, match=r"solution\.angle: expected .* found None for a planar motion; correct"):
        rolling(angle=None)
    with pytest.raises(ValueError, match=r"solution\.angle: expected .* found an array for a spatial motion"):
        unwinding(angle=np.zeros((41, 25)))
    with pytest.raises(ValueError, match=r'motion: expected "planar" or "spatial", found \'diagonal\''):
        replace(rolling(), motion="diagonal")


@pytest.mark.parametrize("name", ["time", "u", "u_point"])
@pytest.mark.parametrize("wrong", [np.nan, -1.0])
def test_times_and_places_must_increase(name: str, wrong: float) -> None:
    """A frame or node out of order would spoil every curve drawn and every interpolation."""
    solution = rolling()
    array = np.array(getattr(solution, name))
    array[-1] = wrong
    with pytest.raises(ValueError, match=rf"solution\.{name}: expected .* increasing"):
        replace(solution, **{name: array})


@pytest.mark.parametrize("name", ["evaluations", "seconds"])
def test_counts_and_times_of_every_kind_must_be_there(name: str) -> None:
    """Readers of the summary rely on the keys."""
    with pytest.raises(ValueError, match=rf"solution\.{name}: expected the keys .* found no .*; write 0"):
        rolling(**{name: {}})


def test_text_that_no_file_can_hold_is_replaced() -> None:
    """A title may contain an escaped NUL; the run must not be lost for it."""
    solution = rolling(title="a\0b", reason="c\udcffd")
    assert (solution.title, solution.reason) == ("a\ufffdb", "c?d")


def test_a_solution_prints_itself_on_one_line() -> None:
    """What it is, how it was found and how far it got, but no arrays."""
    text = repr(rolling(reached=False, reason="no step small enough"))
    assert "\n" not in text
    for part in ("rolling up", "planar", "36 unknowns", "radau", "41 frames until t = 2", "no step small enough"):
        assert part in text


def test_the_record_has_the_agreed_fields() -> None:
    """The names are a contract between the stages."""
    assert [field.name for field in fields(Solution)] == [
        "scene", "title", "motion", "length", "time", "u", "u_point", "position", "rotation", "angle", "twist", "turn",
        "stress", "energy", "dissipated", "work", "method", "elements", "degree", "unknowns", "backend", "requested",
        "estimated", "evaluations", "seconds", "contents", "provenance", "reached", "reason",
        "plan", "fell_back",
    ]
