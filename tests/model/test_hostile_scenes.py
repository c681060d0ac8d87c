"""Scene files, settings and checkpoints that were written or damaged at random: accepted, or refused on one line."""

from __future__ import annotations

import random
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from benchmarks.faults.trials import damage
from benchmarks.fuzz_scenes import PIECES, SCENES, SETTINGS, read_scene, read_setting, resealed
from benchmarks.fuzzing import Tally, mutated
from geocosserat.results.checkpoint import NAME, Checkpoint, load_checkpoint, save_checkpoint

SEEDS = [path.read_bytes() for path in SCENES]
MANY = 200


@settings(max_examples=MANY)
@given(seed=st.integers(0, 2**32))
def test_a_scene_that_was_changed_at_random_is_read_or_refused(seed: int) -> None:
    """Nothing else comes of it, within ten seconds of the processor."""
    tally = Tally("scenes", 10.0)
    tally.take(mutated(SEEDS, PIECES, random.Random(seed)), read_scene)
    assert tally.failures == []


@settings(max_examples=MANY)
@given(content=st.binary(max_size=200) | st.text(max_size=200).map(str.encode))
def test_anything_is_read_or_refused(content: bytes) -> None:
    """As a scene, and as a setting."""
    tally = Tally("anything", 10.0)
    tally.take(content, read_scene)
    tally.take(content, read_setting)
    assert tally.failures == []


@settings(max_examples=MANY)
@given(seed=st.integers(0, 2**32))
def test_a_setting_that_was_changed_at_random_is_taken_or_refused(seed: int) -> None:
    """The same."""
    tally = Tally("settings", 10.0)
    tally.take(mutated(SETTINGS, PIECES, random.Random(seed)), read_setting)
    assert tally.failures == []


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """One with a checkpoint."""
    made = tmp_path_factory.mktemp("checkpoint")
    save_checkpoint(Checkpoint("a" * 64, 1, (1, 2, 3), np.ones((3, 20)), (np.ones((3, 2)),)), made)
    (made / NAME).rename(made / "good")
    return made


@settings(max_examples=MANY)
@given(seed=st.integers(0, 2**32), sealed=st.booleans())
def test_a_checkpoint_that_was_damaged_is_refused_and_a_forged_one_does_no_harm(
    folder: Path, seed: int, sealed: bool
) -> None:
    """Whoever can make checksums gets no further than to a message, or to other numbers."""
    bad = damage((folder / "good").read_bytes(), random.Random(seed))
    (folder / NAME).write_bytes(resealed(bad) if sealed else bad)
    tally = Tally("checkpoints", 10.0)
    found = tally.take(b"", lambda _: load_checkpoint(folder))
    assert tally.failures == []
    assert sealed or found is None


def test_the_tally_sees_what_is_wrong() -> None:
    """Another error than a refusal, and a message of two lines."""
    tally = Tally("wrong", 10.0)
    tally.take(b"x", lambda _: 1 / 0)
    assert tally.failures == ["ZeroDivisionError: division by zero"]
