"""Well-posedness, definiteness and convexity of laws, against closed forms."""

from __future__ import annotations

import json
import math
import time
from fractions import Fraction

import numpy as np
import pytest
from flint import arb, arb_mat, fmpq

from geocosserat.model.expressions import Number, parse
from geocosserat.model.law import load_law
from geocosserat.passivity import definite as proofs
from geocosserat.passivity.definite import (
    characteristic,
    definite_at,
    definite_over,
    has_positive_rates,
    hurwitz,
    is_definite,
    is_not_definite,
    rates_at,
    rates_over,
)
from geocosserat.passivity.losses import Loss
from geocosserat.passivity.stability import StabilityAnswer, stability
from geocosserat.passivity.tangent import Range, blocks, symmetric, tangent_of

FULL = """
motion = "spatial"
[stress]
F1 = "10*(h1 - 1) + (h2**2 + h3**2)/2"
F2 = "4*tanh(h2) + (h1 - 1)*h2 + 0.3*Pi3"
F3 = "4*tanh(h3) + (h1 - 1)*h3 - 0.3*Pi2"
M1 = "2*Pi1 + 0.1*Pi1**3 + 0.2*sin(Pi2)"
M2 = "Pi2/sqrt(1 + Pi2**2/10) + 0.5*Pi3 + 0.1*Pi1*Pi3"
M3 = "Pi3*(1 + Pi3**2/10) - 0.5*Pi2 + 0.3*h3"
[friction]
matrix = [1, 2, 2, 0.1, 0.1, 0.1]
"""


def planar(stress: str, rest: str = "") -> StabilityAnswer:
    """The answer for a planar law given by the tables of its stress or energy."""
    answer = stability(load_law(f'motion = "planar"\n{rest}\n{stress}\n'))
    assert answer is not None
    return answer


def energy(density: str, rest: str = "") -> StabilityAnswer:
    """The answer for an energy density in the plane."""
    return planar(f'[energy]\ndensity = "{density}"', rest)


def first(answer: StabilityAnswer, what: str, direction: str) -> Loss:
    """The one loss in that direction."""
    (loss,) = (loss for loss in answer.lost if loss.what == what and loss.direction == direction)
    return loss


def test_a_law_without_stress_has_no_stability() -> None:
    """There is no tangent to speak of."""
    assert stability(load_law('motion = "planar"\n[friction]\nmatrix = [1, 1, 1]\n')) is None


def test_a_quadratic_energy_is_convex_by_exact_minors() -> None:
    """Positive moduli: all three hold, proved, with the margin of a unit diagonal."""
    answer = energy("5*(h1 - 1)**2 + 3*h2**2 + Pi**2/2")
    assert (answer.parabolic, answer.definite, answer.convex) == (True, True, True)
    assert dict(answer.grades) == {"parabolic": "proved", "definite": "proved", "convex": "proved"}
    assert answer.margins["definite"].least == pytest.approx(1.0)
    assert answer.lost == ()
    assert answer.map is None
    assert not answer.complex_eigenvalues


def test_the_scaled_margin_is_one_less_the_correlation() -> None:
    """[[4, c], [c, 9]] scaled has eigenvalues 1 +- c/6."""
    answer = energy("5*(h1 - 1)**2 + 2*h2**2 + 9*Pi**2/2 + 3*h2*Pi")
    assert answer.margins["definite"].least == pytest.approx(1 - 3 / 6)
    least = (13 - math.sqrt(25 + 4 * 9)) / 2
    assert answer.margins["unscaled"].least == pytest.approx(least)


def test_odd_moduli_make_eigenvalues_complex_and_stay_parabolic() -> None:
    """[[1, a], [-a, 1]] has eigenvalues 1 +- ia; its symmetric part does not know of a."""
    answer = planar('[stress]\nF1 = "h1 - 1"\nF2 = "h2 + 5*Pi"\nM = "Pi - 5*h2"')
    assert answer.parabolic is True
    assert answer.definite is True
    assert answer.convex is None
    assert answer.complex_eigenvalues
    assert answer.margins["parabolic"].least == pytest.approx(1.0)


