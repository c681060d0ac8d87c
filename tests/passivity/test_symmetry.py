"""Symmetry classes of laws: how the group acts on strains, which class a law has, and what moduli that class allows."""

from __future__ import annotations

import itertools
import json
import math
import time
from typing import Any

import numpy as np
import pytest
import sympy as sp
from scipy.linalg import expm

from geocosserat.algebra.groups import SE2, SE3, Group
from geocosserat.model.law import load_law
from geocosserat.passivity.sections import (
    ANY,
    PLANE,
    SPACE,
    Element,
    about_axis,
    action,
    class_name,
    elements_of,
    moduli,
    spin,
)
from geocosserat.passivity.symmetry import SymmetryAnswer, symmetry

ROUND = "5*(h1 - 1)**2 + h2**2 + h3**2 + Pi1**2 + (Pi2**2 + Pi3**2)/2"


def spatial(stress: dict[str, str], rest: str = "") -> SymmetryAnswer:
    """The answer for the stresses of a spatial law."""
    lines = "\n".join(f'{name} = "{e}"' for name, e in stress.items())
    answer = symmetry(load_law(f'motion = "spatial"\n{rest}\n[stress]\n{lines}\n'))
    assert answer is not None
    return answer


def energy(density: str, motion: str = "spatial") -> SymmetryAnswer:
    """The answer for an energy density."""
    answer = symmetry(load_law(f'motion = "{motion}"\n[energy]\ndensity = "{density}"\n'))
    assert answer is not None
    return answer


def found(answer: SymmetryAnswer) -> set[str]:
    """Names of the elements that leave the law as it is."""
    return {e.name for e in answer.elements if e.invariant}


def matrix_of(element: Element, group: Group) -> Any:
    """The action as floats."""
    return np.array(action(group, element.frame, element.reverses), dtype=np.float64)


# the group


@pytest.mark.parametrize("group", [SE2, SE3])
def test_strains_go_as_the_curve_that_is_moved(group: Group) -> None:
    """Strain of Q phi(+-u) Q^-1 by differences, for a rod that bends and twists, is what the action says."""
    chance = np.random.default_rng(5)
    strain = chance.uniform(-0.5, 0.5, group.dimension)
    strain[0] += 1

    def phi(u: float) -> Any:
        return expm(u * group.hat(strain))

    for element in elements_of(group):
        q = np.eye(group.size)
        q[1:, 1:] = np.array(element.frame, dtype=np.float64)

        def moved(u: float, q: Any = q, sign: int = -1 if element.reverses else 1) -> Any:
            return q @ phi(sign * u) @ np.linalg.inv(q)

        u, step = 0.3, 1e-5
        rate = np.linalg.inv(moved(u)) @ (moved(u + step) - moved(u - step)) / (2 * step)
        assert group.vee(rate) == pytest.approx(matrix_of(element, group) @ strain, abs=1e-8)


@pytest.mark.parametrize("group", [SE2, SE3])
def test_every_element_keeps_the_straight_rod(group: Group) -> None:
    """A stretch of a straight rod is the same seen from any of them."""
    straight = np.eye(group.dimension)[0]
    for element in elements_of(group):
        assert np.array(matrix_of(element, group) @ straight) == pytest.approx(straight)


def test_rotations_of_a_strain_are_axial() -> None:
    """A mirror plane through e1 turns the twist round and keeps the stretch; bends go opposite to shears."""
    mirror = next(e for e in SPACE if e.name == "m12")
    assert np.diag(matrix_of(mirror, SE3)).tolist() == [1, 1, -1, -1, -1, 1]
    across = next(e for e in SPACE if e.name == "mh")
    assert np.diag(matrix_of(across, SE3)).tolist() == [1, -1, -1, -1, 1, 1]
    turned = next(e for e in SPACE if e.name == "D3")
    assert np.diag(matrix_of(turned, SE3)).tolist() == [1, 1, -1, 1, 1, -1]


def test_a_planar_reflection_changes_the_signs_of_shear_and_bend() -> None:
    """About the axis both; across it, backwards, the shear; by a half-turn, backwards, the bend."""
    signs = [np.diag(matrix_of(e, SE2)).tolist() for e in PLANE]
    assert signs == [[1, -1, -1], [1, -1, 1], [1, 1, -1]]


