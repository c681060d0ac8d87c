"""Kernels that already exist as text: those that come with the program, then this user's own."""

import hashlib
import json
from contextlib import suppress
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

from geocosserat.kernel.places import cache_folder, making, own_bytes, write_whole
from geocosserat.shipped import shipped


@dataclass(frozen=True)
class KernelText:
    """A kernel in both languages. origin: "shipped", "cache" or "generated"."""

    identity: str
    c: str
    numpy: str
    signature: dict[str, Any]
    origin: str


@lru_cache(maxsize=1)
def _catalogue() -> dict[str, str]:
    """Stem of the shipped files by identity."""
    try:
        folder = shipped("generated")
    except FileNotFoundError:
        return {}
    return {json.loads(path.read_text())["identity"]: path.stem for path in sorted(folder.glob("*.json"))}


def _digest(*parts: Any) -> str:
    """Of everything that a record holds, and of the name it goes by."""
    return hashlib.sha256(json.dumps(parts, sort_keys=True).encode()).hexdigest()


def find(identity: str) -> KernelText | None:
    """The kernel with this identity, or None. A damaged file in the cache counts as missing."""
    stem = _catalogue().get(identity)
    if stem is not None:
        folder = shipped("generated")
        texts = [(folder / f"{stem}{suffix}").read_text() for suffix in (".c", ".py", ".json")]
        return KernelText(identity, texts[0], texts[1], json.loads(texts[2]), "shipped")
    try:
        record = json.loads(own_bytes(cache_folder() / f"{identity}.json"))
        c, numpy, signature = record["c"], record["numpy"], record["signature"]
        if record["digest"] != _digest(identity, c, numpy, signature):
            return None
        return KernelText(identity, c, numpy, signature, "cache")
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return None


def store(identity: str, c: str, numpy: str, signature: dict[str, Any]) -> KernelText:
    """Keeps a newly generated kernel in the user's cache; a cache that cannot be written is not an error."""
    record = {"c": c, "numpy": numpy, "signature": signature, "digest": _digest(identity, c, numpy, signature)}
    with suppress(OSError):
        folder = cache_folder()
        with making(folder):
            write_whole(folder / f"{identity}.json", json.dumps(record).encode())
    return KernelText(identity, c, numpy, signature, "generated")
