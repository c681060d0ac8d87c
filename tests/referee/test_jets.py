"""Fields, their derivatives, and the fields of a rod: all that follows from phi' = phi E and d(phi)/dt = phi V."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
import sympy as sp

from geocosserat.algebra.groups import SE2, SE3, Group
from geocosserat.referee.jets import Jets
from geocosserat.referee.motion import Motion, cross, dot, epsilon, hat
from geocosserat.referee.statement import compare

NAMES = [tuple(f"{letter}{i}" for i in (1, 2, 3)) for letter in ("Pi", "Omega", "M", "m")]
SO3 = Group("SO(3)", 3, SE3.basis[3:], *NAMES)
GROUPS = [SE2, SE3, SO3]
SOLID = [SE2, SE3]


@pytest.fixture(params=GROUPS, ids=lambda g: g.name)
def rod(request: pytest.FixtureRequest) -> Motion:
    return Motion(request.param)


def same(left: Any, right: Any, fields: Jets | None = None) -> bool:
    return compare(left, right, fields).how.startswith("proved")


def test_derivatives_are_symbols_whatever_the_order() -> None:
    """x_ut is x_tu."""
    jets = Jets()
    x = jets.scalar("x")
    assert str(jets.du(x)) == "x_u"
    assert str(jets.du(jets.dt(jets.du(x)))) == "x_uut"
    assert jets.du(jets.dt(x)) == jets.dt(jets.du(x))


def test_derivatives_obey_the_product_and_the_chain_rule() -> None:
    """Of whatever holds fields."""
    jets = Jets()
    x, y = jets.fields(["x", "y"])
    e = x**2 * y + sp.sin(x) / y
    assert same(jets.du(x * y), jets.du(x) * y + x * jets.du(y))
    assert same(jets.dt(1 / x), -jets.dt(x) / x**2)
    assert jets.du(sp.sin(x)) == sp.cos(x) * jets.du(x)
    assert compare(jets.du(jets.dt(e)), jets.dt(jets.du(e))).vanishes


def test_constants_have_no_derivatives_and_no_field_either() -> None:
    """Numbers, constants, and symbols that were never declared."""
    jets = Jets()
    k = jets.constant("k")
    assert [jets.du(e) for e in (k, 3, sp.Symbol("small"))] == [0, 0, 0]
    assert jets.dt(k * jets.scalar("x")) == k * sp.Symbol("x_t")


def test_a_law_says_what_a_derivative_is_and_so_are_all_higher_ones() -> None:
    """x' = x y: its derivative in time, and that of the rate along u, are one."""
    jets = Jets()
    x, y = jets.fields(["x", "y"])
    jets.law(x, u=x * y)
    assert jets.du(x) == x * y
    assert same(jets.du(jets.du(x)), x * y**2 + x * jets.du(y))
    assert same(jets.du(jets.dt(x)), jets.dt(jets.du(x)))
    assert same(jets.du(jets.dt(jets.dt(x))), jets.dt(jets.dt(jets.du(x))))


def test_laws_that_do_not_agree_show() -> None:
    """x' = y and dx/dt = y: mixed derivatives agree only if y' is dy/dt, so not for all y."""
    jets = Jets()
    x, y = jets.fields(["x", "y"])
    jets.law(x, u=y, t=y)
    assert not compare(jets.du(jets.dt(x)), jets.dt(jets.du(x))).vanishes


def test_a_name_is_taken_once() -> None:
    """Two fields of one name would be one."""
    jets = Jets()
    jets.scalar("x")
    with pytest.raises(ValueError, match="expected a new name for a field, found x again; take another one"):
        jets.constant("x")


def test_arrays_are_named_by_their_indices_and_symmetric_ones_are() -> None:
    """From one, as on paper."""
    jets = Jets()
    K = jets.symmetric("K", 3)
    assert [str(x) for x in jets.array("p", 2)] == ["p1", "p2"]
    assert str(jets.constants("A", 2, 3)[1, 2]) == "A23"
    assert (K.T == K).all()
    assert len(set(K.ravel())) == 6
    assert not jets.du(K).any()


def test_mixed_derivatives_of_the_configuration_agree(rod: Motion) -> None:
    """Entry by entry, with all higher ones, whether or not R is a rotation."""
    phi = rod.configuration
    assert same(rod.du(rod.dt(phi)), rod.dt(rod.du(phi)))
    assert same(rod.du(rod.dt(rod.du(phi))), rod.dt(rod.du(rod.du(phi))))


