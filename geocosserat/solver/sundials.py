"""The C interface of SUNDIALS, as far as it is needed, from the libraries that scikit-sundae ships.

Calling an integrator itself lets it call a compiled kernel directly: nothing of Python runs inside an integration, and
scikit-sundae's own import (which needs much of scipy) is not paid.
"""

import importlib.util
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import cffi

COMMON = """
int SUNDIALSGetVersionNumber(int *major, int *minor, int *patch, char *label, int len);
int SUNContext_Create(int comm, void **context);
int SUNContext_Free(void **context);
int SUNContext_ClearErrHandlers(void *context);
void *N_VMake_Serial(long long length, double *data, void *context);
double *N_VGetArrayPointer(void *vector);
void N_VDestroy(void *vector);
void *SUNDenseMatrix(long long rows, long long columns, void *context);
double *SUNDenseMatrix_Data(void *matrix);
void SUNMatDestroy(void *matrix);
void *SUNLinSol_Dense(void *vector, void *matrix, void *context);
void *SUNLinSol_SPGMR(void *vector, int side, int krylov, void *context);
int SUNLinSolFree(void *solver);
void free(void *);
"""
SHARED = """
int {0}SVtolerances(void *memory, double rtol, void *atol);
int {0}SetUserData(void *memory, void *data);
int {0}SetMaxNumSteps(void *memory, long steps);
int {0}SetStopTime(void *memory, double t);
int {0}SetLinearSolver(void *memory, void *solver, void *matrix);
int {0}SetJacFn(void *memory, void *jacobian);
int {0}SetPreconditioner(void *memory, void *setup, void *solve);
int {0}GetNumSteps(void *memory, long *count);
int {0}GetNumJacEvals(void *memory, long *count);
int {0}GetNumPrecEvals(void *memory, long *count);
char *{0}GetReturnFlagName(long flag);
void {0}Free(void **memory);
"""
OWN = {
    "CVode": """
void *CVodeCreate(int method, void *context);
int CVodeInit(void *memory, void *rate, double t, void *y);
int CVodeSetMaxHnilWarns(void *memory, int count);
int CVodeGetNumRhsEvals(void *memory, long *count);
int CVodeGetNumLinRhsEvals(void *memory, long *count);
int CVode(void *memory, double until, void *y, double *t, int task);
""",
    "IDA": """
void *IDACreate(void *context);
int IDAInit(void *memory, void *residual, double t, void *y, void *slope);
int IDASetId(void *memory, void *differential);
int IDASetSuppressAlg(void *memory, int suppress);
int IDAGetNumResEvals(void *memory, long *count);
int IDAGetNumLinResEvals(void *memory, long *count);
int IDASolve(void *memory, double until, double *t, void *y, void *slope, int task);
""",
}
FILES = {"CVode": "_cy_cvode*", "IDA": "_cy_ida*"}

MAJOR = 7
"""The generation of SUNDIALS whose interface this is."""


@dataclass(frozen=True)
class Sundials:
    """An open library, the foreign-function interface it is called through, and which integrator it holds."""

    ffi: cffi.FFI
    lib: Any
    prefix: str

    def address(self, name: str) -> int:
        """Address of a function of the library."""
        return int(self.ffi.cast("uintptr_t", getattr(self.lib, name)))

    def call(self, name: str) -> Any:
        """The integrator's function of that name, without its prefix."""
        return getattr(self.lib, f"{self.prefix}{name}")


@lru_cache(maxsize=2)
def sundials(prefix: str) -> Sundials | None:
    """SUNDIALS ("CVode" or "IDA") as installed with scikit-sundae, or None if it is another generation or cannot be
    opened so."""
    spec = importlib.util.find_spec("sksundae")  # finds the folder, imports nothing
    if spec is None or spec.origin is None:
        return None
    ffi = cffi.FFI()
    ffi.cdef(COMMON + SHARED.format(prefix) + OWN[prefix])
    for path in sorted(Path(spec.origin).parent.glob(FILES[prefix])):
        if path.suffix not in (".so", ".pyd"):
            continue
        try:
            lib: Any = ffi.dlopen(str(path))
            version, label = ffi.new("int[3]"), ffi.new("char[32]")
            lib.SUNDIALSGetVersionNumber(version, version + 1, version + 2, label, 32)
            if version[0] == MAJOR and all(hasattr(lib, name) for name in (f"{prefix}Init", "SUNLinSol_SPGMR")):
                return Sundials(ffi, lib, prefix)
        except (OSError, AttributeError):
            continue
    return None
