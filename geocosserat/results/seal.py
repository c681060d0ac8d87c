"""A checksum that a file carries inside itself and that covers all its other bytes.

The library of the file format can hang on a damaged file, so damage must be found before it sees a byte: the
checksum is an ordinary text attribute of the file, found here by its first characters, and the sum is taken
with its digits blank.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator

MARK = "geocosserat-sha256:"
_DIGITS = 64
_MOST_MARKS = 16
BLANK = MARK + "0" * _DIGITS


def seal(image: bytes) -> bytes:
    """The image with the digits of its one BLANK filled in.

    Raises ValueError unless BLANK occurs exactly once, and among few other checksums.
    """
    count, marks = image.count(BLANK.encode()), image.count(MARK.encode())
    if marks > _MOST_MARKS:
        raise ValueError(f"checksum: expected the text {MARK!r} at most {_MOST_MARKS} times in the file, found it "
                         f"{marks} times; take it out of the scene and the title")
    if count != 1:
        raise ValueError(f"checksum: expected the text {BLANK!r} once in the file, found it {count} times; "
                         f"take it out of the scene and the title")
    at = image.index(BLANK.encode()) + len(MARK)
    digits = hashlib.sha256(image).hexdigest().encode()
    return b"".join((image[:at], digits, image[at + _DIGITS:]))


def marked(sealed: bytes) -> bool:
    """Whether the bytes carry a checksum at all, right or wrong."""
    return MARK.encode() in sealed


def intact(sealed: bytes) -> bool:
    """Whether the bytes are those that `seal` returned."""
    return any(_matches(sealed, at) for at in _places(sealed))


def _places(sealed: bytes) -> Iterator[int]:
    """Where checksums may stand: several places, if a scene quotes that of another file in a comment. Not so many that
    trying them all would take long."""
    at = -1
    for _ in range(_MOST_MARKS):
        at = sealed.find(MARK.encode(), at + 1)
        if at < 0:
            return
        yield at + len(MARK)


def _matches(sealed: bytes, at: int) -> bool:
    total = hashlib.sha256(memoryview(sealed)[:at])
    total.update(b"0" * _DIGITS)
    total.update(memoryview(sealed)[at + _DIGITS:])
    return total.hexdigest().encode() == sealed[at:at + _DIGITS]
