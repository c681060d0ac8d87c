"""Reflections, rotations and reversals of a rod, how they act on strain and stress, and what linear laws they allow.

All of it follows from phi' = phi E. Conjugation by a rotation or reflection q of the frame, phi -> Q phi Q^-1, makes of
a rod another, with E -> Q E Q^-1; so reflections turn the rotations in E as axial vectors. Running backwards,
phi(u) -> phi(-u), changes the sign of E; together with a q that turns e1 round it leaves the straight rod as it is.
The stress pairs with E to the power, so it goes with the inverse transpose. P. Curie, J. Phys. Theor. Appl. 3, 393
(1894); T. J. Healey, Math. Mech. Solids 7, 405 (2002).
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
import sympy as sp
from numpy.typing import NDArray
from sympy.polys.matrices import DomainMatrix

from geocosserat.algebra.groups import Group

Array = NDArray[Any]


@dataclass(frozen=True)
class Element:
    """A rotation or reflection of the section, with or without a reversal of the rod.

    ``name``: short; ``words``: in full. ``frame``: the orthogonal matrix q (space, space), exact. ``reverses``:
    whether the rod runs backwards.
    """

    name: str
    words: str
    frame: tuple[tuple[sp.Expr, ...], ...]
    reverses: bool

    @property
    def proper(self) -> bool:
        """Whether q is a rotation, so that a screw stays right-handed."""
        return bool(sp.Matrix(self.frame).det() == 1)


def action(group: Group, frame: Sequence[Sequence[Any]], reverses: bool) -> Array:
    """The matrix A of E -> A E, orthogonal, so that the stress goes with A too: (d, d), of exact entries."""
    q = np.eye(group.size, dtype=np.int64).astype(object)
    q[1:, 1:] = [list(row) for row in frame]
    moved: Array = group.Ad(q)
    return -moved if reverses else moved


def spin(group: Group) -> Array:
    """The matrix of E -> [b, E] with b the rotation about e1, by which rotations by any angle are generated: (d, d)."""
    about = np.zeros(group.dimension, dtype=np.int64)
    about[group.space] = 1
    generator: Array = group.ad(about)
    return generator


def about_axis(cosine: Any, sine: Any) -> tuple[tuple[Any, ...], ...]:
    """The rotation about e1 in space."""
    zero, one = sp.S.Zero, sp.S.One
    return ((one, zero, zero), (zero, cosine, -sine), (zero, sine, cosine))


def _diagonal(*entries: int) -> tuple[tuple[sp.Expr, ...], ...]:
    n = range(len(entries))
    return tuple(tuple(sp.Integer(entries[i] if i == j else 0) for j in n) for i in n)


def _turn(n: int) -> tuple[tuple[sp.Expr, ...], ...]:
    angle = 2 * sp.pi / n
    return about_axis(sp.cos(angle), sp.sin(angle))


def _reversed_quarter() -> tuple[tuple[sp.Expr, ...], ...]:
    first, *rest = _turn(4)
    return (tuple(-x for x in first), *rest)


PLANE: tuple[Element, ...] = (
    Element("m", "reflection about the rod's axis", _diagonal(1, -1), False),
    Element("mh", "reflection across the axis, with reversal", _diagonal(-1, 1), True),
    Element("C2", "half-turn in the plane, with reversal", _diagonal(-1, -1), True),
)
SPACE: tuple[Element, ...] = (
    Element("C2", "rotation about e1 by a half-turn", _turn(2), False),
    Element("C3", "rotation about e1 by a third of a turn", _turn(3), False),
    Element("C4", "rotation about e1 by a quarter of a turn", _turn(4), False),
    Element("C6", "rotation about e1 by a sixth of a turn", _turn(6), False),
    Element("m12", "reflection in the plane of e1 and e2", _diagonal(1, 1, -1), False),
    Element("m13", "reflection in the plane of e1 and e3", _diagonal(1, -1, 1), False),
    Element("mh", "reflection across e1, with reversal", _diagonal(-1, 1, 1), True),
    Element("D2", "half-turn about e2, with reversal", _diagonal(-1, 1, -1), True),
    Element("D3", "half-turn about e3, with reversal", _diagonal(-1, -1, 1), True),
    Element("i", "inversion, with reversal", _diagonal(-1, -1, -1), True),
    Element("S4", "quarter of a turn about e1 and reflection across it, with reversal", _reversed_quarter(), True),
)
ANY = "Cinf"
"""The name of rotations about e1 by any angle, which have a generator in place of a matrix."""


def elements_of(group: Group) -> tuple[Element, ...]:
    """The elements that are looked for in a law of the plane or of space."""
    return PLANE if group.rotations == 1 else SPACE


@lru_cache(maxsize=64)
def moduli(group: Group, names: frozenset[str]) -> tuple[int, int]:
    """How many symmetric and antisymmetric moduli a linear law has that these elements leave invariant.

    The dimensions of the spaces of tangents T with A T = T A for all of them (and G T = T G for the generator of
    rotations by any angle), by exact elimination.
    """
    d = group.dimension
    round_ = {ANY, "C3", "C4", "C6"}
    matrices = [action(group, e.frame, e.reverses) for e in elements_of(group) if e.name in names - round_]
    if names & round_:
        # rotations by a third of a turn or less leave no more tensors of rank two than those by any angle
        # (C. Hermann, Z. Kristallogr. 89, 32 (1934))
        matrices.append(spin(group).astype(object))
    return _commuting(matrices, d, 1), _commuting(matrices, d, -1)


def _commuting(matrices: Sequence[Array], d: int, sign: int) -> int:
    """Dimension of the space of matrices T = sign T^T that commute with all of these."""
    pairs = [(i, j) for i in range(d) for j in range(i if sign == 1 else i + 1, d)]
    if not matrices:
        return len(pairs)
    columns = []
    for i, j in pairs:
        unit = np.zeros((d, d), dtype=np.int64).astype(object)
        unit[i, j], unit[j, i] = 1, sign
        columns.append(np.concatenate([(m @ unit - unit @ m).ravel() for m in matrices]))
    rows = {tuple(row) for row in np.array(columns, dtype=object).T.tolist()}
    rows.discard((0,) * len(pairs))
    if not rows:
        return len(pairs)
    entries = [[sp.Integer(x) for x in row] for row in rows]
    return len(pairs) - int(DomainMatrix.from_list_sympy(len(rows), len(pairs), entries).to_field().rank())


def class_name(group: Group, found: Collection[str]) -> tuple[str, str]:
    """Schoenflies' name of the class, with e1 as its axis, and the same in words.

    C1h, D1, D1h and so on are kept apart from Cs, C2 and C2v, which they are but for the direction of the axis.
    """
    if group.rotations == 1:
        return _PLANE_CLASSES[frozenset(found)]
    order = next((n for n in ("inf", "6", "4", "3", "2") if f"C{n}" in found), "1")
    upright = {"m12", "m13"} & set(found)
    across = {"D2", "D3"} & set(found)
    if "mh" in found:
        name = f"D{order}h" if upright or across else f"C{order}h"
    elif (across and upright) or ("S4" in found and (across or upright)):
        name = f"D{order}d"
    elif across:
        name = f"D{order}"
    elif "S4" in found:
        name = "S4"
    elif "i" in found:
        name = "S6" if order == "3" else "S2"
    else:
        name = f"C{order}v" if upright else f"C{order}"
    return {"C1v": "Cs"}.get(name, name).replace("inf", "∞"), _words(order, bool(upright), found)


def _words(order: str, upright: bool, found: Collection[str]) -> str:
    section = {
        "1": "no rotation about its axis leaves it as it is",
        "inf": "alike in all directions across the axis (transversely isotropic)",
    }.get(order, f"{order}-fold about its axis")
    improper = {"m12", "m13", "mh", "i", "S4"} & set(found)
    mirrors = "with mirror planes through the axis" if order != "1" else "with a mirror plane through the axis"
    hand = mirrors if upright else "without mirror planes" if improper else "chiral"
    ends = {"mh", "D2", "D3", "i", "S4"} & set(found)
    return f"{section}; {hand}; {'alike' if ends else 'not alike'} when run backwards"


_PLANE_CLASSES = {
    frozenset(): ("C1", "no symmetry: the two sides of the rod differ, and so do its two directions"),
    frozenset({"m"}): ("Cs", "the two sides of the rod are alike, its two directions are not"),
    frozenset({"mh"}): ("C1h", "a mirror across the rod: alike when run backwards, with e2 kept"),
    frozenset({"C2"}): ("C2", "a half-turn: alike when run backwards, with e2 turned round"),
    frozenset({"m", "mh", "C2"}): ("C2v", "both sides of the rod are alike, and both its directions"),
}
