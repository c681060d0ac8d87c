"""What a law stores: its energy and the remainder add up to the stress, and one kernel serves all values."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest

from geocosserat.codegen.identity import identity
from geocosserat.discretisation.structuring import structure_of
from geocosserat.model.expressions import derivative, evaluate
from geocosserat.model.law import Law, load_law
from geocosserat.model.scene import load_scene
from geocosserat.passivity.storing import stored, storing
from tests.passivity.zoo import FULL, FULL_SPATIAL, ZOO, linear, planar, spatial

CONSERVATIVE = [
    name for name, known in ZOO.items()
    if known.verdict == "passive" and "stress" in known.law and not known.slow and "parameters" not in known.law
    and "outside" not in name and "cut" not in name and "vortex" not in name and "_dot" not in str(known.law)
]  # fmt: skip
WORKING = [
    name for name, known in ZOO.items()
    if known.verdict == "active" and "stress" in known.law and "parameters" not in known.law
    and "_dot" not in str(known.law) and not known.faint
]  # fmt: skip
SWIRL = spatial(
    {"F1": "9*(h1 - 1) + 0.1*Pi1*Pi2", "F2": "4*h2", "F3": "4*h3", "M1": "Pi1 + 0.3*Pi2",
     "M2": "Pi2 - 0.3*Pi1 + sin(Pi3)", "M3": "Pi3"}
)  # fmt: skip


def kept(law: Mapping[str, Any]) -> Law:
    """The law with what it stores."""
    return storing(load_law(law))


def points(law: Law, count: int = 30) -> dict[str, Any]:
    """Strains around the reference, and a place and time."""
    chance = np.random.default_rng(5)
    around = {
        name: x + chance.uniform(-0.4, 0.4, count) for name, x in zip(law.group.strain, law.reference, strict=True)
    }
    return {**law.parameters, **around, "u": 0.37, "t": 0.2}


def values(e: Any, at: Mapping[str, Any]) -> Any:
    """An expression at many points."""
    return np.broadcast_to(evaluate(e, at), at["h1"].shape)


def check_sum(law: Law) -> None:
    """Gradient and remainder are the stress."""
    assert law.energy is not None
    assert law.stress is not None
    at = points(law)
    rest = law.remainder or (None,) * len(law.stress)
    for name, stress, remainder in zip(law.group.strain, law.stress, rest, strict=True):
        total = values(derivative(law.energy, name), at) + (0 if remainder is None else values(remainder, at))
        np.testing.assert_allclose(total, values(stress, at), rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("name", CONSERVATIVE)
def test_a_conservative_law_stores_all_that_it_does(name: str) -> None:
    """There is an energy and no remainder, and the energy's slopes are the stress."""
    law = kept(ZOO[name].law)
    assert law.energy is not None
    assert law.remainder == ()
    check_sum(law)


@pytest.mark.parametrize("name", WORKING)
def test_energy_and_remainder_add_up(name: str) -> None:
    """Where a law has no energy, what is left over is named; it is not nothing."""
    law = kept(ZOO[name].law)
    if law.energy is None:  # all of it counts as lost, which holds too
        assert law.remainder == ()
        return
    assert law.remainder
    check_sum(law)
    at = points(law)
    assert max(float(np.nanmax(np.abs(values(e, at)))) for e in law.remainder) > 0


@pytest.mark.parametrize("name", ["odd, shear and bend", "odd, bend and twist", "full K, not symmetric"])
def test_a_linear_law_stores_its_symmetric_part(name: str) -> None:
    """The energy of an odd law is that of (K + K^T)/2, and the remainder does no work along a ray."""
    law = kept(ZOO[name].law)
    assert law.energy is not None
    at = points(law)
    away = [at[n] - x for n, x in zip(law.group.strain, law.reference, strict=True)]
    work = sum(values(e, at) * d for e, d in zip(law.remainder, away, strict=True))
    np.testing.assert_allclose(work, 0.0, atol=1e-13)


