"""A closed loop of strain whose net work is certified: what shows that a stress is not conservative."""

from __future__ import annotations

import math
import random
import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Final, Literal, TypeAlias

import numpy as np
from flint import arb
from numpy.typing import NDArray

from geocosserat.model.expressions import Binary, Call, Expression, Number, Symbol, derivative, evaluate, symbols
from geocosserat.passivity.balls import EVALUATIONS, PARAMETER, ball_of, line_integral, precision
from geocosserat.passivity.ranges import Range

Floats: TypeAlias = NDArray[np.float64]
Plane: TypeAlias = tuple[int, int]

_RADII: Final = tuple(Fraction(r) for r in ("1/10", "1/2", "1/50", "1", "2", "1/1000"))
_OFFSETS: Final = tuple(Fraction(r) for r in ("1/5", "-1/5", "1/2", "-1/2", "1", "-1", "2", "-2"))
_NODES: Final = 128
_CLEAR: Final = 1e-6
"""Net work over the work of its pieces above which double precision is trusted to choose a loop."""
_BITS: Final = (64, 128, 256, 512, 1024, 2048)
_RANDOM: Final = 40
_FEW: Final = 1000
_TRIED: Final = 4


@dataclass(frozen=True)
class Loop:
    """The ellipse centre + radii[0] cos(2 pi s) e_first + radii[1] sin(2 pi s) e_second, 0 <= s <= 1.

    centre: d strain components, exact. work: what the law gives to its surroundings over one cycle, minus the integral
    of the stress times the change of strain (force x length per length of rod: a density); above zero by the choice of
    which component is first. low, high: certified bounds of it. parameters: values of what the law leaves open, of u
    and of t, at which this holds.
    """

    centre: tuple[Fraction, ...]
    first: int
    second: int
    radii: tuple[Fraction, Fraction]
    work: float
    low: float
    high: float
    bits: int
    parameters: Mapping[str, Fraction]
    kind: Literal["ellipse"] = "ellipse"

    def path(self, strain: Sequence[str]) -> dict[str, Expression]:
        """The strain components as expressions of ``s``."""
        path = {name: exact_number(c) for name, c in zip(strain, self.centre, strict=True)}
        angle = Binary("*", Binary("*", Number(2.0), Number(math.pi)), Symbol(PARAMETER))
        for index, radius, function in ((self.first, self.radii[0], "cos"), (self.second, self.radii[1], "sin")):
            name = strain[index]
            path[name] = path[name] + exact_number(radius) * Call(function, angle)
        return path


def exact_number(value: Fraction) -> Expression:
    """An expression that is exactly a rational number."""
    number = float(value)
    short = Fraction(repr(number))
    if short == value:
        return Number(number)
    if value.denominator == 1:  # more digits than a number has
        return Binary("+", Number(number), exact_number(value - short))
    return Binary("/", exact_number(Fraction(value.numerator)), exact_number(Fraction(value.denominator)))


def work_of(
    stress: Sequence[Expression],
    strain: Sequence[str],
    loop: Loop,
    bits: int = 128,
    tolerance: float | None = None,
    evaluations: int = EVALUATIONS,
) -> arb:
    """An enclosure of what the law gives over one cycle of a loop."""
    path = loop.path(strain)
    moving = (strain[loop.first], strain[loop.second])
    with precision(bits):
        values = {name: ball_of(value) for name, value in loop.parameters.items()}
        fixed = {name: ball_of(c) for name, c in zip(strain, loop.centre, strict=True) if name not in moving}
        form = {name: e for name, e in zip(strain, stress, strict=True) if name in moving}
        goal = arb(tolerance) if tolerance else None
        way = {name: path[name] for name in moving}
        return -line_integral(form, way, {**values, **fixed}, tolerance=goal, evaluations=evaluations)


