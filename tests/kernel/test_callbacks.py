"""A compiled kernel as SUNDIALS calls it: the same rate, factors and solves, through addresses."""

from __future__ import annotations

from itertools import product
from typing import Any

import cffi
import numpy as np
import pytest
from numpy.typing import NDArray

from geocosserat.conductor.kernels import kernel_text
from geocosserat.discretisation.semidiscrete import discretise
from geocosserat.kernel.contract import NativeKernel
from geocosserat.kernel.load import load
from geocosserat.kernel.native import NativeRod
from tests.discretisation.rods import FROZEN, VISCOUS, changed, random_state, rod
from tests.kernel.kernels import Case, T, cases, kernel, rate, state

Array = NDArray[np.float64]
_CALLED = ("everything", "hung", "plain", "reeled", "ring", "damped")
CASES = [case for case in cases(("c",)) if case.name.split()[1] in _CALLED]
CONSTRAINED = [case for case in cases(("c",)) if case.name in (*FROZEN, *VISCOUS)]


class Caller:
    """Calls a kernel's callbacks with vectors that are plain arrays: their address is their data."""

    def __init__(self, k: NativeRod) -> None:
        self.ffi = ffi = cffi.FFI()
        self.data = ffi.callback("double *(void *)", lambda thing: ffi.cast("double *", thing))
        address = int(ffi.cast("uintptr_t", self.data))
        self.gamma: float | None = None  # as it was set up
        self.current = ffi.callback("int (void *, double *)", self._current)
        self.callbacks = k.callbacks(address, int(ffi.cast("uintptr_t", self.current)))
        self.solver = ffi.new("void *[2]", [self.problem, ffi.NULL])

    def _current(self, memory: Any, into: Any) -> int:
        if self.gamma is not None:
            into[0] = self.gamma
        return 0

    def at(self, array: Array) -> Any:
        return self.ffi.cast("void *", array.ctypes.data)

    def function(self, name: str, arguments: str) -> Any:
        return self.ffi.cast(f"int (*)({arguments})", getattr(self.callbacks, name))

    @property
    def problem(self) -> Any:
        return self.ffi.cast("void *", self.callbacks.data)

    def rate(self, t: float, y: Array, out: Array) -> int:
        return int(self.function("rate", "double, void *, void *, void *")(t, self.at(y), self.at(out), self.problem))

    def system(self, t: float, y: Array, usable: bool, gamma: float) -> tuple[int, bool]:
        renewed, none = self.ffi.new("int *", -1), self.ffi.NULL
        call = self.function("system", "double, void *, void *, void *, int, int *, double" + ", void *" * 4)
        code = call(t, self.at(y), none, none, usable, renewed, gamma, self.problem, none, none, none)
        return int(code), bool(renewed[0])

    def solve(self, b: Array, name: str = "solve") -> Array:
        out = np.full_like(b, np.nan)
        call = self.function(name, "void *, void *, void *, void *, double")
        assert call(self.solver, self.ffi.NULL, self.at(out), self.at(b), 0.0) == 0
        return out

    def residual(self, t: float, y: Array, slope: Array, out: Array) -> int:
        call = self.function("residual", "double, void *, void *, void *, void *")
        return int(call(t, self.at(y), self.at(slope), self.at(out), self.problem))

    def residual_system(self, t: float, y: Array, c: float) -> int:
        none = self.ffi.NULL
        call = self.function("residual_system", "double, double" + ", void *" * 8)
        return int(call(t, c, self.at(y), none, none, none, self.problem, none, none, none))


def native(case: Case) -> NativeRod:
    found = kernel(case)
    assert isinstance(found, NativeRod)
    assert isinstance(found, NativeKernel)
    return found


@pytest.mark.parametrize("case", CASES, ids=str)
def test_the_callback_gives_the_rate_of_the_kernel(case: Case) -> None:
    """Digit for digit."""
    y, out = state(case, 1), np.empty(len(state(case, 1)))
    assert Caller(native(case)).rate(T, y, out) == 0
    np.testing.assert_array_equal(out, rate(case, T, y))


@pytest.mark.parametrize("case", CASES, ids=str)
def test_the_system_is_solved_with_the_blocks_of_the_state_it_was_made_at(case: Case) -> None:
    """A Jacobian said to be usable is kept, another step only factors it again; and it says which of both it did."""
    k, y, b = native(case), state(case, 1), state(case, 2)
    caller, wanted = Caller(k), np.empty(len(b))
    for at, usable, gamma in ((y, False, 0.1), (state(case, 3), True, 0.1), (state(case, 3), True, 0.7)):
        assert caller.system(T, at, usable, gamma) == (0, not usable)
        found = caller.solve(b)
        k.prepare(T, y)
        k.factor(gamma)
        k.solve(b, wanted)
        np.testing.assert_array_equal(found, wanted)


