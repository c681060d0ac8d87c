"""The pointwise expressions: compatibility, balance and carried frames, exactly, at random rational places."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
import sympy as sp
from numpy.typing import NDArray

from geocosserat.derivation.convert import to_sympy
from geocosserat.discretisation.pointwise import Pointwise, pointwise
from geocosserat.discretisation.structuring import structure_of
from tests.discretisation.rods import FROZEN, MOTIONS, NAMES, VISCOUS, scene

Symbols = NDArray[np.object_]


@cache
def expressions(name: str) -> Pointwise:
    return pointwise(structure_of(scene(name).model))


def symbols(stem: str, d: int) -> Symbols:
    return np.array([sp.Symbol(f"{stem}_{i + 1}") for i in range(d)], dtype=object)


def matrix(named: dict[str, sp.Expr] | object, stem: str, rows: int, columns: int) -> Symbols:
    """The matrix of the entries called stem_i_j; those left out are zero."""
    assert isinstance(named, dict)
    entries = [[named.get(f"{stem}_{i + 1}_{j + 1}", sp.Integer(0)) for j in range(columns)] for i in range(rows)]
    return np.array(entries, dtype=object)


def turn(p: Pointwise) -> Symbols:
    return np.array(list(p.turn.values()), dtype=object)


def zero(*expressions: Symbols) -> bool:
    """Whether all entries vanish identically."""
    return all(sp.simplify(sp.expand(e)) == 0 for array in expressions for e in np.ravel(array))


@pytest.mark.parametrize("motion", MOTIONS)
def test_the_strain_rate_is_the_slope_plus_the_bracket_of_turn_and_twist(motion: str) -> None:
    """Compatibility, as matrices: hat(rate) = hat(slope) + [hat(E), hat(W)]."""
    p = expressions(f"{motion} plain")
    group, d = p.group, p.group.dimension
    E, W, U = turn(p), symbols("value", d), symbols("slope", d)
    hatted = group.hat(E) @ group.hat(W) - group.hat(W) @ group.hat(E)
    rate = np.array([p.strain_rate[f"rate_{i + 1}"] for i in range(d)], dtype=object)
    assert zero(group.hat(rate) - group.hat(U) - hatted)


@pytest.mark.parametrize("motion", MOTIONS)
def test_the_pull_does_on_a_twist_the_work_that_the_stress_does_on_its_bracket(motion: str) -> None:
    """<pull, W> = <S, [E, W]>: the reason that the scheme can add no work."""
    p = expressions(f"{motion} plain")
    d = p.group.dimension
    E, W, S = turn(p), symbols("value", d), np.array([sp.Symbol(n) for n in p.group.stress])
    pull = np.array([p.pull[f"pull_{i + 1}"] for i in range(d)], dtype=object)
    assert zero(pull @ W - S @ p.group.bracket(E, W))


@pytest.mark.parametrize("name", NAMES)
def test_bracket_and_advection_are_the_two_derivatives_of_the_strain_rate(name: str) -> None:
    """With respect to the value of the twist, and to the turn; on the stress of viscous modes it does not depend."""
    p = expressions(name)
    d = p.group.dimension
    rates = [p.strain_rate[f"rate_{i + 1}"] for i in range(d)]
    by_value = [[e.diff(x) for x in symbols("value", d)] for e in rates]
    by_state = [[e.diff(x) for x in p.state[:d]] for e in rates]
    assert zero(matrix(p.bracket, "ad", d, d) - np.array(by_value))
    assert zero(matrix(p.advection, "advection", d, d) - np.array(by_state))
    assert not any(e.has(x) for e in rates for x in p.state[d:])


@pytest.mark.parametrize("name", NAMES)
def test_the_stress_is_the_derivative_of_the_energy(name: str) -> None:
    """Hyperelastic, whatever the stiffness and the reference; of frozen modes it is no matter of energy but given.
    Where no energy is known, all that the stress does is lost."""
    p = expressions(name)
    structure = structure_of(scene(name).model)
    frozen = structure.frozen
    if any(structure.viscous):
        return  # see below
    if p.loss:
        lost = [p.stress[s] * sp.Symbol(f"rate_{i}") for i, s in enumerate(p.group.stress, start=1) if s in p.stress]
        assert p.energy["energy"] == 0
        assert zero(np.array([p.loss["loss"] - sum(lost)]))
        return
    energy = p.energy["energy"].subs({sp.Symbol(s): e for s, e in p.stress.items()})
    for symbol, stress, held in zip(p.state, p.group.stress, frozen, strict=True):
        assert held == (stress not in p.stress) == (symbol.name == stress)
        if not held:
            assert zero(np.array([energy.diff(symbol) - p.stress[stress]]))
        else:
            assert energy.diff(symbol) == 0


@pytest.mark.parametrize("name", VISCOUS)
def test_the_stress_of_a_viscous_mode_is_a_state_that_must_be_what_its_law_says(name: str) -> None:
    """At the rates of strain; and whatever part of it does not store energy is lost, as is that of the other modes."""
    p, model = expressions(name), scene(name).model
    structure, law, d = structure_of(model), model.law, p.group.dimension
    assert law is not None
    assert law.stress is not None
    rates = [sp.Symbol(f"rate_{i}") for i in range(1, d + 1)]
    known = dict(zip((sp.Symbol(x, real=True) for x in p.group.strain), turn(p), strict=True))
    known |= {
        sp.Symbol(f"{x}_dot", real=True): sp.Integer(0) if held else rate
        for x, rate, held in zip(p.group.strain, rates, structure.frozen, strict=True)
    }
    known |= {sp.Symbol(x, real=True): sp.Symbol(f"p_{x}") for x in law.parameters}
    known |= {sp.Symbol("u", real=True): sp.Symbol("along"), sp.Symbol("t", real=True): sp.Symbol("t")}
    said = [to_sympy(e).xreplace(known) for e in law.stress]
    by_law = [sp.Symbol(s) if here else e for s, e, here in zip(p.group.stress, said, structure.viscous, strict=True)]
    gaps = [e - sp.Symbol(s) for s, e, here in zip(p.group.stress, said, structure.viscous, strict=True) if here]
    assert zero(np.array(list(p.gap.values())) - np.array(gaps))
    assert all(here == (s in map(str, p.state[d:])) for s, here in zip(p.group.stress, structure.viscous, strict=True))
    assert not {str(x) for x in p.state[d:]} & set(p.stress)
    energy = p.energy["energy"]
    stored = [energy.diff(x) for x in p.state[:d]]
    lost = sum((a - b) * r for a, b, r, held in zip(by_law, stored, rates, structure.frozen, strict=True) if not held)
    assert zero(np.array([p.loss["loss"] - lost]))
    assert (energy != 0) == (law.energy is not None)


@pytest.mark.parametrize("name", FROZEN)
def test_a_frozen_mode_is_its_reference_and_answers_to_no_strain(name: str) -> None:
    """Its turn is the coefficient of the reference, its stress a state of its own; what must vanish is its strain rate
    less that of the reference and, where both ends are held, a slack of its stress."""
    p, structure = expressions(name), structure_of(scene(name).model)
    d, E, W = p.group.dimension, turn(p), symbols("value", p.group.dimension)
    rates = symbols("slope", d) + p.group.ad(E) @ W
    for i in np.flatnonzero(structure.frozen):
        rest, moving = structure.reference[i], structure.reference_rate[i]
        assert E[i] == (sp.Integer(int(rest)) if rest in "01" else sp.Symbol(rest))
        stress = p.group.stress[i]
        slack = sp.Symbol(f"slack_{stress}") * sp.Symbol(stress) if structure.indeterminate else sp.Integer(0)
        wanted = rates[i] - (sp.Integer(0) if moving == "0" else sp.Symbol(moving)) - slack
        assert zero(np.array([p.strain_rate[f"rate_{i + 1}"] - wanted]))


@pytest.mark.parametrize("name", NAMES)
def test_the_velocity_relative_to_the_medium_is_symmetric_in_its_drive(name: str) -> None:
    """Onsager: the mobility is a symmetric matrix; and all of the velocity that is not the medium's."""
    p, structure = expressions(name), structure_of(scene(name).model)
    d, drive = p.group.dimension, symbols("drive", p.group.dimension)
    slips = [p.velocity[f"slip_{i + 1}" if structure.dragged else v] for i, v in enumerate(p.group.twist)]
    mobility = np.array([[e.diff(x) for x in drive] for e in slips])
    assert zero(mobility - mobility.T)
    assert zero(np.array(slips) - mobility @ drive)
    assert len(p.velocity) == (2 * d if structure.dragged else d)
    for i, v in enumerate(p.group.twist) if structure.dragged else ():
        moving = f"medium_{i + 1}" in p.surroundings
        medium = sp.Symbol(f"medium_{i + 1}") if moving else sp.Integer(0)
        assert p.velocity[v] == sp.Symbol(f"slip_{i + 1}") + medium