def test_the_generator_is_the_derivative_of_a_rotation() -> None:
    """At angle zero."""
    angle = sp.Symbol("angle")
    turned = action(SE3, about_axis(sp.cos(angle), sp.sin(angle)), False)
    rate = np.array([[sp.sympify(x).diff(angle).subs(angle, 0) for x in row] for row in turned], dtype=np.float64)
    assert np.array_equal(rate, spin(SE3))


@pytest.mark.parametrize("group", [SE2, SE3])
def test_moduli_are_counted_as_characters_count_them(group: Group) -> None:
    """Dimensions by elimination equal half the mean of (tr A)^2 +- tr A^2 over the group that elements generate."""
    elements = elements_of(group)
    for names in [(), *itertools.combinations([e.name for e in elements], 1), *itertools.combinations(
        [e.name for e in elements], 2
    )]:  # fmt: skip
        whole = closed([matrix_of(e, group) for e in elements if e.name in names], group.dimension)
        counts = [
            sum(np.trace(a) ** 2 + sign * np.trace(a @ a) for a in whole) / (2 * len(whole)) for sign in (1, -1)
        ]
        assert moduli(group, frozenset(names)) == tuple(round(c) for c in counts), names


def closed(generators: list[Any], d: int) -> list[Any]:
    """All products."""
    whole = [np.eye(d)]
    for a in whole:
        for g in generators:
            if not any(np.allclose(g @ a, b) for b in whole):
                whole.append(g @ a)
    return whole


def test_moduli_of_known_classes() -> None:
    """No symmetry: 21 + 15; round: 7 + 5, with mirrors 5 + 1, and alike backwards 4 + 0."""
    assert moduli(SE3, frozenset()) == (21, 15)
    assert moduli(SE3, frozenset({ANY, "C2", "C3", "C4", "C6"})) == (7, 5)
    assert moduli(SE3, frozenset({ANY, "m12", "m13"})) == (5, 1)
    assert moduli(SE3, frozenset({ANY, "m12", "mh"})) == (4, 0)
    assert moduli(SE2, frozenset()) == (6, 3)
    assert moduli(SE2, frozenset({"m"})) == (4, 1)
    assert moduli(SE2, frozenset({"m", "mh", "C2"})) == (3, 0)


def test_a_round_section_has_the_moduli_of_any_of_its_rotations_from_three_fold_on() -> None:
    """Hermann's theorem for tensors of rank two."""
    for name in ("C3", "C4", "C6"):
        assert moduli(SE3, frozenset({name})) == moduli(SE3, frozenset({ANY}))


def test_classes_have_their_names() -> None:
    """Schoenflies' names with e1 as the axis."""
    names = {
        (): "C1", ("m12",): "Cs", ("mh",): "C1h", ("i",): "S2", ("D2",): "D1", ("C2", "m12", "m13"): "C2v",
        ("C2", "mh", "i"): "C2h", ("C2", "D2", "D3"): "D2", ("C2", "C4", "S4", "mh", "i"): "C4h", ("C2", "S4"): "S4",
        ("C2", "S4", "m12", "m13"): "D2d", ("C3", "i"): "S6", ("C3", "i", "D2", "m13"): "D3d",
        ("C2", "C3", "C4", "C6", ANY): "C∞", ("C2", "C3", "C4", "C6", ANY, "m12", "m13"): "C∞v",
        (ANY, "m12", "mh"): "D∞h", (ANY, "D2"): "D∞", (ANY, "mh"): "C∞h",
    }  # fmt: skip
    for elements, name in names.items():
        assert class_name(SE3, elements)[0] == name
    assert len({class_name(SE2, c)[0] for c in ((), ("m",), ("mh",), ("C2",), ("m", "mh", "C2"))}) == 5


# laws


def test_a_law_without_stress_has_no_class() -> None:
    """There is nothing to leave as it is."""
    assert symmetry(load_law('motion = "planar"\n[friction]\nmatrix = [1, 1, 1]\n')) is None


def test_a_round_elastic_rod_has_all_symmetries() -> None:
    """D infinity h, proved, with four even moduli and no odd one."""
    answer = energy(ROUND)
    assert (answer.name, answer.grade, answer.even, answer.odd, answer.used_odd) == ("D∞h", "proved", 4, 0, ())
    assert found(answer) == {ANY, *(e.name for e in SPACE)}


def test_an_elliptic_section_has_two_mirror_planes() -> None:
    """Different bends about e2 and e3: D2h."""
    answer = energy(ROUND + " + Pi2**2")
    assert answer.name == "D2h"
    assert found(answer) == {"C2", "m12", "m13", "mh", "D2", "D3", "i"}


