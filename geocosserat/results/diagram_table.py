"""What accuracy costs, on a terminal: the front, what models leave out, what failed, and what it was measured on."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable

from rich.console import Console
from rich.table import Table
from rich.text import Text

from geocosserat.results.diagram import Diagram, Point


def print_diagram(diagram: Diagram, console: Console, files: Iterable[str] = ()) -> None:
    """The points that no other one beats, a line each, then all that must be said beside them."""
    console.print(Text(diagram.title, style="bold"))
    table = Table(box=None, pad_edge=False, header_style="dim")
    for name in ("error", "ms", "median", "method", "mesh", "rtol", "unknowns", "steps", "rates", "model"):
        table.add_column(name, justify="left" if name in ("model", "method") else "right", no_wrap=name != "model")
    for i in diagram.front:
        table.add_row(*map(Text, _row(diagram.points[i], diagram.floor)))
    console.print(table)
    for line in notes(diagram):
        console.print(Text(line), soft_wrap=True)
    for file in files:
        console.print(Text(f"wrote {file}"), soft_wrap=True)


def _row(point: Point, floor: float) -> tuple[str, ...]:
    assert point.error is not None
    error = f"< {floor:.1e}" if point.error < floor else f"{point.error:.1e}"
    size = f"{point.elements} x {point.degree}"
    times = f"{1e3 * point.seconds:.3g}", f"{1e3 * point.median:.3g}"
    counts = str(point.unknowns), str(point.steps), str(point.rates)
    return error, *times, point.method, size, f"{point.rtol:.0e}", *counts, point.model


def notes(diagram: Diagram) -> list[str]:
    """Lines for the foot of a table or a picture."""
    lines = [
        f"{len(diagram.points)} ways measured, {len(diagram.front)} that no other one beats in both error and time; "
        "errors are of positions at the end, relative to the length"
    ]
    for model in diagram.models:
        said = model.reason
        if model.error is not None:
            said = f"{model.error:.1e} from the scene as given, however finely computed"
        lines.append(f"{model.model}: {said}")
    failed = [point for point in diagram.points if point.error is None]
    for (method, reason), count in Counter((point.method, _short(point.reason)) for point in failed).most_common(5):
        lines.append(f"failed {count} times: {method}: {reason}")
    if diagram.left_out:
        lines.append(f"not tried for want of time: {diagram.left_out}")
    if reference := diagram.reference:
        lines.append(
            f"reference: {reference.method}, {reference.elements} x {reference.degree}, rtol {reference.rtol:.0e}, "
            f"its own error at most {reference.error:.1e}"
        )
    return [*lines, ", ".join(f"{name} {version}".strip() for name, version in diagram.machine.items())]


def _short(reason: str) -> str:
    """Without the instant and the number of steps, so that alike failures count together."""
    return reason.partition(": ")[2] or reason
