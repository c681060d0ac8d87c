"""Rods whose motion is known in closed form: clamped at the origin, their curvature a(t) times a constant."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from geocosserat.results.solution import Solution

Array = NDArray[np.float64]
FRICTION = 0.3

SCENE = """title = "made up"
[rod]
motion = "planar"  # χ, 曲率: text beyond ASCII must survive
"""


def grid(elements: int, degree: int, length: float) -> tuple[Array, Array]:
    """Gauss-Lobatto nodes (N,) and Gauss points (Q,) of the rod."""
    highest = np.eye(degree + 1)[degree]
    nodes = np.concatenate(([-1.0], np.sort(legendre.legroots(legendre.legder(highest))), [1.0]))
    points = legendre.leggauss(degree)[0]
    left = np.arange(elements)[:, None]
    u = (left + (nodes[None, :-1] + 1) / 2).ravel()
    return np.append(u, elements) * length / elements, (left + (points + 1) / 2).ravel() * length / elements


def _turned(darboux: Array, theta: Array) -> tuple[Array, Array]:
    """Rotation exp(theta n^) and the integral of its first column over theta; n is along darboux."""
    n = darboux / np.linalg.norm(darboux)
    hat = np.cross(n, np.eye(3)).T  # hat @ v = n x v
    s, c = np.sin(theta)[..., None, None], (1 - np.cos(theta))[..., None, None]
    rotation = np.eye(3) + s * hat + c * hat @ hat
    angle = theta[..., None]
    path = angle * np.eye(3)[0] + (1 - np.cos(angle)) * hat[:, 0]
    path = path + (angle - np.sin(angle)) * (hat @ hat)[:, 0]
    return rotation, path


def rod(
    motion: str,
    darboux: tuple[float, float, float],
    amplitude: Callable[[Array], Array],
    rate: Callable[[Array], Array],
    *,
    length: float = 1.0,
    until: float = 2.0,
    driven: bool = False,
    frames: int = 41,
    elements: int = 2,
    degree: int = 6,
    **changes: Any,
) -> Solution:
    """A solution with curvature a(t) darboux and bending and twisting stiffness 1.

    The energy stored is a^2 |darboux|^2 length / 2. A rod that is not driven dissipates what it loses; a
    driven one dissipates FRICTION times its mean square curvature rate, and the work closes the ledger.
    """
    time = np.linspace(0.0, until, frames)
    u, u_point = grid(elements, degree, length)
    vector = np.array(darboux)
    curvature = float(np.linalg.norm(vector))
    a, adot = amplitude(time), rate(time)
    rotation, path = _turned(vector, a[:, None] * curvature * u)
    position = path / (a[:, None, None] * curvature)
    # r = path(u a) / a, so dr/dt = a'/a (u e_1 - r), in the moving frame; Omega = a' u darboux
    moved = np.einsum("tnji,tnj->tni", rotation, position)
    v = (adot / a)[:, None, None] * (u[:, None] * np.eye(3)[0] - moved)
    omega = adot[:, None, None] * u[:, None] * vector
    bent = a[:, None, None] * np.ones((len(u_point), 1)) * vector
    stretched = np.broadcast_to(np.eye(3)[0], bent.shape)
    energy = a**2 * curvature**2 * length / 2
    heat = FRICTION * np.mean(adot**2) * curvature**2 * length**3 * time
    dissipated = heat if driven else energy[0] - energy
    work = energy - energy[0] + dissipated
    turn = np.concatenate((stretched, bent), axis=-1)
    stress = np.concatenate((np.zeros_like(bent), bent), axis=-1)
    twist = np.concatenate((v, omega), axis=-1)
    angle = None
    if motion == "planar":
        kept = [0, 1, 5]
        position, rotation = position[..., :2], rotation[..., :2, :2]
        turn, stress, twist = turn[..., kept], stress[..., kept], twist[..., kept]
        angle = a[:, None] * vector[2] * u
    values: dict[str, Any] = {
        "scene": SCENE, "title": "made up", "motion": motion, "length": length,
        "time": time, "u": u, "u_point": u_point,
        "position": position, "rotation": rotation, "angle": angle,
        "twist": twist, "turn": turn, "stress": stress,
        "energy": energy, "dissipated": dissipated, "work": work,
        "method": "radau", "elements": elements, "degree": degree, "unknowns": turn[0].size, "backend": "c",
        "requested": 1e-6, "estimated": 0.1 + 0.2,
        "evaluations": {"rate": 120, "jacobian": 7, "steps": 31},
        "seconds": {"derive": 0.0, "compile": 0.0, "plan": 1 / 3, "solve": 0.012},
        "contents": {"fields": ["h1"], "operations": {"stress": 3}},
        "provenance": {"geocosserat": "0.1", "kernel": "abc"}, "reached": True, "reason": "",
    }
    return Solution(**(values | changes))


def rolling(**changes: Any) -> Solution:
    """A planar rod rolled up into a full circle by its ends."""
    return rod("planar", (0.0, 0.0, 2 * np.pi), lambda t: 0.02 + 0.49 * t, lambda t: 0.49 + 0 * t,
               **({"title": "rolling up", "driven": True} | changes))


def unrolling(**changes: Any) -> Solution:
    """A planar rod that relaxes from three quarters of a circle."""
    return rod("planar", (0.0, 0.0, 1.5 * np.pi), lambda t: np.exp(-2 * t), lambda t: -2 * np.exp(-2 * t),
               **({"title": "unrolling"} | changes))


def unwinding(**changes: Any) -> Solution:
    """A helix of three turns that relaxes."""
    return rod("spatial", (6.0, 0.0, 18.0), lambda t: np.exp(-1.2 * t), lambda t: -1.2 * np.exp(-1.2 * t),
               **({"title": "unwinding helix", "degree": 12} | changes))
