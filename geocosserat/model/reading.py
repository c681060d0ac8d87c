"""From a file, a text or a mapping to plain tables, numbers and words; nothing is interpreted yet."""

from __future__ import annotations

import os
import re
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from geocosserat.model.errors import InputError
from geocosserat.model.place import Found, Place, shown

MAX_BYTES = 1_000_000
MAX_LINE = 12_000
MAX_LEVELS = 8
_STRINGS = re.compile(
    r'"""(?:\\.|[^\\])*?"{3,5}|\'\'\'.*?\'{3,5}|"(?:\\[^\n]|[^"\\\n])*"|\'[^\'\n]*\'|["\'][^\n]*|#[^\n]*', re.DOTALL
)
"""Of TOML, closed or not, and comments: what is left of a text without them has dots in keys, numbers and times."""


@dataclass(frozen=True, slots=True)
class Read:
    """The plain values of a scene or a law, its text (None for a mapping) and its file (None if there is none)."""

    values: dict[str, Any]
    text: str | None
    path: str | None
    what: str = "scene"

    @property
    def file(self) -> str:
        """The name for messages."""
        return shown_path(self.path) if self.path else self.what


def read(scene: str | os.PathLike[str] | Mapping[str, Any], what: str = "scene") -> Read:
    """Read a scene, or ``what`` else, from a file, from TOML text (a str with a line break in it) or from a mapping.

    Raises InputError for a file that cannot be read, is larger than 1 MB or not UTF-8, for a line of more
    than 12 000 characters and for invalid TOML.
    """
    if isinstance(scene, Mapping):
        values = _plain(Place(what), scene, 0)
        assert isinstance(values, dict)
        return Read(values, None, None, what)
    if isinstance(scene, str) and "\n" in scene:
        return Read(_tables(what, scene, what), scene, None, what)
    if not isinstance(scene, str | os.PathLike):
        raise InputError("a path, TOML text or a mapping", shown(scene), "pass one of these", key=what)
    path = os.fspath(scene)
    text = _text(path)
    return Read(_tables(shown_path(path), text, what), text, path, what)


def _text(path: str) -> str:
    try:
        with open(path, "rb") as file:
            content = file.read(MAX_BYTES + 1)  # never more, whatever the path leads to
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise InputError("a readable file", reason.lower(), "check the path", file=shown_path(path)) from None
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        if len(content) > MAX_BYTES:
            return " " * len(content)  # too large, which is said first
        line = content[: error.start].count(b"\n") + 1
        raise InputError(
            "UTF-8 text", f"the byte 0x{content[error.start]:02x}", "save the file as UTF-8",
            key=f"line {line}", file=shown_path(path),
        ) from None  # fmt: skip


def shown_path(path: str) -> str:
    """A path as it is if it prints on one line, else escaped."""
    return path if path.isprintable() and path else ascii(path)


def _tables(file: str, text: str, what: str) -> dict[str, Any]:
    if len(text) > MAX_BYTES or len(text.encode("utf-8", "replace")) > MAX_BYTES:
        raise InputError("at most 1 MB", "more", f"a {what} is a short text; is this the right file?", file=file)
    for number, line in enumerate(text.split("\n"), start=1):
        if len(line) > MAX_LINE:
            raise InputError(
                f"lines of at most {MAX_LINE} characters", f"one of {len(line)}", "break the line",
                key=f"line {number}", file=file,
            )  # fmt: skip
    flatter = InputError(f"at most {MAX_LEVELS} levels of nesting", "more", "write it flatter", file=file)
    # before tomllib reads them, which takes quadratic time and memory for a long dotted key
    if any(piece.count(".") > MAX_LEVELS for piece in re.split(r"[=,\n]", _STRINGS.sub("", text))):
        raise flatter
    try:
        tables = tomllib.loads(text)
    except RecursionError:
        raise flatter from None
    except ValueError as error:  # TOMLDecodeError, and integers of thousands of digits
        raise InputError("valid TOML", str(error), "correct that line", file=file) from None
    values = _plain(Place(file), tables, 0)
    assert isinstance(values, dict)
    return values


def _plain(place: Place, value: Any, level: int) -> Any:
    """A copy in Python's own types, no deeper than any scene or law is."""
    if level > MAX_LEVELS:
        raise place.wrong(f"at most {MAX_LEVELS} levels of nesting", Found("more"), "write it flatter")
    match value:
        case Mapping():
            for key in value:
                if not isinstance(key, str):
                    raise place.wrong("keys that are words", key, "write the key as a string")
            return {key: _plain(place.at(key), entry, level + 1) for key, entry in value.items()}
        case np.ndarray() | np.generic():
            return _plain(place, value.tolist(), level) if value.dtype.kind in "biuf" else value
        case list() | tuple():
            return [_plain(place.at(i), entry, level + 1) for i, entry in enumerate(value)]
        case _:
            return value
