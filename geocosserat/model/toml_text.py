"""Plain tables back to TOML text, so that a scene changed by settings can be kept and run again."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from typing import Any

_BARE_KEY = re.compile(r"[A-Za-z0-9_-]+")


def to_toml(values: dict[str, Any]) -> str:
    """TOML text that reads back as ``values``: tables, lists, strings, numbers and booleans."""
    return "\n".join(_table(values, ())).strip("\n") + "\n"


def _table(values: dict[str, Any], path: tuple[str, ...]) -> Iterator[str]:
    # a table's own values come first: after a sub-table's header they would belong to that
    for key, value in values.items():
        if not (isinstance(value, dict) or _is_tables(value)):
            yield f"{_key(key)} = {_value(value)}"
    for key, value in values.items():
        inner = (*path, key)
        header = ".".join(map(_key, inner))
        if isinstance(value, dict):
            yield f"\n[{header}]"
            yield from _table(value, inner)
        elif _is_tables(value):
            for entry in value:
                yield f"\n[[{header}]]"
                yield from _table(entry, inner)


def _is_tables(value: Any) -> bool:
    return isinstance(value, list) and bool(value) and all(isinstance(entry, dict) for entry in value)


def _value(value: Any) -> str:
    match value:
        case bool():
            return str(value).lower()
        case int() | float():
            return repr(value)
        case str():
            return _string(value)
        case list():
            return "[" + ", ".join(map(_value, value)) + "]"
        case dict():
            return "{" + ", ".join(f"{_key(key)} = {_value(entry)}" for key, entry in value.items()) + "}"
        case _:
            raise TypeError(f"expected a string, a number, a list or a table, found {type(value).__name__}")


def _key(key: str) -> str:
    return key if _BARE_KEY.fullmatch(key) else _string(key)


def _string(text: str) -> str:
    # JSON's escapes are TOML's, but for DEL, which TOML wants escaped too
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")
