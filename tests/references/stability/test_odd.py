"""Odd rods: what is known of their growths without computing them, and where they flutter."""

import numpy as np
import pytest

from tests.references import linear_rod
from tests.references.stability import linear, odd

FRICTION = (1.0, 2.0, 0.02)


def _law(**entries: float) -> list[list[float]]:
    """C of k1 = 40, k2 = 16, k3 = 1 with entries elsewhere, named by row and column."""
    c = np.diag([40.0, 16.0, 1.0])
    for name, x in entries.items():
        c[int(name[1]), int(name[2])] = x
    return c.tolist()


def test_without_coupling_it_is_the_plain_rod() -> None:
    """Rates of stretching in closed form, and those of bending of `linear_rod`."""
    bending = linear_rod.decay_rates(linear_rod.Rod(1.0, 16.0, 1.0, 2.0, 0.02), "clamped", "free", 3)
    stretching = 40.0 * ((np.arange(1, 4) - 0.5) * np.pi) ** 2
    expected = np.sort([*bending, *stretching])[:4]
    found = linear.growths(odd.free(_law(), FRICTION), 4)
    np.testing.assert_allclose(-found, expected, rtol=1e-9)


def test_it_does_not_matter_which_side_is_coupled() -> None:
    """A law and its transpose have the same growths, however large the coupling."""
    for a in (5.0, 20.0):
        one, other = (linear.growths(odd.free(_law(**{side: a}), FRICTION), 5) for side in ("c12", "c21"))
        np.testing.assert_allclose(np.sort(one.real), np.sort(other.real), rtol=1e-8)
        np.testing.assert_allclose(np.sort(abs(one.imag)), np.sort(abs(other.imag)), rtol=1e-8, atol=1e-7)


@pytest.mark.parametrize("sides", [("c12", "c21"), ("c02", "c20"), ("c01", "c10")])
def test_an_antisymmetric_coupling_never_makes_it_grow(sides: tuple[str, str]) -> None:
    """While the symmetric part of the law is positive all growths decay."""
    for a in (3.0, 30.0, 100.0):
        law = _law(**{sides[0]: a, sides[1]: -a})
        assert linear.growths(odd.free(law, FRICTION), 1)[0].real < 0.0


def test_stretch_that_bending_drives_does_not_act_back() -> None:
    """F1 = k1 (h1 - 1) + a Pi alone leaves the growths as they are."""
    plain, driven = (linear.growths(odd.free(_law(c02=a), FRICTION), 4) for a in (0.0, 25.0))
    np.testing.assert_allclose(driven, plain, rtol=1e-8)


def test_a_one_sided_coupling_flutters_beyond_the_bound_on_one_side_only() -> None:
    """Of F2 = k2 h2 + a Pi from a = 11.08 on, beyond 2 sqrt(k2 k3) = 8; not for a < 0."""
    value, frequency = linear.loss(lambda a: odd.free(_law(c12=float(a)), FRICTION), [1.0, 8.0, 15.0])
    assert value > 8.0
    assert frequency > 1.0
    assert linear.growths(odd.free(_law(c12=-60.0), FRICTION), 1)[0].real < 0.0
