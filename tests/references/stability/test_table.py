"""The table of losses of stability: computed again, and found by collocation too."""

import numpy as np
import pytest

from tests.references.stability import linear, whirling
from tests.references.stability.table import FAMILIES, Value, all_values, value

COMPUTED = [entry for entry in all_values() if entry.scene in FAMILIES]
# at the ring's loss two growths vanish at once: `test_michell` has it
SIMPLE = [entry for entry in COMPUTED if entry.scene != "ring_held"]


def _seen(entry: Value, value: float, frequency: float) -> float:
    """The frequency in axes that turn with a spun base."""
    return abs(frequency - value) if entry.over == "spin" else frequency


@pytest.mark.parametrize("entry", SIMPLE, ids=lambda entry: entry.scene)
def test_collocation_finds_the_loss_and_the_determinant_the_value(entry: Value) -> None:
    """The first loss in the interval, by collocation, is refined to the number in the table by the determinant."""
    family = FAMILIES[entry.scene]
    first, swing = linear.loss(family, np.linspace(*entry.interval, 5))
    value, frequency = linear.flutter(family, first, swing) if swing else (linear.divergence(family, first), 0.0)
    assert first == pytest.approx(value, rel=1e-8)
    assert swing == pytest.approx(frequency, rel=1e-8)
    assert value == pytest.approx(entry.value, rel=1e-14)
    assert _seen(entry, value, frequency) == pytest.approx(entry.frequency, rel=1e-13)


@pytest.mark.parametrize("entry", COMPUTED, ids=lambda entry: entry.scene)
def test_the_growths_are_zeros_of_the_determinant_and_leading(entry: Value) -> None:
    """The leading growth by collocation, refined by the determinant, is the one of the table, before and after."""
    (before, decay), (after, growth) = entry.growths
    assert before < entry.value < after
    assert decay.real < 0.0 < growth.real
    for parameter, expected in entry.growths:
        found = linear.leading(FAMILIES[entry.scene](parameter), degree=18 if entry.scene == "ring_held" else 28)
        if entry.over == "spin":
            found = whirling.seen(found, parameter)
        assert abs(found - expected) < 1e-12 * abs(expected)


def test_every_scene_occurs_once() -> None:
    """Values are found by the name of the scene."""
    names = [entry.scene for entry in all_values()]
    assert len(set(names)) == len(names)
    assert value("heavy").over == "weight"