@pytest.mark.parametrize("motion", MOTIONS)
def test_a_carried_frame_follows_its_twist(motion: str) -> None:
    """phi_dot = phi V for the matrix of the carried pose, and shift is the small motion that a change of it makes,
    rotation first."""
    p = expressions(f"{motion} plain")
    group = p.group
    rng = np.random.default_rng(4)
    twist = [sp.Rational(int(n), 7) for n in rng.integers(-20, 20, group.dimension)]
    V = np.array(twist, dtype=object)
    pose = np.array(p.pose, dtype=object)
    if motion == "planar":
        c, s = sp.cos(pose[2]), sp.sin(pose[2])
        R = np.array([[c, -s], [s, c]], dtype=object)
    else:
        a, b, c, d = pose[3:]
        R = np.array(sp.Quaternion(a, b, c, d).to_rotation_matrix().tolist(), dtype=object)
    phi = np.zeros((group.size, group.size), dtype=object)
    phi[0, 0], phi[1:, 0], phi[1:, 1:] = sp.Integer(1), pose[: group.space], R
    values = dict(zip(p.pose, (sp.Rational(int(n), 5) for n in rng.integers(1, 20, len(pose))), strict=True))
    moving = dict(zip((sp.Symbol(n) for n in group.twist), twist, strict=True))
    rates = np.array([e.subs(moving) for e in p.carry.values()], dtype=object)

    def number(array: Symbols) -> Symbols:
        return np.array([sp.sympify(e).subs(values) for e in array.ravel()], dtype=object).reshape(array.shape)

    def along(direction: Symbols) -> Symbols:
        """The derivative of phi in a direction of the pose."""
        out = np.zeros_like(phi)
        for index, e in np.ndenumerate(phi):
            out[index] = sum(sp.diff(e, x) * dx for x, dx in zip(p.pose, direction, strict=True))
        return out

    assert zero(number(along(rates)) - number(phi) @ group.hat(V))
    shift = matrix(p.shift, "shift", group.dimension, len(pose))
    for j, unit in enumerate(np.eye(len(pose), dtype=int)):
        turning = group.vee(group.inverse(number(phi)) @ number(along(unit.astype(object))))
        assert zero(np.roll(turning, group.rotations) - number(shift[:, j]))