def find_loop(
    stress: Sequence[Expression],
    strain: Sequence[str],
    reference: Sequence[Fraction],
    box: Mapping[str, Range],
    planes: Sequence[Plane],
    values: Sequence[Mapping[str, Fraction]] = ({},),
    centres: Sequence[Sequence[Fraction]] = (),
    deep: bool = True,
    wide: bool = True,
    seconds: float = 5.0,
) -> Loop | None:
    """A loop with certified net work, the simplest that is found; None if none is.

    ``planes``: pairs of strain components to look in. ``values``: choices of what is open, the best first.
    ``centres``: points to look around beside the reference. ``deep``: rise to thousands of bits, where double
    precision sees nothing. ``wide``: look further than around the reference and ``centres``.
    ``seconds``: bound on each of the two searches.
    """
    until = time.monotonic() + seconds
    for chosen in values:
        for stage in _stages(reference, box, centres, wide):
            clear = _promising(stress, strain, box, planes, chosen, stage)
            for share, loop in clear[:_TRIED]:
                if time.monotonic() > until:
                    return None
                if (found := _certified(stress, strain, loop, (64, 128, 256), share)) is not None:
                    return found
    if not deep:
        return None
    until = time.monotonic() + seconds
    for bits in _BITS:
        for chosen in values:
            for centre in (*centres, tuple(reference), *(p for p, _ in _around(reference, box, Fraction(1, 5)))):
                for i, j in planes:
                    if time.monotonic() > until:
                        return None
                    drawn = _loop(centre, (i, j), Fraction(1, 10), strain, box, chosen)
                    if drawn is not None and (found := _certified(stress, strain, drawn, (bits,), None)) is not None:
                        return found
    return None


def _stages(
    reference: Sequence[Fraction], box: Mapping[str, Range], centres: Sequence[Sequence[Fraction]], wide: bool
) -> Iterator[list[tuple[Fraction, ...]]]:
    yield [*(tuple(c) for c in centres), tuple(reference)]
    if not wide:
        return
    yield [p for offset in _OFFSETS for p, _ in _around(reference, box, offset)]
    chance = random.Random(1)
    names = list(box)
    points = []
    for k in range(_RANDOM):
        width = Fraction(1 + k % 4, 2)
        point = [c + width * Fraction(chance.randrange(-20, 21), 20) for c in reference]
        points.append(tuple(_kept(x, box[name]) for x, name in zip(point, names, strict=True)))
    yield points


def _kept(x: Fraction, interval: Range) -> Fraction:
    low, high = interval
    if not math.isinf(low) and x <= low:
        return Fraction(low) + Fraction(1, 8) * (1 if math.isinf(high) else Fraction(high) - Fraction(low))
    if not math.isinf(high) and x >= high:
        return Fraction(high) - Fraction(1, 8) * (1 if math.isinf(low) else Fraction(high) - Fraction(low))
    return x


def _around(
    reference: Sequence[Fraction], box: Mapping[str, Range], offset: Fraction
) -> Iterator[tuple[tuple[Fraction, ...], str]]:
    for i, (name, interval) in enumerate(box.items()):
        x = reference[i] + offset
        if interval[0] < x < interval[1]:
            yield (*reference[:i], x, *reference[i + 1 :]), name


def _loop(
    centre: Sequence[Fraction],
    plane: Plane,
    radius: Fraction,
    strain: Sequence[str],
    box: Mapping[str, Range],
    values: Mapping[str, Fraction],
) -> Loop | None:
    """A loop inside the box; smaller across than along where the box is thin."""
    radii = []
    for index in plane:
        low, high = box[strain[index]]
        room = min(centre[index] - low, high - centre[index])
        if room <= 0:
            return None
        radii.append(radius if radius <= room else _simple(room))
    return Loop(tuple(centre), plane[0], plane[1], (radii[0], radii[1]), 0.0, 0.0, 0.0, 0, dict(values))


def _simple(room: Any) -> Fraction:
    """A power of ten times 1, 2 or 5 that is not larger."""
    power = Fraction(10) ** math.floor(math.log10(float(room)))
    return max(f * power for f in (Fraction(1, 2), Fraction(1), Fraction(2), Fraction(5)) if f * power <= room)


