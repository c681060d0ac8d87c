"""A run in a few numbers: for programs (JSON types) and for people (a terminal)."""

from __future__ import annotations

import json
import math
import os
from collections.abc import Iterable, Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

from rich.console import Console
from rich.table import Table
from rich.text import Text

from geocosserat.results.atomic import write_bytes
from geocosserat.results.ledger import ledger
from geocosserat.results.recurrence import recurrence
from geocosserat.results.solution import Solution


def summary(
    solution: Solution, files: Iterable[str | os.PathLike[str]] = (), *, scene: str | None = None
) -> dict[str, Any]:
    """The fields of ``run --json`` in plain JSON types; a number that is not finite becomes None.

    `files` are the paths written; `scene` is the path of the scene, by default its title. `tip` is the right
    end (u = length), `base` the left one, both at the last frame; `until` is the time of that frame.
    """
    recurs = recurrence(solution)
    fields = {
        "scene": solution.title if scene is None else scene,
        "title": solution.title,
        "motion": solution.motion,
        "unknowns": solution.unknowns,
        "method": solution.method,
        "fell_back": None if solution.fell_back is None else dict(solution.fell_back),
        "elements": solution.elements,
        "degree": solution.degree,
        "backend": solution.backend,
        "until": float(solution.time[-1]),
        "frames": len(solution.time),
        "reached": solution.reached,
        "reason": solution.reason,
        "tip": _end(solution, -1),
        "base": _end(solution, 0),
        "energy": {"start": float(solution.energy[0]), "end": float(solution.energy[-1])},
        "ledger": asdict(ledger(solution)),
        "periodic": None if recurs is None else recurs.fields(),
        "error": {"requested": solution.requested, "estimated": solution.estimated},
        "contents": dict(solution.contents),
        "evaluations": dict(solution.evaluations),
        "seconds": dict(solution.seconds),
        "plan": list(solution.plan),
        "files": [os.fspath(file) for file in files],
    }
    finite: dict[str, Any] = _finite(fields)
    return finite


def write_summary(fields: Mapping[str, Any], path: str | os.PathLike[str]) -> Path:
    """Write the fields as a JSON file, atomically. Raises FileError when it cannot be written."""
    return write_bytes(path, (json.dumps(fields, indent=2, allow_nan=False) + "\n").encode())


def print_summary(solution: Solution, console: Console, files: Iterable[str | os.PathLike[str]] = ()) -> None:
    """Print what a reader wants to know first: where the ends are, the balance, the error, the cost."""
    fields = summary(solution, files)
    rows = [
        ("rod", f"{fields['motion']}, {fields['unknowns']} unknowns "
                f"({count(fields['elements'], 'element')} of degree {fields['degree']})"),
        *(("law", _law(law)) for law in [fields["contents"].get("law")] if law),
        ("time", _time(fields)),
        ("tip", place(fields["tip"])),
        ("base", place(fields["base"])),
        ("energy", f"{digits(fields['energy']['start'])} at the start, "
                   f"{digits(fields['energy']['end'])} at the end"),
        ("ledger", _ledger(fields["ledger"])),
        *(("period", _period(recurs)) for recurs in [fields["periodic"]] if recurs),
        ("error", f"estimated {digits(fields['error']['estimated'], 2)}, "
                  f"requested {digits(fields['error']['requested'], 2)} (of the length)"),
        ("cost", _cost(fields)),
        *(("fell back", _fell_back(told)) for told in [fields["fell_back"]] if told),
        *(("wrote", file) for file in fields["files"]),
    ]
    grid = Table.grid(padding=(0, 2))
    for name, value in rows:
        # Text, so that brackets in a title or a path are not taken for markup
        grid.add_row(Text(name, style="dim"), Text(value, overflow="fold"))
    console.print(Text(fields["title"], style="bold"))
    console.print(grid)


def _law(law: Mapping[str, Any]) -> str:
    return f"{law['name']}: {law['verdict']}" + (f", {law['grade']}" if law["grade"] else "")


def _fell_back(told: Mapping[str, Any]) -> str:
    return f"to the safe method from t = {digits(told['at'], 6)} on: {told['reason']}"


def _end(solution: Solution, node: int) -> dict[str, Any]:
    end = {"position": solution.position[-1, node].tolist(), "rotation": solution.rotation[-1, node].tolist()}
    return end if solution.angle is None else end | {"angle": float(solution.angle[-1, node])}


def _finite(value: Any) -> Any:
    """JSON knows neither NaN nor infinity."""
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if isinstance(value, dict):
        return {key: _finite(inner) for key, inner in value.items()}
    return [_finite(inner) for inner in value] if isinstance(value, list) else value


def digits(value: float | None, most: int = 10) -> str:
    """A number with so many digits, at most."""
    return "unknown" if value is None else f"{value:.{most}g}"


def count(number: int, thing: str, things: str = "") -> str:
    """So many things, in words."""
    return f"{number} {thing}" if number == 1 else f"{number} {things or thing + 's'}"


def place(end: Mapping[str, Any]) -> str:
    """Where an end is, and how it is turned."""
    position = "(" + ", ".join(digits(x) for x in end["position"]) + ")"
    if "angle" in end:
        return f"{position}, angle {digits(end['angle'])}"
    tangent = "(" + ", ".join(digits(row[0], 6) for row in end["rotation"]) + ")"
    return f"{position}, normal to the section {tangent}"


def _ledger(terms: Mapping[str, float | None]) -> str:
    return (f"stored {digits(terms['stored'], 6)} + dissipated {digits(terms['dissipated'], 6)} "
            f"= work {digits(terms['work'], 6)}; residual {digits(terms['residual'], 2)}")


def _period(recurs: Mapping[str, Any]) -> str:
    text = (f"{digits(recurs['period'], 7)}, amplitude {digits(recurs['amplitude'], 6)}, "
            f"from {digits(recurs['from'], 3)} on, to {digits(recurs['error'], 2)}")
    if not recurs["drift"]:
        return text
    by = ", ".join(digits(x, 6) for x in recurs["drift"]["displacement"])
    return f"{text}; each adds ({by}) and a turn of {digits(recurs['drift']['angle'], 6)}"


def _time(fields: Mapping[str, Any]) -> str:
    until = f"until {digits(fields['until'], 6)}, {count(fields['frames'], 'frame')}"
    return until if fields["reached"] else f"{until}; not reached: {fields['reason']}"


def _cost(fields: Mapping[str, Any]) -> str:
    counts, seconds = fields["evaluations"], fields["seconds"]
    spent = ", ".join(f"{name} {value:.3g} s" for name, value in seconds.items() if value)
    foreseen = next((run["predicted"] for run in reversed(fields["plan"]) if run["whole"]), None)
    spent += f" (foreseen {foreseen:.3g} s)" if foreseen and spent else ""
    return (f"{fields['method']}, {fields['backend']} backend: {count(counts['steps'], 'step')}, "
            f"{count(counts['rate'], 'rate')}, {count(counts['jacobian'], 'Jacobian')}; "
            f"{spent or 'no time'}")
