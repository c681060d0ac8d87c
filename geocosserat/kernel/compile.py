"""C to a shared library, once, kept under a hash of everything that shaped it."""

import hashlib
import os
import platform
import shlex
import shutil
import subprocess
import tempfile
from collections.abc import Callable
from contextlib import suppress
from functools import lru_cache
from pathlib import Path
from typing import TypeVar

from geocosserat.kernel.places import PART, cache_folder, making, own_bytes

FLAGS = ("-std=c99", "-O3", "-march=native", "-fno-math-errno", "-ffp-contract=fast", "-fPIC", "-shared")
"""Strict floating point but for products that are added in one rounding: no -ffast-math. Without errno, sqrt and the
like need no call."""

PATIENCE = 600.0
"""Seconds that a compiler is given."""


T = TypeVar("T")


class CompileError(RuntimeError):
    """The C compiler refused a generated kernel; the message has its words."""


@lru_cache(maxsize=1)
def compiler() -> str | None:
    """Path of the C compiler ($CC, cc, gcc or clang), or None. CC="" says: use none."""
    if "CC" in os.environ:
        words = shlex.split(os.environ["CC"])
        return shutil.which(words[0]) if words else None
    return next((path for name in ("cc", "gcc", "clang") if (path := shutil.which(name))), None)


def _machine() -> str:
    """What -march=native depends on."""
    try:
        lines = Path("/proc/cpuinfo").read_text().splitlines()
        features = next((line for line in lines if line.startswith(("flags", "Features"))), "")
    except OSError:
        features = platform.processor()
    return platform.machine() + features


def _words() -> list[str]:
    """What $CC says after the name of the compiler, as in CC="gcc -fsanitize=address"."""
    return shlex.split(os.environ.get("CC", ""))[1:]


def _key(source: str, degree: int, tool: str) -> str:
    """A hash of everything that shapes the compiled kernel of this degree."""
    status = os.stat(tool)
    parts = (
        source,
        str(degree),
        *FLAGS,
        *_words(),
        os.path.realpath(tool),
        str(status.st_size),
        str(status.st_mtime_ns),
        _machine(),
    )
    return hashlib.sha256(chr(0).join(parts).encode()).hexdigest()


def _name(key: str, content: bytes) -> str:
    """The name of a library says what shaped it and what is in it: one that was damaged goes by a false name."""
    return f"{key}.{hashlib.sha256(content).hexdigest()}.so"


def _found(folder: Path, key: str) -> Path | None:
    """The library of that key in the cache, as it was when it was made by this user. Others are removed."""
    for path in sorted(folder.glob(f"{key}.*.so")):
        with suppress(OSError):
            if path.name == _name(key, own_bytes(path)):
                return path
        with suppress(OSError):
            path.unlink()
    return None


def compile_c(source: str, degree: int = 0) -> Path:
    """The shared library of a kernel at a degree, or of other C (which has none), compiled now if it never was.

    Two processes may compile the same kernel at once: each writes its own file, and the last one stays.

    Raises CompileError when there is no compiler or it fails.
    """
    tool = compiler()
    if tool is None:
        raise CompileError("expected a C compiler, found none on the path; install one, or use the numpy backend")
    try:
        cache, key = cache_folder(), _key(source, degree, tool)
        found = _found(cache, key)
        if found is not None:
            return found
        with making(cache), tempfile.TemporaryDirectory(dir=cache, prefix=PART) as folder:
            code, built = Path(folder) / "rod.c", Path(folder) / "rod.so"
            code.write_text(source)
            command = [tool, *_words(), *FLAGS, f"-DDEGREE={degree}", str(code), "-o", str(built), "-lm"]
            done = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE, check=False)
            if done.returncode:
                said = " ".join(done.stderr.split())[:1000] or f"exit code {done.returncode}"
                raise CompileError(f"{tool} failed on a generated kernel: {said}")
            built.chmod(0o700)  # whatever the umask
            target = cache / _name(key, built.read_bytes())
            os.replace(built, target)
    except subprocess.TimeoutExpired:
        raise CompileError(f"{tool} did not compile a generated kernel within {PATIENCE} s") from None
    except OSError as error:  # a full or read-only disk, a compiler that is no program
        raise CompileError(f"{tool} could not be used on a generated kernel: {error}") from error
    return target


def opened(open_library: Callable[[Path], T], source: str, degree: int = 0) -> T:
    """What `open_library` makes of the compiled library. One that cannot be opened is made again, once.

    Raises CompileError where there is no compiler, or libraries cannot be loaded.
    """
    library = compile_c(source, degree)
    try:
        return open_library(library)
    except OSError:
        library.unlink(missing_ok=True)
    try:
        return open_library(compile_c(source, degree))
    except OSError as error:  # a folder whose files may not be run
        raise CompileError(f"expected a compiled kernel that can be loaded: {error}; set GEOCOSSERAT_CACHE") from error