def test_coupling_of_stretch_and_twist_is_chiral_but_not_polar() -> None:
    """A rope: D infinity; it screws the same way seen from both its ends."""
    answer = energy(ROUND + " + (h1 - 1)*Pi1")
    assert answer.name == "D∞"
    assert "chiral" in answer.words
    assert (answer.even, answer.odd) == (6, 2)


def test_coupling_of_shear_and_bend_is_polar_but_not_chiral() -> None:
    """h2 Pi3 - h3 Pi2 tells the ends of the rod apart: C infinity v."""
    answer = energy(ROUND + " + 0.1*(h2*Pi3 - h3*Pi2)")
    assert answer.name == "C∞v"
    assert (answer.even, answer.odd) == (5, 1)


def test_odd_bending_needs_no_mirrors() -> None:
    """M2 ~ Pi3, M3 ~ -Pi2: round, but a mirror plane would turn the one bend and not the other."""
    base = {"F1": "h1 - 1", "F2": "h2", "F3": "h3", "M1": "Pi1", "M2": "Pi2 + 0.4*Pi3", "M3": "Pi3 - 0.4*Pi2"}
    answer = spatial(base)
    assert ANY in found(answer)
    assert not {"m12", "m13"} & found(answer)
    # an axial vector across the rod, turned by a quarter: the sense changes with a mirror through the axis and not with
    # one across it; backwards, bends by a half-turn about e2 go as (Pi2, -Pi3)
    assert answer.used_odd == (("Pi2", "Pi3", "2/5"),)
    matrix = np.array([[1, 0.4], [-0.4, 1]])
    for element in SPACE:
        a = matrix_of(element, SE3)[4:, 4:]
        assert np.allclose(a @ matrix, matrix @ a) == (element.name in found(answer)), element.name


def test_used_moduli_never_exceed_those_allowed() -> None:
    """An odd planar law with a mirror has one odd modulus, shear and bend."""
    answer = symmetry(load_law('motion = "planar"\n[stress]\nF1 = "h1 - 1"\nF2 = "h2 + 3*Pi"\nM = "Pi - 3*h2"\n'))
    assert answer is not None
    assert (answer.name, answer.even, answer.odd) == ("Cs", 4, 1)
    assert answer.used_odd == (("h2", "Pi", "3"),)


def test_threefold_sections_are_seen_by_their_cubic_terms() -> None:
    """Pi2^3 - 3 Pi2 Pi3^2 is left alone by thirds of a turn and by no half-turn about the axis."""
    answer = energy(ROUND + " + Pi2**3 - 3*Pi2*Pi3**2")
    assert answer.name == "D3h"
    assert {"C2", "C4", "C6", ANY}.isdisjoint(found(answer))


def test_a_twofold_section_is_not_fourfold() -> None:
    """A half-turn does not make a quarter of a turn."""
    answer = energy(ROUND + " + Pi2**2 + h2**4")
    assert "C2" in found(answer)
    assert "C4" not in found(answer)
    assert energy(ROUND + " + Pi2**4 + Pi3**4").name == "D4h"


def test_the_square_of_a_threefold_term_is_sixfold() -> None:
    """Pi2^3 - 3 Pi2 Pi3^2 changes sign with a half-turn about the axis, its square does not."""
    assert energy(ROUND + " + (Pi2**3 - 3*Pi2*Pi3**2)**2").name == "D6h"


def test_a_section_of_square_screws_has_quarter_turns_with_reflection() -> None:
    """Shear stiffness of e2 against bend of e3 and the reverse: Pi1 (h2^2 - h3^2) is odd under a quarter-turn."""
    answer = energy(ROUND + " + Pi1*(h2**2 - h3**2)")
    assert "C4" not in found(answer)
    assert answer.grade == "proved"
    check = {e.name for e in SPACE if invariant(e, lambda x: x[3] * (x[1] ** 2 - x[2] ** 2))}
    assert found(answer) == check


def invariant(element: Element, density: Any) -> bool:
    """Whether a density is the same at random strains and where the element takes them."""
    points = np.random.default_rng(2).normal(size=(6, 20))
    return bool(np.allclose(density(points), density(matrix_of(element, SE3) @ points)))


def test_a_defect_of_a_part_in_ten_to_the_thirty_breaks_a_symmetry() -> None:
    """Exact decisions, not floats."""
    answer = energy(ROUND + " + 1e-30*h2*Pi2")
    assert "m12" not in found(answer)
    assert answer.grade == "proved"


