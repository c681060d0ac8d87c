"""What goes wrong with result files, as one message."""

from __future__ import annotations

import os


class FileError(OSError):
    """A result file that cannot be written or read.

    ``str()`` is the one message "FILE: expected ..., found ...; DO"; the attributes `file`, `expected`,
    `found` and `hint` are its parts.
    """

    def __init__(self, file: str | os.PathLike[str], expected: str, found: str, hint: str) -> None:
        super().__init__(f"{os.fspath(file)}: expected {expected}, found {found}; {hint}")
        self.file = os.fspath(file)
        self.expected = expected
        self.found = found
        self.hint = hint

    def __reduce__(self) -> tuple[type[FileError], tuple[str, str, str, str]]:
        # OSError would hand its one argument to __init__; errors must survive the way from a worker process
        return type(self), (self.file, self.expected, self.found, self.hint)
