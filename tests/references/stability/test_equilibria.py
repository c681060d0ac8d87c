"""The table of bent equilibria, computed again."""

import pytest

from tests.references.stability import bent, buckled, equilibria
from tests.references.stability.equilibria import Equilibrium, all_equilibria


@pytest.mark.parametrize("entry", all_equilibria(), ids=lambda entry: f"{entry.scene}-{entry.settings['load']:g}")
def test_the_table_has_what_is_computed(entry: Equilibrium) -> None:
    """Place of the tip to 1e-12, and the growth, between two signs of the determinant: stable, all of them."""
    load = entry.settings["load"]
    if entry.scene == "column_buckled":
        tip, state = equilibria.column(load)
        place: tuple[float, ...] = (tip.x, tip.y)
        again = buckled.shot(equilibria.THICK, load, tip)
        assert place == pytest.approx((again.x, again.y), abs=1e-12)
        assert load < equilibria.second_load()
    else:
        place, state = equilibria.bend(load, entry.settings["torsion"])
    assert place == pytest.approx(entry.tip, abs=1e-12 * max(entry.tip))
    below, above = (bent.determinant(state, entry.growth * (1.0 + shift)) for shift in (-1e-11, 1e-11))
    assert below * above < 0.0
    assert bent.growths(state, 1, degree=18)[0] == pytest.approx(entry.growth, rel=1e-6)
    assert entry.growth < 0.0
