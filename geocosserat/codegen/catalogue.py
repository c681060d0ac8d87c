"""The kernels that come with the program, and the command that writes them: python -m geocosserat.codegen.catalogue.

They serve the commonest rods at once, without symbolic algebra; every other kernel is generated on demand.
"""

import json
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from geocosserat.codegen.source import generate
from geocosserat.discretisation.structuring import structure_of
from geocosserat.model.scene import load_scene
from geocosserat.shipped import shipped

_STIFFNESS = {"planar": [2.0] * 3, "spatial": [2.0] * 6}
_HELIX = ["1", "0", "0", "0.5", "0", "0.7"]
_TIP = {"planar": [0.1, 0.2], "spatial": [0.1, 0.2, 0.3]}


def _scene(motion: str, **changes: Any) -> Mapping[str, Any]:
    values = _STIFFNESS[motion]
    rod = {"motion": motion, "length": 1.0, "stiffness": values, "friction": values, **changes.pop("rod", {})}
    return {"rod": rod, "run": {"until": 1.0}, **changes}


def catalogue() -> Iterator[tuple[str, str, Mapping[str, Any]]]:
    """(file stem, title, a scene of that structure) of each shipped kernel."""
    for motion in ("planar", "spatial"):
        yield f"{motion}_clamped_free", f"{motion.capitalize()} rod, clamped on the left", _scene(motion)
        free = {"left": {"kind": "free"}}
        yield f"{motion}_free_free", f"{motion.capitalize()} rod, both ends free", _scene(motion, ends=free)
        pulled = {"right": {"kind": "free", "force": _TIP[motion], "frame": "world"}}
        yield (
            f"{motion}_dead_load",
            f"{motion.capitalize()} rod under a dead force at its tip",
            _scene(motion, ends=pulled),
        )
    helix = {"right": {"kind": "free", "force": [0.1, 0.0, 0.2], "frame": "world"}}
    yield (
        "helix_dead_load",
        "Spatial rod, helical at rest, under a dead force at its tip",
        _scene("spatial", rod={"reference": _HELIX}, ends=helix),
    )


def files() -> Iterator[tuple[str, str]]:
    """(name, content) of every file of the catalogue."""
    for stem, title, values in catalogue():
        source = generate(structure_of(load_scene(values).model), title)
        yield f"{stem}.c", source.c
        yield f"{stem}.py", source.numpy
        yield f"{stem}.json", json.dumps(source.signature, indent=2) + "\n"


def write(folder: Path) -> None:
    """Writes the catalogue and removes what is no longer part of it."""
    folder.mkdir(exist_ok=True)
    wanted = dict(files())
    for path in folder.iterdir():
        if path.name not in wanted and path.suffix in (".c", ".py", ".json"):
            path.unlink()
    for name, content in wanted.items():
        (folder / name).write_text(content)


if __name__ == "__main__":
    write(shipped("templates").parent / "generated")
