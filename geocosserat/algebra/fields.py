"""Left-invariant vector fields X_a = (phi b_a)_ij d/d phi_ij: rates of change along the moving frame.

They act on functions of the entries of a configuration, numerically through the gradient and symbolically by
differentiation, and satisfy [X_a, X_b] = C_abc X_c.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from geocosserat.algebra.groups import Array, Group


def tangents(group: Group, g: Array) -> Array:
    """The matrices g b_a that the fields attach to g: (..., size, size) -> (..., d, size, size)."""
    g = np.asarray(g)
    basis = np.stack(group.basis)
    out: Array = g[..., None, :, :] @ (basis.astype(object) if g.dtype == object else basis)
    return out


def act(group: Group, g: Array, gradient: Array) -> Array:
    """X_a[f] at g from its gradient df/d phi_ij there: (..., size, size) twice -> (..., d)."""
    out: Array = (tangents(group, g) * np.asarray(gradient)[..., None, :, :]).sum(axis=(-2, -1))
    return out


def derivatives(group: Group, f: Any, phi: Array) -> Array:
    """X_a[f] of a symbolic f, where phi (size, size) has a symbol for each free entry: object array (d,).

    `symbolic.configuration` makes such a phi; entries that are plain numbers are constants of the group.
    """
    gradient = np.array([[f.diff(x) if hasattr(x, "diff") else 0 for x in row] for row in phi], dtype=object)
    return act(group, phi, gradient)
