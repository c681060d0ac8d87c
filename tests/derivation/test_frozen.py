"""Frozen modes, rotations without friction, references that move, and ends that are pinned, driven or joined."""

from __future__ import annotations

import dataclasses

import pytest
import sympy as sp

from geocosserat.algebra.groups import SE2, SE3, Group
from geocosserat.derivation.closure import closure
from geocosserat.derivation.equations import derive
from geocosserat.derivation.forms import document
from geocosserat.derivation.notation import T, U, field, field_names, fields
from geocosserat.derivation.printing import to_latex, to_text
from geocosserat.model.records import End
from tests.derivation.scenes import BASE, FROZEN, QUASISTATIC, derived, diagonal, planar, same, spatial, vector

SCENES = pytest.mark.parametrize("name", FROZEN)
GROUPS = pytest.mark.parametrize("group", [SE2, SE3], ids=["planar", "spatial"])


@SCENES
def test_a_frozen_rod_is_the_free_one_with_its_mode_at_its_reference(name: str) -> None:
    """Every equation is that of the rod without frozen modes with E set to the reference and the stress kept."""
    model = FROZEN[name]
    frozen, free = derived(name), derive(dataclasses.replace(model, frozen=()))
    held = {field(mode): e for mode, e in zip(model.group.strain, free.reference, strict=True) if mode in model.frozen}
    kept = {s: s for s in frozen.multipliers}
    laws = {e.left: kept.get(e.left, e.right) for e in free.stress_law}
    for part in ("compatibility", "balance"):
        for a, b in zip(getattr(frozen, part), getattr(free, part), strict=True):
            assert same(a.left, b.left.subs(held).doit())
            assert same(a.right, b.right.subs(held).doit())
    for a, b in zip(frozen.motion, free.balance, strict=True):
        wrench = {e.left: e.right for e in free.wrench_law}
        expected = b.left.xreplace(wrench).xreplace(laws).doit() + a.left
        assert same(a.right, expected.subs(held).doit())
    assert frozen.stress == free.stress
    assert {e.left for e in frozen.stress_law} == set(free.stress) - set(frozen.multipliers)


@SCENES
def test_there_are_as_many_equations_as_unknown_fields(name: str) -> None:
    """The unknowns are exactly the fields that occur in the closed system; the remark says how many there are."""
    model, equations = FROZEN[name], derived(name)
    sides = [side for e in equations.closed for side in (e.left, e.right)]
    names = field_names(equations.unknowns)
    assert field_names(sides) == names
    assert len(equations.closed) == len(equations.unknowns) == len(names)
    assert len(equations.unknowns) == 2 * model.group.dimension
    assert len(equations.multipliers) == len(model.frozen) == len(equations.constraints)
    words = closure(equations)
    assert f"{len(names)} equations for the {len(names)} unknown fields" in words
    assert all(name in words for name in (*names, *(f.func.__name__ for f in equations.multipliers)))
    assert ("no friction" in words) == bool(equations.algebraic)


@SCENES
def test_it_prints_in_every_way(name: str) -> None:
    """Text, ASCII and LaTeX; frozen modes are in the title, and their turn is written as what it is."""
    model, equations = FROZEN[name], derived(name)
    laid_out = document(equations)
    text, plain, latex = to_text(laid_out), to_text(laid_out, unicode=False), to_latex(laid_out)
    assert plain.isascii()
    assert latex.count("{") == latex.count("}")
    for words in (text, plain, latex):
        assert "frozen" in words.splitlines()[0]
        assert "Constraints" in words
        assert "multiplier" in words
        assert "Orientation" not in words
        assert "medium" not in words
    assert not set(model.frozen) & set(equations.fields)


def test_the_stress_of_a_frozen_mode_has_no_law_and_no_energy() -> None:
    """Not even where the stiffness couples it to others: its strain is zero, and its stress is unknown."""
    stiffness = (vector("k1", "a", "b"), vector("a", "k2", 1), vector("b", 1, "k3"))
    equations = derive(planar(stiffness=stiffness, frozen=("h1",)))
    h2, Pi = fields(("h2", "Pi"))
    k2, k3 = sp.Symbol("k2", real=True), sp.Symbol("k3", real=True)
    assert [e.left for e in equations.stress_law] == [*fields(("F2", "M"))]
    assert same(equations.stress_law[0].right, k2 * h2 + Pi)
    assert same(equations.energy, k2 * h2**2 / 2 + h2 * Pi + k3 * Pi**2 / 2)
    assert equations.turn[0] == 1


def test_an_asymmetric_coupling_to_a_frozen_mode_is_no_obstacle_to_an_energy() -> None:
    """What couples to a strain that is zero does no work."""
    odd = (vector("k1", "a", 0), vector("-a", "k2", 0), vector(0, 0, "k3"))
    assert derive(planar(stiffness=odd)).energy is None
    assert derive(planar(stiffness=odd, frozen=("h1",))).energy is not None


