"""Charts of the two groups: what the frame is as a function of coordinates, and nothing that follows from it.

A configuration is a position (x, y in the plane, x, y, z in space; lengths) and a rotation matrix R whose
columns are the moving frame. A chart gives R by coordinates of its own, which are fields of (u, t); how turn,
twist and rates look in them is derived in `chart_maps`.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from types import MappingProxyType
from typing import Final

import numpy as np
import sympy as sp

from geocosserat.algebra.groups import SE2, SE3, Array, Group
from geocosserat.derivation import orientation
from geocosserat.derivation.notation import field as field_named
from geocosserat.derivation.notation import fields
from geocosserat.derivation.records import Equation, Equations, Vector

AXES: Final = "xyz"


@dataclass(frozen=True)
class Chart:
    """Coordinates of the rotations of a group, and the rotation matrix as a function of them.

    ``words``: what the coordinates mean, for readers. ``coordinates``: fields, dimensionless (angles in radians).
    ``rotation``: R, object array (space, space), of the coordinates, of ``size``, and of sines and cosines of single
    fields. ``where``: the singular set in words. ``singular`` vanishes exactly there, where the rates of the
    coordinates are unbounded or the chart ends; None if there is no such place. ``size``: if R contains the size of
    the coordinates, a power of its field and the polynomial of the coordinates that this is. ``abbreviations``:
    fields that stand for functions of the coordinates, each of those before it. ``constraints``: what the coordinates
    satisfy, if there are more of them than rotations.

    For the reduction to a readable form: ``unknowns``, what R and the maps are polynomials in, of which the first in
    a relation is eliminated by it; ``names``, polynomials that vanish and bring in the abbreviations;
    ``reciprocals``, the unknowns that stand for one over an expression.
    """

    name: str
    group: Group
    words: str
    coordinates: Vector
    rotation: Array = field(compare=False, repr=False)
    where: str
    singular: sp.Expr | None = None
    size: Equation | None = None
    abbreviations: Equations = ()
    constraints: Equations = ()
    unknowns: Vector = ()
    names: Vector = ()
    reciprocals: Mapping[sp.Expr, sp.Expr] = field(default_factory=dict, compare=False)

    @property
    def position(self) -> Vector:
        """The coordinates of the position: fields x, y(, z), lengths."""
        return fields(AXES[: self.group.space])


def frame(group: Group) -> Array:
    """Fields e1x, e1y, ... for the entries of R, row by world axis: object array (space, space)."""
    n = group.space
    names = [[f"e{i + 1}{axis}" for i in range(n)] for axis in AXES[:n]]
    return np.array([fields(row) for row in names], dtype=object)


def _angle() -> Chart:
    theta = field_named("theta")
    return Chart(
        name="angle",
        group=SE2,
        words="theta is the angle of e1 from the world's x axis; it counts full turns.",
        coordinates=(theta,),
        rotation=orientation.rotation(SE2),
        unknowns=(sp.sin(theta), sp.cos(theta)),
        where="None: every configuration has an angle, and the rates are bounded.",
    )


def _rotation_vector() -> Chart:
    w = fields(("theta1", "theta2", "theta3"))
    theta, c1, c2, c3, d1, d2 = fields(("theta", "c1", "c2", "c3", "d1", "d2"))
    square = sp.Add(*(x**2 for x in w))
    sin, cos, per_theta, per_versine = sp.sin(theta), sp.cos(theta), sp.Symbol("1/theta"), sp.Symbol("1/versine")
    rotation = cos * _one() + sin / theta * _cross(w) + (1 - cos) / theta**2 * _outer(w)
    return Chart(
        name="rotation-vector",
        group=SE3,
        words=(
            "The frame is the world's axes turned by the angle theta about the axis (theta1, theta2, theta3). "
            "At zero all is smooth: there c1 = 1, c2 = 1/2, c3 = 1/6, d1 = 1 and d2 = 1/12 (limits)."
        ),
        coordinates=w,
        rotation=rotation,
        where=(
            "Rotation vectors of length theta = 2 pi, 4 pi, ...: whole turns, where d1 and d2 are infinite. "
            "Zero is no such place. Every configuration has a vector of length pi or less."
        ),
        singular=c2,
        size=Equation(theta**2, square),
        abbreviations=(
            Equation(theta, sp.sqrt(square)),
            Equation(c1, sin / theta),
            Equation(c2, (1 - cos) / theta**2),
            Equation(c3, (1 - c1) / theta**2),
            Equation(d1, c1 / (2 * c2)),
            Equation(d2, (1 - d1) / theta**2),
        ),
        unknowns=(sin, per_versine, cos, d1, c1, per_theta, *w, theta, c2, c3, d2),
        names=(
            sin * per_versine - 2 * d1 * per_theta,
            sin * per_theta - c1,
            cos - 1 + c2 * theta**2,
            c1 * per_theta**2 - per_theta**2 + c3,
            d1 * per_theta**2 - per_theta**2 + d2,
        ),
        reciprocals=MappingProxyType({theta: per_theta, 1 - cos: per_versine}),
    )


def _quaternion() -> Chart:
    p = fields(("p0", "p1", "p2", "p3"))
    norm, per_norm = field_named("norm"), sp.Symbol("1/norm")
    square = sp.Add(*(x**2 for x in p))
    real, imaginary = p[0], p[1:]
    length = sp.Add(*(x**2 for x in imaginary))
    rotation = ((real**2 - length) * _one() + 2 * real * _cross(imaginary) + 2 * _outer(imaginary)) / norm
    return Chart(
        name="quaternion",
        group=SE3,
        words="p0 + i p1 + j p2 + k p3 is a unit quaternion; p and -p are the same frame.",
        coordinates=p,
        rotation=rotation,
        where="None: every configuration has two quaternions, and the rates are bounded.",
        size=Equation(norm, square),
        constraints=(Equation(square, sp.S.One),),
        unknowns=(per_norm, *p, norm),
        reciprocals=MappingProxyType({norm: per_norm}),
    )


def _cayley() -> Chart:
    g = fields(("g1", "g2", "g3"))
    D, per_D = field_named("D"), sp.Symbol("1/D")
    square = sp.Add(1, *(x**2 for x in g))
    length = square - 1
    rotation = ((1 - length) * _one() + 2 * _cross(g) + 2 * _outer(g)) / D
    e = frame(SE3)
    return Chart(
        name="cayley",
        group=SE3,
        words=(
            "The Gibbs vector (g1, g2, g3) lies along the axis of the rotation from the world's axes to the frame; "
            "its length is the tangent of half the angle."
        ),
        coordinates=g,
        rotation=rotation,
        where=(
            "Frames half a turn (pi) away from the world's axes, about whatever axis: the vector is infinite there, "
            "and with it its rates. No finite vector is singular."
        ),
        singular=1 + e[0, 0] + e[1, 1] + e[2, 2],
        size=Equation(D, square),
        abbreviations=(Equation(D, square),),
        unknowns=(per_D, *g, D),
        reciprocals=MappingProxyType({D: per_D}),
    )


def _euler() -> Chart:
    psi, theta, phi = fields(("psi", "theta", "phi"))
    per_cos = sp.Symbol("1/cos")
    rotation = _about(2, psi) @ _about(1, theta) @ _about(0, phi)
    return Chart(
        name="euler",
        group=SE3,
        words=(
            "Angles z-y'-x'': turn by psi about z, then by theta about the new y, then by phi about the newest x, "
            "which is e1; so R = Rz(psi) Ry(theta) Rx(phi)."
        ),
        coordinates=(psi, theta, phi),
        rotation=rotation,
        where="theta = pi/2 + any whole number of pi: where e1 points along the world's z axis, up or down.",
        singular=sp.cos(theta),
        unknowns=(*map(sp.sin, (psi, theta, phi)), per_cos, *map(sp.cos, (psi, theta, phi))),
        reciprocals=MappingProxyType({sp.cos(theta): per_cos}),
    )


def _matrix() -> Chart:
    e = frame(SE3)
    product = e.T @ e
    pairs = [(i, i) for i in range(3)] + [(1, 2), (2, 0), (0, 1)]
    return Chart(
        name="matrix",
        group=SE3,
        words=(
            "The entries of R themselves: e1x is the component of e1 along the world's x axis. "
            "The frame is right-handed: e3 is the cross product of e1 and e2."
        ),
        coordinates=tuple(e.T.ravel()),
        rotation=e,
        unknowns=tuple(e.T.ravel()),
        where="None: the nine entries are those of any frame, and the rates are bounded.",
        constraints=tuple(Equation(product[i, j], sp.Integer(i == j)) for i, j in pairs),
    )


# the first of each group is the one to take if none is asked for
_CHARTS: Final[Mapping[Group, Mapping[str, Callable[[], Chart]]]] = MappingProxyType(
    {
        SE2: MappingProxyType({"angle": _angle}),
        SE3: MappingProxyType(
            {
                "rotation-vector": _rotation_vector,
                "quaternion": _quaternion,
                "cayley": _cayley,
                "euler": _euler,
                "matrix": _matrix,
            }
        ),
    }
)


def chart_names(group: Group) -> tuple[str, ...]:
    """The charts of a group, the default first: "angle" in the plane, "rotation-vector" in space."""
    return tuple(_CHARTS[group])


@lru_cache(maxsize=16)
def chart_of(group: Group, name: str | None = None) -> Chart:
    """The chart of that name, or the default. Raises ValueError, naming the choices, if the group has none such."""
    names = chart_names(group)
    chosen = names[0] if name is None else name
    if chosen not in names:
        raise ValueError(f"chart: expected one of {', '.join(names)}, found {name!r}; choose one of these")
    return _CHARTS[group][chosen]()


def _one() -> Array:
    return np.eye(3, dtype=int).astype(object)


def _outer(v: Vector) -> Array:
    return np.outer(np.array(v, dtype=object), np.array(v, dtype=object))


def _cross(v: Vector) -> Array:
    """The matrix of v x, from the basis of the algebra."""
    return SE3.rotation(SE3.hat(np.array([0, 0, 0, *v], dtype=object)))


def _about(axis: int, angle: sp.Expr) -> Array:
    """The rotation by an angle about a world axis: one plus sine times generator plus versine times its square."""
    generator = _cross(tuple(int(axis == k) for k in range(3)))
    rotation: Array = _one() + sp.sin(angle) * generator + (1 - sp.cos(angle)) * (generator @ generator)
    return rotation
