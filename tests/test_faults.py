"""Whatever happens to a run, nothing is lost: some of each kind of the trials that benchmarks.faults makes many of."""

from __future__ import annotations

import random
import shutil
from collections.abc import Iterator
from dataclasses import replace

import pytest

from benchmarks.faults import trials
from benchmarks.faults.__main__ import tried
from benchmarks.faults.programs import QUICK, finished, wrong_with
from benchmarks.faults.trials import TRIALS, Ground, Outcome, ended_run
from geocosserat.results.checkpoint import Keeper
from geocosserat.results.solution import Array, Solution
from geocosserat.solver.trajectory import Trajectory

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
    for _ in range(3):
        assert trials.killed(ground, chance, (QUICK,)).lost == ""


@pytest.mark.slow
@pytest.mark.parametrize("kind", [kind for kind in TRIALS if kind not in QUICKLY])
def test_nothing_is_lost_in_some_trials(kind: str, ground: Ground) -> None:
    """A twentieth of the whole torture."""
    count, trial = TRIALS[kind]
    _, losses = tried(ground, trial, max(2, count // 20), random.Random(kind))
    assert losses == []


def test_a_run_that_goes_on_with_other_bits_counts_as_lost(ground: Ground, monkeypatch: pytest.MonkeyPatch) -> None:
    """The trials see what they are there to see: a checkpoint whose numbers are a little wrong."""
    begin, expected = Keeper.begin, ground.reference(QUICK).solution

    def forgetful(self: Keeper, number: int, start: Array, times: Array) -> Trajectory:
        found = begin(self, number, start, times)
        return replace(found, states=found.states * (1 + 1e-15))

    with ground.new(ended_run(ground)) as out:
        arguments = [*QUICK.arguments(out), "--resume"]
        shutil.copytree(out, out.with_name("again"))
        assert finished(arguments, ground.said, QUICK.prepare) == 0
        assert wrong_with(out, expected) == ""
        monkeypatch.setattr(Keeper, "begin", forgetful)
        shutil.rmtree(out)
        out.with_name("again").rename(out)
        assert finished(arguments, ground.said, QUICK.prepare) == 0
        assert "position" in wrong_with(out, expected)


def test_losses_are_counted_and_told(ground: Ground, capsys: pytest.CaptureFixture[str]) -> None:
    """With what happened."""
    happened, losses = tried(ground, lambda *_: Outcome("burnt", "everything"), 3, random.Random(0))
    assert happened == {"burnt": 3}
    assert losses == ["burnt: everything"] * 3
    assert "LOST: burnt: everything" in capsys.readouterr().out


def test_trials_in_which_nothing_struck_are_not_counted(ground: Ground) -> None:
    """Others are made for them, but not without end; a loss counts in any case."""
    outcomes = iter([Outcome("missed", struck=False), Outcome("hit"), Outcome("missed", "all", struck=False)])
    assert tried(ground, lambda *_: next(outcomes), 2, random.Random(0)) == ({"hit": 1, "missed": 1}, ["missed: all"])
    assert tried(ground, lambda *_: Outcome("missed", struck=False), 2, random.Random(0)) == ({}, [])


@pytest.mark.parametrize("name", ["position", "estimated"])
def test_a_difference_is_named(name: str, ground: Ground) -> None:
    """In an array, or in what is said of it."""
    one = ground.reference(QUICK).solution
    changed = {"position": one.position * (1 + 1e-15), "estimated": 1.0}
    other: Solution = replace(one, **{name: changed[name]})  # type: ignore[arg-type]
    assert trials.differences(one, other) == name
    assert trials.differences(one, one) == ""
