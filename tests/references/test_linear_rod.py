"""The linear rod: closed forms, matrix exponentials, the equations of the group, and the balance of power."""

import itertools
import math
from dataclasses import replace

import mpmath
import numpy as np
import pytest

from tests.references import cantilever_modes, chebyshev, euler_bernoulli, helix, linear_rod
from tests.references.linear_rod import Array, Complex, End, Kind, Rod, decay_rates, driven, response

ROD = Rod(length=1.3, k2=5.0, k3=1.1, friction2=0.7, friction3=0.4)
HELD = replace(ROD, trap=2.0, field=0.6)
SLENDER = Rod(length=1.3, k2=math.inf, k3=1.1, friction2=0.7, friction3=0.0)
PAIRS: tuple[tuple[Kind, Kind], ...] = (
    ("clamped", "clamped"), ("clamped", "pinned"), ("clamped", "free"),
    ("pinned", "pinned"), ("pinned", "free"), ("free", "free"), ("free", "clamped"),
)  # fmt: skip
MAGNETIC = End("free", force=0.2 - 0.1j, torque=0.3j)


@pytest.mark.parametrize("rod", [ROD, replace(ROD, k2=1e5, friction3=1e-3), replace(SLENDER, friction3=0.2)])
def test_clamped_free_rates_agree_with_counted_ones(rod: Rod) -> None:
    """`cantilever_modes` counts its rates by focal points: none is passed over, 14 digits agree."""
    other = cantilever_modes.Rod(rod.length, rod.k2, rod.k3, rod.friction2, rod.friction3)
    expected = cantilever_modes.decay_rates(other, 5)
    np.testing.assert_allclose(decay_rates(rod, "clamped", "free", 5), expected, rtol=1e-14)


@pytest.mark.parametrize("friction3", [0.0, 0.3])
@pytest.mark.parametrize(("left", "right"), PAIRS[:-1])
def test_without_shear_the_rates_obey_the_characteristic_equations(left: Kind, right: Kind, friction3: float) -> None:
    """Euler and Bernoulli's rod with any ends, behind its rigid motions."""
    rod = replace(SLENDER, friction3=friction3)
    rigid = linear_rod.rigid_modes(rod, left, right)
    rates = decay_rates(rod, left, right, rigid + 4)
    expected = euler_bernoulli.decay_rates(1.3, 1.1, 0.7, friction3, f"{left}-{right}", 4)  # type: ignore[arg-type]
    np.testing.assert_array_equal(rates[:rigid], 0.0)
    np.testing.assert_allclose(rates[rigid:], expected, rtol=1e-13)


@pytest.mark.parametrize("rod", [ROD, HELD, replace(HELD, friction3=1e-4, k2=300.0)])
def test_pinned_rods_have_the_rates_of_sines(rod: Rod) -> None:
    """y = sin(q u), theta = cos(q u), q = n pi / L, and the rotation cos(0 u): symmetric matrices of 2 x 2."""
    drag = np.array([rod.friction2, rod.friction3])
    expected = [(rod.k2 + rod.field) / rod.friction3]
    for n in range(1, 25):
        q = n * np.pi / rod.length
        stored = np.array([[rod.k2 * q**2 + rod.trap, -rod.k2 * q], [-rod.k2 * q, rod.k2 + rod.k3 * q**2 + rod.field]])
        rates = np.linalg.eigvals(stored / drag[:, None])
        expected += [np.linalg.det(stored) / (np.prod(drag) * rates.max()), rates.max()]
    found = decay_rates(rod, "pinned", "pinned", 6)
    np.testing.assert_allclose(found, np.sort(expected)[:6], rtol=1e-12)


def _shot(rod: Rod, growth: complex, left: End, right: End, at: Array, wave: complex, sources: Complex) -> Complex:
    """(y, theta, F2, M) at the points for sources exp(wave u): exponentials of an augmented matrix, in mpmath.

    sources: (curvature, force, couple) amplitudes.
    """
    with mpmath.workdps(40):
        system = mpmath.zeros(5)
        for i, row in enumerate(linear_rod.matrix(rod, mpmath.mpmathify(growth))):
            for j, entry in enumerate(row):
                system[i, j] = entry
        system[1, 4], system[2, 4], system[3, 4] = sources[0], -sources[1], -sources[2]
        system[4, 4] = wave
        end = mpmath.expm(system * mpmath.mpf(rod.length))
        held = {"clamped": (0, 1), "pinned": (0, 3), "free": (2, 3)}
        values = [[e.displacement, e.angle, s * e.force, s * e.torque] for e, s in ((left, -1), (right, 1))]
        start = mpmath.zeros(5, 1)
        start[4] = 1
        for k in held[left.kind]:
            start[k] = values[0][k]
        known = end * start
        unknown = [k for k in range(4) if k not in held[left.kind]]
        a = mpmath.matrix([[end[r, k] for k in unknown] for r in held[right.kind]])
        b = mpmath.matrix([values[1][r] - known[r] for r in held[right.kind]])
        for k, value in zip(unknown, mpmath.lu_solve(a, b), strict=True):
            start[k] = value
        rows = [mpmath.expm(system * mpmath.mpf(float(x))) * start for x in at]
        return np.array([[complex(row[k]) for k in range(4)] for row in rows])


CASES = (
    (ROD, driven(0.3, -0.2j, 5.0), End("free")),
    (ROD, driven(0.0, 0.4, 5.0), End("pinned", displacement=0.1j, torque=0.05)),
    (HELD, MAGNETIC, End("free", force=-0.3, torque=0.2)),
    (HELD, End("clamped"), End("clamped", displacement=0.1, angle=0.2j)),
    (SLENDER, driven(0.3, 0.2, 5.0), MAGNETIC),
    (replace(SLENDER, friction3=0.2, trap=3.0), End("pinned"), End("free")),
)


