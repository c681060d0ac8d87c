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
void SUNMatDestroy(void *matrix);
typedef void **solver;
solver SUNLinSol_Dense(void *vector, void *matrix, void *context);
solver SUNLinSolNewEmpty(void *context);
int SUNLinSolGetType_Dense(solver);
int SUNLinSolGetID_Dense(solver);
int SUNLinSolSetup_Dense(solver, void *matrix);
int SUNLinSolSolve_Dense(solver, void *matrix, void *x, void *b, double tolerance);
int SUNLinSolFree(solver);
void SUNLinSolFreeEmpty(solver);
void free(void *);
"""
SHARED = """
int {0}SVtolerances(void *memory, double rtol, void *atol);
int {0}SetUserData(void *memory, void *data);
int {0}SetMaxNumSteps(void *memory, long steps);
int {0}SetStopTime(void *memory, double t);
int {0}SetLinearSolver(void *memory, solver, void *matrix);
int {0}SetLinearSolutionScaling(void *memory, int on);
int {0}SetNonlinConvCoef(void *memory, double share);
int {0}GetNumSteps(void *memory, long *count);
int {0}GetNumJacEvals(void *memory, long *count);
char *{0}GetReturnFlagName(long flag);
void {0}Free(void **memory);
"""
OWN = {
    "CVode": """
void *CVodeCreate(int method, void *context);
int CVodeInit(void *memory, void *rate, double t, void *y);
int CVodeSetMaxHnilWarns(void *memory, int count);
int CVodeSetLinSysFn(void *memory, void *system);
int CVodeGetCurrentGamma(void *memory, double *gamma);
int CVodeGetNumRhsEvals(void *memory, long *count);
int CVode(void *memory, double until, void *y, double *t, int task);
""",
    "IDA": """
void *IDACreate(void *context);
int IDAInit(void *memory, void *residual, double t, void *y, void *slope);
int IDASetId(void *memory, void *differential);
int IDASetSuppressAlg(void *memory, int suppress);
int IDASetJacFn(void *memory, void *system);
int IDAGetCurrentCj(void *memory, double *slope);
int IDAGetNumResEvals(void *memory, long *count);
int IDASolve(void *memory, double until, double *t, void *y, void *slope, int task);
""",
}
FILES = {"CVode": "_cy_cvode*", "IDA": "_cy_ida*"}

MAJOR = 7
"""The generation of SUNDIALS whose interface this is."""

OPERATIONS = ("GetType", "GetID", "Solve")
"""Of its dense linear solver: those that another one needs too."""
MEMBERS, TABLE = 3, 12
"""How far into a solver to look for the table of its operations, and into that for one of them."""


@dataclass(frozen=True)
class Sundials:
    """An open library, the foreign-function interface it is called through, and which integrator it holds.

    table: which member of a linear solver points to its operations; places: where among them some are, by name.
    """

    ffi: cffi.FFI
    lib: Any
    prefix: str
    table: int
    places: dict[str, int]

    def address(self, name: str) -> int:
        """Address of a function of the library."""
        return int(self.ffi.cast("uintptr_t", getattr(self.lib, name)))

    def call(self, name: str) -> Any:
        """The integrator's function of that name, without its prefix."""
        return getattr(self.lib, f"{self.prefix}{name}")

    def meaning(self, code: int) -> str:
        """Its name of what a call came to, as in CV_CONV_FAILURE."""
        text = self.call("GetReturnFlagName")(code)
        name = bytes(self.ffi.string(text)).decode()
        self.ffi.dlopen(None).free(text)  # that of the program: preloaded allocators come before the library's own
        return name

    def solver(self, solve: Any, content: Any, context: Any) -> Any:
        """A direct linear solver whose system is factored elsewhere; `solve` finds `content` where it points to."""
        made = self.lib.SUNLinSolNewEmpty(context)
        operations = self.ffi.cast("void **", made[self.table])
        for name in ("GetType", "GetID"):
            operations[self.places[name]] = self.ffi.cast("void *", self.address(f"SUNLinSol{name}_Dense"))
        operations[self.places["Solve"]], made[0] = solve, content
        return made


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
            if version[0] == MAJOR and hasattr(lib, f"{prefix}Init"):
                found = _places(ffi, lib)
                if found is not None:
                    return Sundials(ffi, lib, prefix, *found)
        except (OSError, AttributeError):
            continue
    return None


def _places(ffi: cffi.FFI, lib: Any) -> tuple[int, dict[str, int]] | None:
    """Where a linear solver has the table of its operations, and where that has some: looked for in one that is known,
    since they move from version to version."""
    context, one = ffi.new("void **"), ffi.new("double[1]")
    lib.SUNContext_Create(0, context)
    vector, matrix = lib.N_VMake_Serial(1, one, context[0]), lib.SUNDenseMatrix(1, 1, context[0])
    known = lib.SUNLinSol_Dense(vector, matrix, context[0])
    wanted = {name: ffi.cast("void *", getattr(lib, f"SUNLinSol{name}_Dense")) for name in OPERATIONS}
    found = None
    for member in range(1, MEMBERS):  # the first is its content, the last its context
        operations = ffi.cast("void **", known[member])
        if operations == ffi.NULL or operations[0] != wanted["GetType"]:
            continue
        table = [operations[i] for i in range(TABLE)]
        if all(address in table for address in wanted.values()):
            found = member, {name: table.index(address) for name, address in wanted.items()}
            break
    lib.SUNLinSolFree(known)
    lib.SUNMatDestroy(matrix)
    lib.N_VDestroy(vector)
    lib.SUNContext_Free(context)
    return found