def test_what_is_not_definite_may_be_parabolic() -> None:
    """[[1, 4], [0, 1]]: both eigenvalues are 1, the symmetric part is indefinite; both are proved."""
    answer = planar('[stress]\nF1 = "h1 - 1"\nF2 = "h2 + 4*Pi"\nM = "Pi"')
    assert (answer.parabolic, answer.definite) == (True, False)
    assert dict(answer.grades) == {"parabolic": "proved", "definite": "proved"}


def test_the_friction_decides_what_an_indefinite_tangent_does() -> None:
    """T = [[1, 2], [-2, -0.5]] / friction (g, 1): the trace 1/g - 1/2 changes sign at g = 2, the determinant never."""
    stress = '[stress]\nF1 = "h1 - 1"\nF2 = "h2 + 2*Pi"\nM = "-0.5*Pi - 2*h2"\n'
    assert planar(stress + "[friction]\nmatrix = [1, 1.99, 1]").parabolic is True
    worse = planar(stress + "[friction]\nmatrix = [1, 2.01, 1]")
    assert worse.parabolic is False
    assert worse.grades["parabolic"] == "proved"
    # on the verge: exactly zero real parts are not positive
    assert planar(stress + "[friction]\nmatrix = [1, 2, 1]").parabolic is False


def test_missing_friction_is_said_to_be_the_identity() -> None:
    """An assumption, and none where the law has a friction."""
    assert any("friction" in a for a in energy("h1**2 - 2*h1 + h2**2 + Pi**2").assumptions)
    with_friction = energy("h1**2 - 2*h1 + h2**2 + Pi**2", "[friction]\nmatrix = [1, 1, 1]")
    assert not any("friction" in a for a in with_friction.assumptions)


def test_a_strain_without_stiffness_is_degenerate_not_unstable() -> None:
    """F2 = 0: a zero eigenvalue is not positive, but the energy is convex."""
    answer = energy("(h1 - 1)**2 + Pi**2")
    assert (answer.parabolic, answer.definite, answer.convex) == (False, False, True)
    assert answer.grades["convex"] == "proved"
    assert answer.margins["definite"].least == 0.0
    assert [loss.direction for loss in answer.lost] == ["reference", "reference"]


def test_a_softening_spring_is_lost_where_its_second_derivative_vanishes() -> None:
    """W = k(1 - cos(a Pi))/a^2 is lost at Pi = pi/(2a), both ways, and located to 1e-10."""
    domain = "[domain]\nPi = [-2, 2]\n"
    answer = energy("(h1 - 1)**2 + h2**2 + (1 - cos(1.3*Pi))/1.69", domain)
    for direction, sign in (("Pi +", 1), ("Pi -", -1)):
        for what in ("definite", "parabolic"):
            loss = first(answer, what, direction)
            assert loss.where["Pi"] == pytest.approx(sign * math.pi / 2.6, abs=1e-10)
            assert loss.value == pytest.approx(math.pi / 5.2, abs=1e-10)
    assert answer.convex is False
    assert answer.grades["convex"] == "proved"
    assert answer.map is not None
    assert "Pi" in answer.map.names


def test_the_nearest_loss_may_lie_off_the_axes() -> None:
    """h2^2 + Pi^2 - 0.9 (h2 Pi)^2 stays convex along both axes of the domain, not along its diagonals."""
    answer = energy("(h1 - 1)**2 + h2**2/2 + Pi**2/2 - 0.45*h2**2*Pi**2", "[domain]\nh2 = [-1, 1]\nPi = [-1, 1]")
    definite = [loss for loss in answer.lost if loss.what == "definite"]
    assert definite[0].direction == "oblique"
    x, y = definite[0].where["h2"], definite[0].where["Pi"]
    # on the surface (1 - 0.9 y^2)(1 - 0.9 x^2) = (1.8 x y)^2
    assert (1 - 0.9 * y**2) * (1 - 0.9 * x**2) == pytest.approx((1.8 * x * y) ** 2, abs=1e-9)
    assert definite[0].where["h1"] == 1.0
    assert answer.map is not None
    assert answer.map.names == ("h2", "Pi")


