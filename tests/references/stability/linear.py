"""Linear boundary-value problems with polynomial coefficients, and the growths at which they have a solution.

    Y' = (A_0 + A_1 u + A_2 u^2 + ... + growth G) Y,   0 < u < L

n components; at u = 0 all vanish but those named in `start`, at u = L the rows `end` give zero: half of n each. A rod
near an equilibrium is of this form, Y being displacement, angle, force and moment, all as exp(growth t).

* *Determinant*: the solutions from the start are power series in u, c_(k+1) = (sum_j A_j c_(k-j)) / (k+1), which
  converge everywhere; in extended precision, so that few digits are lost. It vanishes at a growth of the rod.
* *Collocation*: the same equations at Chebyshev points are a matrix pencil; less accurate, but it finds all growths.
  It gives the estimates that are refined, and is the second method the first is checked against.

Source: E. L. Ince, *Ordinary Differential Equations*, chapter XVI (series); L. N. Trefethen, *Spectral Methods in
MATLAB*, chapters 6 and 9 (collocation).
"""

import itertools
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.optimize import brentq

from tests.references import chebyshev

Complex = npt.NDArray[np.complex128]
Matrix = npt.NDArray[Any]
TERMS = 2000
SHIFT = 0.3 + 0.7j  # no growth of any rod here


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


def _determinant(matrix: Matrix) -> Any:
    """By elimination, in any precision."""
    a, result = matrix.copy(), matrix.dtype.type(1)
    for k in range(len(a)):
        pivot = k + int(np.argmax(np.abs(a[k:, k])))
        if a[pivot, k] == 0:
            return matrix.dtype.type(0)
        if pivot != k:
            a[[k, pivot]], result = a[[pivot, k]], -result
        result = result * a[k, k]
        a[k + 1 :] -= np.outer(a[k + 1 :, k] / a[k, k], a[k])
    return result


def determinant(problem: Problem, growth: Any) -> Any:
    """What vanishes at a growth: the rows at the end, of the solutions from the start."""
    length = np.longdouble(problem.length)
    steps = [np.array(a, dtype=np.clongdouble) * length ** (k + 1) for k, a in enumerate(problem.coefficients)]
    steps[0] = steps[0] + np.array(problem.growing, dtype=np.clongdouble) * (length * growth)
    terms: list[Any] = [np.eye(problem.size, dtype=np.clongdouble)[:, list(problem.start)]]
    total, small = terms[0], 0
    while small < 3:
        if len(terms) == TERMS:
            raise ArithmeticError(f"expected a series that ends within {TERMS} terms; the coefficients are too large")
        terms.append(sum(a @ c for a, c in zip(steps, reversed(terms), strict=False)) / len(terms))
        total = total + terms[-1]
        small = small + 1 if np.abs(terms[-1]).max() < 1e-21 * np.abs(total).max() else 0
    return _determinant(np.array(problem.end, dtype=np.clongdouble) @ total)


def growths(problem: Problem, number: int, degree: int = 28) -> Complex:
    """The `number` leading growths (1 / time) by collocation, largest real part first."""
    u, size = chebyshev.points(degree, problem.length), problem.size
    left = np.kron(np.eye(size), chebyshev.derivative(degree, problem.length)).astype(complex)
    for k, a in enumerate(problem.coefficients):
        left -= np.kron(np.array(a, dtype=complex), np.diag(u**k))
    right = np.kron(np.array(problem.growing, dtype=complex), np.eye(degree + 1))
    # a condition takes the place of the equation, at its end, of a component: those the start fixes, then the others
    for component in (i for i in range(size) if i not in problem.start):
        at = component * (degree + 1)
        left[at], right[at] = np.eye(len(left))[at], 0.0
    for component, row in zip(problem.start, np.array(problem.end, dtype=complex), strict=True):
        at = component * (degree + 1) + degree
        left[at], right[at] = np.kron(row, np.eye(degree + 1)[degree]), 0.0
    inverse = np.linalg.eigvals(np.linalg.solve(left - SHIFT * right, right))
    found = SHIFT + 1.0 / inverse[np.abs(inverse) > 1e-7 * np.abs(inverse).max()]
    return np.asarray(found[np.argsort(-found.real)][:number])


def secant(function: Callable[[Any], Any], estimate: Any) -> Any:
    """The zero of a function, of a complex number or a real one, next to an estimate."""
    before, now = np.clongdouble(estimate) * (1.0 + 1e-6), np.clongdouble(estimate)
    values = function(before), function(now)
    for _ in range(40):
        step = values[1] * (now - before) / (values[1] - values[0])
        before, now = now, now - step
        if abs(step) < 1e-12 * abs(now):  # the next step would be its square
            return now
        values = values[1], function(now)
    raise ArithmeticError(f"secants from {estimate} did not settle; expected a zero nearby")


def refined(problem: Problem, growth: complex) -> complex:
    """The growth (1 / time) next to an estimate, to double precision."""
    return complex(secant(lambda x: determinant(problem, x), growth))


def leading(problem: Problem, degree: int = 28) -> complex:
    """The growth (1 / time) of largest real part; of a pair, the one that turns positively."""
    first, *others = growths(problem, 6, degree)
    alike = [x for x in others if abs(x.real - first.real) < 1e-6 * abs(first)]
    return refined(problem, max([first, *alike], key=lambda x: x.imag))


def divergence(family: Family, value: float) -> float:
    """The value next to an estimate at which a growth is zero."""
    # the determinant may have a phase, so that secants leave the real axis by rounding
    return float(secant(lambda p: determinant(family(p.real), 0.0), value).real)


def flutter(family: Family, value: float, frequency: float) -> tuple[float, float]:
    """The value next to the first one at which a growth is i frequency, and that frequency (1 / time)."""
    now = np.array([value, frequency], dtype=np.longdouble)
    for _ in range(20):
        d = determinant(family(now[0]), 1j * now[1])
        steps = 1e-8 * now
        by_value = (determinant(family(now[0] + steps[0]), 1j * now[1]) - d) / steps[0]
        by_frequency = (determinant(family(now[0]), 1j * (now[1] + steps[1])) - d) / steps[1]
        # d + by_value dp + by_frequency dw = 0 for real dp and dw
        area = (by_value.conjugate() * by_frequency).imag
        move = np.array([(d * by_frequency.conjugate()).imag, -(d * by_value.conjugate()).imag]) / area
        now = now + move
        if np.abs(move / now).max() < 1e-14:
            return float(now[0]), float(now[1])
    raise ArithmeticError(f"Newton's method from {value}, {frequency} did not settle; expected flutter nearby")


def loss(family: Family, values: Iterable[float], degree: int = 28) -> tuple[float, float]:
    """The first loss of stability along increasing values, by collocation: value and frequency (0: divergence)."""

    def lead(value: float) -> complex:
        return complex(growths(family(value), 1, degree)[0])

    for before, value in itertools.pairwise(values):
        if lead(value).real > 0.0:
            found = float(brentq(lambda x: lead(x).real, before, value, xtol=1e-11, rtol=1e-11))
            frequency = abs(lead(found).imag)
            return found, frequency if frequency > 1e-4 else 0.0
    raise ArithmeticError("expected a loss of stability in the interval, found none")
