"""The one error a user of a scene file sees: what is wrong, where, and what to do about it."""

from __future__ import annotations


class InputError(ValueError):
    """A scene, a setting or an argument is wrong; ``str()`` is the whole message, one line.

    The message reads ``FILE: KEY: expected ..., found ...; DO``. Parts that are not known are left out.

    Attributes: ``file`` and ``key`` (where), ``expected`` and ``found`` (what), ``hint`` (what to do).
    """

    def __init__(
        self,
        expected: str,
        found: str,
        hint: str | None = None,
        *,
        key: str | None = None,
        file: str | None = None,
    ) -> None:
        self.file = file
        self.key = key
        self.expected = expected
        self.found = found
        self.hint = hint
        where = "".join(f"{part}: " for part in (file, key) if part)
        what = f"expected {expected}, found {found}"
        super().__init__(where + what + (f"; {hint}" if hint else ""))

    def __reduce__(self) -> tuple[object, ...]:
        # keyword-only arguments: the default would hand the finished message to __init__ again
        return _rebuild, (self.expected, self.found, self.hint, self.key, self.file)


def _rebuild(expected: str, found: str, hint: str | None, key: str | None, file: str | None) -> InputError:
    return InputError(expected, found, hint, key=key, file=file)
