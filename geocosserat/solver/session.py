"""One integration by SUNDIALS that calls a compiled kernel directly, without Python inside."""

from abc import ABC, abstractmethod
from typing import Any, ClassVar

import numpy as np

from geocosserat.kernel.contract import Array, Kernel, NativeKernel
from geocosserat.solver.settings import BREATH, NEWTON, SINGULAR, Hope, stands_still
from geocosserat.solver.sundials import Sundials
from geocosserat.solver.trajectory import Frame, Progress, Trajectory

NORMAL = 1
TOO_MUCH_WORK = -1


class Session(ABC):
    """Owns the objects of one integration and gives them back; a subclass knows its integrator's own functions.

    Linear systems are the kernel's own: its blocks are factored where SUNDIALS asks for a matrix, which is a dummy.
    """

    name: ClassVar[str]
    rate_count: ClassVar[str]
    system_setter: ClassVar[str]
    current: ClassVar[str]

    def __init__(self, library: Sundials, kernel: Kernel, start: Array, t: float, rtol: float, atol: Array) -> None:
        self.library, self.ffi, self.lib = library, library.ffi, library.lib
        self.kernel: Kernel = kernel
        assert isinstance(kernel, NativeKernel)
        self.callbacks = kernel.callbacks(library.address("N_VGetArrayPointer"), library.address(self.current))
        self.y, self.atol = start.copy(), atol.copy()
        ffi, lib, call = self.ffi, self.lib, library.call
        self._context = ffi.new("void **")
        self._check(lib.SUNContext_Create(0, self._context))
        self.context = self._context[0]
        lib.SUNContext_ClearErrHandlers(self.context)  # errors come back as codes, not as text on the terminal
        self._kept: list[tuple[Any, Array]] = []
        self.state, tolerance = self.vector(self.y), self.vector(self.atol)
        self._memory = ffi.new("void **", self.create(t))
        self.memory = self._memory[0]
        ffi.cast("void **", self.callbacks.data)[0] = self.memory
        self.begin(t)
        self._check(call("SVtolerances")(self.memory, rtol, tolerance))
        self._check(call("SetUserData")(self.memory, self.pointer(self.callbacks.data)))
        self._check(call("SetMaxNumSteps")(self.memory, BREATH))
        system, solve = self.linear()
        self.solver = library.solver(self.pointer(solve), self.pointer(self.callbacks.data), self.context)
        self.matrix = lib.SUNDenseMatrix(1, 1, self.context)
        self._check(call("SetLinearSolver")(self.memory, self.solver, self.matrix))
        self._check(call(self.system_setter)(self.memory, self.pointer(system)))
        self._check(call("SetNonlinConvCoef")(self.memory, NEWTON))
        # SUNDIALS would shrink or stretch what an older step size gives, energies and all, which are exact as they are
        self._check(call("SetLinearSolutionScaling")(self.memory, 0))

    @abstractmethod
    def create(self, t: float) -> Any:
        """The integrator's memory."""

    @abstractmethod
    def begin(self, t: float) -> None:
        """Hands over the problem and its start."""

    @abstractmethod
    def linear(self) -> tuple[int, int]:
        """Addresses of what factors the linear system, and of what solves it."""

    @abstractmethod
    def advance(self, until: float, reached: Any) -> int:
        """One call of the integrator; its code."""

    def vector(self, values: Array) -> Any:
        """SUNDIALS' view of an array."""
        made = self.lib.N_VMake_Serial(len(values), self.ffi.cast("double *", values.ctypes.data), self.context)
        self._kept.append((made, values))
        return made

    def pointer(self, address: int) -> Any:
        return self.ffi.cast("void *", address)

    def __enter__(self) -> "Session":
        return self

    def __exit__(self, *_: object) -> None:
        lib = self.lib
        self.library.call("Free")(self._memory)
        lib.SUNLinSolFreeEmpty(self.solver)
        lib.SUNMatDestroy(self.matrix)
        for made, _values in self._kept:
            lib.N_VDestroy(made)
        lib.SUNContext_Free(self._context)

    def _check(self, code: int) -> None:
        if code < 0:
            raise RuntimeError(f"SUNDIALS refused a setting with code {code}; this is an error of geocosserat")

    def _count(self, name: str) -> int:
        value = self.ffi.new("long *")
        self.library.call(f"GetNum{name}")(self.memory, value)
        return int(value[0])

    def integrate(self, times: Array, progress: Progress, frame: Frame) -> Trajectory:
        """From times[0] through all of `times`; see `integrate`."""
        first, last = float(times[0]), float(times[-1])
        states = np.empty((len(times), len(self.y)))
        states[0] = self.y
        reached_t: Any = self.ffi.new("double *", first)
        self._check(self.library.call("SetStopTime")(self.memory, last))
        done, reason, hope = 1, "", Hope()
        while done < len(times):
            before = reached_t[0]
            code = self.advance(float(times[done]), reached_t)
            steps, now = self._count("Steps"), reached_t[0]
            if code == TOO_MUCH_WORK:
                progress((now - first) / (last - first), steps)
                if stands_still(before, now, BREATH):
                    reason = f"{self.name} stopped at t = {now:.6g}: its steps go nowhere; {SINGULAR}"
                    break
                if not hope.lost(steps, (now - first) / (last - first)):
                    continue
                reason = f"{self.name} stopped at t = {now:.6g}: {steps} steps did not reach the end"
                break
            if code < 0:
                reason = f"{self.name} stopped at t = {now:.6g} after {steps} steps: {self._meaning(code)}"
                break
            if not np.all(np.isfinite(self.y)):
                reason = f"{self.name} returned values that are not finite at t = {now:.6g}"
                break
            states[done] = self.y
            done += 1
            progress((now - first) / (last - first), steps)
            if frame(done - 1, states[done - 1], steps):
                break
        return Trajectory(
            times=times[:done].copy(),
            states=states[:done],
            rates=self._count(self.rate_count),
            jacobians=self._count("JacEvals"),
            steps=self._count("Steps"),
            reached=done == len(times),
            reason=reason,
        )

    def _meaning(self, code: int) -> str:
        words = self.library.meaning(code)
        return MEANINGS.get(words.partition("_")[2], words)


MEANINGS = {
    "ERR_FAILURE": f"the error test failed however small the step; {SINGULAR}",
    "ERR_FAIL": f"the error test failed however small the step; {SINGULAR}",
    "CONV_FAILURE": f"Newton's method failed however small the step; {SINGULAR}",
    "CONV_FAIL": f"Newton's method failed however small the step; {SINGULAR}",
    "RHSFUNC_FAIL": "the rate could not be evaluated",
    "RES_FAIL": "the rate could not be evaluated",
    "FIRST_RHSFUNC_ERR": "the rate is not finite at the start",
    "FIRST_RES_FAIL": "the rate is not finite at the start",
    "REPTD_RHSFUNC_ERR": "the rate is not finite however small the step",
    "REP_RES_ERR": "the rate is not finite however small the step",
    "UNREC_RHSFUNC_ERR": "the rate is not finite",
    "TOO_MUCH_ACC": "the tolerance asked for is below round-off; ask for less accuracy",
    "ILL_INPUT": "it could not begin, or the span of time is too short for the numbers of a computer",
    "LSETUP_FAIL": "the linear system is singular",
    "LSOLVE_FAIL": "the linear system could not be solved",
}