@pytest.mark.parametrize(("rod", "left", "right"), CASES)
def test_the_response_agrees_with_matrix_exponentials(rod: Rod, left: End, right: End) -> None:
    """Driven and loaded ends, a wave of curvature, force and couple along the rod: to 1e-12 of the largest."""
    wave, sources = -0.4 + 5.0j, np.array([0.5, 0.3j, 0.2 - 0.1j])
    at = np.linspace(0.0, rod.length, 4)
    profiles = [lambda u, size=size: size * np.exp(wave * u) for size in sources]
    found = response(rod, 5.0, left, right, at, profiles[1], profiles[2], profiles[0])
    expected = _shot(rod, 5.0j, left, right, at, wave, sources)
    for values, exact in zip((found.displacement, found.angle, found.force, found.moment), expected.T, strict=True):
        np.testing.assert_allclose(values, exact, atol=2e-12 * max(1.0, np.abs(exact).max()))


@pytest.mark.parametrize(("rod", "left", "right"), CASES)
def test_the_rates_are_where_the_response_has_no_bound(rod: Rod, left: End, right: End) -> None:
    """The collocated equations with i frequency = -rate are singular, and not so half-way to the next rate."""
    rates = decay_rates(rod, left.kind, right.kind, 5)
    for rate, next_rate in itertools.pairwise(rates[2:]):
        sizes = [
            np.abs(response(rod, 1j * x, left, replace(right, torque=1.0, angle=1.0), [0.7]).angle).max()
            for x in (rate * (1.0 + 1e-9), 0.5 * (rate + next_rate))
        ]
        assert sizes[0] > 1e6 * sizes[1]


def test_the_response_solves_the_matrix_equations_of_the_rod() -> None:
    """Compatibility and balance from commutators alone, to first order, with magnetic torque and trap in the world."""
    frequency, rest = 5.0, np.array([1.0, 0.0, 0.0])
    u, slope = chebyshev.points(30, HELD.length), chebyshev.derivative(30, HELD.length)
    curvature, force, couple = (lambda u: np.exp(3j * u)), (lambda u: 0.3 * u), 0.2j
    found = response(HELD, frequency, driven(0.1, 0.2, frequency), MAGNETIC, u, force, couple, curvature)
    zero = np.zeros_like(found.displacement)
    bend = found.moment / HELD.k3 + curvature(u)
    strain = np.stack([zero, found.force / HELD.k2, bend], axis=1)
    stress = np.stack([zero, found.force, found.moment], axis=1)
    twist = 1j * frequency * np.stack([zero, found.displacement, found.angle], axis=1)
    wrench = np.stack(
        [
            zero,
            force(u) - HELD.trap * found.displacement - HELD.friction2 * twist[:, 1],
            couple - HELD.field * found.angle - HELD.friction3 * twist[:, 2],
        ],
        axis=1,
    )

    def bracket(x: Array, y: Array) -> Array:
        product = helix.hat(x) @ helix.hat(y) - helix.hat(y) @ helix.hat(x)
        return np.array([product[1, 0], product[2, 0], product[2, 1]])

    ad = np.stack([bracket(rest, basis) for basis in np.eye(3)], axis=1)
    np.testing.assert_allclose(slope @ twist + twist @ ad.T, 1j * frequency * strain, atol=1e-9)
    np.testing.assert_allclose(slope @ stress - stress @ ad + wrench, 0.0, atol=1e-9)
    np.testing.assert_allclose(twist[0], [0.0, 0.1, 0.2], atol=1e-12)


def test_the_power_of_a_driven_clamp_is_dissipated() -> None:
    """Half Re(-F2* v2 - M* Omega) at the clamp is half the integral of friction |velocity|^2."""
    node, weight = np.polynomial.legendre.leggauss(40)
    at, weight = 0.5 * ROD.length * (node + 1.0), 0.5 * ROD.length * weight
    clamp = driven(0.3, -0.2j, 4.0)
    inside = response(ROD, 4.0, clamp, End("free"), at)
    base = response(ROD, 4.0, clamp, End("free"), [0.0])
    spent = (
        16.0 * weight @ (ROD.friction2 * np.abs(inside.displacement) ** 2 + ROD.friction3 * np.abs(inside.angle) ** 2)
    )
    given = -(base.force[0].conj() * 0.3 + base.moment[0].conj() * -0.2j).real
    assert given == pytest.approx(spent, rel=1e-12)
    assert spent > 0.0


def test_slowly_changing_curvature_bends_the_rod_without_stress() -> None:
    """As frequency -> 0 the angle is the integral of Pi0; the rest is of the size of the frequency."""
    for frequency in (1e-3, 1e-5):
        found = response(ROD, frequency, End("clamped"), End("free"), [0.5, 1.3], curvature=lambda u: np.cos(2.0 * u))
        assert np.abs(found.angle - 0.5 * np.sin([1.0, 2.6])).max() < 2.0 * frequency
        assert np.abs(found.moment).max() < 2.0 * frequency


def test_two_rates_that_coincide_are_refused() -> None:
    """trap / friction2 = field / friction3: all rigid motions of a free rod decay alike."""
    twin = replace(ROD, trap=0.7, field=0.4)
    with pytest.raises(ArithmeticError, match="expected simple rates"):
        decay_rates(twin, "free", "free", 2)
