"""What the rod is made of: stiffness or a law, friction, the turn at rest, and the modes that are frozen."""

from __future__ import annotations

import math

from geocosserat.algebra.groups import Group
from geocosserat.model.checks import check_all_finite, check_positive
from geocosserat.model.expressions import Number, constant, derivative, evaluate, steps, symbols
from geocosserat.model.fields import ALONG_ROD, ALONG_ROD_IN_TIME, Names, Table, matrix, vector, word
from geocosserat.model.law import Law, at_rest
from geocosserat.model.place import Found, shown
from geocosserat.model.records import Matrix, Vector


def read_stiffness(rod: Table, group: Group, names: Names, law: Law | None, reference: Vector) -> Matrix:
    """K, positive definite; of frozen modes too, though it then has no effect. Of a law its tangent at the reference,
    whatever that is."""
    place, values = rod.at("stiffness")
    if law is not None and law.stress is not None:
        if "stiffness" in rod:
            raise place.wrong("either rod.stiffness or rod.law", Found("both"), "remove one")
        return _about(law.stress, group, names, reference)
    stiffness = matrix(place, values, names, ALONG_ROD, group.strain)
    check_positive(place, stiffness, names, group.strain, "a passive rod resists every deformation")
    return stiffness


def _about(stress: Vector, group: Group, names: Names, reference: Vector) -> Matrix:
    """The tangent of a law at rest at the reference, mid-rod, in numbers; zero where it has no value."""
    middle: dict[str, float] = {**names.parameters, "u": names.length / 2, "t": 0.0}
    at = middle | {name: float(evaluate(e, middle)) for name, e in zip(group.strain, reference, strict=True)}
    values = [[float(evaluate(derivative(at_rest(e, group), name), at)) for name in group.strain] for e in stress]
    return tuple(tuple(Number(x if math.isfinite(x) else 0.0) for x in row) for row in values)


def read_friction(rod: Table, group: Group, names: Names, law: Law | None) -> Matrix:
    """Γ, positive definite, but for rotations whose row and column are zero whatever the parameters are: those have no
    friction, and the number 0 there. That of the law if the rod has none of its own."""
    place, values = rod.at("friction")
    if "friction" not in rod and law is not None and law.friction is not None:
        place, friction = rod.at("law")[0].at("friction"), law.friction
    else:
        friction = matrix(place, values, names, ALONG_ROD, group.twist)
    damped = [i for i in range(group.dimension) if i < group.translations or not _zero(friction, i)]
    rows = [[friction[i][j] for j in damped] for i in damped]
    hint = "every motion must be damped; only a rotation may go without, by the number 0 in its whole row"
    check_positive(place, rows, names, [group.twist[i] for i in damped], hint)
    every = range(group.dimension)
    return tuple(tuple(friction[i][j] if i in damped and j in damped else Number(0.0) for j in every) for i in every)


def _zero(m: Matrix, i: int) -> bool:
    """Whether row and column i come to zero without any name in them."""
    return all(constant(e) == 0.0 for e in (*m[i], *(row[i] for row in m)))


def read_reference(rod: Table, group: Group, names: Names, until: float, law: Law | None) -> Vector:
    """The turn at rest, which may change in time but not jump; that of the law, else straight and unsheared, if the
    scene has none."""
    if "reference" not in rod:
        return tuple(Number(x) for x in (law.reference if law else (1.0,) + (0.0,) * (group.dimension - 1)))
    place, values = rod.at("reference")
    reference = vector(place, values, names, ALONG_ROD_IN_TIME, group.strain)
    check_all_finite(place, reference, names, until)
    for i, e in enumerate(reference):
        if any("t" in symbols(step) for step in steps(e)):
            found = Found(f"{shown(values[i])}, which jumps in time")
            raise place.at(i).wrong("a reference that changes smoothly in time", found, "write a steep tanh instead")
        if law is not None and "t" in symbols(e):
            found = Found(f"{shown(values[i])}, which depends on t")
            raise place.at(i).wrong("a reference that rests, since the rod has a law", found, "write t in the law")
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
