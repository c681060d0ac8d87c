"""The reference element: every table is exact on the polynomials it is meant for, at every degree on offer."""

from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest
from numpy.polynomial import chebyshev, legendre

from geocosserat.discretisation.quadrature import reference_element

DEGREES = (*range(1, 13), 16, 25, 33, 48, 63, 64)

# Abramowitz and Stegun, tables 25.4 (Gauss) and 25.6 (Lobatto): positive abscissas and weights
GAUSS = {
    1: {0.0: 2.0},
    2: {0.577350269189626: 1.0},
    3: {0.0: 0.888888888888889, 0.774596669241483: 0.555555555555556},
    4: {0.339981043584856: 0.652145154862546, 0.861136311594053: 0.347854845137454},
    5: {0.0: 0.568888888888889, 0.538469310105683: 0.478628670499366, 0.906179845938664: 0.236926885056189},
    8: {
        0.183434642495650: 0.362683783378362,
        0.525532409916329: 0.313706645877887,
        0.796666477413627: 0.222381034453374,
        0.960289856497536: 0.101228536290376,
    },
}
LOBATTO = {
    1: {1.0: 1.0},
    2: {0.0: 1.33333333, 1.0: 0.33333333},
    3: {0.44721360: 0.83333333, 1.0: 0.16666667},
    4: {0.0: 0.71111111, 0.65465367: 0.54444444, 1.0: 0.1},
    5: {0.28523152: 0.55485838, 0.76505532: 0.37847496, 1.0: 0.06666667},
    6: {0.0: 0.48761904, 0.46884879: 0.43174538, 0.83022390: 0.27682604, 1.0: 0.04761904},
}


@pytest.mark.parametrize("degree", GAUSS)
def test_gauss_rules_are_the_tabulated_ones(degree: int) -> None:
    """Abramowitz and Stegun, table 25.4, all printed digits."""
    table = reference_element(degree)
    found = {abs(x): w for x, w in zip(table.points, table.weights, strict=True)}
    np.testing.assert_allclose(sorted(found), sorted(GAUSS[degree]), rtol=0, atol=6e-16)
    np.testing.assert_allclose([found[x] for x in sorted(found)], list(GAUSS[degree].values()), rtol=0, atol=1.5e-15)


@pytest.mark.parametrize("degree", LOBATTO)
def test_lobatto_rules_are_the_tabulated_ones(degree: int) -> None:
    """Abramowitz and Stegun, table 25.6, all printed digits."""
    table = reference_element(degree)
    found = {abs(x): w for x, w in zip(table.nodes, table.masses, strict=True)}
    np.testing.assert_allclose(sorted(found), sorted(LOBATTO[degree]), rtol=0, atol=1e-8)
    np.testing.assert_allclose([found[x] for x in sorted(found)], list(LOBATTO[degree].values()), rtol=0, atol=1e-8)


@pytest.mark.parametrize("degree", [2, 5, 16, 64])
def test_points_and_nodes_are_the_exact_ones_to_the_last_digits(degree: int) -> None:
    """One more Newton step in 30 digits, on P_p and on P_p', moves none of them by more than round-off."""
    table = reference_element(degree)

    def polynomials(x: float) -> tuple[mp.mpf, mp.mpf, mp.mpf]:
        """P_p and its first two derivatives, from Legendre's equation."""
        x, p = mp.mpf(x), degree
        value, below = mp.legendre(p, x), mp.legendre(p - 1, x)
        slope = p * (below - x * value) / (1 - x * x)
        return value, slope, (2 * x * slope - p * (p + 1) * value) / (1 - x * x)

    with mp.workdps(30):
        for x in table.points:
            value, slope, _ = polynomials(x)
            assert abs(value / slope) < 2e-16
        for x in table.nodes[1:-1]:
            _, slope, curvature = polynomials(x)
            assert abs(slope / curvature) < 2e-16
    assert (table.nodes[0], table.nodes[-1]) == (-1, 1)


@pytest.mark.parametrize("degree", DEGREES)
def test_both_rules_are_exact_to_degree_2p_minus_1_and_no_further(degree: int) -> None:
    """Every Legendre polynomial but the constant integrates to zero up to there; P_p^2 and (1 - x^2) P_p'^2 do not."""
    table = reference_element(degree)
    wanted = np.zeros(2 * degree)
    wanted[0] = 2
    gauss = table.weights @ legendre.legvander(table.points, 2 * degree - 1)
    lobatto = table.masses @ legendre.legvander(table.nodes, 2 * degree - 1)
    np.testing.assert_allclose(gauss, wanted, rtol=0, atol=1e-14)
    np.testing.assert_allclose(lobatto, wanted, rtol=0, atol=1e-14)
    assert abs(table.weights @ legendre.legvander(table.points, 2 * degree)[:, -1]) > 1e-3
    assert abs(table.masses @ legendre.legvander(table.nodes, 2 * degree)[:, -1]) > 1e-3
    assert np.all(table.weights > 0)
    assert np.all(table.masses > 0)