def test_open_parameters_stand_for_all_their_values() -> None:
    """A modulus left open breaks what it would break at any value but zero."""
    stress = {"F1": "h1 - 1", "F2": "h2 + a*Pi3", "F3": "h3 - a*Pi2", "M1": "Pi1", "M2": "Pi2", "M3": "Pi3"}
    answer = spatial(stress, "[parameters]\na = {symbol = true}\n")
    assert answer.name == "C∞v"
    assert answer.used_odd == (("h2", "Pi3", "a/2"), ("h3", "Pi2", "-a/2"))
    assert any("a" in text for text in answer.assumptions)


def test_rates_go_as_the_strains_do() -> None:
    """A viscous bend that depends on the sign of the shear rate is not mirror symmetric."""
    law = 'motion = "planar"\n[stress]\nF1 = "h1 - 1"\nF2 = "h2"\nM = "Pi + {}"\n'
    even, odd = symmetry(load_law(law.format("Pi_dot"))), symmetry(load_law(law.format("h1_dot")))
    assert even is not None
    assert odd is not None
    assert even.name == "C2v"
    assert odd.name == "C1h"


def test_kinks_do_not_hide_from_the_generator() -> None:
    """abs(Pi2) + abs(Pi3) has four-fold symmetry, the root of the sum of squares all; steps too."""
    assert energy(ROUND + " + abs(Pi2)**3 + abs(Pi3)**3").name == "D4h"
    assert energy(ROUND + " + sqrt(1 + Pi2**2 + Pi3**2)").name == "D∞h"
    assert ANY not in found(energy(ROUND + " + heaviside(Pi2)*Pi2**2"))
    assert energy(ROUND + " + abs(Pi2**2 + Pi3**2 - 1)**3").name == "D∞h"


def test_steps_are_no_constants_to_the_generator() -> None:
    """A couple that steps with a bend has no derivative to tell, and still no rotation leaves it."""
    stress = {"F1": "h1 - 1", "F2": "h2", "F3": "h3", "M1": "Pi1 + 0.3*heaviside(Pi2)", "M2": "Pi2", "M3": "Pi3"}
    answer = spatial(stress)
    assert ANY not in found(answer)
    assert "C2" not in found(answer)


def test_a_reference_that_is_curved_is_seen_in_the_law() -> None:
    """Bent at rest in the plane: what remains is the mirror across the rod."""
    assert energy("(h1 - 1)**2 + h2**2 + (Pi - 0.5)**2", "planar").name == "C1h"
    assert energy("(h1 - 1)**2 + h2**2 + Pi**2", "planar").name == "C2v"


def test_what_is_refuted_is_shown_at_a_strain() -> None:
    """The strain is in the text, and the law differs there."""
    answer = energy("(h1 - 1)**2 + h2**2 + Pi**2/2 + h2*Pi**2/7", "planar")
    mirror = next(e for e in answer.elements if e.name == "m")
    assert mirror.invariant is False
    assert " at Pi = " in mirror.how or " at h2 = " in mirror.how


def test_all_laws_of_the_format_are_objective() -> None:
    """A sentence, and the pose is no name that a stress may use."""
    assert "objective" in energy(ROUND).objective
    with pytest.raises(ValueError, match="theta"):
        load_law('motion = "planar"\n[stress]\nM = "Pi + theta"\n')


def test_a_full_spatial_law_takes_less_than_a_second() -> None:
    """Six coupled nonlinear components."""
    answer_in = {
        "F1": "10*(h1 - 1) + (h2**2 + h3**2)/2", "F2": "4*tanh(h2) + (h1 - 1)*h2 + 0.3*Pi3",
        "F3": "4*tanh(h3) + (h1 - 1)*h3 - 0.3*Pi2", "M1": "2*Pi1 + 0.1*Pi1**3 + 0.2*sin(Pi2)",
        "M2": "Pi2/sqrt(1 + Pi2**2/10) + 0.5*Pi3 + 0.1*Pi1*Pi3", "M3": "Pi3*(1 + Pi3**2/10) - 0.5*Pi2 + 0.3*h3",
    }  # fmt: skip
    start = time.process_time()
    answer = spatial(answer_in)
    assert time.process_time() - start < 1
    assert answer.name == "C1"
    assert (answer.even, answer.odd) == (21, 15)


def test_fields_are_json() -> None:
    """All plain."""
    fields = energy(ROUND).fields()
    assert json.loads(json.dumps(fields, allow_nan=False))["name"] == "D∞h"
    assert math.isfinite(fields["even"])
