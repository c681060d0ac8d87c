"""A compiled kernel behind the kernel contract.

cffi hands an array's address to C in a third of the time that ctypes needs (benchmarks/bindings.py).
"""

from collections.abc import Mapping
from functools import lru_cache
from itertools import accumulate
from pathlib import Path
from typing import Any

import cffi
import numpy as np

from geocosserat.discretisation.semidiscrete import SemiDiscrete
from geocosserat.kernel.contract import ENERGIES, Array, Callbacks, Functions

DECLARATIONS = """
typedef struct rod {
    int elements;
    const double *half, *scale, *mass, *share, *u, *u_point, *tables, *uniform, *point, *node, *base;
    double *work;
} rod;
size_t rod_work(int elements);
size_t rod_block(void);
size_t rod_pair(void);
size_t rod_border(void);
size_t rod_factors(void);
size_t rod_scratch(void);
int rod_rate(const rod *r, double t, const double *y, double *dy);
int rod_observe(const rod *r, double t, const double *y, double *twist, double *stress, double *energy);
int rod_blocks(const rod *r, double t, const double *y, double *lower, double *diagonal, double *upper, double *border,
               double *scratch);
int rod_dense(const rod *r, double t, const double *y, double *J, double *lower, double *diagonal, double *upper,
              double *border, double *scratch);
int rod_factor(int elements, double gamma, const double *lower, const double *diagonal, const double *upper,
               const double *border, double *factors, int *pivots);
int rod_solve(int elements, const double *factors, const int *pivots, const double *b, double *x, double *scratch);
typedef struct rod_problem {
    void *memory;
    const rod *r;
    size_t size;
    double *lower, *diagonal, *upper, *border, *factors, *scratch, *solving, *right;
    double *whole, *room, *at, *next, *rates;
    int *pivots;
    void *vector, *current;
    int ahead;
    double t, powers[2];
    double slope;
} rod_problem;
int problem_slope(void *problem, double t, const double *y, double *rate);
size_t problem_room(int elements);
int problem_slopes(void *problem, int count, const double *t, const double *y, double *rate);
const double *problem_dense(void *problem, double t, const double *y);
int problem_rate(double t, void *y, void *rate, void *problem);
int problem_system(double t, void *y, void *rate, void *none, int usable, int *renewed, double gamma, void *problem,
                   void *a, void *b, void *c);
int problem_solve(void *solver, void *none, void *x, void *b, double tolerance);
int problem_residual(double t, void *y, void *yp, void *residual, void *problem);
int problem_residual_system(double t, double c, void *y, void *yp, void *residual, void *none, void *problem,
                            void *a1, void *a2, void *a3);
int problem_residual_solve(void *solver, void *none, void *x, void *b, double tolerance);
"""


@lru_cache(maxsize=1)
def _interface() -> cffi.FFI:
    ffi = cffi.FFI()
    ffi.cdef(DECLARATIONS)
    return ffi


@lru_cache(maxsize=64)
def _library(path: Path) -> Any:
    """The library of that path, which a hash of its source names: opened once, for cffi looks each function up anew in
    a library that is opened again, which takes longer than a short run."""
    return _interface().dlopen(str(path))


@lru_cache(maxsize=64)
def _of_library(path: Path) -> tuple[int, int, int, int, int, int, int]:
    """What is the same for all rods of a library, and takes a while to ask for: numbers of a block, of a pair, of the
    border and of scratch space; addresses of the rate, of several rates at once and of the dense Jacobian."""
    ffi, lib = _interface(), _library(path)
    functions = (lib.problem_slope, lib.problem_slopes, lib.problem_dense)
    rate, rates, dense = (int(ffi.cast("uintptr_t", thing)) for thing in functions)
    return lib.rod_block(), lib.rod_pair(), lib.rod_border(), lib.rod_scratch(), rate, rates, dense


