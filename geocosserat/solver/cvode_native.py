"""CVODE calling a compiled kernel directly. The same method and settings as `cvode`, without Python inside.

Source: A. C. Hindmarsh et al., ACM Trans. Math. Softw. 31 (2005) 363.
"""

from typing import Any

import numpy as np

from geocosserat.kernel.contract import Array, Kernel, NativeKernel
from geocosserat.solver.settings import BREATH, DENSE_LIMIT, KRYLOV, STEP_LIMIT, stands_still
from geocosserat.solver.sundials import Sundials
from geocosserat.solver.trajectory import Frame, Progress, Trajectory

BDF, NORMAL, LEFT = 2, 1, 1
TOO_MUCH_WORK = -1


def cvode_native(
    library: Sundials,
    kernel: Kernel,
    start: Array,
    times: Array,
    rtol: float,
    atol: Array,
    progress: Progress,
    frame: Frame,
) -> Trajectory:
    """Integrates a NativeKernel from times[0] through all of `times`; see `integrate`."""
    with _Session(library, kernel, start, float(times[0]), rtol, atol) as session:
        return session.integrate(times, progress, frame)


class _Session:
    """Owns the objects of one integration and gives them back."""

    def __init__(self, library: Sundials, kernel: Kernel, start: Array, t: float, rtol: float, atol: Array) -> None:
        self.ffi, self.lib = library.ffi, library.lib
        assert isinstance(kernel, NativeKernel)
        dense = kernel.size <= DENSE_LIMIT
        self.callbacks = kernel.callbacks(
            library.address("N_VGetArrayPointer"), library.address("SUNDenseMatrix_Data"), dense
        )
        self.y, self.atol = start.copy(), atol.copy()
        ffi, lib = self.ffi, self.lib
        self.context = ffi.new("void **")
        self._check(lib.SUNContext_Create(0, self.context))
        context = self.context[0]
        lib.SUNContext_ClearErrHandlers(context)  # errors come back as codes, not as text on the terminal
        self.vectors = [
            lib.N_VMake_Serial(len(a), ffi.cast("double *", a.ctypes.data), context) for a in (self.y, self.atol)
        ]
        y, tolerance = self.vectors
        self.cvode = ffi.new("void **", lib.CVodeCreate(BDF, context))
        cvode, c = self.cvode[0], self.callbacks
        self._check(lib.CVodeInit(cvode, ffi.cast("void *", c.rate), t, y))
        self._check(lib.CVodeSVtolerances(cvode, rtol, tolerance))
        self._check(lib.CVodeSetUserData(cvode, ffi.cast("void *", c.data)))
        self._check(lib.CVodeSetMaxNumSteps(cvode, BREATH))
        self._check(lib.CVodeSetMaxHnilWarns(cvode, -1))  # nor do warnings appear there
        self.matrix = lib.SUNDenseMatrix(kernel.size, kernel.size, context) if dense else ffi.NULL
        self.solver = (
            lib.SUNLinSol_Dense(y, self.matrix, context) if dense else lib.SUNLinSol_SPGMR(y, LEFT, KRYLOV, context)
        )
        self._check(lib.CVodeSetLinearSolver(cvode, self.solver, self.matrix))
        if dense:
            self._check(lib.CVodeSetJacFn(cvode, ffi.cast("void *", c.jacobian)))
        else:
            self._check(lib.CVodeSetPreconditioner(cvode, ffi.cast("void *", c.setup), ffi.cast("void *", c.solve)))

    def __enter__(self) -> "_Session":
        return self

    def __exit__(self, *_: object) -> None:
        lib = self.lib
        lib.CVodeFree(self.cvode)
        lib.SUNLinSolFree(self.solver)
        if self.matrix != self.ffi.NULL:
            lib.SUNMatDestroy(self.matrix)
        for vector in self.vectors:
            lib.N_VDestroy(vector)
        lib.SUNContext_Free(self.context)

    def _check(self, code: int) -> None:
        if code < 0:
            raise RuntimeError(f"SUNDIALS refused a setting with code {code}; this is an error of geocosserat")

    def _count(self, name: str) -> int:
        value = self.ffi.new("long *")
        getattr(self.lib, f"CVodeGetNum{name}")(self.cvode[0], value)
        return int(value[0])

    def integrate(self, times: Array, progress: Progress, frame: Frame) -> Trajectory:
        cvode, lib = self.cvode[0], self.lib
        first, last = float(times[0]), float(times[-1])
        states = np.empty((len(times), len(self.y)))
        states[0] = self.y
        reached_t: Any = self.ffi.new("double *", first)
        self._check(lib.CVodeSetStopTime(cvode, last))
        done, reason = 1, ""
        while done < len(times):
            before = reached_t[0]
            code = lib.CVode(cvode, float(times[done]), self.vectors[0], reached_t, NORMAL)
            steps = self._count("Steps")
            if code == TOO_MUCH_WORK:
                progress((reached_t[0] - first) / (last - first), steps)
                if stands_still(before, reached_t[0], BREATH):
                    reason = f"CVODE stopped at t = {reached_t[0]:.6g}: its steps go nowhere; {SINGULAR}"
                    break
                if steps < STEP_LIMIT:
                    continue
                reason = f"CVODE stopped at t = {reached_t[0]:.6g}: {steps} steps did not reach the end"
                break
            if code < 0:
                reason = f"CVODE stopped at t = {reached_t[0]:.6g} after {steps} steps: {self._meaning(code)}"
                break
            if not np.all(np.isfinite(self.y)):
                reason = f"CVODE returned values that are not finite at t = {reached_t[0]:.6g}"
                break
            states[done] = self.y
            frame(done, states[done])
            done += 1
            progress((reached_t[0] - first) / (last - first), steps)
        return Trajectory(
            times=times[:done].copy(),
            states=states[:done],
            rates=self._count("RhsEvals") + self._count("LinRhsEvals"),
            jacobians=self._count("JacEvals") if self.matrix != self.ffi.NULL else self._count("PrecEvals"),
            steps=self._count("Steps"),
            reached=done == len(times),
            reason=reason,
        )

    def _meaning(self, code: int) -> str:
        text = self.lib.CVodeGetReturnFlagName(code)
        words = bytes(self.ffi.string(text)).decode()
        self.lib.free(text)
        return MEANINGS.get(words, words)


SINGULAR = "the motion may be singular here"
MEANINGS = {
    "CV_ERR_FAILURE": f"the error test failed however small the step; {SINGULAR}",
    "CV_CONV_FAILURE": f"Newton's method failed however small the step; {SINGULAR}",
    "CV_RHSFUNC_FAIL": "the rate could not be evaluated",
    "CV_FIRST_RHSFUNC_ERR": "the rate is not finite at the start",
    "CV_REPTD_RHSFUNC_ERR": "the rate is not finite however small the step",
    "CV_UNREC_RHSFUNC_ERR": "the rate is not finite",
    "CV_TOO_MUCH_ACC": "the tolerance asked for is below round-off; ask for less accuracy",
    "CV_ILL_INPUT": "it could not begin, or the span of time is too short for the numbers of a computer",
    "CV_LSETUP_FAIL": "the linear system is singular",
    "CV_LSOLVE_FAIL": "the linear system could not be solved",
}
