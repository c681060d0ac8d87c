"""The rod bent by an end couple: an arc, checked against the matrix exponential and its closure."""

import numpy as np
import pytest

from tests.references import circle, elastica, helix


@pytest.mark.parametrize(
    ("torque", "reference"), [(0.0, 0.0), (1e-9, 0.0), (2.4, 0.0), (-3.0, 0.8), (25.0, 0.0)]
)
def test_the_arc_is_the_exponential_of_its_turn(torque: float, reference: float) -> None:
    """Position and angle agree with phi(u) = exp(u E), straight, slightly bent and wound up."""
    u = np.linspace(0.0, 1.7, 6)
    turn = circle.strain(u, torque, 1.2, reference)[0]
    poses = helix.pose(turn, u)
    angle = circle.angle(u, torque, 1.2, reference)
    np.testing.assert_allclose(circle.position(u, torque, 1.2, reference), poses[:, 1:, 0], atol=1e-13)
    np.testing.assert_allclose(np.cos(angle), poses[:, 1, 1], atol=1e-13)
    np.testing.assert_allclose(np.sin(angle), poses[:, 2, 1], atol=1e-13)


def test_the_rod_closes_on_itself_at_a_full_turn() -> None:
    """A couple of 2 pi k3 / L brings the tip back to the clamp, the angle being 2 pi and not zero."""
    torque = 2.0 * np.pi * 1.2 / 1.7
    np.testing.assert_allclose(circle.position([1.7], torque, 1.2), 0.0, atol=1e-15)
    assert circle.angle([1.7], torque, 1.2)[0] == pytest.approx(2.0 * np.pi, rel=1e-15)


def test_the_couple_does_twice_the_stored_energy_of_work_at_constant_torque() -> None:
    """Clapeyron: torque * turn of the tip = 2 * energy, for a straight reference."""
    assert 2.4 * circle.angle([1.7], 2.4, 1.2)[0] == pytest.approx(
        2.0 * circle.energy(1.7, 2.4, 1.2), rel=1e-15
    )


def test_curvature_under_a_force_is_that_of_the_couple_it_has_about_each_section() -> None:
    """A rod under a force has the curvature that the couple of that force about each section gives."""
    rod = elastica.Cantilever(length=1.0, k=1e3, k3=1.0, force=(0.2, 1.0))
    u = np.array([0.0, 0.4, 0.9])
    shape = elastica.elliptic(rod, [*u, 1.0])
    arm = shape.position[-1] - shape.position[:-1]
    couple = arm[:, 0] * rod.force[1] - arm[:, 1] * rod.force[0]
    expected = [circle.curvature(value, rod.k3) for value in couple]
    np.testing.assert_allclose(shape.strain[:-1, 2], expected, rtol=1e-12)