@pytest.mark.parametrize("case", CASES, ids=str)
def test_a_rate_that_is_not_finite_asks_for_a_smaller_step(case: Case) -> None:
    """Whichever component of turn or stress it comes from: a positive code is "recoverable" to SUNDIALS; a singular
    system likewise."""
    k, y = native(case), state(case, 1)
    out, points = np.empty(len(y)), case.elements * case.degree
    components = len(rod(*case[:3]).structure.state_names)
    for bad, place in product((np.nan, np.inf, -np.inf), range(0, components * points, points)):
        broken = y.copy()
        broken[place] = bad
        assert Caller(k).rate(T, broken, out) == 1
        code, _ = Caller(k).system(T, broken, False, 0.1)
        assert code >= 0
    assert Caller(k).rate(T, y, out) == 0


@pytest.mark.parametrize("case", [c for c in CASES if c.name not in (*FROZEN, *VISCOUS)], ids=str)
def test_only_a_rod_with_frozen_or_viscous_modes_has_residuals(case: Case) -> None:
    """The others are ordinary: their addresses are 0, and nothing of the kind is in their kernel."""
    found = Caller(native(case)).callbacks
    assert (found.residual, found.residual_system, found.residual_solve) == (0, 0, 0)
    assert "residual" not in kernel_text(rod(*case[:3]).structure).c


@pytest.mark.parametrize("case", CONSTRAINED, ids=str)
def test_the_residual_is_the_slope_less_the_rate_and_of_stresses_the_constraint(case: Case) -> None:
    """Digit for digit; a rate that is not finite asks for a smaller step."""
    y, slope, out = state(case, 1), state(case, 2), np.empty(len(state(case, 1)))
    caller = Caller(native(case))
    assert caller.residual(T, y, slope, out) == 0
    held, f = rod(*case[:3]).algebraic == 1, rate(case, T, y)
    assert 0 < held.sum() < len(y)
    np.testing.assert_array_equal(out, np.where(held, f, slope - f))
    y[-3] = np.nan
    assert caller.residual(T, y, slope, out) == 1


@pytest.mark.parametrize("case", CONSTRAINED, ids=str)
@pytest.mark.parametrize("c", [0.5, 30.0])
def test_the_system_of_the_residual_is_its_jacobian(case: Case, c: float) -> None:
    """With the slope a multiple c of the state, as IDA has it: c - df/dy, and df/dy of stresses."""
    k, y, b = native(case), state(case, 1), state(case, 2)
    caller = Caller(k)
    assert caller.residual_system(T, y, c) == 0
    J, held = k.jacobian(T, y), rod(*case[:3]).algebraic == 1
    matrix = np.where(held[:, None], J, c * np.eye(len(y)) - J)
    found, wanted = caller.solve(b, "residual_solve"), np.linalg.solve(matrix, b)
    accuracy = max(1e-11, 1e-16 * np.linalg.cond(matrix))
    np.testing.assert_allclose(found, wanted, rtol=0, atol=accuracy * np.abs(wanted).max())


def test_without_friction_of_a_rotation_the_energies_change_by_their_powers_where_newton_leads() -> None:
    """By b and gamma times what the powers differ there from where they were asked for; all else as ever."""
    rods = [
        discretise(changed("planar everything", rod={"friction": [1.0, 2.0, friction]}), 4, 2) for friction in (0, 0.3)
    ]
    for r, ahead in zip(rods, (True, False), strict=True):
        k = load(kernel_text(r.structure), r, "c")
        assert isinstance(k, NativeRod)
        caller, y, b = Caller(k), random_state(r, 1), random_state(r, 2)
        gamma, here, there, plain = 1e-3, np.empty(len(y)), np.empty(len(y)), np.empty(len(y))
        caller.gamma = gamma
        assert caller.system(T, y, False, gamma) == (0, True)
        assert caller.rate(T, y, here) == 0
        change = caller.solve(b)
        k.prepare(T, y)
        k.factor(gamma)
        k.solve(b, plain)
        k.rate(T, y + change * (np.arange(len(y)) < len(y) - 2), there)
        wanted = b[-2:] + ahead * gamma * (there - here)[-2:]
        np.testing.assert_array_equal(change[:-2], plain[:-2])
        np.testing.assert_allclose(change[-2:], wanted, rtol=1e-12)
        assert (np.abs(change[-2:] - b[-2:]).max() > 1e-3) == ahead
