"""Left-invariant vector fields: their commutators, their invariance, the derivatives that they are."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
import sympy as sp

from geocosserat.algebra import fields, symbolic
from geocosserat.algebra.exponential import exp
from geocosserat.algebra.groups import Group
from tests.algebra.elements import GROUPS, components

BOTH = pytest.mark.parametrize("group", GROUPS, ids=lambda g: g.name)


def smooth_function(phi: np.ndarray, seed: int) -> sp.Expr:
    """A random smooth function of all free entries: a sine and an exponential."""
    rng = np.random.default_rng(seed)
    free = [x for x in phi.ravel() if isinstance(x, sp.Symbol)]

    def linear() -> sp.Expr:
        weights = [sp.Rational(int(n), 11) for n in rng.integers(-9, 9, len(free))]
        return sp.Add(1, *(n * x for n, x in zip(weights, free, strict=True)))

    return sp.sin(linear()) + sp.exp(linear() / 7) * linear()


def random_values(phi: np.ndarray, seed: int) -> dict[sp.Symbol, sp.Rational]:
    """Exact random values of the entries."""
    rng = np.random.default_rng(seed)
    free = [x for x in phi.ravel() if isinstance(x, sp.Symbol)]
    return {x: sp.Rational(int(rng.integers(-200, 200)), 101) for x in free}


@BOTH
def test_the_fields_commute_like_the_basis(group: Group) -> None:
    """[X_a, X_b] f = C_abc X_c f for a random smooth f of the entries, decided at 40 digits."""
    phi = symbolic.configuration(group)
    f = smooth_function(phi, 31)
    at = random_values(phi, 32)
    first = fields.derivatives(group, f, phi)
    second = [fields.derivatives(group, Xf, phi) for Xf in first]  # second[b][a] = X_a X_b f
    numbers = [e.subs(at).evalf(40) for e in first]
    for a, b in itertools.combinations(range(group.dimension), 2):
        found = (second[b][a] - second[a][b]).subs(at).evalf(40)
        expected = sum(int(c) * x for c, x in zip(group.structure[a, b], numbers, strict=True))
        assert abs(found - expected) < 1e-30, (a, b)
    assert max(abs(x) for x in numbers) > 1e-3


@BOTH
def test_a_field_is_the_derivative_along_the_moving_frame(group: Group) -> None:
    """X_a[f](g) = d/de f(g exp(e b_a)) at e = 0, over a batch of configurations."""
    phi = symbolic.configuration(group)
    f = smooth_function(phi, 33)
    free = [x for x in phi.ravel() if isinstance(x, sp.Symbol)]
    where = [(i, j) for i, j in np.ndindex(phi.shape) if isinstance(phi[i, j], sp.Symbol)]
    value = sp.lambdify([free], f, "numpy")
    slope = sp.lambdify([free], [f.diff(x) for x in free], "numpy")
    g = exp(group, components(group, 34, (3,)))
    gradient = np.zeros_like(g)
    for n in range(3):
        for (i, j), x in zip(where, slope([g[n][w] for w in where]), strict=True):
            gradient[n, i, j] = x
    found = fields.act(group, g, gradient)
    e = 1e-5
    for n, a in np.ndindex(3, group.dimension):
        b = np.eye(group.dimension)[a]
        ahead, behind = (value([(g[n] @ exp(group, sign * e * b))[w] for w in where]) for sign in (1, -1))
        assert found[n, a] == pytest.approx((ahead - behind) / (2 * e), rel=1e-6, abs=1e-6)


@BOTH
def test_the_fields_are_left_invariant(group: Group) -> None:
    """Moving a configuration moves the field with it: X_a(hg) = h X_a(g)."""
    g, h = exp(group, components(group, 35)), exp(group, components(group, 36))
    assert fields.tangents(group, h @ g) == pytest.approx(h @ fields.tangents(group, g), abs=1e-13)


@BOTH
def test_translation_fields_are_derivatives_along_the_frame_vectors(group: Group) -> None:
    """X_i = e_i . d/dr for a function of position alone, and the rotations do nothing to it."""
    phi = symbolic.configuration(group)
    r, R = group.position(phi), group.rotation(phi)
    f = sp.sin(sum(sp.Integer(k + 2) * x for k, x in enumerate(r)))
    found = fields.derivatives(group, f, phi)
    for i in range(group.space):
        assert sp.expand(found[i] - sum(R[j, i] * f.diff(r[j]) for j in range(group.space))) == 0
    assert not any(found[group.translations :])


@BOTH
def test_a_constant_has_no_derivative(group: Group) -> None:
    """X_a of a number is zero."""
    assert not any(fields.derivatives(group, sp.Integer(3), symbolic.configuration(group)))
