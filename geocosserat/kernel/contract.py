"""What a solver may ask of a kernel. Solvers see this and nothing else: no rods."""

from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Protocol, runtime_checkable

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

ENERGIES = 2
"""Of a rod's state: dissipated and work done, its last entries, on which nothing depends."""


LANES = 8
"""How many states a kernel's `rates` take at once."""


@dataclass(frozen=True)
class Callbacks:
    """Addresses of C functions with the signatures of SUNDIALS' callbacks, for integrations that never leave C.

    data: what they take as their user data, whose first member is the integrator's memory. rate: of CVODE; system:
    factors its linear system; solve: as a linear solver, whose first member points to `data`. The residuals are those
    of IDA, of kernels with constraints; 0 where there are none. keep: whatever must stay alive while they are used.
    """

    data: int
    rate: int
    system: int
    solve: int
    keep: Any
    residual: int = 0
    residual_system: int = 0
    residual_solve: int = 0


@dataclass(frozen=True)
class Functions:
    """Addresses of C functions for an integrator of small dense systems.

    data: what they take first. rate: int (data, t, y, rate). rates: int (data, count, t, y, rate), the same of up to
    LANES states side by side, t (LANES,), y and rate (size, LANES): for methods whose steps have several stages.
    jacobian: const double * (data, t, y), the matrix by rows, its owner's until the next call. quadratures: how many of
    the last entries nothing depends on. keep: whatever must stay alive while they are used.
    """

    data: int
    rate: int
    rates: int
    jacobian: int
    quadratures: int
    keep: Any


@runtime_checkable
class NativeKernel(Protocol):
    """A kernel that can also be called from C."""

    def functions(self) -> Functions:
        """Its rate and dense Jacobian."""

    def callbacks(self, vector: int, current: int) -> Callbacks:
        """Its callbacks; vector and current are the addresses of N_VGetArrayPointer, and of CVodeGetCurrentGamma or
        IDAGetCurrentCj."""


@lru_cache(maxsize=64)
def is_native(kind: type) -> bool:
    """Whether kernels of that type are native. Asking each of them takes longer than a step of a small one."""
    return issubclass(kind, NativeKernel)


class Kernel(Protocol):
    """A first-order system y' = f(t, y) with its linear algebra.

    size: number of state entries. backend: "c" or "numpy". algebraic (size,): 1 for entries that are fixed by a
    constraint f_i(t, y) = 0, linear in all of them, and have no rate; 0 for the others. quadratures: how many of the
    last entries nothing depends on.
    """

    @property
    def size(self) -> int: ...

    @property
    def backend(self) -> str: ...

    @property
    def algebraic(self) -> Array: ...

    @property
    def quadratures(self) -> int: ...

    def rate(self, t: float, y: Array, out: Array) -> None:
        """f(t, y) into out; y (size,) contiguous, not written."""

    def jacobian(self, t: float, y: Array) -> Array:
        """df/dy (size, size), row i the derivatives of component i."""

    def prepare(self, t: float, y: Array) -> None:
        """Linearise at (t, y), block by block, for the factors to come."""

    def factor(self, gamma: float) -> None:
        """Factor 1 - gamma df/dy at the state last prepared, rows of constraints as df/dy; linear in the number of
        elements.

        Raises numpy.linalg.LinAlgError if a block is singular.
        """

    def solve(self, b: Array, out: Array) -> None:
        """Solve with the factors; out may not be b."""


class Balance(Protocol):
    """Of a kernel whose last two entries book what was dissipated and what work was done, and that stores an energy:
    nothing but these changes it. For methods that keep the balance in each step."""

    def stored(self, t: float, y: Array) -> tuple[float, float]:
        """The energy stored, and a size of which rounding is a part: what stresses would do on whole strains."""

    def aim(self, t: float, before: Array, after: Array) -> float:
        """Chooses how the stress is to be corrected: along its own change from one state to the other. What such a
        correction does on that way, which is positive."""

    def correct(self, share: float) -> None:
        """From now on the kernel's stress is off by that share of the correction, which is neither stored nor booked; 0
        ends it."""
