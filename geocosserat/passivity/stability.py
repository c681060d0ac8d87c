"""Whether a law is well posed and stable: eigenvalues of friction^-1 T, definiteness of sym T, and where they are lost.

In short waves friction V = (stress)' and dE/dt = V' + ..., so dE/dt = (friction^-1 T E')' + ...: diffusion if all
eigenvalues of friction^-1 T have positive real parts (parabolic in the sense of Petrovskii), ill posed if one has a
negative one. Complex ones, of odd laws, make diffusion oscillate, no worse. Where the friction is symmetric and
positive definite, so is sym T > 0 enough: friction^-1/2 T friction^-1/2 then has a positive definite symmetric part.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np

from geocosserat.model.law import Law, Matrix
from geocosserat.passivity.definite import (
    definite_at,
    definite_over,
    rates_at,
    rates_over,
    semidefinite_at,
)
from geocosserat.passivity.losses import Loss, Measure, losses, worst
from geocosserat.passivity.maps import Sampled, StabilityMap, map_of, scale_of, weights_of
from geocosserat.passivity.minors import Conditions, conditions
from geocosserat.passivity.tangent import Floats, Grade, Tangent, least_definite, symmetric, tangent_of

_ROUNDING: Final = 1e-10  # of eigenvalues relative to the largest entry: what is smaller is taken for zero


@dataclass(frozen=True)
class Margin:
    """``least``: the least value found over the domain; ``where``: the strains there; ``rest``: at the reference."""

    least: float
    where: Mapping[str, float]
    rest: float


@dataclass(frozen=True)
class StabilityAnswer:
    """What is known of the tangent of a law over its domain.

    ``parabolic``: all eigenvalues of friction^-1 T (length^2 / time) have positive real parts; ``definite``: sym T is
    positive definite; ``convex``: the energy is convex, None also where there is none. None: not decided. ``grades``:
    of those that are decided. ``margins``: "definite" (sym T scaled to a unit diagonal at the reference), "unscaled",
    "parabolic". ``lost``: first losses, the nearest first for each. ``complex_eigenvalues``: of friction^-1 T, at some
    point of the sample. ``conditions``: on open parameters, by the same names. ``map``: None where nothing varies.
    """

    parabolic: bool | None
    definite: bool | None
    convex: bool | None
    grades: Mapping[str, Grade]
    margins: Mapping[str, Margin]
    lost: tuple[Loss, ...]
    complex_eigenvalues: bool
    assumptions: tuple[str, ...]
    map: StabilityMap | None
    how: str
    conditions: Mapping[str, Conditions] = field(default_factory=dict)
    not_checked: tuple[str, ...] = ()

    def fields(self) -> dict[str, Any]:
        """The same as numbers, texts, lists and dictionaries; what is not a finite number is None."""
        plain: dict[str, Any] = {
            "parabolic": self.parabolic,
            "definite": self.definite,
            "convex": self.convex,
            "grades": dict(self.grades),
            "margins": {
                name: {"least": _number(m.least), "where": dict(m.where), "rest": _number(m.rest)}
                for name, m in self.margins.items()
            },
            "lost": [
                {"what": loss.what, "where": dict(loss.where), "direction": loss.direction, "value": loss.value}
                for loss in self.lost
            ],
            "complex_eigenvalues": self.complex_eigenvalues,
            "conditions": {
                name: {
                    "inequalities": None if c.inequalities is None else list(c.inequalities),
                    "never": c.never, "where": c.where, "reason": c.reason,
                }
                for name, c in self.conditions.items()
            },
            "assumptions": list(self.assumptions),
            "not_checked": list(self.not_checked),
            "how": self.how,
        }  # fmt: skip
        plain["map"] = None if self.map is None else {
            "names": list(self.map.names),
            **{name: _rounded(getattr(self.map, name)) for name in ("x", "y", "definite", "parabolic")},
        }
        return plain


def stability(law: Law, conservative: bool | None = None) -> StabilityAnswer | None:
    """Whether a law is parabolic, its tangent definite, its energy convex; None if it has no stress.

    ``conservative``: whether the stress is known to have an energy; True for laws that are written so.
    """
    tangent = tangent_of(law)
    if tangent is None:
        return None
    conservative = True if law.energy is not None else conservative
    if tangent.open:
        return _with_open(law, tangent, conservative)
    return _with_numbers(tangent, conservative)


def _with_open(law: Law, tangent: Tangent, conservative: bool | None) -> StabilityAnswer:
    definite, parabolic = conditions(tangent, law.open)
    decided = {"definite": _of(definite), "parabolic": _of(parabolic)}
    # a diagonal friction of positive numbers: definite is enough
    names = ", ".join(tangent.open)
    missing = [f"{name}: {c.reason}" for name, c in (("definite", definite), ("parabolic", parabolic)) if c.reason]
    if tangent.variables:
        missing.append(
            f"stability away from the reference: the tangent depends on {names} and on {', '.join(tangent.variables)}; "
            f"give the parameters values"
        )
    convex = decided["definite"] if conservative and decided["definite"] else None
    grades: dict[str, Grade] = {name: "proved" for name, value in decided.items() if value is not None}
    if convex is not None:
        grades["convex"] = "proved"
    return StabilityAnswer(
        parabolic=decided["parabolic"],
        definite=decided["definite"],
        convex=convex,
        grades=grades,
        margins={},
        lost=(),
        complex_eigenvalues=False,
        assumptions=tangent.assumptions,
        map=None,
        how=f"principal minors and Hurwitz's determinants of the tangent {definite.where}, with {names} open",
        conditions={"definite": definite, "parabolic": parabolic},
        not_checked=tuple(missing),
    )


def _of(found: Conditions) -> bool | None:
    if found.never:
        return False
    return True if found.inequalities == () and found.where == "everywhere" else None


def _with_numbers(tangent: Tangent, conservative: bool | None) -> StabilityAnswer:
    rest = tangent.rest[None]
    at_rest = tangent.values(tangent.matrix, rest)[0]
    sampled = Sampled(tangent, scale_of(at_rest))
    points = tangent.sample()
    least = sampled.definite(points)
    rate, turned = sampled.rates(points)
    unscaled = least_definite(tangent.values(tangent.matrix, points), np.ones(len(at_rest)))
    where, margin = worst(sampled.definite, tangent, points, least)
    rate_where, rate_margin = worst(sampled.rate, tangent, points, rate)
    size = float(np.nanmax(np.abs(rate), initial=0.0))
    floors = {"definite": _ROUNDING, "parabolic": _ROUNDING * size}

    halves = symmetric(tangent.matrix)
    weights = weights_of(sampled)
    definite, definite_grade = _definite(tangent, halves, weights, where, margin)
    parabolic, parabolic_grade = _parabolic(
        tangent, weights, rate_where, rate_margin, floors["parabolic"],
        (definite_grade == "proved") if definite else None,
    )
    convex, convex_grade = _convex(tangent, halves, definite, definite_grade, margin, conservative)
    steps = any("steps" in a for a in tangent.assumptions)
    grades: dict[str, Grade] = {
        name: "sampled" if steps and value else grade
        for name, value, grade in (
            ("parabolic", parabolic, parabolic_grade), ("definite", definite, definite_grade),
            ("convex", convex, convex_grade),
        ) if value is not None
    }  # fmt: skip

    def lifted(measure: Measure, floor: float) -> Measure:
        def at(points: Floats) -> Floats:
            values = measure(points)
            return np.where(np.abs(values) <= floor, 0.0, values)

        return at

    lost = losses("definite", lifted(sampled.definite, floors["definite"]), tangent, points, least)
    lost += losses("parabolic", lifted(sampled.rate, floors["parabolic"]), tangent, points, rate)
    holes = int(np.isnan(least).sum())
    assumptions = tangent.assumptions
    if holes:
        assumptions += (f"the tangent has no value at {holes} of {len(points)} points; they are left out",)
    lowest = int(np.nanargmin(unscaled)) if not np.isnan(unscaled).all() else 0
    return StabilityAnswer(
        parabolic=parabolic,
        definite=definite,
        convex=convex,
        grades=grades,
        margins={
            "definite": Margin(margin, _named(tangent, where), float(least[0])),
            "unscaled": Margin(float(unscaled[lowest]), _named(tangent, points[lowest]), float(unscaled[0])),
            "parabolic": Margin(rate_margin, _named(tangent, rate_where), float(rate[0])),
        },
        lost=lost,
        complex_eigenvalues=bool(np.nanmax(turned, initial=0.0) > 1e-6),
        assumptions=assumptions,
        map=map_of(sampled, lost),
        how=_how(tangent, {"parabolic": parabolic, "definite": definite, "convex": convex}, grades, len(points)),
        not_checked=_not_checked(least, rate),
    )


def _definite(
    tangent: Tangent, halves: Matrix, weights: Floats, where: Floats, margin: float
) -> tuple[bool | None, Grade]:
    if np.isnan(margin):
        return None, "sampled"
    if margin <= _ROUNDING:
        proved = definite_at(halves, _named(tangent, where))
        return False, "proved" if proved is False else "sampled"
    return True, "proved" if definite_over(halves, tangent.ranges, weights) else "sampled"


def _parabolic(
    tangent: Tangent, weights: Floats, where: Floats, margin: float, floor: float, definite: bool | None
) -> tuple[bool | None, Grade]:
    """``definite``: whether sym T is proved to be positive definite, None if it is not so."""
    if np.isnan(margin):
        return None, "sampled"
    if margin <= floor:
        proved = rates_at(tangent.matrix, tangent.friction, _named(tangent, where))
        return False, "proved" if proved is False else "sampled"
    f = tangent.friction
    if not tangent.variables:
        return True, "proved" if rates_at(tangent.matrix, f, _named(tangent, where)) else "sampled"
    if definite is not None and f == tuple(zip(*f, strict=True)) and definite_over(f, tangent.ranges, weights):
        # as good as what is known of sym T; another attempt would find no more
        return True, "proved" if definite else "sampled"
    return True, "proved" if rates_over(tangent.matrix, f, tangent.ranges, weights) else "sampled"


def _convex(
    tangent: Tangent, halves: Matrix, definite: bool | None, grade: Grade, margin: float, conservative: bool | None
) -> tuple[bool | None, Grade]:
    """As definite, but zero eigenvalues do no harm."""
    if not conservative or definite is None:
        return None, "sampled"
    if definite or margin < -_ROUNDING:
        return definite, grade
    if not tangent.variables:
        exact = semidefinite_at(halves, _named(tangent, tangent.rest))
        return (True, "sampled") if exact is None else (exact, "proved")
    return True, "sampled"


def _not_checked(least: Floats, rate: Floats) -> tuple[str, ...]:
    good = ~np.isnan(least)
    if not good.any():
        return ("stability: the tangent has a value at none of the points tried",)
    return ("parabolic: the friction is singular",) if np.isnan(rate[good]).all() else ()


def _how(tangent: Tangent, values: Mapping[str, bool | None], grades: Mapping[str, Grade], points: int) -> str:
    ways = {
        "proved": "proved by enclosures over the divided domain" if tangent.variables else "proved by exact minors",
        "refuted": "refuted by enclosures at one strain" if tangent.variables else "refuted by exact minors",
        "sampled": f"sampled at {points} points (corners, axes, Sobol) and by pattern search",
    }

    def way(name: str) -> str:
        return "sampled" if grades[name] == "sampled" else "proved" if values[name] else "refuted"

    parts = {key: [name for name in grades if way(name) == key] for key in ways}
    return "; ".join(f"{', '.join(names)}: {ways[key]}" for key, names in parts.items() if names)


def _named(tangent: Tangent, point: Floats) -> dict[str, float]:
    return {r.name: float(x) for r, x in zip(tangent.ranges, point, strict=True)}


def _number(value: float) -> float | None:
    return value if np.isfinite(value) else None


def _rounded(values: Floats) -> list[Any]:
    """To six figures; None for what is not finite."""
    flat = [float(f"{v:.6g}") if np.isfinite(v) else None for v in values.ravel()]
    return flat if values.ndim == 1 else [flat[k : k + values.shape[1]] for k in range(0, len(flat), values.shape[1])]
