"""A rod that slides along itself: the helix (or arc) of uniform turn E, phi(u, t) = base exp((u + s(t)) E).

Then phi' = phi E and phi_t = phi V with V = s_t E, so compatibility E_t = V' + [E, V] = 0 holds: V is parallel to E.
The balance Sigma' + ad*_E Sigma - Gamma V + j = 0 holds with the wrench density

    j = s_t Gamma E     (body components, friction Gamma any matrix)

if the stress is uniform and ad*_E Sigma = 0. Two cases:

* E is the reference: Sigma = 0. Ends may be free, or driven with the twist s_t E; both are exact.
* Sigma = (a Pi, a h + b Pi), see `helix.uniform_stress`: the right end is loaded with Sigma and the left with -Sigma,
  in the body, or both are driven with s_t E; the reference is E - K^-1 Sigma.

Nothing is stored; the power spent per length is s_t^2 E . Gamma E. Components: planar (3,) or spatial (6,).

Dimensions: u and s lengths; E (none, 1 / length); Gamma force x time / length^2 and force x time; j force / length
and force.
"""

import numpy as np
import numpy.typing as npt

from tests.references import helix

Array = npt.NDArray[np.float64]


def pose(turn: npt.ArrayLike, u: npt.ArrayLike, slid: float, base: npt.ArrayLike | None = None) -> Array:
    """Configurations at u when the rod has slid by `slid` = s(t) (length): (points, 3, 3) or (points, 4, 4).

    `base` is the configuration of u = 0 at s = 0, by default the identity.
    """
    return helix.closed_pose(turn, np.atleast_1d(np.asarray(u, dtype=float)) + slid, base)


def twist(turn: npt.ArrayLike, speed: float) -> Array:
    """The twist V of every section, and of driven ends, at the speed s_t (length / time): (3,) or (6,)."""
    return speed * np.asarray(turn, dtype=float)


def wrench(turn: npt.ArrayLike, friction: npt.ArrayLike, speed: float) -> Array:
    """The wrench density in body components, (3,) or (6,); friction is a diagonal or a matrix."""
    gamma = np.asarray(friction, dtype=float)
    return np.asarray((np.diag(gamma) if gamma.ndim == 1 else gamma) @ twist(turn, speed))


def power(turn: npt.ArrayLike, friction: npt.ArrayLike, speed: float, length: float) -> float:
    """What the wrench spends (force x length / time), all of it dissipated."""
    return float(length * wrench(turn, friction, speed) @ twist(turn, speed))