@GROUPS
def test_a_reference_that_moves_drives_its_constraint(group: Group) -> None:
    """The rate of a frozen reference is what V' + ad_E V must be; where the mode is free, it strains the rod."""
    reference = ("1 + a*sin(t)*u", *[0] * (group.dimension - 2), "b*t")
    model = dataclasses.replace(BASE[group], reference=vector(*reference), frozen=("h1",))
    equations = derive(model)
    a, b = sp.Symbol("a", real=True), sp.Symbol("b", real=True)
    assert equations.constraints[0].left == a * U * sp.cos(T)
    assert equations.constraints[0] == equations.compatibility[0]
    assert equations.turn[0] == 1 + a * U * sp.sin(T)
    last = equations.stress_law[-1].right
    assert last.subs(equations.turn[-1], b * T) == 0
    assert "active reference" in equations.terms
    assert "active reference" not in derive(BASE[group]).terms
    # it is differentiated along the rod where a stress turns with it
    assert any(e.right.has(sp.sin(T)) for e in equations.motion)


@GROUPS
def test_a_rotation_without_friction_is_an_algebraic_balance(group: Group) -> None:
    """Nothing stands on the left of its row, no velocity in it, and it is listed."""
    equations = derive(dataclasses.replace(BASE[group], friction=QUASISTATIC[group]))
    assert equations.algebraic == (("Omega",) if group is SE2 else ("Omega2", "Omega3"))
    for row, v in zip(equations.motion, equations.twist, strict=True):
        assert (row.left == 0) == (v.func.__name__ in equations.algebraic)
        assert not row.right.has(*equations.twist)
    text = to_text(document(equations), unicode=False)
    assert "algebraic balance" in text
    assert any(line.lstrip().startswith("0 = ") for line in text.splitlines())
    assert derive(BASE[group]).algebraic == ()


@pytest.mark.parametrize("side", ["left", "right"])
def test_a_pinned_end_turns_about_a_fixed_point(side: str) -> None:
    """No velocity; the moment is that of its load, outward."""
    sign = -1 if side == "left" else 1
    a = sp.Symbol("a", real=True)
    flat = getattr(derive(planar(**{side: End("pinned", torque=vector("a*t"))})), side)
    assert [(e.left, e.right) for e in flat.equations] == [
        (field("v1"), 0),
        (field("v2"), 0),
        (field("M"), sign * a * T),
    ]
    solid = getattr(derive(spatial(**{side: End("pinned")})), side)
    assert [(e.left, e.right) for e in solid.equations] == [
        (f, 0) for f in fields(("v1", "v2", "v3", "M1", "M2", "M3"))
    ]
    world = derive(spatial(**{side: End("pinned", torque=vector(0, 0, "a"), frame="world")}))
    assert getattr(world, side).equations[-1].right == sign * a * field("e3z")
    assert [str(f.func) for f in world.orientation.fields] == ["e1z", "e2z", "e3z"]


def test_a_driven_end_has_the_twist_of_the_scene() -> None:
    """All components, in the moving frame; it is listed, and no orientation is needed for it."""
    equations = derive(planar(right=End("driven", twist=vector(0, "a*sin(t)", "b"))))
    a, b = sp.Symbol("a", real=True), sp.Symbol("b", real=True)
    assert [(e.left, e.right) for e in equations.right.equations] == [
        (field("v1"), 0), (field("v2"), a * sp.sin(T)), (field("Omega"), b)
    ]  # fmt: skip
    assert equations.terms[-1] == "drive of the right end"
    assert equations.orientation.fields == ()


@GROUPS
def test_joined_ends_share_their_twist_and_their_stress(group: Group) -> None:
    """At u = 0 and u = length, printed with the place; nothing about loads."""
    model = dataclasses.replace(BASE[group], joined=True, left=End("free"), right=End("free"), length=2.5)
    equations = derive(model)
    for end, shared in ((equations.left, equations.twist), (equations.right, equations.stress)):
        assert [(e.left, e.right) for e in end.equations] == [
            (f.subs(U, 0), f.subs(U, sp.Rational(5, 2))) for f in shared
        ]
    laid_out = document(equations)
    assert "v1(0) = v1(5/2)" in to_text(laid_out, unicode=False)
    assert "v₁(0) = v₁(5/2)" in to_text(laid_out)
    assert r"v_{1}(0) &= v_{1}(\frac{5}{2})" in to_latex(laid_out)
    assert "stays closed" in to_text(laid_out)
    assert "Right end" not in to_text(laid_out)


def test_where_a_free_law_steps_only_its_stress_stays_a_field() -> None:
    """The stress of a frozen mode is one anyway; a step in the law of a frozen mode changes nothing."""
    stiffness = diagonal("k1", "k2", "k3*(1 + heaviside(u - 0.5))")
    equations = derive(planar(stiffness=stiffness, frozen=("h1", "h2")))
    assert equations.keeps_stress
    assert len(equations.unknowns) == len(equations.closed) == 7
    assert "continuous where the law steps" in closure(equations)
    frozen_step = derive(planar(stiffness=diagonal("heaviside(u - 0.5)", "k2", "k3"), frozen=("h1",)))
    assert not frozen_step.keeps_stress
    assert len(frozen_step.unknowns) == len(frozen_step.closed) == 6


def test_both_ends_held_may_leave_a_multiplier_open() -> None:
    """The remark says so, and only then."""
    held = derive(planar(frozen=("h1",), right=End("clamped")))
    assert "may leave a constant tension" in to_text(document(held)).replace("\n  ", " ")
    assert "may leave" not in to_text(document(derive(planar(frozen=("h1",))))).replace("\n  ", " ")
