"""A constitutive law as a file says it: stress of the turn, wrench of the configuration, friction of the twist."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Final, Literal, TypeAlias

from geocosserat.algebra.groups import Group, group_of
from geocosserat.model.describe import matrix_text, named_text, number_text
from geocosserat.model.expressions import (
    RESERVED,
    Expression,
    ExpressionError,
    Number,
    derivative,
    fixed,
    parse,
    symbols,
)
from geocosserat.model.fields import Names, Table, number, numbers, word
from geocosserat.model.parameters import read_parameters
from geocosserat.model.place import NOTHING, Found, Place
from geocosserat.model.reading import read
from geocosserat.model.schema import MOTIONS
from geocosserat.model.toml_text import to_toml

Vector: TypeAlias = tuple[Expression, ...]
Matrix: TypeAlias = tuple[tuple[Expression, ...], ...]
Sign: TypeAlias = Literal["real", "positive"]

LAW_KEYS: Final = (
    "name", "motion", "parameters", "reference", "domain", "stress", "energy", "wrench", "friction",
)  # fmt: skip
PARTS: Final = ("stress", "energy", "wrench", "friction")


def rates(group: Group) -> tuple[str, ...]:
    """Names of the rates of the turn, for laws that are viscous: ``h1_dot`` (1 / time), ..., ``Pi_dot``."""
    return tuple(f"{name}_dot" for name in group.strain)


def at_rest(e: Expression, group: Group) -> Expression:
    """A component of a stress where no strain changes."""
    for name in rates(group):
        e = fixed(e, name, 0.0)
    return e


def pose_names(group: Group) -> tuple[str, ...]:
    """Names of a configuration: x, y, theta in the plane; in space x, y, z and e1x, e1y, ... e3z, the frame's axes."""
    if group.rotations == 1:
        return ("x", "y", "theta")
    return ("x", "y", "z", *(f"e{i}{axis}" for i in (1, 2, 3) for axis in "xyz"))


@dataclass(frozen=True, slots=True)
class Law:
    """A law of one motion; expressions keep the names of its parameters.

    ``reference``: the turn that energies are counted from, d numbers. ``domain``: intervals of strain components in
    which the law is meant; what is not named is not bounded. ``stress``: d expressions of the turn, its rates, u and
    t (force, force x length), or None. ``energy``: the density (force) of which the stress, at rates of zero, is the
    gradient but for the ``remainder``, d expressions, empty if there is none; None if no energy is known. ``wrench``: d
    expressions of the configuration, u and t, in the moving frame (force / length, force), or None. ``friction``: d x d
    expressions of u, or None. ``parameters``: the values of those that have one; ``open``: those left open, and whether
    they are positive. ``source``: TOML text that reads back as this law.
    """

    name: str
    group: Group
    reference: tuple[float, ...]
    domain: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    stress: Vector | None = None
    energy: Expression | None = None
    remainder: Vector = ()
    wrench: Vector | None = None
    friction: Matrix | None = None
    parameters: Mapping[str, float] = field(default_factory=dict)
    open: Mapping[str, Sign] = field(default_factory=dict)
    source: str = ""
    path: str | None = None

    @property
    def viscous(self) -> bool:
        """Whether the stress depends on the rate of the turn."""
        return any(symbols(e) & set(rates(self.group)) for e in self.stress or ())

    def __str__(self) -> str:
        group = self.group
        lines = [f"{self.name}, a law in {group.name}"]
        if self.energy is not None:
            lines.append(f"  energy     {named_text([self.energy], ['density'])}")
        if self.stress is not None:
            lines.append(f"  stress     {named_text(self.stress, group.stress)}")
        if self.wrench is not None:
            lines.append(f"  wrench     {named_text(self.wrench, group.wrench)}")
        if self.friction is not None:
            lines.append(f"  friction   {matrix_text(self.friction, group.twist)}")
        for name, (low, high) in self.domain.items():
            lines.append(f"  domain     {number_text(low)} <= {name} <= {number_text(high)}")
        values = [f"{name} = {number_text(value)}" for name, value in self.parameters.items()]
        values += [f"{name} {'> 0' if sign == 'positive' else 'open'}" for name, sign in self.open.items()]
        if values:
            lines.append(f"  parameters {', '.join(values)}")
        return "\n".join(lines)


