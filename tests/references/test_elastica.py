"""The clamped rod under a dead tip force: elliptic functions, shooting, tables and balance equations."""

import math

import numpy as np
import pytest

from tests.references import chebyshev, elastica
from tests.references.elastica import Cantilever

FORCES = ((0.0, -1.0), (0.3, 0.4), (-3.0, 0.5), (-2.0, -4.0), (5.0, 1.0), (-3.0, 1e-3), (-2.5, 0.0))


def _rod(force: tuple[float, float], k: float = 50.0) -> Cantilever:
    return Cantilever(length=1.3, k=k, k3=1.2, force=force)


@pytest.mark.parametrize("force", FORCES)
def test_elliptic_functions_and_shooting_agree(force: tuple[float, float]) -> None:
    """Two methods that share no formula, one of which does not use k1 = k2, give one shape to 1e-12."""
    u = np.linspace(0.0, 1.3, 9)
    exact, shot = elastica.elliptic(_rod(force), u), elastica.shooting(_rod(force), u)
    np.testing.assert_allclose(shot.position, exact.position, atol=1e-12)
    np.testing.assert_allclose(shot.angle, exact.angle, atol=1e-12)
    np.testing.assert_allclose(shot.strain, exact.strain, atol=1e-12)


@pytest.mark.parametrize("force", [(0.0, -1.0), (-3.0, 0.5), (-20.0, 5.0)])
def test_the_shape_satisfies_the_planar_rod_equations(force: tuple[float, float]) -> None:
    """Kinematics, force and moment balance hold pointwise, and so do the conditions at both ends."""
    rod = _rod(force, k=30.0)
    u = chebyshev.points(40, rod.length)
    shape = elastica.elliptic(rod, u)
    slope = chebyshev.derivative(40, rod.length)
    h1, h2, bend = shape.strain.T
    f1, f2, moment = rod.k * (h1 - 1.0), rod.k * h2, rod.k3 * bend
    cosine, sine = np.cos(shape.angle), np.sin(shape.angle)
    scale = math.hypot(*force)
    np.testing.assert_allclose(slope @ shape.angle, bend, atol=1e-10)
    np.testing.assert_allclose(slope @ shape.position[:, 0], cosine * h1 - sine * h2, atol=1e-10)
    np.testing.assert_allclose(slope @ shape.position[:, 1], sine * h1 + cosine * h2, atol=1e-10)
    np.testing.assert_allclose(slope @ f1 - bend * f2, 0.0, atol=1e-10 * scale)
    np.testing.assert_allclose(slope @ f2 + bend * f1, 0.0, atol=1e-10 * scale)
    np.testing.assert_allclose(slope @ moment + h1 * f2 - h2 * f1, 0.0, atol=1e-10 * scale)
    np.testing.assert_allclose([*shape.position[0], shape.angle[0], moment[-1]], 0.0, atol=1e-14)
    assert np.all(np.sign(bend[:-1]) == rod.direction), "the principal solution has no inflection"


@pytest.mark.parametrize(
    ("load", "back", "side", "angle"),
    [(1.0, 0.05643, 0.30172, 0.46135), (5.0, 0.38763, 0.71379, 1.21537), (10.0, 0.55500, 0.81061, 1.43029)],
)
def test_the_inextensible_cantilever_has_the_published_tip(
    load: float, back: float, side: float, angle: float
) -> None:
    """Table of K. Mattiasson, Int. J. Numer. Methods Eng. 17 (1981) 145: transverse tip force."""
    tip = elastica.elliptic(Cantilever(1.0, math.inf, 1.0, (0.0, load)), [1.0])
    np.testing.assert_allclose([*tip.position[0], tip.angle[0]], [1.0 - back, side, angle], atol=2e-5)


@pytest.mark.parametrize(
    ("degrees", "ratio", "x", "y"),
    [(20, 1.015, 0.970, 0.220), (60, 1.152, 0.741, 0.593), (140, 2.541, -0.107, 0.750)],
)
def test_the_buckled_column_has_the_published_tip(degrees: float, ratio: float, x: float, y: float) -> None:
    """Table of Timoshenko and Gere, *Theory of Elastic Stability*, article 2.7, three decimals."""
    force = (-ratio * (math.pi / 2.0) ** 2, 0.0)
    tip = elastica.elliptic(Cantilever(1.0, math.inf, 1.0, force), [1.0])
    np.testing.assert_allclose([*tip.position[0]], [x, y], atol=6e-3)
    assert math.degrees(tip.angle[0]) == pytest.approx(degrees, abs=0.5)


def test_a_column_stays_straight_up_to_the_critical_load_and_buckles_to_the_chosen_side() -> None:
    """Below k3 (pi / 2 L)^2 only shortening; above, mirror images for the two sides."""
    critical = 1.2 * (math.pi / 2.6) ** 2
    below = elastica.elliptic(_rod((-0.999 * critical, 0.0)), [1.3])
    np.testing.assert_allclose(below.position, [[1.3 * (1.0 - 0.999 * critical / 50.0), 0.0]], rtol=1e-14)
    left, right = (
        elastica.elliptic(Cantilever(1.3, 50.0, 1.2, (-1.1 * critical, 0.0), side), [0.5, 1.3])
        for side in (1.0, -1.0)
    )
    np.testing.assert_allclose(left.position, right.position * [1.0, -1.0], atol=1e-15)
    assert left.position[1, 1] > 0.3


def test_equal_stretch_and_shear_shift_the_rod_by_force_over_stiffness() -> None:
    """By shooting, where it is not built in: position(k) - position(inf) = P u / k, same angles."""
    u, force = np.array([0.4, 1.3]), (-2.0, -4.0)
    soft, stiff = elastica.shooting(_rod(force, k=20.0), u), elastica.shooting(_rod(force, k=math.inf), u)
    np.testing.assert_allclose(soft.position - stiff.position, np.outer(u, force) / 20.0, atol=1e-12)
    np.testing.assert_allclose(soft.angle, stiff.angle, atol=1e-12)


def test_a_small_force_gives_the_linear_beam() -> None:
    """Deflection Fy u^2 (3 L - u) / (6 k3) + Fy u / k2, up to third order in the force."""
    u, force = np.array([0.5, 1.3]), 1e-5
    shape = elastica.elliptic(_rod((0.0, force)), u)
    linear = force * (u**2 * (3.9 - u) / 7.2 + u / 50.0)
    np.testing.assert_allclose(shape.position[:, 1], linear, rtol=1e-9)
