"""Laws of the two groups that follow from their bases alone."""

from __future__ import annotations

import pickle

import numpy as np
import pytest
import sympy as sp
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from geocosserat.algebra import symbolic
from geocosserat.algebra.exponential import exp
from geocosserat.algebra.groups import SE2, SE3, Group, group_of
from tests.algebra.elements import GROUPS, components

BOTH = pytest.mark.parametrize("group", GROUPS, ids=lambda g: g.name)
INTEGERS = st.integers(-50, 50)


def algebra_elements(group: Group, count: int) -> st.SearchStrategy[np.ndarray]:
    """Integer components, for which every identity must hold without rounding."""
    return hnp.arrays(np.int64, (count, group.dimension), elements=INTEGERS)


@BOTH
@given(data=st.data())
def test_the_bracket_satisfies_the_jacobi_identity(group: Group, data: st.DataObject) -> None:
    """[X, [Y, Z]] + [Y, [Z, X]] + [Z, [X, Y]] = 0, in exact integers."""
    X, Y, Z = data.draw(algebra_elements(group, 3))
    bracket = group.bracket
    cyclic = bracket(X, bracket(Y, Z)) + bracket(Y, bracket(Z, X)) + bracket(Z, bracket(X, Y))
    assert not cyclic.any()


@BOTH
@given(data=st.data())
def test_the_bracket_is_the_matrix_commutator(group: Group, data: st.DataObject) -> None:
    """hat [X, Y] = hat X hat Y - hat Y hat X, and ad X is its matrix."""
    X, Y = data.draw(algebra_elements(group, 2))
    commutator = group.hat(X) @ group.hat(Y) - group.hat(Y) @ group.hat(X)
    assert np.array_equal(group.hat(group.bracket(X, Y)), commutator)
    assert np.array_equal(group.ad(X) @ Y, group.vee(commutator))


@BOTH
@given(data=st.data())
def test_the_dual_action_is_minus_the_transpose_of_ad(group: Group, data: st.DataObject) -> None:
    """<ad*_X s, Y> = -<s, ad_X Y> for all X, Y and s."""
    X, Y, s = data.draw(algebra_elements(group, 3))
    assert np.dot(group.coad(X) @ s, Y) == -np.dot(s, group.ad(X) @ Y)


@BOTH
def test_structure_constants_reproduce_every_commutator(group: Group) -> None:
    """[b_a, b_b] = C_abc b_c, antisymmetric in a and b, and integers."""
    C = group.structure
    assert C.dtype.kind == "i"
    assert np.array_equal(C, -C.transpose(1, 0, 2))
    for a, x in enumerate(group.basis):
        for b, y in enumerate(group.basis):
            assert np.array_equal(x @ y - y @ x, np.tensordot(C[a, b], np.stack(group.basis), 1))


def test_the_frame_turns_by_the_cross_product() -> None:
    """In space R' = R hat(Pi) says e_i' = Pi x e_i, with Pi = Pi_k e_k; the first rotation is about e_1."""
    rng = np.random.default_rng(3)
    R = SE3.rotation(exp(SE3, rng.normal(size=6)))
    Pi = rng.normal(size=3)
    rate = R @ SE3.rotation(SE3.hat(np.concatenate([np.zeros(3), Pi])))
    assert np.abs(rate.T - np.cross(R @ Pi, R.T)).max() < 1e-14


def test_the_plane_sits_in_space_as_a_subalgebra() -> None:
    """With h1, h2 and Pi3 alone the bracket of space is that of the plane, and the rest stays zero."""
    plane = [0, 1, 5]
    C = SE3.structure[np.ix_(plane, plane)]
    assert np.array_equal(C[..., plane], SE2.structure)
    assert not C[..., [2, 3, 4]].any()


@BOTH
def test_hat_and_vee_are_inverse_over_batches(group: Group) -> None:
    """vee(hat X) = X for any leading axes, and the batch axes stay in place."""
    X = components(group, 0, (2, 3))
    M = group.hat(X)
    assert M.shape == (2, 3, group.size, group.size)
    assert np.array_equal(group.vee(M), X)
    assert np.array_equal(group.ad(X)[1, 2], group.ad(X[1, 2]))
    assert np.array_equal(group.coad(X)[1, 2], group.coad(X[1, 2]))


