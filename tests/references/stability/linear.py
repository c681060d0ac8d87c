"""Linear boundary-value problems with polynomial coefficients, and the growths at which they have a solution.

    Y' = (A_0 + A_1 u + A_2 u^2 + ... + growth G) Y,   0 < u < L

n components; at u = 0 all vanish but those named in `start`, at u = L the rows `end` give zero: half of n each. A rod
near an equilibrium is of this form, Y being displacement, angle, force and moment, all as exp(growth t).

* *Determinant*: the solutions from the start are power series in u, c_(k+1) = (sum_j A_j c_(k-j)) / (k+1), which
  converge everywhere; with `mpmath`, so that no digits are lost. It vanishes at a growth of the rod.
* *Collocation*: the same equations at Chebyshev points are a matrix pencil; less accurate, but it finds all growths.
  It gives the estimates that are refined, and is the second method the first is checked against.

Source: E. L. Ince, *Ordinary Differential Equations*, chapter XVI (series); chapter 6 of Trefethen's *Spectral Methods
in MATLAB* (collocation).
"""

import itertools
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

import mpmath
import numpy as np
import numpy.typing as npt
from scipy.optimize import brentq

from tests.references import chebyshev

Complex = npt.NDArray[np.complex128]
Matrix = npt.NDArray[Any]
DIGITS = 30


@dataclass(frozen=True)
class Problem:
    """The matrices, each (n, n) of any numbers; `start`: components that are free at u = 0; `end`: rows (n / 2, n)."""

    length: float
    coefficients: tuple[Matrix, ...]
    growing: Matrix
    start: tuple[int, ...]
    end: Matrix

    @property
    def size(self) -> int:
        """n."""
        return len(self.growing)


Family = Callable[[Any], Problem]


def determinant(problem: Problem, growth: Any) -> Any:
    """What vanishes at a growth: the rows at the end, of the solutions from the start."""
    length = mpmath.mpf(problem.length)
    steps = [np.array(a, dtype=object) * length ** (k + 1) for k, a in enumerate(problem.coefficients)]
    steps[0] = steps[0] + np.array(problem.growing, dtype=object) * length * growth
    terms = [np.array([[mpmath.mpf(i == j) for j in problem.start] for i in range(problem.size)], dtype=object)]
    total, floor = terms[0], mpmath.mpf(10) ** (-mpmath.mp.dps)
    small = 0
    while small < 3 and len(terms) < 1000:
        terms.append(sum(a @ c for a, c in zip(steps, reversed(terms), strict=False)) / mpmath.mpf(len(terms)))
        total = total + terms[-1]
        small = small + 1 if max(map(abs, terms[-1].ravel())) < floor * max(map(abs, total.ravel())) else 0
    return mpmath.det(mpmath.matrix((np.array(problem.end, dtype=object) @ total).tolist()))


def growths(problem: Problem, number: int, degree: int = 36) -> Complex:
    """The `number` leading growths (1 / time) by collocation, largest real part first."""
    u, size = chebyshev.points(degree, problem.length), problem.size
    left = np.kron(np.eye(size), chebyshev.derivative(degree, problem.length)).astype(complex)
    for k, a in enumerate(problem.coefficients):
        left -= np.kron(np.array(a, dtype=complex), np.diag(u**k))
    right = np.kron(np.array(problem.growing, dtype=complex), np.eye(degree + 1))
    # a condition takes the place of the equation, at its end, of a component: those the start fixes, then the others
    fixed = [i for i in range(size) if i not in problem.start]
    for component, row in [(i, np.eye(size)[i]) for i in fixed]:
        at = component * (degree + 1)
        left[at], right[at] = np.kron(row, np.eye(degree + 1)[0]), 0.0
    for component, row in zip(problem.start, np.array(problem.end, dtype=complex), strict=True):
        at = component * (degree + 1) + degree
        left[at], right[at] = np.kron(row, np.eye(degree + 1)[degree]), 0.0
    inverse = np.linalg.eigvals(np.linalg.solve(left, right))
    found = 1.0 / inverse[np.abs(inverse) > 1e-7 * np.abs(inverse).max()]
    return np.asarray(found[np.argsort(-found.real)][:number])


def refined(problem: Problem, growth: complex) -> complex:
    """The growth (1 / time) next to an estimate, to double precision."""
    with mpmath.workdps(DIGITS):
        guess = mpmath.mpc(growth)
        found = mpmath.findroot(lambda x: determinant(problem, x), (guess, guess * (1 + mpmath.mpf(10) ** -6)), tol=1e-40)
        return complex(found)


def leading(problem: Problem, degree: int = 36) -> complex:
    """The growth (1 / time) of largest real part; of a pair, the one that turns positively."""
    first, *others = growths(problem, 6, degree)
    alike = [x for x in others if abs(x.real - first.real) < 1e-6 * abs(first)]
    return refined(problem, max([first, *alike], key=lambda x: x.imag))


def divergence(family: Family, value: float) -> float:
    """The value next to an estimate at which a growth is zero."""
    with mpmath.workdps(DIGITS):
        pair = (mpmath.mpf(value), value * (1 + mpmath.mpf(10) ** -6))
        scale = abs(determinant(family(pair[0] * 1.01), 0))
        # the determinant may have a phase, so that the secants leave the real axis by rounding
        found = mpmath.findroot(lambda p: determinant(family(p), 0) / scale, pair, tol=1e-40)
        return float(mpmath.re(found))


def flutter(family: Family, value: float, frequency: float) -> tuple[float, float]:
    """The value next to the first one at which a growth is i frequency, and that frequency (1 / time)."""
    with mpmath.workdps(DIGITS):

        def condition(p: Any, w: Any) -> tuple[Any, Any]:
            d = determinant(family(p), mpmath.mpc(0, w))
            return mpmath.re(d), mpmath.im(d)

        scale = abs(determinant(family(mpmath.mpf(value) * 1.01), mpmath.mpc(0, frequency)))
        found = mpmath.findroot(
            lambda p, w: [x / scale for x in condition(p, w)], (value, frequency), tol=1e-30, maxsteps=30
        )
        return float(found[0]), float(found[1])


def loss(family: Family, values: Iterable[float], degree: int = 28) -> tuple[float, float]:
    """The first loss of stability along increasing values, by collocation: value and frequency (0: divergence)."""

    def lead(value: float) -> complex:
        return complex(growths(family(value), 1, degree)[0])

    for before, value in itertools.pairwise(values):
        if lead(value).real > 0.0:
            found = float(brentq(lambda x: lead(x).real, before, value, xtol=1e-14, rtol=1e-14))
            return found, abs(lead(found).imag)
    raise ArithmeticError(f"expected a loss of stability up to {values[-1]}, found none")
