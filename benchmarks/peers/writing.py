"""What was measured, as Markdown and as JSON."""

from collections.abc import Mapping, Sequence
from typing import Any

from benchmarks.peers.search import Found

Row = Mapping[float, Found | None] | str


def _number(x: object) -> str:
    return f"{x:.3g}" if isinstance(x, float) else str(x)


def _cell(found: Found | None, unit: Found | None) -> str:
    if found is None:
        return "not reached"
    ratio = f", {found.least / unit.least:.3g} x" if unit and found is not unit else ""
    how = " ".join(map(_number, found.setting))
    if found.extrapolated:
        return f"{1e3 * found.least:.3g}{ratio}; extrapolated"
    return f"{1e3 * found.least:.3g} ({1e3 * found.median:.3g}){ratio}; {how}"


def table(rows: Mapping[str, Row], targets: Sequence[float]) -> str:
    """Markdown: milliseconds, minimum (median), times those of the first row, and the setting."""
    lines = [f"| solver | {' | '.join(f'{t:.0e}' for t in targets)} |", "|---" * (1 + len(targets)) + "|"]
    unit = next(iter(rows.values()))
    assert not isinstance(unit, str)
    for name, row in rows.items():
        if isinstance(row, str):
            cells = [row] + [""] * (len(targets) - 1)
        else:
            cells = [_cell(row[t], unit.get(t)) if t in row else "" for t in targets]
        lines.append(f"| {name} | {' | '.join(cells)} |")
    return "\n".join(lines) + "\n"


def plain(rows: Mapping[str, Row]) -> dict[str, Any]:
    """For JSON."""
    return {
        name: row if isinstance(row, str) else {f"{t:.0e}": vars(f) if f else None for t, f in row.items()}
        for name, row in rows.items()
    }
