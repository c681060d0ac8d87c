"""The exponential, its inverse and its differential, over both groups and all angles."""

from __future__ import annotations

import mpmath as mp
import numpy as np
import pytest
import sympy as sp

from geocosserat.algebra import symbolic
from geocosserat.algebra.exponential import (
    dexp,
    dexp_inverse,
    exp,
    log,
    rotation_from_vector,
    vector_from_rotation,
)
from geocosserat.algebra.groups import Group
from tests.algebra.elements import ANGLES, GROUPS, components, exact_exp, floats, with_angle

BOTH = pytest.mark.parametrize("group", GROUPS, ids=lambda g: g.name)
ALL_ANGLES = pytest.mark.parametrize("angle", ANGLES)


@BOTH
@pytest.mark.parametrize("angle", [*ANGLES, 4.0, 2 * np.pi, 40.0])
def test_exp_is_the_matrix_exponential(group: Group, angle: float) -> None:
    """Against the power series at 40 digits, at no, tiny, half, full and many turns."""
    for seed, X in enumerate(with_angle(group, angle, 11, (5,))):
        with mp.workdps(40):
            expected = floats(exact_exp(group, X))
        assert exp(group, X) == pytest.approx(expected, rel=1e-14, abs=1e-14), seed


@BOTH
@ALL_ANGLES
def test_log_gives_back_what_exp_was_given(group: Group, angle: float) -> None:
    """log(exp X) = X below half a turn, to rounding, near zero relative to the angle itself."""
    X = with_angle(group, angle, 12, (50,))
    back = log(group, exp(group, X))
    assert back == pytest.approx(X, rel=1e-13, abs=1e-14)
    w, found = X[..., group.translations :], back[..., group.translations :]
    assert np.abs(found - w).max() <= 4e-16 * min(1.0, angle) + 4e-16 * angle


@BOTH
@pytest.mark.parametrize("angle", [np.pi, np.nextafter(np.pi, 4.0), 3.5, 6.0, 20.0])
def test_exp_gives_back_what_log_was_given(group: Group, angle: float) -> None:
    """exp(log g) = g at and beyond half a turn, where log takes the shorter way round."""
    g = exp(group, with_angle(group, angle, 13, (50,)))
    X = log(group, g)
    assert exp(group, X) == pytest.approx(g, abs=1e-13)
    assert np.linalg.norm(X[..., group.translations :], axis=-1).max() <= np.pi * (1 + 1e-15)


def test_an_exact_half_turn_has_the_logarithm_with_a_positive_first_component() -> None:
    """diag(1, -1, -1) and its like have no rounding to decide the sign; the stated rule does."""
    n = np.array([[1.0, 0, 0], [0, -1, 0], [0, 0, 1], [0.0, 0.6, -0.8], [-0.6, 0.8, 0.0]])
    R = 2 * n[:, :, None] * n[:, None, :] - np.eye(3)
    first = np.array([next(x for x in row if x) for row in n])
    assert vector_from_rotation(R) == pytest.approx(np.pi * n * np.sign(first)[:, None], abs=1e-15)
    assert vector_from_rotation(np.array([[-1.0, 0], [0, -1]])) == pytest.approx([np.pi])


@BOTH
@pytest.mark.parametrize("angle", ANGLES)
def test_Ad_of_exp_is_exp_of_ad(group: Group, angle: float) -> None:
    """Ad(exp X) = e^{ad X}."""
    for X in with_angle(group, angle, 14, (3,)):
        with mp.workdps(30):
            expected = floats(mp.expm(mp.matrix(group.ad(X).tolist()), method="taylor"))
        assert group.Ad(exp(group, X)) == pytest.approx(expected, rel=1e-13, abs=1e-13)


@BOTH
@pytest.mark.parametrize("angle", [*ANGLES, 4.0, 2 * np.pi, 15.0])
def test_dexp_is_the_left_trivialised_derivative(group: Group, angle: float) -> None:
    """exp(X)^-1 (exp(X + e Y) - exp(X - e Y)) / 2e with e = 1e-20 at 60 digits decides side and sign."""
    X, Y = with_angle(group, angle, 15), components(group, 16)
    with mp.workdps(60):
        e = mp.mpf(10) ** -20
        ahead, behind = (
            exact_exp(group, np.array([mp.mpf(x) + sign * e * mp.mpf(y) for x, y in zip(X, Y, strict=True)]))
            for sign in (1, -1)
        )
        expected = group.vee(floats(exact_exp(group, X) ** -1 * (ahead - behind) / (2 * e)))
    assert dexp(group, X) @ Y == pytest.approx(expected, rel=1e-13, abs=2e-14)


