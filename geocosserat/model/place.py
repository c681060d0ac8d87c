"""Where in a scene a value stands, and how a wrong value is shown in a message."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from geocosserat.model.errors import InputError
from geocosserat.model.parser import nearest

_BARE_KEY = re.compile(r"[A-Za-z0-9_-]{1,60}")


@dataclass(frozen=True, slots=True)
class Place:
    """A dotted key in a file; the same dotted keys are the paths of ``--set``."""

    file: str
    key: str = ""

    def at(self, name: str | int) -> Place:
        """The place of an entry of this table or list."""
        step = str(name) if _BARE_KEY.fullmatch(str(name)) else shown(name)
        return Place(self.file, f"{self.key}.{step}" if self.key else step)

    def wrong(self, expected: str, found: object, hint: str | None = None) -> InputError:
        """The error that says so; ``found`` is shown as a value, text made by ``Found`` as it is."""
        text = found.text if isinstance(found, Found) else shown(found)
        return InputError(expected, text, hint, key=self.key or None, file=self.file)

    def unavailable(self, expected: str, found: object, hint: str) -> InputError:
        """The error for what the scene format knows but this version does not do."""
        return self.wrong(expected, Found(f"{shown(found)}, which is not available in this version"), hint)

    def unknown(self, name: str, known: Iterable[str], what: str = "key") -> InputError:
        """The error for an unknown key of this table, or an unknown word in this place."""
        names = tuple(known)
        like = nearest(name, names)
        hint = f"did you mean {like}?" if like else "remove it" if what == "key" else f"write one of the {what}s"
        place, found = (self.at(name), Found("an unknown key")) if what == "key" else (self, Found(shown(name)))
        return place.wrong(one_of(names), found, hint)


@dataclass(frozen=True, slots=True)
class Found:
    """What was found, already in words."""

    text: str


NOTHING = Found("nothing")


def one_of(names: Sequence[str]) -> str:
    """``one of a, b, c``, or just the one name."""
    return names[0] if len(names) == 1 else "one of " + ", ".join(names)


def shown(value: object) -> str:
    """A value in a few words that are safe to print, however large or strange it is."""
    match value:
        case bool():
            return f"the boolean {str(value).lower()}"
        case int() if value.bit_length() > 100:
            return f"an integer of {value.bit_length()} bits"
        case int() | float():
            return repr(value)
        case str():
            return ascii(value if len(value) <= 60 else value[:57] + "...")
        case Mapping():
            return "a table"
        case list() | tuple():
            simple = len(value) <= 6 and all(isinstance(entry, str | int | float) for entry in value)
            return "[" + ", ".join(map(shown, value)) + "]" if simple else f"a list of {len(value)}"
        case _:
            return f"a {type(value).__name__}"