def test_of_oblique_and_straight_ways_the_nearest_comes_first() -> None:
    """5 - 4 Pi^2 - ... : shear alone is lost at 1/sqrt(8), shear and bend together before."""
    answer = energy("5*(h1 - 1)**2 + 5*h2**2 + Pi**4/4 + Pi**2/2 - 4*h2**2*Pi**2")
    definite = [loss for loss in answer.lost if loss.what == "definite"]
    assert definite[0].direction == "oblique"
    assert first(answer, "definite", "h2 +").where["h2"] == pytest.approx(8**-0.5, abs=1e-10)
    assert [loss.value for loss in definite] == sorted(loss.value for loss in definite)


def test_a_way_ends_where_the_tangent_has_no_value() -> None:
    """-sqrt(1.2 - h1) stiffens without bound towards h1 = 1.2 and is not lost there."""
    answer = energy("-sqrt(1.2 - h1) + h2**2 + Pi**2")
    assert answer.lost == ()
    assert answer.definite is True
    assert answer.grades["definite"] == "sampled"
    assert any("no value" in a for a in answer.assumptions)


def test_a_law_without_any_value_is_not_decided() -> None:
    """Nothing is claimed, and that is said."""
    answer = energy("sqrt(-1 - h2**2) + h1**2")
    assert (answer.definite, answer.parabolic, answer.convex) == (None, None, None)
    assert "none of the points" in answer.not_checked[0]


def test_the_map_shows_where_it_is_lost_rather_than_what_varies_most() -> None:
    """The stretch stiffens a hundredfold, shear and bend go soft together."""
    answer = energy("5*(h1 - 1)**2 + 900*(h1 - 1)**4 + 5*h2**2 + Pi**4/4 + Pi**2/2 - 4*h2**2*Pi**2")
    assert answer.map is not None
    assert answer.map.names == ("h2", "Pi")


def test_an_indefinite_nonlinear_law_is_proved_parabolic() -> None:
    """[[1, 4], [0, 1 + 3 Pi^2]]: by discs around approximate eigenvalues, over the whole domain."""
    answer = planar('[stress]\nF1 = "h1 - 1"\nF2 = "h2 + 4*Pi"\nM = "3*Pi + Pi**3"')
    assert (answer.definite, answer.parabolic) == (False, True)
    assert dict(answer.grades) == {"parabolic": "proved", "definite": "proved"}


def test_conditions_too_long_to_read_are_named_in_bounded_time() -> None:
    """All 36 moduli open: three minors in full, the others by name."""
    names = [f"k{i}" for i in range(36)]
    strain = ("h1", "h2", "h3", "Pi1", "Pi2", "Pi3")
    rows = [" + ".join(f"{names[6 * i + j]}*{e}" for j, e in enumerate(strain)) for i in range(6)]
    lines = [f'{c} = "{row}"' for c, row in zip(("F1", "F2", "F3", "M1", "M2", "M3"), rows, strict=True)]
    opened = "\n".join(f"{name} = {{symbol = true}}" for name in names)
    start = time.process_time()
    answer = stability(load_law("\n".join(['motion = "spatial"', "[parameters]", opened, "[stress]", *lines])))
    assert time.process_time() - start < 3
    assert answer is not None
    found = answer.conditions["definite"].inequalities
    assert found is not None
    assert any("minors 4 to 6" in text for text in found)
    assert "k0 > 0" in found
    assert answer.definite is None


def test_a_thin_pocket_between_samples_is_found_or_not_claimed_proved() -> None:
    """A dip of T of width 1e-4 is not seen by any sample; what is then said of it is not proved."""
    density = "(h1 - 1)**2 + h2**2 + Pi**2/2 - 1e-8*1.6*exp(-(1e4*(Pi - 0.3217))**2)"
    answer = energy(density)
    assert answer.definite is False or answer.grades["definite"] == "sampled"