@BOTH
@ALL_ANGLES
def test_dexp_inverse_is_the_inverse(group: Group, angle: float) -> None:
    """On both sides, over a batch, from zero to half a turn."""
    X = with_angle(group, angle, 17, (4, 2))
    product = dexp(group, X) @ dexp_inverse(group, X)
    assert product == pytest.approx(np.broadcast_to(np.eye(group.dimension), product.shape), abs=1e-14)


@BOTH
def test_dexp_differs_between_the_sides_by_Ad(group: Group) -> None:
    """d exp exp^-1 = dexp(-X) = Ad(exp X) dexp(X)."""
    X = components(group, 18, (6,))
    assert dexp(group, -X) == pytest.approx(group.Ad(exp(group, X)) @ dexp(group, X), abs=1e-13)


@BOTH
def test_one_parameter_subgroups_add(group: Group) -> None:
    """exp(aX) exp(bX) = exp((a + b) X)."""
    X = components(group, 19, (8,))
    assert exp(group, 0.7 * X) @ exp(group, 1.9 * X) == pytest.approx(exp(group, 2.6 * X), abs=1e-12)


@BOTH
@ALL_ANGLES
def test_rotation_vectors_and_matrices_are_inverse(group: Group, angle: float) -> None:
    """The rotation helpers agree with the group's own exponential and with each other."""
    X = with_angle(group, angle, 20, (5,))
    w = X[..., group.translations :]
    R = rotation_from_vector(w)
    expected = group.rotation(exp(group, X))
    assert np.abs(R - expected).max() <= 1e-15
    assert vector_from_rotation(R) == pytest.approx(w, rel=1e-14, abs=1e-15)
    assert np.abs(R @ np.swapaxes(R, -1, -2) - np.eye(group.space)).max() <= 4e-15
    assert np.linalg.det(R) == pytest.approx(np.ones(5))


def test_a_vector_of_another_length_is_refused() -> None:
    """Two components make no rotation."""
    with pytest.raises(ValueError, match="1 or 3 components, found 2"):
        rotation_from_vector(np.zeros(2))
    with pytest.raises(ValueError, match="2 or 3 rows, found 4"):
        vector_from_rotation(np.eye(4))


@BOTH
@pytest.mark.parametrize("function", ["exp", "dexp", "dexp_inverse"])
def test_symbolic_and_numeric_are_one_formula(group: Group, function: str) -> None:
    """The symbolic result at random values, and at zero, is the numeric one."""
    X = symbolic.components(group.strain)
    expression = sp.Matrix(getattr(symbolic, function)(group, X))
    numeric = {"exp": exp, "dexp": dexp, "dexp_inverse": dexp_inverse}[function]
    for values in (*components(group, 21, (2,)), np.zeros(group.dimension)):
        at = dict(zip(X, values, strict=True))
        found = np.array(expression.subs(at).evalf().tolist(), dtype=float)
        assert found == pytest.approx(numeric(group, values), abs=1e-14)


@BOTH
def test_the_symbolic_exponential_differentiates_to_dexp(group: Group) -> None:
    """exp(X)^-1 d exp(X)/dX_a = column a of dexp(X), at 30 digits; also at zero, where a quotient fails."""
    X = symbolic.components(group.strain)
    g, T = sp.Matrix(symbolic.exp(group, X)), sp.Matrix(symbolic.dexp(group, X))
    rng = np.random.default_rng(22)
    somewhere = [sp.Rational(int(n), 97) for n in rng.integers(-200, 200, len(X))]
    for values in (somewhere, [sp.Integer(0)] * len(X)):
        at = dict(zip(X, values, strict=True))
        here = g.subs(at).evalf(40)
        for a, x in enumerate(X):
            tangent = here.inv() * g.diff(x).subs(at).evalf(40)
            column = group.vee(np.array(tangent.tolist()))
            for found, expected in zip(column, T[:, a].subs(at).evalf(40), strict=True):
                assert abs(found - expected) < 1e-30
