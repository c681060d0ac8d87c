"""The linear ends of a rod: what is held, what is loaded, and that a load with a potential keeps the symmetry."""

from __future__ import annotations

import dataclasses

import pytest
import sympy as sp

from geocosserat.algebra.groups import SE2, SE3, Group
from geocosserat.derivation.elimination import put_in
from geocosserat.derivation.equations import derive
from geocosserat.derivation.known_base import known_base
from geocosserat.derivation.linear import base_of, linearise
from geocosserat.derivation.linear_ends import ends_alone, ends_displaced
from geocosserat.derivation.notation import U, field, fields, symbol
from geocosserat.model.records import End
from tests.derivation.displaced import CLOSE, Displaced, precise
from tests.derivation.scenes import BASE, planar, vector

GROUPS = pytest.mark.parametrize("group", [SE2, SE3], ids=["planar", "spatial"])
k1, k2, k3, g1, g2, g3 = (symbol(name) for name in ("k1", "k2", "k3", "gamma1", "gamma2", "gamma3"))
eta1, eta2, eta3 = fields(("eta1", "eta2", "eta3"))


@pytest.mark.parametrize(("frame", "symmetric"), [("world", True), ("body", False)])
def test_a_dead_end_load_is_symmetric_and_a_follower_is_not(frame: str, symmetric: bool) -> None:
    """Two polynomials that satisfy the linear ends of a clamped rod under thrust, integrated exactly."""
    load = End("free", force=vector("-a", 0), frame=frame)  # type: ignore[arg-type]
    linear = linearise(derive(planar(right=load)))
    own = known_base(linear.base)
    assert own is not None
    values = {field("F1"): sp.Rational(-1, 2), field("h1"): sp.Rational(7, 8), k1: 4, k2: 3, k3: 2, g1: 1, g2: 1, g3: 1}
    system = own.of(linear.balance)
    rows = [e.right.xreplace(values) for e in system.rows]
    right = ends_displaced(linear.base)[1]
    laws = {e.left: e.right for e in (*linear.kinematics, *linear.stress)}
    ends = [e.left.xreplace(laws).xreplace(laws) - e.right for e in right.equations]
    ends = [put_in(e, own.values).xreplace(own.still).xreplace(values) for e in ends]
    etas, tests = [], sp.symbols("c0:12")
    for seed in (1, 2):
        free = {c: sp.Rational((i * 7 * seed) % 5 - 2, 2) for i, c in enumerate(tests)}
        shape = {f: sum(tests[4 * k + j] * U ** (j + 1) for j in range(4)) for k, f in enumerate((eta1, eta2, eta3))}
        conditions = [put_in(e, shape).subs(U, 1) for e in ends]
        solved = sp.solve(conditions, [tests[3], tests[7], tests[11]], dict=True)[0]
        etas.append({f: x.subs(solved).subs(free) for f, x in shape.items()})
    forms = []
    for a, b in (etas, etas[::-1]):
        density = sum(x * put_in(e, b) for x, e in zip(a.values(), rows, strict=True))
        forms.append(sp.integrate(sp.expand(density), (U, 0, 1)))
    assert (forms[0] == forms[1]) is symmetric
    assert forms[0] != 0


@GROUPS
@pytest.mark.parametrize("side", ["left", "right"])
def test_a_load_in_the_world_turns_back_in_the_frame_of_an_end_that_turns(group: Group, side: str) -> None:
    """The stress there changes as the components of the load do; of one in the body it does not."""
    n = group.space
    load = {"force": vector("a", "b*t", 1)[:n], "torque": vector("a", 1, "b")[: group.rotations]}
    for end in (End("free", **load, frame="world"), End("pinned", torque=load["torque"], frame="world")):
        base = base_of(derive(dataclasses.replace(BASE[group], **{side: end})))
        rod = Displaced(base.equations, 29)
        conditions = getattr(base.equations, side)
        outward = -1 if side == "left" else 1
        held = n if end.kind == "pinned" else 0
        slopes = rod.slope(lambda at, c=conditions: [precise(x, at) for x in c.load])
        known = rod.at(0) | rod.unknowns
        known |= {
            f: outward * precise(x, rod.at(0)) for f, x in zip(fields(group.stress), conditions.load, strict=True)
        }
        rows = ends_displaced(base)[0 if side == "left" else 1].equations
        assert [e.left for e in rows] == [*base.displacement[:held], *base.stress_change[held:]]
        for row, slope in zip(rows[held:], slopes[held:], strict=True):
            assert abs(precise(row.right, known) - outward * slope) < CLOSE
    body = base_of(derive(dataclasses.replace(BASE[group], **{side: End("free", **load)})))
    assert all(e.right == 0 for e in ends_displaced(body)[0 if side == "left" else 1].equations)


def test_an_end_that_is_held_is_not_displaced_and_does_not_change_its_twist() -> None:
    """Clamped and driven: all of it; pinned: its place. Joined ends share what they have."""
    driven = End("driven", twist=vector("a", 0, "t"))
    base = base_of(derive(planar(left=End("pinned"), right=driven)))
    left, right = ends_displaced(base)
    assert [e.left for e in left.equations] == [eta1, eta2, field("dM")]
    assert [e.left for e in right.equations] == [eta1, eta2, eta3]
    assert [e.left for e in ends_alone(base)[1].equations] == [*fields(("dv1", "dv2", "dOmega"))]
    assert all(e.right == 0 for e in (*left.equations, *right.equations))
    ring = base_of(derive(planar(left=End("free"), joined=True)))
    shared = [*ends_displaced(ring), ends_alone(ring)[0]]
    assert [(end.equations[0].left, end.equations[0].right) for end in shared] == [
        (f.subs(U, 0), f.subs(U, 1)) for f in fields(("eta1", "dF1", "dv1"))
    ]
