"""From a law to the verdict on it, and to witnesses that run."""

import json
import os
from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from geocosserat.bounded import OutOfBounds, bounded
from geocosserat.conductor.folder import claimed
from geocosserat.conductor.scene import MOST_SECONDS
from geocosserat.model.errors import InputError
from geocosserat.model.law import Law, load_law
from geocosserat.results.atomic import write_bytes

if TYPE_CHECKING:
    from geocosserat.passivity.check import Check

LawLike = str | os.PathLike[str] | Mapping[str, Any] | Law
LAW_PICTURE, PASSAGE, FINDINGS = "law.png", "law.tex", "check.json"
CHECK_FILES = ("witness_stress.toml", "witness_wrench.toml", LAW_PICTURE, PASSAGE, FINDINGS)


@dataclass(frozen=True)
class Checked:
    """What `check` returns: all that was found of a law, and the fields of ``check --json`` as attributes.

    found: None if it took too long; files: those written.
    """

    found: "Check | None"
    files: tuple[Path, ...]
    fields: Mapping[str, Any]

    def __getattr__(self, name: str) -> Any:
        fields = self.__dict__.get("fields", {})  # empty while a copy is being made
        if name in fields:
            return fields[name]
        raise AttributeError(f"a check has no field {name!r}; it has {', '.join(fields)}")


def check(
    law: LawLike,
    out: str | os.PathLike[str] | None = None,
    *,
    values: Mapping[str, float] | None = None,
    overwrite: bool = False,
    seconds: float = MOST_SECONDS,
) -> Checked:
    """Is a constitutive law passive? With a proof, or with a counter-example that runs.

    law: a path, TOML text, a mapping or a Law. values: of its parameters. `out`: a folder for the witnesses as scenes,
    a picture, a passage for a paper and what was found as JSON. Takes at most `seconds`; then it is undecided.

    Raises InputError for a wrong law or folder.
    """
    read = law if isinstance(law, Law) else load_law(law, values)
    for name in values or ():
        if name not in read.parameters:
            known = ", ".join((*read.parameters, *read.open)) or "none"
            raise InputError(f"a parameter of the law ({known})", repr(name), "choose one of these", key="--set")
    folder = None if out is None else Path(out)
    try:
        with claimed(folder, overwrite, CHECK_FILES):
            found, fields, content = bounded(partial(_answered, read, folder is not None), seconds)
            files = () if folder is None else _written(content, folder)
    except OutOfBounds as error:
        why = {"verdict": "undecided", "grade": None, "conditions": [], "not_checked": [f"all: {error}"]}
        return Checked(None, (), {"law": read.path or read.name, "name": read.name, **why, "files": []})
    return Checked(found, files, {**fields, "files": [str(file) for file in files]})


def _written(content: Mapping[str, bytes], folder: Path) -> tuple[Path, ...]:
    files = tuple(write_bytes(folder / name, data) for name, data in content.items())
    for name in set(CHECK_FILES) - set(content):  # of an earlier check, which are no more true
        (folder / name).unlink(missing_ok=True)
    return files


def _answered(law: Law, written: bool) -> "tuple[Check, dict[str, Any], dict[str, bytes]]":
    """All that is found of a law, its fields, and the files to write."""
    from geocosserat.passivity.check import check as check_law

    found = check_law(law)
    fields = found.fields
    if not written:
        return found, fields, {}
    from geocosserat.passivity.picture import image
    from geocosserat.passivity.portrait import portrait
    from geocosserat.passivity.show import passage

    content = {f"witness_{part}.toml": text.encode() for part, text in found.scenes.items()}
    content[PASSAGE] = passage(found).encode()
    content[FINDINGS] = (json.dumps(fields, indent=2, allow_nan=False) + "\n").encode()
    figure = portrait(found)
    if figure is not None:
        content[LAW_PICTURE] = image(figure, Path(LAW_PICTURE).suffix)
    return found, fields, content
