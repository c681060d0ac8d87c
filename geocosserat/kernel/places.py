"""The user's cache: a private folder, files that appear whole or not at all."""

import os
import tempfile
from pathlib import Path


def cache_folder() -> Path:
    """The folder of this user's generated and compiled kernels, made if missing, closed to others.

    $GEOCOSSERAT_CACHE if set, else $XDG_CACHE_HOME/geocosserat, else ~/.cache/geocosserat; where none of them can
    be written (a read-only home), a private folder under the system's temporary one.
    """
    named = os.environ.get("GEOCOSSERAT_CACHE")
    base = os.environ.get("XDG_CACHE_HOME")
    try:
        home = Path(base) if base else Path.home() / ".cache"
        return _private(Path(named) if named else home / "geocosserat")
    except (OSError, RuntimeError):  # RuntimeError: a user without a home
        return _private(Path(tempfile.gettempdir()) / f"geocosserat-{os.getuid()}")


def _private(folder: Path) -> Path:
    folder.mkdir(parents=True, exist_ok=True, mode=0o700)
    status = folder.stat()
    if status.st_uid != os.getuid() or status.st_mode & 0o022:
        raise PermissionError(
            f"expected {folder} to belong to this user and to be writable by nobody else; "
            "change its owner and mode, or set GEOCOSSERAT_CACHE to another folder"
        )
    if not os.access(folder, os.W_OK | os.X_OK):
        raise PermissionError(f"expected {folder} to be writable; set GEOCOSSERAT_CACHE to another folder")
    return folder


def write_whole(path: Path, content: bytes) -> None:
    """Writes a file so that readers see the old one or the new one, never a part."""
    handle, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.")
    try:
        with os.fdopen(handle, "wb") as stream:
            stream.write(content)
            stream.flush()
            os.fsync(stream.fileno())
        os.replace(name, path)
    except BaseException:
        Path(name).unlink(missing_ok=True)
        raise
