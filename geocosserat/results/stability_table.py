"""States of rest on a terminal: where the ends are, whether the rod stays there, and what becomes of that."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from rich.console import Console
from rich.table import Table
from rich.text import Text

from geocosserat.results.solution import Solution
from geocosserat.results.stability import Critical, Followed, Map, Modes, Stability, rest_fields
from geocosserat.results.summary import count, digits, place


def print_rest(
    solution: Solution, residual: float, modes: Modes, console: Console, files: Iterable[str] = (), title: str = ""
) -> None:
    """A state of rest: the rod, its ends, energy, how exact it is, and its stability."""
    fields = rest_fields(solution, residual, modes, [*files])
    mesh = f"{count(fields['elements'], 'element')} of degree {fields['degree']}"
    error = fields["error"]
    rows = [
        ("rod", f"{fields['motion']}, {fields['unknowns']} unknowns ({mesh})"),
        ("tip", place(fields["tip"])),
        ("base", place(fields["base"])),
        ("energy", f"{digits(fields['energy']['end'])} stored"),
        ("residual", f"{digits(residual, 2)} (strain that one more round would change)"),
        ("error", f"estimated {digits(error['estimated'], 2)} of the length, between the last two meshes"),
        ("stability", _verdict(modes)),
        *(("wrote", file) for file in fields["files"]),
    ]
    console.print(Text(title or fields["title"], style="bold"))
    _print_grid(rows, console)


def print_stability(record: Stability, console: Console) -> None:
    """The state of rest, its growth rates, and what was found over a value, or two."""
    print_rest(record.solution, record.residual, record.modes, console)
    table = Table(box=None, pad_edge=False, header_style="dim")
    for name in ("growth rate", "frequency", "known to"):
        table.add_column(name, justify="right", no_wrap=True)
    for growth, error in zip(record.modes.growth.tolist(), record.modes.errors.tolist(), strict=True):
        told = "one mesh" if error == float("inf") else f"{error:.0e}"
        table.add_row(digits(growth.real), digits(abs(growth.imag)) if growth.imag else "", told)
    console.print(table)
    if record.followed is not None:
        _print_followed(record.followed, console)
    if record.map is not None:
        _print_map(record.map, console)
    _print_grid([("wrote", file) for file in record.files], console)


def _verdict(modes: Modes) -> str:
    words = "stable" if modes.stable else f"not stable: {count(modes.unstable, 'small motion')} that grow"
    neutral = f"; {count(modes.neutral, 'motion')} that nothing resists" if modes.neutral else ""
    return f"{words}; leading rate {_rate(modes.growth.tolist())}{neutral}"


def _rate(growth: Sequence[complex]) -> str:
    if not growth:
        return "unknown"
    first = growth[0]
    return digits(first.real, 6) + (f" at {digits(abs(first.imag), 6)} radians per time" if first.imag else "")


def _print_followed(followed: Followed, console: Console) -> None:
    first, last = followed.interval
    critical = followed.critical
    if critical is None:
        began = followed.branches[0][0].growth > 0
        so_far = "at all states that were looked at" if not followed.reason else "as far as it was followed"
        why = "it is not stable to begin with" if began else f"small motions decay {so_far}"
        console.print(Text(f"{followed.key} from {first:g} to {last:g}: no loss of stability; {why}"))
    for crossing in followed.crossings:
        console.print(Text(f"{followed.key} = {digits(crossing.value, 12)}: {_said(crossing)}"), soft_wrap=True)
    sides = len(followed.branches) - 1
    if sides:
        console.print(Text(f"{count(sides, 'branch', 'branches')} leave the path sideways"))
    if followed.reason:
        console.print(Text(f"not followed to the end: {followed.reason}"), soft_wrap=True)


def _said(crossing: Critical) -> str:
    kind = "fold" if crossing.fold else crossing.kind
    words = f"{kind} {'begins' if crossing.gains else 'ends'}"
    if crossing.kind == "flutter":
        words += f", {digits(crossing.frequency, 12)} radians per time"
    return words + ("" if crossing.error is None else f" (the last two meshes differ by {digits(crossing.error, 2)})")


def _print_map(map: Map, console: Console) -> None:
    grows = int((map.growth > 0).sum())
    console.print(Text(f"{map.keys[0]} by {map.keys[1]}: small motions grow at {grows} of {map.growth.size} pairs"))


def _print_grid(rows: Iterable[tuple[str, str]], console: Console) -> None:
    grid = Table.grid(padding=(0, 2))
    for name, value in rows:
        # Text, so that brackets in a title or a path are not taken for markup
        grid.add_row(Text(name, style="dim"), Text(value, overflow="fold"))
    console.print(grid)


