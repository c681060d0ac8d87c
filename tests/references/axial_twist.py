"""Pure stretch or pure twist of a straight rod: linear diffusion, in closed form.

On a straight rest state (h1 = 1) stretch and twist each close on themselves, for any amplitude:

    friction * v1 = F1',   F1 = stiffness * (h1 - 1),   d/dt h1 = v1'   (for twist: Omega1, M1, Pi1)

so the excess strain e obeys friction * e_t = stiffness * e_uu. A clamped end has no velocity (e_u = 0), a
free end no stress (e = 0). Source: separation of variables; Carslaw and Jaeger, *Conduction of
Heat in Solids*, chapter III.

Dimensions: stiffness is force for stretch and force x length^2 for twist; friction is force x time / length^2
for stretch and force x time for twist; rates are 1 / time.
"""

from typing import Literal

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]
Ends = Literal["clamped-free", "free-free"]


def wave_numbers(length: float, number: int, ends: Ends) -> Array:
    """Wave numbers q_n (1 / length), shape (number,), slowest first."""
    order = np.arange(1, number + 1, dtype=float)
    return np.asarray((order - 0.5 if ends == "clamped-free" else order) * np.pi / length)


def decay_rates(stiffness: float, friction: float, length: float, number: int, ends: Ends) -> Array:
    """Rates stiffness / friction * q_n^2 (1 / time), shape (number,): mode n decays as exp(-rate_n t)."""
    return np.asarray(stiffness / friction * wave_numbers(length, number, ends) ** 2)


def strain_modes(u: npt.ArrayLike, length: float, number: int, ends: Ends) -> Array:
    """Excess strains at u (length), shape (number, points): cos(q u) if clamped at 0, sin(q u) if free."""
    phase = wave_numbers(length, number, ends)[:, None] * np.asarray(u, dtype=float)[None, :]
    return np.asarray(np.cos(phase) if ends == "clamped-free" else np.sin(phase))


def velocity_modes(
    u: npt.ArrayLike, stiffness: float, friction: float, length: float, number: int, ends: Ends
) -> Array:
    """Velocity of each strain mode, stiffness / friction * e': v1 (length / time) or Omega1 (1 / time)."""
    wave = wave_numbers(length, number, ends)[:, None]
    phase = wave * np.asarray(u, dtype=float)[None, :]
    return np.asarray(
        stiffness / friction * wave * (-np.sin(phase) if ends == "clamped-free" else np.cos(phase))
    )


def strain(
    u: npt.ArrayLike,
    t: float,
    amplitudes: npt.ArrayLike,
    stiffness: float,
    friction: float,
    length: float,
    ends: Ends,
) -> Array:
    """Excess strain e(u, t), shape (points,), that started as sum_n amplitudes_n * mode_n(u)."""
    start = np.asarray(amplitudes, dtype=float)
    decay = np.exp(-decay_rates(stiffness, friction, length, len(start), ends) * t)
    return np.asarray((start * decay) @ strain_modes(u, length, len(start), ends))


def loaded_strain(
    u: npt.ArrayLike,
    t: float,
    load: float,
    stiffness: float,
    friction: float,
    length: float,
    number: int = 200,
) -> Array:
    """Excess strain e(u, t) of a clamped-free rod whose free end is loaded from t = 0, at rest before.

    `load` is a force along the rod, or a torque about it. The series of `number` terms is exact to rounding
    once ``exp(-rate_number * t)`` is; that is, not at very early times.
    """
    wave = wave_numbers(length, number, "clamped-free")
    sign = (-1.0) ** np.arange(number)
    decay = np.exp(-decay_rates(stiffness, friction, length, number, "clamped-free") * t)
    series = (2.0 * sign / (wave * length) * decay) @ strain_modes(u, length, number, "clamped-free")
    return np.asarray(load / stiffness * (1.0 - series))


def loaded_tip(
    t: float, load: float, stiffness: float, friction: float, length: float, number: int = 200
) -> float:
    """Displacement (length) or turn (angle) of that free end: the integral of `loaded_strain`."""
    wave = wave_numbers(length, number, "clamped-free")
    decay = np.exp(-decay_rates(stiffness, friction, length, number, "clamped-free") * t)
    return float(load / stiffness * (length - np.sum(2.0 / (wave**2 * length) * decay)))
