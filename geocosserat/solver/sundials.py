"""The C interface of SUNDIALS, as far as it is needed, from the libraries that scikit-sundae ships.

Calling CVODE itself lets it call a compiled kernel directly: nothing of Python runs inside an integration, and
scikit-sundae's own import (which needs much of scipy) is not paid.
"""

import importlib.util
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import Any

import cffi

DECLARATIONS = """
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
void *CVodeCreate(int method, void *context);
int CVodeInit(void *cvode, void *rate, double t, void *y);
int CVodeSVtolerances(void *cvode, double rtol, void *atol);
int CVodeSetUserData(void *cvode, void *data);
int CVodeSetMaxNumSteps(void *cvode, long steps);
int CVodeSetMaxHnilWarns(void *cvode, int count);
int CVodeSetStopTime(void *cvode, double t);
int CVodeSetLinearSolver(void *cvode, void *solver, void *matrix);
int CVodeSetJacFn(void *cvode, void *jacobian);
int CVodeSetPreconditioner(void *cvode, void *setup, void *solve);
int CVode(void *cvode, double until, void *y, double *t, int task);
int CVodeGetNumSteps(void *cvode, long *count);
int CVodeGetNumRhsEvals(void *cvode, long *count);
int CVodeGetNumLinRhsEvals(void *cvode, long *count);
int CVodeGetNumJacEvals(void *cvode, long *count);
int CVodeGetNumPrecEvals(void *cvode, long *count);
char *CVodeGetReturnFlagName(long flag);
void CVodeFree(void **cvode);
void free(void *);
"""

MAJOR = 7
"""The generation of SUNDIALS whose interface this is."""


@dataclass(frozen=True)
class Sundials:
    """The open library and the foreign-function interface it is called through."""

    ffi: cffi.FFI
    lib: Any

    def address(self, name: str) -> int:
        """Address of a function of the library."""
        return int(self.ffi.cast("uintptr_t", getattr(self.lib, name)))


@lru_cache(maxsize=1)
def sundials() -> Sundials | None:
    """SUNDIALS as installed with scikit-sundae, or None if it is another generation or cannot be opened so."""
    spec = importlib.util.find_spec("sksundae")  # finds the folder, imports nothing
    if spec is None or spec.origin is None:
        return None
    ffi = cffi.FFI()
    ffi.cdef(DECLARATIONS)
    for path in sorted(Path(spec.origin).parent.glob("_cy_cvode*")):
        if path.suffix not in (".so", ".pyd"):
            continue
        try:
            lib: Any = ffi.dlopen(str(path))
            version, label = ffi.new("int[3]"), ffi.new("char[32]")
            lib.SUNDIALSGetVersionNumber(version, version + 1, version + 2, label, 32)
            if version[0] == MAJOR and all(hasattr(lib, name) for name in ("CVodeCreate", "SUNLinSol_SPGMR")):
                return Sundials(ffi, lib)
        except (OSError, AttributeError):
            continue
    return None