def _promising(
    stress: Sequence[Expression],
    strain: Sequence[str],
    box: Mapping[str, Range],
    planes: Sequence[Plane],
    values: Mapping[str, Fraction],
    centres: Sequence[Sequence[Fraction]],
) -> list[tuple[float, Loop]]:
    """Loops of which double precision is sure, the clearest first."""
    # between the axes, where laws may have no value
    angle = 2 * np.pi * (np.arange(_NODES) + 0.5) / _NODES
    found: list[tuple[float, float, Loop]] = []
    for centre in centres:
        for radius in _RADII:
            for i, j in planes:
                loop = _loop(centre, (i, j), radius, strain, box, values)
                if loop is None:
                    continue
                env: dict[str, Any] = {name: float(v) for name, v in values.items()}
                env |= {name: float(c) for name, c in zip(strain, centre, strict=True)}
                a, b = (float(r) for r in loop.radii)
                env[strain[i]] = float(centre[i]) + a * np.cos(angle)
                env[strain[j]] = float(centre[j]) + b * np.sin(angle)
                along = -a * np.sin(angle) * evaluate(stress[i], env)
                across = b * np.cos(angle) * evaluate(stress[j], env)
                pieces = along + across
                size = float(np.sum(np.abs(along) + np.abs(across)))
                net = float(np.sum(pieces))
                if not (math.isfinite(net) and size > 0 and abs(net) > _CLEAR * size):
                    continue
                if abs(net - 2 * float(np.sum(pieces[::2]))) < abs(net) / 4:
                    work = -2 * math.pi * net / _NODES
                    found.append((abs(net) / size, work, loop if work > 0 else _turned(loop)))
        if found and found[0][0] > 1e-2:
            break
    # simple radii first where the share is much the same
    order = {radius: k for k, radius in enumerate(_RADII)}
    found.sort(key=lambda item: (-min(round(math.log10(item[0])), -2), order.get(item[2].radii[0], 9), -item[0]))
    return [(abs(work), loop) for _, work, loop in found]


def _turned(loop: Loop) -> Loop:
    """The same way backwards."""
    return Loop(
        loop.centre, loop.second, loop.first, (loop.radii[1], loop.radii[0]), loop.work, loop.low, loop.high,
        loop.bits, loop.parameters,
    )  # fmt: skip


def _certified(
    stress: Sequence[Expression], strain: Sequence[str], loop: Loop, rising: Sequence[int], expected: float | None
) -> Loop | None:
    for bits in rising:
        with precision(bits):
            tolerance = None if expected is None else expected * 2.0**-30
            work = work_of(stress, strain, loop, bits, tolerance, _FEW if expected else EVALUATIONS)
            if not work.is_finite():
                return None
            if work.contains(0):
                continue
            if work < 0:
                loop, work = _turned(loop), -work
            low, high = float(work.lower()), float(work.upper())
            return Loop(
                loop.centre, loop.first, loop.second, loop.radii, float(work.mid()),
                math.nextafter(low, -math.inf), math.nextafter(high, math.inf), bits, loop.parameters,
            )  # fmt: skip
    return None


def curl_on_grid(
    stress: Sequence[Expression],
    strain: Sequence[str],
    loop: Loop,
    half_widths: tuple[float, float] | None = None,
    count: int = 81,
) -> tuple[Floats, Floats, Floats]:
    """First strain component, second one, and the curl d Sigma_second / d E_first - d Sigma_first / d E_second.

    On a square grid of ``count`` points each way around the centre of a loop, three times its radii wide if not
    given; the arrays are (count, count), not a number where the law is not defined. The net work of a loop is minus
    the integral of the curl over its inside, where the law is smooth.
    """
    a, b = half_widths or (3 * float(loop.radii[0]), 3 * float(loop.radii[1]))
    first, second = strain[loop.first], strain[loop.second]
    x, y = np.meshgrid(
        float(loop.centre[loop.first]) + np.linspace(-a, a, count),
        float(loop.centre[loop.second]) + np.linspace(-b, b, count),
        indexing="ij",
    )
    env: dict[str, Any] = {name: float(value) for name, value in loop.parameters.items()}
    env |= {name: float(c) for name, c in zip(strain, loop.centre, strict=True)}
    env |= {first: x, second: y}
    curl = derivative(stress[loop.second], first) - derivative(stress[loop.first], second)
    return x, y, np.broadcast_to(np.asarray(evaluate(curl, env), dtype=np.float64), x.shape).copy()


def open_names(stress: Sequence[Expression], strain: Sequence[str]) -> frozenset[str]:
    """Names besides the strain components."""
    return frozenset(name for e in stress for name in symbols(e)) - set(strain)