def test_a_nonlinear_law_is_proved_over_its_domain() -> None:
    """log cosh is convex; between enclosures and 0 there is 1/cosh(1)^2 at least."""
    answer = energy("(h1 - 1)**2 + log(cosh(h2)) + log(cosh(Pi))")
    assert answer.convex is True
    assert set(answer.grades.values()) == {"proved"}
    assert answer.margins["unscaled"].least == pytest.approx(1 / math.cosh(1) ** 2, rel=1e-6)


def test_domains_that_the_law_declares_are_kept_to() -> None:
    """Inside the declared bend the softening spring is proved convex; nothing is assumed of that strain."""
    answer = energy("(h1 - 1)**2 + h2**2 + 1 - cos(Pi)", "[domain]\nPi = [-1.5, 1.5]")
    assert answer.convex is True
    assert answer.grades["convex"] == "proved"
    assert not any("Pi" in a for a in answer.assumptions)
    assert any("Pi" in a for a in energy("(h1 - 1)**2 + h2**2 + 1 - cos(Pi)").assumptions)


def test_a_kink_is_proved_from_both_its_sides() -> None:
    """Pi + abs(Pi)/2 has slopes 1/2 and 3/2: definite in either, and by enclosures in between."""
    answer = planar('[stress]\nF1 = "h1 - 1"\nF2 = "h2"\nM = "Pi + abs(Pi)/2"')
    assert answer.definite is True
    assert answer.grades["definite"] == "proved"
    assert planar('[stress]\nF1 = "h1 - 1"\nF2 = "h2"\nM = "Pi + 2*abs(Pi)"').definite is False


def test_a_step_of_the_stress_is_never_proved() -> None:
    """M = Pi - heaviside(Pi): all slopes are 1, and still it is not monotonic."""
    answer = planar('[stress]\nF1 = "h1 - 1"\nF2 = "h2"\nM = "Pi - heaviside(Pi)"')
    assert answer.grades["definite"] == "sampled"
    assert any("steps" in a for a in answer.assumptions)


def test_a_singular_law_is_not_proved() -> None:
    """A tangent without value somewhere is at best sampled elsewhere."""
    answer = energy("(h1 - 1)**2 + h2**2 + Pi**2 + 0.01/(1.3 - h1)**2", "[domain]\nh1 = [0.5, 1.5]")
    assert answer.grades["definite"] == "sampled"


def test_places_count_as_part_of_the_domain() -> None:
    """A stiffness 1 - 2 u is lost at u = 1/2, which is said to be looked at between 0 and 1."""
    answer = planar('[stress]\nF1 = "h1 - 1"\nF2 = "h2"\nM = "(1 - 2*u)*Pi"')
    assert answer.definite is False
    assert first(answer, "definite", "u +").where["u"] == pytest.approx(0.5, abs=1e-10)
    assert any(" u " in a for a in answer.assumptions)
    friction = planar('[stress]\nF1 = "h1 - 1"\nF2 = "h2"\nM = "Pi"', '[friction]\nmatrix = [1, 1, "1 - 2*u"]')
    assert friction.definite is True
    assert friction.parabolic is False


def test_viscous_laws_are_taken_at_rest() -> None:
    """The rate is left out and that is said."""
    answer = planar('[stress]\nF1 = "h1 - 1"\nF2 = "h2"\nM = "Pi + 7*Pi_dot"')
    assert answer.definite is True
    assert any("viscous" in a for a in answer.assumptions)


def test_open_parameters_give_conditions() -> None:
    """A 2 x 2 block: definite iff k > 0 and 4 k m > (a + b)^2; parabolic iff the trace and determinant are positive."""
    rest = "[parameters]\nk = {symbol = true}\nm = {symbol = true, positive = true}\na = {symbol = true}\n"
    answer = planar('[stress]\nF1 = "h1 - 1"\nF2 = "k*h2 + a*Pi"\nM = "m*Pi - a*h2"', rest)
    assert answer.definite is None
    assert answer.conditions["definite"].inequalities == ("k > 0",)
    assert answer.conditions["parabolic"].inequalities == ("k + m > 0", "a**2 + k*m > 0")
    assert answer.conditions["definite"].where == "everywhere"
    assert answer.grades == {}


