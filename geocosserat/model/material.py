"""What the rod is made of: stiffness, friction, the turn at rest, and the modes that are frozen."""

from __future__ import annotations

from geocosserat.algebra.groups import Group
from geocosserat.model.checks import check_all_finite, check_positive
from geocosserat.model.expressions import Number, constant, steps, symbols
from geocosserat.model.fields import ALONG_ROD, ALONG_ROD_IN_TIME, Names, Table, matrix, vector, word
from geocosserat.model.place import Found, shown
from geocosserat.model.records import Matrix, Vector


def read_stiffness(rod: Table, group: Group, names: Names) -> Matrix:
    """K, positive definite; of frozen modes too, though it then has no effect."""
    place, values = rod.at("stiffness")
    if "law" in rod:
        at, law = rod.at("law")
        raise at.unavailable("no law file", law, "write rod.stiffness instead")
    stiffness = matrix(place, values, names, ALONG_ROD, group.strain)
    check_positive(place, stiffness, names, group.strain, "a passive rod resists every deformation")
    return stiffness


def read_friction(rod: Table, group: Group, names: Names) -> Matrix:
    """Γ, positive definite, but for rotations whose row and column are literally zero: those have no friction."""
    place, values = rod.at("friction")
    friction = matrix(place, values, names, ALONG_ROD, group.twist)
    damped = [i for i in range(group.dimension) if i < group.translations or not _zero(friction, i)]
    rows = [[friction[i][j] for j in damped] for i in damped]
    hint = "every motion must be damped; only a rotation may go without, by the number 0 in its whole row"
    check_positive(place, rows, names, [group.twist[i] for i in damped], hint)
    return friction


def _zero(m: Matrix, i: int) -> bool:
    """Whether row and column i are literally zero, whatever the parameters are."""
    return all(constant(e) == 0.0 for e in (*m[i], *(row[i] for row in m)))


def read_reference(rod: Table, group: Group, names: Names, until: float) -> Vector:
    """The turn at rest, which may change in time but not jump; straight and unsheared if the scene has none."""
    if "reference" not in rod:
        return (Number(1.0), *(Number(0.0) for _ in group.strain[1:]))
    place, values = rod.at("reference")
    reference = vector(place, values, names, ALONG_ROD_IN_TIME, group.strain)
    check_all_finite(place, reference, names, until)
    for i, e in enumerate(reference):
        if any("t" in symbols(step) for step in steps(e)):
            found = Found(f"{shown(values[i])}, which jumps in time")
            raise place.at(i).wrong("a reference that changes smoothly in time", found, "write a steep tanh instead")
    return reference


def read_frozen(rod: Table, group: Group) -> tuple[str, ...]:
    """Modes held at their reference, each once and in the order of the group; never all of them."""
    if "frozen" not in rod:
        return ()
    place, modes = rod.at("frozen")
    if not isinstance(modes, list):
        raise place.wrong("a list of modes", modes, f"choose from {', '.join(group.strain)}")
    named = {word(place.at(i), mode, group.strain) for i, mode in enumerate(modes)}
    if len(named) == group.dimension:
        found = Found("every mode frozen")
        raise place.wrong("a mode that is free", found, "leave one out: a rigid body is not a rod")
    return tuple(mode for mode in group.strain if mode in named)
