"""All compiled code under the sanitisers of the compiler: python -m benchmarks.sanitize [words for pytest].

Kernels and integrators are compiled with AddressSanitizer and UndefinedBehaviorSanitizer and the tests run on them; the
first access outside of its array, use after it was freed, or undefined operation ends the run with a report. Tests that
take long are left out unless it is asked for them (`-m slow`). Python itself and its libraries are not instrumented,
and what they leave allocated is not looked at. Whether the sanitisers are at work at all is tried first, with wrong
code. Not for workers of `-n`: they have threads, and the AddressSanitizer of gcc 12, unlike malloc itself, is not ready
for a fork while another thread allocates; what is forked then waits for ever.
"""

from __future__ import annotations

import os
import shlex
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

FLAGS = "-fsanitize=address,undefined -fno-sanitize-recover=all -fno-omit-frame-pointer -g1"
RUNTIMES = ("libasan.so", "libubsan.so")
LEVEL = "-O1"
"""Of the optimiser, as the sanitisers' authors advise: the checks are the same, compiled in a sixth of the time."""

WRONG = {
    "outside of its array": ("double f(int n) { double *a = calloc(4, 8); return a[n]; }", 4),
    "undefined": ("double f(int n) { return (double)(n + 2147483647); }", 1),
}
"""Code with a fault that the sanitisers should report, and what to call it with."""


LIGHT = """#!/bin/sh
unset LD_PRELOAD
case "$*" in *-fsanitize=*) ;; *) exec {tool} "$@" ;; esac
for word do
    shift
    case $word in
    /*/rod.c) cd "${{word%/*}}" && set -- "$@" rod.c "-ffile-prefix-map=${{word%/*}}=." ;;
    *) set -- "$@" "$word" ;;
    esac
done
exec {tool} "$@" {level}
"""
"""A compiler that does not run under the sanitisers itself, as Python must, optimises little what is to run under them,
and makes the same library of the same kernel in any folder, as it does without them."""


def light(tool: str, folder: Path) -> str:
    """Path of that compiler, written to a folder."""
    path = folder / Path(tool).name
    path.write_text(LIGHT.format(tool=shlex.quote(tool), level=LEVEL))
    path.chmod(0o700)
    return str(path)


def environment(tool: str) -> dict[str, str]:
    """That in which Python loads sanitised libraries."""
    found = [subprocess.check_output([tool, f"-print-file-name={name}"], text=True).strip() for name in RUNTIMES]
    return {
        **os.environ,
        "CC": f"{tool} {FLAGS}",
        "LD_PRELOAD": " ".join(found),
        "ASAN_OPTIONS": "detect_leaks=0:abort_on_error=1:allocator_may_return_null=1",
        "UBSAN_OPTIONS": "print_stacktrace=1",
        "OPENBLAS_NUM_THREADS": "1",
    }


def unnoticed(tool: str) -> list[str]:
    """Faults that the sanitisers do not report in a library compiled and loaded as kernels are."""
    missed = []
    for name, (code, argument) in WRONG.items():
        program = (
            "import ctypes; from geocosserat.kernel.compile import compile_c; "
            f"f = ctypes.CDLL(str(compile_c('#include <stdlib.h>\\n{code}\\n'))).f; f.argtypes = [ctypes.c_int]; "
            f"print('ran', f(0), flush=True); f({argument}); print('unnoticed')"
        )
        with tempfile.TemporaryDirectory() as cache:
            used = {**environment(tool), "GEOCOSSERAT_CACHE": cache}
            command = [sys.executable, "-c", program]
            done = subprocess.run(command, env=used, capture_output=True, text=True, check=False)
        reported = "AddressSanitizer" in done.stderr or "runtime error" in done.stderr
        if "ran" not in done.stdout or "unnoticed" in done.stdout or not reported:
            missed.append(f"{name}: {done.stderr[-300:]}")
    return missed


def main() -> None:
    """Runs the tests."""
    tool = shutil.which("gcc")
    if tool is None:
        sys.exit("expected gcc on the path, with its sanitisers, found none; install it")
    root = Path(__file__).parents[1]
    command = [sys.executable, "-m", "pytest", "--capture=sys", *sys.argv[1:]]  # a report goes to the terminal
    with tempfile.TemporaryDirectory() as folder:
        tool = light(tool, Path(folder))
        missed = unnoticed(tool)
        if missed:
            sys.exit("expected gcc's sanitisers to report faults, found some that went unnoticed: " + "; ".join(missed))
        code = subprocess.run(command, cwd=root, env=environment(tool), check=False).returncode
    sys.exit(code)


if __name__ == "__main__":
    main()
