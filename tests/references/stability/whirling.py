"""The spin at which a rod that is spun at its base begins to whirl, to ten digits and more.

The straight rod turns as one, and passes on the drag of what lies beyond: M1 = -friction4 spin (L - u); no tension. The
problem is that of `straight` with a clamped base, in axes that do not turn with it. Without stretch, shear and drag of
tilting it is friction2 xi_t = -bend xi'''' + i (M1 xi'')', whose only number is spin friction4 L^2 / bend.

A mode is exp(growth t) in the world. Seen from the base, which turns, it is exp((growth - i spin) t), and its mirror
image is the conjugate: `seen` says which eigenvalue the turning frame shows.

Source: C. W. Wolgemuth, T. R. Powers, R. E. Goldstein, Phys. Rev. Lett. 84 (2000) 1623: about 8.9.

Dimensions: friction4 force x time; spin radians / time.
"""

from typing import Any

from tests.references.stability.linear import Problem
from tests.references.stability.straight import Rod, State, problem


def spun(rod: Rod, friction4: float, spin: Any) -> Problem:
    """The rod near its straight state, seen from the world."""
    drag = friction4 * spin
    return problem(rod, State(moment=[-drag * rod.length, drag]), "clamped", "dead")


def seen(growth: complex, spin: float) -> complex:
    """The eigenvalue (1 / time) in the frame that turns with the base; of the pair, that with positive frequency."""
    return complex(growth.real, abs(growth.imag - spin))
