"""The characteristic equations against tables, the rod with stiff shear, and a collocated eigenproblem."""

import math
from typing import get_args

import numpy as np
import pytest

from tests.references import cantilever_modes, chebyshev, euler_bernoulli
from tests.references.euler_bernoulli import Array, Ends, decay_rates

ALL: tuple[Ends, ...] = get_args(Ends)
TABLE: dict[Ends, list[float]] = {
    "clamped-clamped": [4.730040744862704, 7.853204624095838, 10.995607838001671],
    "clamped-pinned": [3.926602312047919, 7.068582745628732, 10.210176122813031],
    "clamped-free": [1.875104068711961, 4.694091132974175, 7.854757438237613],
    "pinned-pinned": [math.pi, 2 * math.pi, 3 * math.pi],
    "pinned-free": [3.926602312047919, 7.068582745628732, 10.210176122813031],
    "free-free": [4.730040744862704, 7.853204624095838, 10.995607838001671],
}


@pytest.mark.parametrize("ends", ALL)
def test_without_rotary_friction_the_roots_are_those_of_the_tables(ends: Ends) -> None:
    """beta = (rate friction2 L^4 / k3)^(1/4), to all printed digits."""
    rates = decay_rates(1.7, 2.0, 0.6, 0.0, ends, 3)
    np.testing.assert_allclose((rates * 0.6 * 1.7**4 / 2.0) ** 0.25, TABLE[ends], rtol=1e-14)


def _collocated(length: float, k3: float, friction2: float, friction3: float, ends: Ends) -> Array:
    """Positive rates by integration on Chebyshev points: no end condition is differentiated.

    Y'''' = q stands for Y = q integrated four times plus a cubic; the four end conditions give the cubic.
    """
    degree, (left, right) = 40, ends.split("-")
    u = chebyshev.points(degree, length)
    once = chebyshev.integral(degree, length, 0)
    ladder = [np.eye(degree + 1)]  # Y'''' and its integrals: Y''', Y'', Y', Y without the cubic
    for _ in range(4):
        ladder.append(once @ ladder[-1])
    powers = [[u**n * math.perm(p, p - n) if n >= 0 else 0 * u for p in range(4) for n in [p - d]] for d in range(4)]
    # columns: q at the points, then the cubic; fields Y, Y', Y'', Y'''
    field = [np.hstack([ladder[4 - d], np.stack(powers[d], axis=1)]) for d in range(4)]
    size, stored, drag = degree + 5, [], []
    for place, kind in ((0, left), (-1, right)):
        for row, reaction in {
            "clamped": [(field[0], None), (field[1], None)],
            "pinned": [(field[0], None), (field[2], None)],
            "free": [(field[2], None), (field[3], field[1])],
        }[kind]:
            stored.append(k3 * row[place])
            drag.append(np.zeros(size) if reaction is None else -friction3 * reaction[place])
    stored += list(k3 * np.hstack([np.eye(degree + 1), np.zeros((degree + 1, 4))]))
    drag += list(friction2 * field[0] - friction3 * field[2])
    a, b = np.array(stored), np.array(drag)
    # inverse iteration matrix about a rate that is not zero, for the rigid motions
    shift = -k3 / (friction2 * length**4)
    inverse = np.linalg.eigvals(np.linalg.solve(a - shift * b, b))
    inverse = inverse[(np.abs(inverse.imag) < 1e-8) & (inverse.real > 1e-7 * inverse.real.max())].real
    rates = np.sort(1.0 / inverse + shift)
    return np.asarray(rates[rates > 1e-6 * rates[4]])


@pytest.mark.parametrize("friction3", [0.0, 0.3, 20.0])
@pytest.mark.parametrize("ends", ALL)
def test_rates_agree_with_a_collocated_eigenproblem(ends: Ends, friction3: float) -> None:
    """Chebyshev collocation of the fourth-order equation and its end conditions gives the same rates."""
    coefficients = (1.3, 0.9, 0.7, friction3)
    np.testing.assert_allclose(decay_rates(*coefficients, ends, 3), _collocated(*coefficients, ends)[:3], rtol=1e-9)


def test_rotary_friction_agrees_with_the_determinant_of_the_rod_without_shear() -> None:
    """Clamped-free: first-order system, matrix exponential and counted focal points, to 1e-13."""
    rod = cantilever_modes.Rod(length=1.3, k2=math.inf, k3=0.9, friction2=0.7, friction3=0.3)
    expected = cantilever_modes.decay_rates(rod, 4)
    np.testing.assert_allclose(decay_rates(1.3, 0.9, 0.7, 0.3, "clamped-free", 4), expected, rtol=1e-13)


def test_no_mode_is_passed_over() -> None:
    """Wave numbers of neighbouring modes are about pi / L apart, and the first is below 2 pi / L."""
    for ends in ALL:
        for friction3 in (0.0, 0.3, 20.0):
            rates = decay_rates(1.0, 1.0, 1.0, friction3, ends, 8)
            b = np.sqrt(0.5 * (friction3 * rates + np.sqrt((friction3 * rates) ** 2 + 4.0 * rates)))
            gaps = np.diff(b) / math.pi
            assert np.all((gaps > 0.7) & (gaps < 1.3))
            assert 0.49 < b[0] / math.pi < 2.0
            assert euler_bernoulli.rate_of(b[0], 1.0, 1.0, friction3) == pytest.approx(rates[0], rel=1e-12)