def test_conditions_that_hold_for_all_values_are_proofs() -> None:
    """Positive moduli beside an odd one of any value."""
    rest = "[parameters]\nk = {symbol = true, positive = true}\na = {symbol = true}\n"
    answer = planar('[stress]\nF1 = "k*(h1 - 1)"\nF2 = "k*h2 + a*Pi"\nM = "k*Pi - a*h2"', rest)
    assert answer.definite is True
    assert answer.parabolic is True
    assert answer.grades == {"definite": "proved", "parabolic": "proved"}
    negative = planar('[stress]\nF1 = "-k*(h1 - 1)"\nF2 = "h2"\nM = "Pi"', rest)
    assert negative.definite is False
    assert negative.grades["definite"] == "proved"


def test_open_parameters_of_nonlinear_laws_are_not_decided() -> None:
    """The condition at the reference is necessary, no more, and what is not checked is said."""
    rest = "[parameters]\nk = {symbol = true}\n"
    answer = planar('[stress]\nF1 = "h1 - 1"\nF2 = "h2"\nM = "k*sin(Pi) + Pi**3"', rest)
    assert (answer.definite, answer.parabolic, answer.convex) == (None, None, None)
    assert answer.conditions["definite"].inequalities == ("k > 0",)
    assert answer.conditions["definite"].where == "at the reference"
    assert answer.not_checked


def test_singular_friction_leaves_parabolicity_open() -> None:
    """No rate without friction; definiteness does not need one."""
    answer = energy("(h1 - 1)**2 + h2**2 + Pi**2", "[friction]\nmatrix = [1, 0, 1]")
    assert answer.parabolic is None
    assert answer.definite is True
    assert answer.not_checked


def test_a_full_spatial_law_takes_less_than_three_seconds() -> None:
    """Six coupled nonlinear components, proved by enclosures."""
    law = load_law(FULL)
    start = time.process_time()
    answer = stability(law)
    assert time.process_time() - start < 3
    assert answer is not None
    assert (answer.parabolic, answer.definite) == (True, True)
    assert set(answer.grades.values()) == {"proved"}


def test_fields_are_json_without_loss_of_meaning() -> None:
    """All plain, also where values are missing."""
    for answer in (energy("(h1-1)**2 + h2**2 + 1 - cos(2*Pi)"), energy("h1**2-2*h1 + h2**2 + log(Pi + 0.5)*Pi")):
        text = json.dumps(answer.fields(), allow_nan=False)
        assert json.loads(text)["definite"] is answer.definite
        assert len(json.loads(text)["map"]["definite"]) == 41


def test_the_tangent_is_the_derivative_of_the_stress() -> None:
    """Against central differences, over the sample."""
    tangent = tangent_of(load_law(FULL))
    assert tangent is not None
    points = tangent.sample(16)
    t = tangent.values(tangent.matrix, points)
    rows = tuple(tuple(e for _ in range(6)) for e in tangent.stress)
    for j in range(6):
        step = np.eye(6)[j] * 1e-5
        difference = tangent.values(rows, points + step) - tangent.values(rows, points - step)
        assert t[:, :, j] == pytest.approx(difference[:, :, 0] / 2e-5, abs=1e-8)


# proofs


def test_definiteness_of_balls_agrees_with_the_radius_that_eigenvalues_allow() -> None:
    """diag(1, 1) + balls of radius r: definite for certain only if r + r < 1 by Gershgorin, never if not all are."""
    for radius in (0.1, 0.4, 0.6, 2.0):
        around = arb(0, radius)
        ball = arb_mat([[1 + around, around], [around, 1 + around]])
        assert is_definite(ball) == (radius < 0.5)
        assert not is_not_definite(ball)