@pytest.mark.parametrize("degree", DEGREES)
def test_interpolation_and_slopes_are_exact_on_polynomials_of_degree_p(degree: int) -> None:
    """Chebyshev polynomials, whose slopes grow as the square of the degree."""
    table = reference_element(degree)
    basis = np.eye(degree + 1)
    on_nodes = chebyshev.chebvander(table.nodes, degree)
    at_points = chebyshev.chebvander(table.points, degree)
    slopes = np.stack([chebyshev.chebval(table.points, chebyshev.chebder(row)) for row in basis], axis=1)
    np.testing.assert_allclose(table.values @ on_nodes, at_points, rtol=0, atol=6e-14)
    np.testing.assert_allclose(table.slopes @ on_nodes, slopes, rtol=0, atol=3e-14 * max(degree, 2) ** 2)


@pytest.mark.parametrize("degree", DEGREES)
def test_integrals_are_exact_on_polynomials_of_degree_p_minus_1(degree: int) -> None:
    """From the left end to every node and to every point."""
    table = reference_element(degree)
    on_points = chebyshev.chebvander(table.points, degree - 1)
    for matrix, places in ((table.running, table.nodes), (table.inner, table.points)):
        wanted = [chebyshev.chebval(places, chebyshev.chebint(row, lbnd=-1)) for row in np.eye(degree)]
        np.testing.assert_allclose(matrix @ on_points, np.stack(wanted, axis=1), rtol=0, atol=2e-14)


@pytest.mark.parametrize("degree", DEGREES)
def test_a_constant_is_kept_and_has_no_slope(degree: int) -> None:
    """Row sums: 1 for values, 0 for slopes; running integrals start at zero and end as the weights."""
    table = reference_element(degree)
    np.testing.assert_allclose(table.values.sum(axis=1), 1, rtol=0, atol=1e-14)
    assert np.max(np.abs(table.slopes.sum(axis=1))) <= 4 * np.spacing(np.abs(table.slopes).max())
    np.testing.assert_allclose(table.running[0], 0, atol=2e-15)
    np.testing.assert_allclose(table.running[-1], table.weights, rtol=0, atol=1e-14)


@pytest.mark.parametrize("degree", DEGREES)
def test_integrating_a_slope_gives_the_difference_to_the_left_end(degree: int) -> None:
    """Running integrals undo slopes, to a few digits of the largest slope."""
    table = reference_element(degree)
    wanted = np.eye(degree + 1) - np.eye(degree + 1)[0]
    digits = 1e-14 * (1 + np.abs(table.slopes).max())
    np.testing.assert_allclose(table.running @ table.slopes, wanted, rtol=0, atol=digits)


@pytest.mark.parametrize("degree", DEGREES)
def test_summation_by_parts_between_points_and_nodes(degree: int) -> None:
    """Gauss and Gauss-Lobatto are dual: for S of degree p - 1, D^T w S = [S] - m S' and B^T w S = m S on the nodes.

    So the weak form of the scheme is the strong one, in its sum over an element.
    """
    table = reference_element(degree)
    rng = np.random.default_rng(degree)
    S = rng.normal(size=degree) / np.arange(1, degree + 1) ** 2
    at_points, on_nodes = legendre.legval(table.points, S), legendre.legval(table.nodes, S)
    slope = legendre.legval(table.nodes, legendre.legder(S))
    ends = np.zeros(degree + 1)
    ends[0] -= on_nodes[0]
    ends[-1] += on_nodes[-1]
    weighted = table.weights * at_points
    np.testing.assert_allclose(table.slopes.T @ weighted, ends - table.masses * slope, rtol=0, atol=1e-13 * degree)
    np.testing.assert_allclose(table.values.T @ weighted, table.masses * on_nodes, rtol=0, atol=1e-14)


@pytest.mark.parametrize("degree", DEGREES)
def test_the_element_is_its_own_mirror_image(degree: int) -> None:
    """Points, nodes, weights and masses exactly or to the last digit; tables with both axes reversed."""
    table = reference_element(degree)
    np.testing.assert_array_equal(table.nodes, -table.nodes[::-1])
    np.testing.assert_allclose(table.points, -table.points[::-1], rtol=0, atol=1e-16)
    np.testing.assert_allclose(table.masses, table.masses[::-1], rtol=1e-13)
    np.testing.assert_allclose(table.values, table.values[::-1, ::-1], rtol=0, atol=1e-13)
    np.testing.assert_allclose(table.slopes, -table.slopes[::-1, ::-1], rtol=0, atol=1e-13 * degree**2)


def test_the_lowest_degree_is_the_midpoint_rule() -> None:
    """p = 1: the mean of two nodes, and their difference over the length 2."""
    table = reference_element(1)
    np.testing.assert_array_equal(table.values, [[0.5, 0.5]])
    np.testing.assert_array_equal(table.slopes, [[-0.5, 0.5]])


def test_a_degree_below_one_is_refused() -> None:
    """There is no polynomial to take slopes of."""
    with pytest.raises(ValueError, match="expected a degree of at least 1, found 0"):
        reference_element(0)


@pytest.mark.parametrize("degree", [1, 2, 5, 16, 32])
def test_polynomials_are_carried_to_the_points_of_another_element(degree: int) -> None:
    """Values at p Gauss points determine a polynomial of degree p - 1; at twice as many it has its own values."""
    coarse, fine = reference_element(degree), reference_element(2 * degree)
    highest = np.eye(degree)[degree - 1]
    carried = fine.from_points(coarse) @ legendre.legval(coarse.points, highest)
    np.testing.assert_allclose(carried, legendre.legval(fine.points, highest), atol=1e-12)