class NativeRod:
    """The kernel of a semi-discrete rod in C. One call at a time: it owns its work space."""

    backend = "c"
    quadratures = ENERGIES

    def __init__(self, library: Path, rod: SemiDiscrete) -> None:
        self._ffi = ffi = _interface()
        self._lib = _library(library)
        self._shared = _of_library(library)
        self._double, self._int = ffi.typeof("double[]"), ffi.typeof("int[]")
        self.size = len(rod.state)
        self.algebraic = rod.algebraic
        self._quasi_static = rod.quasi_static
        self._elements = rod.mesh.elements
        self._d, self._points = rod.structure.group.dimension, rod.mesh.elements * rod.mesh.degree
        arrays = {
            "half": rod.mesh.half,
            "scale": 1 / rod.mesh.half,
            "mass": rod.mesh.mass,
            "share": 1 / rod.mesh.mass,
            "u": rod.mesh.u,
            "u_point": rod.mesh.u_point,
            "tables": rod.tables,
            "uniform": rod.uniform,
            "point": rod.point,
            "node": rod.node,
            "base": rod.base,
            "work": np.zeros(self._lib.rod_work(self._elements)),
        }
        self._kept = {name: np.ascontiguousarray(a, dtype=float) for name, a in arrays.items()}
        self._rod = ffi.new("rod *")
        self._rod.elements = self._elements
        self._point(self._rod, self._kept)
        self._blocks: dict[str, Array] = {}
        self._blocks_at: tuple[Any, ...] = ()
        self._factors: tuple[Array, Any, Array] | None = None
        self._functions: Functions | None = None

    def _at(self, array: Array) -> Any:
        return self._ffi.from_buffer(self._double, array)

    def _point(self, struct: Any, arrays: Mapping[str, Array]) -> None:
        """Pointers to the arrays into members of their names; whoever keeps the struct keeps the arrays."""
        for name, array in arrays.items():
            setattr(struct, name, self._at(array))

    def rate(self, t: float, y: Array, out: Array) -> None:
        self._lib.rod_rate(self._rod, t, self._at(y), self._at(out))

    def observe(self, t: float, y: Array) -> tuple[Array, Array, float]:
        """Twist (d, nodes), stress (d, points), stored energy."""
        twist, stress = np.empty((self._d, self._points + 1)), np.empty((self._d, self._points))
        energy = np.empty(1)
        self._lib.rod_observe(self._rod, t, self._at(y), self._at(twist), self._at(stress), self._at(energy))
        return twist, stress, float(energy[0])

    def _space(self) -> dict[str, Array]:
        """Room for the blocks of the Jacobian and what making them takes, in the order in which C has them."""
        if not self._blocks:
            lib, n, b = self._lib, self._elements, self._lib.rod_block()
            shapes = {
                "lower": (n, lib.rod_pair()),
                "diagonal": (n, b, b),
                "upper": (n, lib.rod_pair()),
                "border": (lib.rod_border(),),
                "scratch": (lib.rod_scratch(),),
            }
            self._blocks = {name: np.empty(shape) for name, shape in shapes.items()}
            self._blocks_at = tuple(self._at(a) for a in self._blocks.values())
        return self._blocks

    def _space_at(self) -> tuple[Any, ...]:
        """The same as C takes it."""
        self._space()
        return self._blocks_at

    def _room(self) -> tuple[Array, Array, Array]:
        """Room for factors, pivots and solving."""
        lib, n = self._lib, self._elements
        b = lib.rod_block()
        return np.empty(n * lib.rod_factors()), np.empty(n * b, dtype=np.intc), np.empty(n * b)

    def functions(self) -> Functions:
        """Rate and dense Jacobian as an integrator takes them that calls C directly."""
        if self._functions is None:
            ffi, n = self._ffi, self._elements
            block, pair, border, scratch, rate, rates, dense = self._shared
            sizes = (n * pair, n * block * block, n * pair, border, scratch, self._lib.problem_room(n))
            ends = list(accumulate(sizes))
            room = np.empty(ends[-1] + self._dense_room())  # at once: an array for each would take as long as two steps
            at = self._at(room)
            lower, diagonal, upper, border_at, scratch_at, side_by_side, whole = (at + end for end in (0, *ends))
            problem = ffi.new("rod_problem *", {
                "r": self._rod, "size": self.size, "lower": lower, "diagonal": diagonal, "upper": upper,
                "border": border_at, "scratch": scratch_at, "room": side_by_side, "whole": whole,
            })  # fmt: skip
            kept = problem, room, self._rod, self._kept, self._lib
            self._functions = Functions(int(ffi.cast("uintptr_t", problem)), rate, rates, dense, ENERGIES, keep=kept)
        return self._functions

    def callbacks(self, vector: int, current: int) -> Callbacks:
        """This kernel as SUNDIALS sees it; vector and current are the addresses of N_VGetArrayPointer, and of
        CVodeGetCurrentGamma or IDAGetCurrentCj."""
        ffi, lib = self._ffi, self._lib
        problem = ffi.new("rod_problem *")
        factors, pivots, solving = self._room()
        arrays = self._space() | {"factors": factors, "solving": solving}
        arrays |= {name: np.empty(self.size) for name in ("right", "at", "next", "rates")}
        self._point(problem, arrays)
        problem.pivots = ffi.cast("int *", pivots.ctypes.data)
        problem.r, problem.size, problem.ahead = self._rod, self.size, self._quasi_static
        problem.vector, problem.current = ffi.cast("void *", vector), ffi.cast("void *", current)

        def address(thing: Any) -> int:
            return int(ffi.cast("uintptr_t", thing))

        constrained = ("residual", "residual_system", "residual_solve") if self.algebraic.any() else ()
        return Callbacks(
            data=address(problem),
            rate=address(lib.problem_rate),
            system=address(lib.problem_system),
            solve=address(lib.problem_solve),
            keep=(problem, arrays, pivots, self),
            **{name: address(getattr(lib, f"problem_{name}")) for name in constrained},
        )

    def blocks(self, t: float, y: Array) -> tuple[Array, Array, Array]:
        """The block-tridiagonal Jacobian, (elements, block, block) each."""
        self.prepare(t, y)
        space = self._space()
        b = space["diagonal"].shape[1]

        def product(pairs: Array) -> Array:
            left, right = np.split(pairs, 2, axis=1)
            return left.reshape(self._elements, b, -1) @ right.reshape(self._elements, -1, b)

        return product(space["lower"]), space["diagonal"].copy(), product(space["upper"])

    def _dense_room(self) -> int:
        """Numbers of a dense Jacobian, with room behind the matrix for the eliminated poses."""
        return self.size * (self.size + 12)

    def jacobian(self, t: float, y: Array) -> Array:
        J = np.empty(self._dense_room())
        self._lib.rod_dense(self._rod, t, self._at(y), self._at(J), *self._space_at())
        return J[: self.size**2].reshape(self.size, self.size)

    def prepare(self, t: float, y: Array) -> None:
        self._lib.rod_blocks(self._rod, t, self._at(y), *self._space_at())

    def factor(self, gamma: float) -> None:
        if self._factors is None:
            self._factors = self._room()
        factors, pivots, _ = self._factors
        *blocks, _ = self._space_at()
        failed = self._lib.rod_factor(
            self._elements,
            gamma,
            *blocks,
            self._at(factors),
            self._ffi.from_buffer(self._int, pivots),
        )
        if failed:
            where = f"element {failed - 1}" if failed <= self._elements else "the whole rod"
            raise np.linalg.LinAlgError(f"the linear system of {where} is singular")

    def solve(self, b: Array, out: Array) -> None:
        assert self._factors is not None, "factor comes before solve"
        factors, pivots, scratch = self._factors
        at = self._at
        self._lib.rod_solve(
            self._elements, at(factors), self._ffi.from_buffer(self._int, pivots), at(b), at(out), at(scratch)
        )