def test_definiteness_survives_bad_scales() -> None:
    """Moduli 24 orders apart, correlated by 0.999: definite; by 1.001: proved not to be."""
    for share, found in ((0.999, True), (1.001, False)):
        c = arb(share) * arb(10) ** -6
        ball = arb_mat([[arb(10) ** 6, c], [c, arb(10) ** -18]])
        assert is_definite(ball) is found
        assert is_not_definite(ball) is not found


def test_hurwitz_holds_what_eigenvalues_say() -> None:
    """For random matrices: all determinants positive if and only if all real parts are."""
    chance = np.random.default_rng(3)
    seen = set()
    for _ in range(200):
        n = int(chance.integers(1, 7))
        m = chance.integers(-3, 4, (n, n)) + np.eye(n, dtype=int) * 3
        least = np.linalg.eigvals(m).real.min()
        if abs(least) < 1e-9:
            continue
        minors = hurwitz(characteristic([[fmpq(int(x)) for x in row] for row in m]))
        assert all(x > 0 for x in minors) == (least > 0)
        if has_positive_rates(arb_mat(m.tolist())):
            assert least > 0
        seen.add(least > 0)
    assert seen == {True, False}


def test_a_zero_eigenvalue_is_exactly_not_positive() -> None:
    """Singular in exact numbers, which floats cannot tell from definite: 0.1 * 0.9 = 0.3^2."""
    numbers = [["0.1", "0.3"], ["0.3", "0.9"]]
    matrix = tuple(tuple(parse(x, ()) for x in row) for row in numbers)
    one = tuple(tuple(Number(float(i == j)) for j in range(2)) for i in range(2))
    assert definite_at(matrix, {}) is False
    assert rates_at(matrix, one, {}) is False
    shifted = tuple(tuple(parse(x, ()) for x in row) for row in [["0.1000000000001", "0.3"], ["0.3", "0.9"]])
    assert definite_at(shifted, {}) is True


def test_proofs_over_boxes_are_refused_where_one_point_is_bad() -> None:
    """x^2 - a over [-1, 1] plus 1: positive only if a < 1; at a = 1 it vanishes at one point."""
    box = (Range("x", -1.0, 1.0, 0.25, False),)
    weights = np.ones(1)
    for a, found in (("0.9", True), ("1", False), ("1.0001", False)):
        matrix = ((parse(f"1 + x**2 - {a}", ("x",)),),)
        one = ((Number(1.0),),)
        assert definite_over(matrix, box, weights) is found
        assert rates_over(matrix, one, box, weights) is found


def test_proofs_end_when_their_work_is_done(monkeypatch: pytest.MonkeyPatch) -> None:
    """With less work allowed, what was proved is no longer so, and nothing else changes."""
    law = 'motion = "planar"\n[energy]\ndensity = "(h1 - 1)**2 + h2**2 + log(cosh(Pi + h2))"\n'
    proved = stability(load_law(law))
    monkeypatch.setattr(proofs, "WORK", 100)
    sampled = stability(load_law(law))
    assert proved is not None
    assert sampled is not None
    assert proved.grades["definite"] == "proved"
    assert (sampled.definite, sampled.grades["definite"]) == (True, "sampled")


def test_blocks_are_what_couples() -> None:
    """Odd entries drop out of the symmetric part; a chain couples its ends."""
    rows = [["1", "a", "0"], ["-a", "1", "b"], ["0", "b", "1"]]
    matrix = tuple(tuple(parse(x, ("a", "b")) for x in row) for row in rows)
    assert blocks(matrix) == ((0, 1, 2),)
    assert blocks(symmetric(matrix)) == ((0,), (1, 2))


def test_ends_of_boxes_are_decimals_as_they_are_written() -> None:
    """0.1 is a tenth: enclosures hold the exact rational, which the float is not."""
    ball = proofs._interval(0.1, 0.3)
    for ratio in (Fraction(1, 10), Fraction(3, 10)):
        assert ball.contains(arb(fmpq(ratio.numerator, ratio.denominator)))