def test_the_configuration_changes_by_turn_and_twist(rod: Motion) -> None:
    """phi' = phi E, d(phi)/dt = phi V."""
    phi, group = rod.configuration, rod.group
    assert same(rod.du(phi), phi @ group.hat(rod.turn))
    assert same(rod.dt(phi), phi @ group.hat(rod.twist))


def test_a_configuration_stays_one(rod: Motion) -> None:
    """R^T R and det R do not change: by the constraint, not without it."""
    R = sp.Matrix(rod.rotation)
    determinant, one = R.det(method="berkowitz"), sp.eye(R.rows)
    assert same(np.array(R.T * R), np.array(one), rod)
    assert same(determinant, 1, rod)
    assert not compare(determinant, 1).vanishes
    for change in (rod.du, rod.dt):
        assert same(change(np.array(R.T * R)), np.zeros(R.shape, dtype=int), rod)
        assert same(change(determinant), 0, rod)


def test_the_turn_changes_as_compatibility_has_it(rod: Motion) -> None:
    """dE/dt - V' = ad_E V; the other sign is refuted."""
    ad = np.asarray(rod.group.ad(rod.turn) @ rod.twist)
    change = rod.dt(rod.turn) - rod.du(rod.twist)
    assert same(change, ad, rod)
    assert not compare(change, -ad, rod).vanishes


def test_the_wrench_balances_the_stress(rod: Motion) -> None:
    """j = -(S' + ad*_E S), found from forces and moments about the origin; the other sign is refuted."""
    coad = np.asarray(rod.group.coad(rod.turn) @ rod.stress)
    assert same(rod.wrench, -(rod.du(rod.stress) + coad), rod)
    assert not compare(rod.wrench, -(rod.du(rod.stress) - coad), rod).vanishes


def test_the_power_of_the_wrench_goes_into_the_shape_or_out_at_the_ends(rod: Motion) -> None:
    """(S . V)' = S . dE/dt - j . V, which is how the wrench on another group than SE(2), SE(3) is found."""
    assert same(
        rod.du(dot(rod.stress, rod.twist)), dot(rod.stress, rod.dt(rod.turn)) - dot(rod.wrench, rod.twist), rod
    )


@pytest.mark.parametrize("group", SOLID, ids=lambda g: g.name)
def test_vectors_and_components_are_those_of_the_frame(group: Group) -> None:
    """There and back; the frame turns about Pi and Omega."""
    rod = Motion(group)
    v, turn = rod.split(rod.twist)
    assert same(rod.body(rod.world(v)), v, rod)
    assert not compare(rod.body(rod.world(v)), v).vanishes
    assert same(rod.dt(rod.position), rod.world(v), rod)
    assert same(np.array(rod.frame), rod.rotation.T)
    if group is SE3:
        assert same(rod.dt(rod.frame[0]), cross(rod.world(turn), rod.frame[0]), rod)


@pytest.mark.parametrize("group", SOLID, ids=lambda g: g.name)
def test_moving_the_world_changes_no_turn(group: Group) -> None:
    """g phi has the slope g phi E; a rigid motion is constant and keeps angles."""
    rod = Motion(group)
    g = rod.rigid_motion()
    assert same(rod.du(g @ rod.configuration), g @ rod.configuration @ group.hat(rod.turn), rod)
    R = group.rotation(g)
    assert same(R.T @ R, np.eye(group.space, dtype=int), rod)
    assert not rod.du(g).any()


def test_a_group_of_rotations_has_no_linear_part() -> None:
    """All of turn and twist is angular; vectors are turned by the same frame."""
    rod = Motion(SO3)
    none, turn = rod.split(rod.turn)
    assert len(none) == 0
    assert turn.tolist() == rod.turn.tolist()
    assert same(rod.dt(rod.frame[0]), cross(rod.world(rod.twist), rod.frame[0]), rod)


def test_products_of_vectors_are_the_usual_ones() -> None:
    """Right-handed; the antisymmetric symbol has the same sign."""
    x, y, z = np.eye(3, dtype=int).astype(object)
    a, b = (np.array(sp.symbols(f"{name}1:4"), dtype=object) for name in "ab")
    assert (cross(x, y) == z).all()
    assert same(hat(a) @ b, cross(a, b))
    assert same(np.einsum("ijk,j,k->i", epsilon(), a, b), cross(a, b))
    assert same(dot(a, cross(a, b)), 0)
    assert cross([1, 0], [0, 1]).tolist() == [1]
