"""Whatever happens to a run, nothing is lost: some of each kind of the trials that benchmarks.faults makes many of."""

from __future__ import annotations

import random
from collections.abc import Iterator
from dataclasses import replace

import pytest

from benchmarks.faults import trials
from benchmarks.faults.__main__ import tried
from benchmarks.faults.programs import QUICK
from benchmarks.faults.trials import TRIALS, Ground, Outcome
from geocosserat.results.checkpoint import Keeper
from geocosserat.results.solution import Solution

QUICKLY = {
    "damaged solution file": 40, "damaged checkpoint": 3, "read-only folder": 2, "files that are there already": 5,
}  # fmt: skip


@pytest.fixture(scope="module")
def ground(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Ground]:
    """One for all trials, for runs that nobody disturbs are made once; with a cache of its own, to be damaged."""
    folder = tmp_path_factory.mktemp("faults")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("GEOCOSSERAT_CACHE", str(folder / "cache"))
        yield Ground(folder)


@pytest.mark.parametrize("kind", QUICKLY)
def test_nothing_is_lost_in_a_few_trials(kind: str, ground: Ground) -> None:
    """Refused on one line, and left as it was."""
    _, losses = tried(ground, TRIALS[kind][1], QUICKLY[kind], random.Random(kind))
    assert losses == []


def test_nothing_is_lost_by_kill_9(ground: Ground) -> None:
    """A few times, on a quick run, at any moment: it goes on to the same arrays, bit for bit."""
    chance = random.Random(1)
    for _ in range(4):
        assert trials.killed(ground, chance, (QUICK,)).lost == ""


@pytest.mark.slow
@pytest.mark.parametrize("kind", [kind for kind in TRIALS if kind not in QUICKLY])
def test_nothing_is_lost_in_some_trials(kind: str, ground: Ground) -> None:
    """A twentieth of the whole torture."""
    count, trial = TRIALS[kind]
    _, losses = tried(ground, trial, max(2, count // 20), random.Random(kind))
    assert losses == []


def test_a_solution_with_other_bits_counts_as_lost(ground: Ground, monkeypatch: pytest.MonkeyPatch) -> None:
    """The trials see what they are there to see: a checkpoint that forgets half of what was done."""
    chance = random.Random(2)

    def forgetful(self: Keeper, start: object, *rest: object) -> object:
        found = begin(self, start, *rest)  # type: ignore[arg-type]
        return found if self.resumed is None else type(found)(
            found.times, found.states * (1 + 1e-15), found.rates, found.jacobians, found.steps, found.reached
        )  # fmt: skip

    ground.reference(QUICK)
    begin = Keeper.begin
    monkeypatch.setattr(Keeper, "begin", forgetful)
    outcomes = [trials.killed(ground, chance, (QUICK,)) for _ in range(6)]
    went_on = [outcome for outcome in outcomes if "checkpoint" in outcome.what and "no" not in outcome.what]
    assert all(outcome.lost for outcome in went_on)
    assert all(not outcome.lost for outcome in outcomes if outcome not in went_on)


def test_losses_are_counted_and_told(ground: Ground, capsys: pytest.CaptureFixture[str]) -> None:
    """With what happened."""
    happened, losses = tried(ground, lambda *_: Outcome("burnt", "everything"), 3, random.Random(0))
    assert happened == {"burnt": 3}
    assert losses == ["burnt: everything"] * 3
    assert "LOST: burnt: everything" in capsys.readouterr().out


@pytest.mark.parametrize("name", ["position", "estimated"])
def test_a_difference_is_named(name: str, ground: Ground) -> None:
    """In an array, or in what is said of it."""
    one = ground.reference(QUICK).solution
    changed = {"position": one.position * (1 + 1e-15), "estimated": 1.0}
    other: Solution = replace(one, **{name: changed[name]})  # type: ignore[arg-type]
    assert trials.differences(one, other) == name
    assert trials.differences(one, one) == ""