def load_law(law: str | os.PathLike[str] | Mapping[str, Any], values: Mapping[str, float] | None = None) -> Law:
    """Read and check a law from a TOML file, TOML text (a str with a line break) or a mapping.

    ``values``: of parameters, which take the place of the law's own. Raises InputError, with one message that says
    what to do, for anything wrong in it; nothing is evaluated but by the whitelist parser of expressions.
    """
    given = read(law, "law")
    read_law = law_of(Place(given.file), given.values, values or {})
    return replace(read_law, source=given.text if given.text is not None else to_toml(given.values), path=given.path)


def law_of(place: Place, values: Any, given: Mapping[str, float]) -> Law:
    """The law that plain tables say. Raises InputError as `load_law`."""
    table = Table(place, values, LAW_KEYS)
    group = group_of(word(*table.at("motion"), MOTIONS))
    name = _name(*table.at("name")) if "name" in table else "unnamed law"
    parameters, opened = _parameters(table, group, given)
    if "stress" in table and "energy" in table:
        raise table.at("energy")[0].wrong("either [stress] or [energy]", Found("both"), "remove one")
    if not any(part in table for part in PARTS):
        raise place.wrong("[stress], [energy], [wrench] or [friction]", NOTHING, "write one of these tables")
    known = (*parameters, *opened)
    names = Names(parameters)
    reference = (1.0,) + (0.0,) * (group.dimension - 1)
    if "reference" in table:
        reference = numbers(*table.at("reference"), names, group.strain)
    turn = (*group.strain, *known, "u", "t")
    energy = _energy(*table.at("energy"), turn) if "energy" in table else None
    stress = None
    if energy is not None:
        stress = tuple(derivative(energy, e) for e in group.strain)
    elif "stress" in table:
        stress = _components(*table.at("stress"), group.stress, (*turn, *rates(group)))
    wrench = None
    if "wrench" in table:
        wrench = _components(*table.at("wrench"), group.wrench, (*pose_names(group), *known, "u", "t"))
    return Law(
        name=name,
        group=group,
        reference=reference,
        domain=_domain(*table.at("domain"), group, names, reference) if "domain" in table else {},
        stress=stress,
        energy=energy,
        wrench=wrench,
        friction=_friction(*table.at("friction"), group, (*known, "u")) if "friction" in table else None,
        parameters=parameters,
        open=opened,
        source=to_toml(values),
    )


def _name(place: Place, value: Any) -> str:
    if not isinstance(value, str) or not value.isprintable() or not 0 < len(value) <= 200:
        raise place.wrong("one line of at most 200 characters", value, "write a name in quotes")
    return value


def _parameters(table: Table, group: Group, given: Mapping[str, float]) -> tuple[dict[str, float], dict[str, Sign]]:
    """Those with a value, and those left open."""
    if "parameters" not in table:
        return {}, {}
    place, values = table.at("parameters")
    read_parameters(place, dict.fromkeys(values, 0) if isinstance(values, dict) else values)  # names, and how many
    meant = {*RESERVED, *group.strain, *rates(group), *pose_names(group)}
    for name in values:
        if name in meant:
            found = Found(f"{name}, which the expressions of a {group.name} law know")
            raise place.at(name).wrong("a name of your own", found, "rename it")
    filled = {name: given.get(name, value) for name, value in values.items()}
    opened = {name: _sign(place.at(name), value) for name, value in filled.items() if isinstance(value, dict)}
    return read_parameters(place, {name: value for name, value in filled.items() if name not in opened}), opened