@pytest.mark.parametrize("odd", ["", " + 0.3*Pi"])
def test_a_viscous_law_stores_what_it_does_at_rest(odd: str) -> None:
    """Energy and remainder are those of the law without its rates; these cost no more."""
    still = {"F1": "10*(h1 - 1)", "F2": f"10*h2{odd}", "M": "sinh(Pi)"}
    moving = {**still, "F1": still["F1"] + " + 0.5*(1 + Pi**2)*h1_dot - h2_dot", "M": still["M"] + " + Pi_dot/h1"}
    found, wanted = kept(planar(moving)), kept(planar(still))
    assert found.energy is not None
    assert (found.energy, found.remainder) == (wanted.energy, wanted.remainder)
    assert bool(found.remainder) == bool(odd)


def test_an_energy_is_finite_at_the_reference() -> None:
    """Work along rays may be written with a quotient that has no value where the strain is that at rest."""
    law = kept(SWIRL)
    assert law.energy is not None
    rest = dict(zip(law.group.strain, law.reference, strict=True))
    assert np.isfinite(evaluate(law.energy, rest))
    for name in law.group.strain:
        slope = derivative(law.energy, name)
        assert np.isfinite(evaluate(slope, rest))
        assert all(np.isfinite(evaluate(derivative(slope, other), rest)) for other in law.group.strain)
        for other in ("h2", "Pi1", "Pi2", "Pi3"):  # and on the axes and planes through it
            assert np.isfinite(evaluate(slope, rest | {name: rest[name] + 0.3, other: 0.0}))
    check_sum(law)


def test_what_is_written_as_an_energy_stays_so() -> None:
    """The law comes back as it is."""
    law = load_law(ZOO["a density"].law)
    assert storing(law) is law


def test_a_law_of_which_nothing_is_found_comes_back_as_it_is() -> None:
    """No value at the reference, and no energy: then all that the stress does counts as lost."""
    law = load_law(planar({"F1": "h2*log(abs(h1 - 1))/(h2**2 + (h1 - 1)**2)", "F2": "1/(h1 - 1)"}))
    assert storing(law) is law


def test_a_law_without_a_stress_comes_back_as_it_is() -> None:
    """There is nothing to store."""
    law = load_law(ZOO["friction, definite"].law)
    assert storing(law) is law


def rod(law: Mapping[str, Any]) -> Any:
    """A rod of the law."""
    d = 3 if law["motion"] == "planar" else 6
    scene = {
        "title": "rod", "rod": {"motion": law["motion"], "length": 1.0, "friction": [1.0] * d, "law": law},
        "run": {"until": 1.0},
    }  # fmt: skip
    return stored(load_scene(scene).model)


@pytest.mark.parametrize("odd", [True, False])
def test_one_kernel_serves_several_values_of_a_parameter(odd: bool) -> None:
    """Structures, and so kernels, are equal for any values, with an energy or with a remainder."""
    back = "-a*h2" if odd else "+a*h2"

    def law(a: float, k: float) -> dict[str, Any]:
        return planar(
            {"F1": "k*(h1 - 1)", "F2": "10*h2 + a*Pi", "M": f"k*sin(Pi) {back}"}, parameters={"a": a, "k": k}
        )

    structures = [structure_of(rod(law(*pair))) for pair in ((0.3, 10.0), (-2.0, 4.0), (0.0, 1.0))]
    assert structures[0] == structures[1]
    assert structures[0] == structures[2]
    assert len({identity(s) for s in structures}) == 1
    assert bool(structures[0].law and structures[0].law.remainder) is odd


def test_numbers_in_the_text_make_kernels_of_their_own() -> None:
    """What is not a parameter is part of the structure: the claim above is not empty."""
    a, b = (structure_of(rod(planar({"F1": f"{k}*(h1 - 1)**3", "F2": "h2", "M": "Pi"}))) for k in (2, 3))
    assert a != b


@pytest.mark.parametrize("rows", [FULL, FULL_SPATIAL], ids=["plane", "space"])
def test_a_full_symmetric_stiffness_stores_its_quadratic_form(rows: list[list[float]]) -> None:
    """The energy is half of the form, but for a constant."""
    law = kept(linear(rows))
    assert law.energy is not None
    at = points(law)
    away = np.stack([at[n] - x for n, x in zip(law.group.strain, law.reference, strict=True)])
    expected = 0.5 * np.einsum("it,ij,jt->t", away, np.array(rows, dtype=float), away)
    found = values(law.energy, at) - evaluate(law.energy, dict(zip(law.group.strain, law.reference, strict=True)))
    np.testing.assert_allclose(found, expected, rtol=1e-11)