@BOTH
def test_Ad_is_a_homomorphism_that_transports_the_bracket(group: Group) -> None:
    """Ad(gh) = Ad(g) Ad(h), Ad(g^-1) = Ad(g)^-1 and Ad(g)[X, Y] = [Ad(g)X, Ad(g)Y], over a batch."""
    g, h = exp(group, components(group, 1, (4,))), exp(group, components(group, 2, (4,)))
    X, Y = components(group, 3, (4,)), components(group, 4, (4,))
    A = group.Ad(g)
    assert group.Ad(g @ h) == pytest.approx(A @ group.Ad(h), abs=1e-13)
    assert group.Ad(group.inverse(g)) @ A == pytest.approx(
        np.broadcast_to(np.eye(group.dimension), A.shape), abs=1e-13
    )
    moved = [(A @ Z[..., None])[..., 0] for Z in (X, Y, group.bracket(X, Y))]
    assert group.bracket(moved[0], moved[1]) == pytest.approx(moved[2], abs=1e-12)


@BOTH
def test_a_pose_gives_back_its_position_and_rotation(group: Group) -> None:
    """pose, position, rotation and inverse agree, and a single position broadcasts over many rotations."""
    g = exp(group, components(group, 5, (3,)))
    assert np.array_equal(group.pose(group.position(g), group.rotation(g)), g)
    assert g @ group.inverse(g) == pytest.approx(np.broadcast_to(group.identity(), g.shape), abs=1e-14)
    assert group.pose(np.zeros(group.space), group.rotation(g)).shape == g.shape


@BOTH
def test_symbolic_components_go_through_the_same_definition(group: Group) -> None:
    """Every method on symbols, evaluated, equals the method on the values; integers stay exact."""
    X, Y = (symbolic.components(tuple(f"{p}{i}" for i in range(group.dimension))) for p in "xy")
    values = components(group, 6, (2,))
    at = dict(zip([*X, *Y], values.ravel(), strict=True))
    numbers = np.vectorize(lambda e: float((sp.Integer(0) + e).subs(at).evalf()))
    for method in (group.hat, group.ad, group.coad):
        assert numbers(method(X)) == pytest.approx(method(values[0]), abs=1e-15)
    assert numbers(group.bracket(X, Y)) == pytest.approx(group.bracket(*values), abs=1e-15)
    assert np.array_equal(group.vee(group.hat(X)), X)
    assert not any(e.has(sp.Float) for e in group.bracket(X, Y))
    g = symbolic.exp(group, X)
    assert numbers(group.Ad(g)) == pytest.approx(group.Ad(exp(group, values[0])), abs=1e-13)


@BOTH
def test_names_match_the_dimensions(group: Group) -> None:
    """Each vector has one name a component, translations first."""
    for names in (group.strain, group.twist, group.stress, group.wrench):
        assert len(names) == group.dimension == group.translations + group.rotations
    assert group.strain[group.translations].startswith("Pi")


@BOTH
def test_a_group_compares_hashes_and_pickles_as_a_value(group: Group) -> None:
    """A copy equals the original and works on its own, so records that hold a group do too."""
    copy = pickle.loads(pickle.dumps(group))
    assert copy == group
    assert hash(copy) == hash(group)
    assert np.array_equal(copy.structure, group.structure)


def test_a_basis_cannot_be_changed_in_place() -> None:
    """The basis and the structure constants are read-only."""
    for array in (SE3.basis[0], SE3.structure):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1


def test_a_basis_that_is_not_closed_is_refused() -> None:
    """Leaving one rotation out of space leaves brackets outside the span."""
    broken = Group("broken", 3, SE3.basis[:5], *(("",) * 5,) * 4)
    with pytest.raises(ValueError, match=r"closed under commutators.*complete the basis"):
        _ = broken.structure


def test_a_motion_names_its_group() -> None:
    """planar and spatial are the two motions; another word is refused."""
    assert group_of("planar") is SE2
    assert group_of("spatial") is SE3
    with pytest.raises(ValueError, match='expected "planar" or "spatial", found \'flat\''):
        group_of("flat")