def _sign(place: Place, value: dict[str, Any]) -> Sign:
    table = Table(place, value, ("symbol", "positive"))
    at, symbol = table.at("symbol")
    if symbol is not True:
        raise at.wrong("symbol = true", NOTHING if symbol is None else symbol, "or write a number for the parameter")
    at, positive = table.at("positive")
    if positive not in (None, True, False):
        raise at.wrong("true or false", positive)
    return "positive" if positive else "real"


def _energy(place: Place, value: Any, names: Iterable[str]) -> Expression:
    at, density = Table(place, value, ("density",)).at("density")
    return _expression(at, density, names)


def _components(place: Place, value: Any, components: tuple[str, ...], names: Iterable[str]) -> Vector:
    """One expression for each component; what is not written is zero."""
    table = Table(place, value, components)
    if not value:
        raise place.wrong(f"some of {', '.join(components)}", NOTHING, "write one expression a component")
    return tuple(_expression(*table.at(c), names) if c in table else Number(0.0) for c in components)


def _expression(place: Place, value: Any, names: Iterable[str]) -> Expression:
    known = tuple(names)
    what = "a number or an expression"
    if isinstance(value, bool) or not isinstance(value, int | float | str):
        raise place.wrong(what, NOTHING if value is None else value, "write a number, or an expression in quotes")
    if value in (float("inf"), float("-inf")) or value != value:
        raise place.wrong("a finite number", value)
    try:
        return parse(value, known)
    except ExpressionError as error:
        raise place.wrong(f"{what} of {', '.join(known[:40])}", value, str(error)) from None


def _friction(place: Place, value: Any, group: Group, names: Iterable[str]) -> Matrix:
    """A full matrix as rows, or its diagonal."""
    at, rows = Table(place, value, ("matrix",)).at("matrix")
    d, known = group.dimension, tuple(names)
    what = f"a list of {d} ({', '.join(group.twist)}) or of as many rows"
    if not isinstance(rows, list) or len(rows) != d:
        found = Found(f"a list of {len(rows)}") if isinstance(rows, list) else NOTHING if rows is None else rows
        raise at.wrong(what, found, f"write {d} entries")
    if not any(isinstance(row, list) for row in rows):
        diagonal = [_expression(at.at(i), e, known) for i, e in enumerate(rows)]
        return tuple(tuple(e if i == j else Number(0.0) for j in range(d)) for i, e in enumerate(diagonal))
    for i, row in enumerate(rows):
        if not isinstance(row, list) or len(row) != d:
            found = Found(f"a list of {len(row)}") if isinstance(row, list) else row
            raise at.at(i).wrong(f"a list of {d}", found, f"write {d} entries")
    return tuple(tuple(_expression(at.at(i).at(j), e, known) for j, e in enumerate(row)) for i, row in enumerate(rows))


def _domain(
    place: Place, value: Any, group: Group, names: Names, reference: tuple[float, ...]
) -> dict[str, tuple[float, float]]:
    """Intervals that hold the reference."""
    table = Table(place, value, group.strain)
    return dict(_intervals(table, group, names, reference))


def _intervals(
    table: Table, group: Group, names: Names, reference: tuple[float, ...]
) -> Iterator[tuple[str, tuple[float, float]]]:
    for name, rest in zip(group.strain, reference, strict=True):
        if name not in table:
            continue
        place, ends = table.at(name)
        if not isinstance(ends, list) or len(ends) != 2:
            raise place.wrong("two numbers, the least and the greatest strain", ends, "write for example [0.5, 2]")
        low, high = (number(place.at(i), end, names) for i, end in enumerate(ends))
        if not low < high:
            raise place.wrong("the least before the greatest", ends, "write them in that order")
        if not low <= rest <= high:
            found = Found(f"{number_text(rest)}, outside [{number_text(low)}, {number_text(high)}]")
            raise place.wrong(f"an interval that holds the reference of {name}", found, "change the one or the other")
        yield name, (low, high)
