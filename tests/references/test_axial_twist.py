"""The closed forms of stretch and twist diffusion, checked against the equation and against collocation."""

import numpy as np
import pytest
from scipy.linalg import expm

from tests.references import axial_twist, chebyshev

STIFFNESS, FRICTION, LENGTH = 3.0, 0.7, 1.6
ENDS: tuple[axial_twist.Ends, ...] = ("clamped-free", "free-free")


def _inner_operator(ends: axial_twist.Ends, degree: int = 32) -> tuple[axial_twist.Array, axial_twist.Array]:
    """Collocated stiffness / friction * d2/du2 on the excess strain; the kept points and the matrix."""
    d = chebyshev.derivative(degree, LENGTH)
    velocity = d.copy()  # the velocity has the strain's slope, and none at a clamp
    velocity[0] *= 0.0 if ends == "clamped-free" else 1.0
    operator = STIFFNESS / FRICTION * d @ velocity
    keep = np.ones(degree + 1, dtype=bool)
    keep[-1] = False  # a free end has no excess strain
    keep[0] = ends == "clamped-free"
    return chebyshev.points(degree, LENGTH)[keep], operator[np.ix_(keep, keep)]


@pytest.mark.parametrize("ends", ENDS)
def test_decay_rates_are_the_eigenvalues_of_the_collocated_operator(ends: axial_twist.Ends) -> None:
    """Chebyshev collocation of the diffusion equation has the same slow eigenvalues."""
    _, operator = _inner_operator(ends)
    slow = np.sort(-np.linalg.eigvals(operator).real)[:5]
    rates = axial_twist.decay_rates(STIFFNESS, FRICTION, LENGTH, 5, ends)
    np.testing.assert_allclose(slow, rates, rtol=1e-10)


@pytest.mark.parametrize("ends", ENDS)
def test_a_sum_of_modes_evolves_as_the_matrix_exponential_says(ends: axial_twist.Ends) -> None:
    """The modal sum equals the exponential of the collocated operator on the same start."""
    amplitudes = np.array([0.4, -0.2, 0.1])
    u, operator = _inner_operator(ends)
    args = (STIFFNESS, FRICTION, LENGTH, ends)
    start = axial_twist.strain(u, 0.0, amplitudes, *args)
    expected = expm(operator * 0.05) @ start
    np.testing.assert_allclose(axial_twist.strain(u, 0.05, amplitudes, *args), expected, atol=1e-11)


@pytest.mark.parametrize("ends", ENDS)
def test_compatibility_holds_between_velocity_and_strain_modes(ends: axial_twist.Ends) -> None:
    """-rate * strain mode = slope of the velocity mode, and a clamp has no velocity."""
    u = chebyshev.points(32, LENGTH)
    velocity = axial_twist.velocity_modes(u, STIFFNESS, FRICTION, LENGTH, 3, ends)
    rates = axial_twist.decay_rates(STIFFNESS, FRICTION, LENGTH, 3, ends)
    slope = velocity @ chebyshev.derivative(32, LENGTH).T
    modes = axial_twist.strain_modes(u, LENGTH, 3, ends)
    np.testing.assert_allclose(slope, -rates[:, None] * modes, atol=1e-9)
    if ends == "clamped-free":
        np.testing.assert_allclose(velocity[:, 0], 0.0, atol=1e-14)


def test_a_suddenly_loaded_rod_creeps_as_the_matrix_exponential_says() -> None:
    """The loaded series equals the exponential of the collocated operator with a held end strain."""
    load, t = 0.3, 0.2
    u, operator = _inner_operator("clamped-free", degree=48)
    # the held strain of the loaded end drives the others: an affine system, exponentiated as a linear one
    d = chebyshev.derivative(48, LENGTH)
    velocity = d.copy()
    velocity[0] = 0.0
    forcing = STIFFNESS / FRICTION * (d @ velocity)[:-1, -1] * (load / STIFFNESS)
    affine = np.zeros((len(u) + 1, len(u) + 1))
    affine[:-1, :-1], affine[:-1, -1] = operator, forcing
    expected = expm(affine * t)[:-1, -1]
    result = axial_twist.loaded_strain(u, t, load, STIFFNESS, FRICTION, LENGTH)
    np.testing.assert_allclose(result, expected, atol=1e-10)


def test_the_loaded_tip_is_the_integral_of_the_loaded_strain() -> None:
    """Integrating the strain gives the tip; long after loading it is load * length / stiffness."""
    load = 0.3
    u = chebyshev.points(40, LENGTH)
    for t in (0.1, 0.5):
        tip = chebyshev.integral(40, LENGTH, 0) @ axial_twist.loaded_strain(
            u, t, load, STIFFNESS, FRICTION, LENGTH
        )
        assert axial_twist.loaded_tip(t, load, STIFFNESS, FRICTION, LENGTH) == pytest.approx(
            tip[-1], abs=1e-12
        )
    assert axial_twist.loaded_tip(50.0, load, STIFFNESS, FRICTION, LENGTH) == pytest.approx(
        load * LENGTH / STIFFNESS, abs=1e-14
    )
