"""From C to a library: once, safely in parallel, and with a clear word when it cannot be done."""

from __future__ import annotations

import os
import stat
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from geocosserat.conductor.kernels import kernel_text
from geocosserat.conductor.run import run
from geocosserat.discretisation.semidiscrete import discretise
from geocosserat.kernel import compile as compiling
from geocosserat.kernel.compile import CompileError, compile_c, compiler, opened
from geocosserat.kernel.load import load
from geocosserat.locks import lock
from tests.discretisation.rods import changed

ROOT = Path(__file__).parents[2]
SOURCE = "double twice(double x) { return 2.0 * x * DEGREE; }\n"
SHORT = {"until": 1e-3, "frames": 2, "elements": 1, "degree": 3}


@pytest.fixture
def own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A cache of this test alone; whatever compiler it chooses is forgotten afterwards."""
    monkeypatch.setenv("GEOCOSSERAT_CACHE", str(tmp_path / "cache"))
    compiler.cache_clear()
    yield tmp_path / "cache"
    compiler.cache_clear()


def choose(monkeypatch: pytest.MonkeyPatch, tool: str | None) -> None:
    if tool is None:
        monkeypatch.delenv("CC", raising=False)
    else:
        monkeypatch.setenv("CC", tool)
    compiler.cache_clear()


def script(path: Path, text: str) -> str:
    path.write_text(text)
    path.chmod(0o700)
    return str(path)


def test_a_source_is_compiled_once_for_each_degree(own: Path, c_compiler: str) -> None:
    """The library stays; another degree or another text is another library; nothing else is left behind."""
    first = compile_c(SOURCE, 1)
    before = first.stat().st_mtime_ns
    assert compile_c(SOURCE, 1) == first
    assert first.stat().st_mtime_ns == before
    others = {compile_c(SOURCE, 2), compile_c(SOURCE + "\n", 1)}
    assert len({first, *others}) == 3
    assert {path.name for path in own.iterdir()} == {path.name for path in (first, *others)}


def test_another_compiler_or_machine_makes_another_library(
    own: Path, c_compiler: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A cache on a shared home serves every machine its own code."""
    first = compile_c(SOURCE, 1)
    monkeypatch.setattr(compiling, "_machine", lambda: "another machine")
    second = compile_c(SOURCE, 1)
    choose(monkeypatch, script(own.parent / "other-cc", f'#!/bin/sh\nexec {c_compiler} "$@"\n'))
    assert len({first, second, compile_c(SOURCE, 1)}) == 3


def test_no_compiler_is_said_in_words(own: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """CC="" asks for none; so does a CC that is nowhere."""
    for tool in ("", "no-such-compiler-anywhere"):
        choose(monkeypatch, tool)
        assert compiler() is None
        with pytest.raises(CompileError, match=r"expected a C compiler, found none.*; install one, or use the numpy"):
            compile_c(SOURCE, 1)


def test_a_compiler_is_looked_for_where_none_is_named(
    own: Path, c_compiler: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """cc, gcc or clang, in this order."""
    choose(monkeypatch, None)
    assert compiler() is not None
    bin = own.parent / "bin"
    bin.mkdir()
    gcc = script(bin / "gcc", "#!/bin/sh\n")
    monkeypatch.setenv("PATH", str(bin))
    compiler.cache_clear()
    assert compiler() == gcc
    cc = script(bin / "cc", "#!/bin/sh\n")
    compiler.cache_clear()
    assert compiler() == cc


def test_a_compiler_that_refuses_is_quoted(own: Path, c_compiler: str) -> None:
    """The message has its words, and nothing is kept."""
    with pytest.raises(CompileError, match=r"failed on a generated kernel: (.|\n)*rod\.c:1(.|\n)*mistake"):
        compile_c("int f(void) { return mistake; }", 1)
    assert list(own.iterdir()) == []


@pytest.mark.parametrize(
    "text",
    ["#!/bin/sh\necho no room left >&2\nexit 3\n", "#!/bin/sh\necho no room left >&2\nkill -9 $$\n"],
    ids=["fails", "is killed"],
)
def test_a_broken_compiler_is_an_error_with_its_words(own: Path, monkeypatch: pytest.MonkeyPatch, text: str) -> None:
    """However it ends."""
    choose(monkeypatch, script(own.parent / "broken-cc", text))
    with pytest.raises(CompileError, match="broken-cc failed on a generated kernel: no room left"):
        compile_c(SOURCE, 1)


@pytest.mark.parametrize(
    "text", ["", "not a program", "#!/no/such/interpreter\n", "#!/bin/sh\nexit 0\n"],
    ids=["empty", "no program", "no interpreter", "does nothing"],
)  # fmt: skip
def test_a_compiler_that_is_none_is_an_error_of_the_compiler(
    own: Path, monkeypatch: pytest.MonkeyPatch, text: str
) -> None:
    """Not a crash: the numpy kernel can take over."""
    choose(monkeypatch, script(own.parent / "fake-cc", text))
    with pytest.raises(CompileError, match="fake-cc"):
        compile_c(SOURCE, 1)


def test_a_compiler_that_hangs_is_given_up(own: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """After a while that the message names."""
    choose(monkeypatch, script(own.parent / "slow-cc", "#!/bin/sh\nexec sleep 60\n"))
    monkeypatch.setattr(compiling, "PATIENCE", 0.2)
    with pytest.raises(CompileError, match=r"slow-cc .*0\.2 s"):
        compile_c(SOURCE, 1)


def test_a_full_disk_is_an_error_of_the_compiler(own: Path, c_compiler: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """Nowhere to put the library: said in words, and a run goes on in numpy."""

    def full(*_: object, **__: object) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(compiling.tempfile, "TemporaryDirectory", full)
    with pytest.raises(CompileError, match="No space left on device"):
        compile_c(SOURCE, 1)


def test_a_run_goes_on_in_numpy_when_the_compiler_fails(
    own: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """Unless C was asked for; it says why."""
    choose(monkeypatch, script(own.parent / "broken-cc", "#!/bin/sh\necho no room left >&2\nexit 3\n"))
    done = run(changed("planar plain", run=SHORT))
    assert done.solution.backend == "numpy"
    assert "no room left" in capsys.readouterr().err
    with pytest.raises(CompileError, match="no room left"):
        run(changed("planar plain", run=SHORT | {"backend": "c"}))


@pytest.mark.parametrize("damage", [b"", b"not a library", b"\x7fELF cut off"])
def test_a_library_that_was_cut_off_is_made_again(own: Path, c_compiler: str, damage: bytes) -> None:
    """A machine that went down while it was written: the next run compiles once more, and computes the same."""
    r = discretise(changed("planar plain"), 2, 1)
    path = compile_c(kernel_text(r.structure).c, 1)
    path.write_bytes(damage)
    k, out = load(kernel_text(r.structure), r, "c"), np.full(len(r.state), np.nan)
    k.rate(0.0, r.state, out)
    np.testing.assert_array_equal(out, 0)


def _flipped(path: Path) -> bytes:
    """The whole library, with one bit of its code changed."""
    content = bytearray(path.read_bytes())
    content[content.index(b"\x00rod_rate") // 2] ^= 1
    return bytes(content)


def test_a_library_with_one_wrong_bit_is_never_opened(own: Path, c_compiler: str) -> None:
    """It would still load, and compute something else: its name says what is in it."""
    source = (ROOT / "generated" / "planar_clamped_free.c").read_text()
    path = compile_c(source, 2)
    good, bad = path.read_bytes(), _flipped(path)
    opened_with: list[bytes] = []
    path.write_bytes(bad)
    opened(lambda library: opened_with.append(library.read_bytes()), source, 2)
    assert opened_with == [good]
    assert [found.read_bytes() for found in own.iterdir()] == [good]


@pytest.mark.parametrize("mode", [0o720, 0o702, 0o777])
def test_a_library_that_others_may_have_written_is_never_opened(own: Path, c_compiler: str, mode: int) -> None:
    """Though it is as it should be: it need not stay so until it is opened."""
    path = compile_c(SOURCE, 1)
    path.chmod(mode)
    assert stat.S_IMODE(compile_c(SOURCE, 1).stat().st_mode) == 0o700


def test_a_library_of_somebody_else_is_never_opened(
    own: Path, c_compiler: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Nor a link to one."""
    path = compile_c(SOURCE, 1)
    elsewhere = own.parent / "library"
    path.rename(elsewhere)
    path.symlink_to(elsewhere)
    assert not compile_c(SOURCE, 1).is_symlink()
    status = os.fstat
    other = lambda file: os.stat_result((*status(file)[:4], os.getuid() + 1, *status(file)[5:]))  # noqa: E731
    monkeypatch.setattr("geocosserat.kernel.places.os.fstat", other)
    before = path.stat().st_mtime_ns
    assert compile_c(SOURCE, 1).stat().st_mtime_ns != before


def test_what_a_program_left_that_was_ended_is_removed_and_what_others_are_making_is_not(
    own: Path, c_compiler: str
) -> None:
    """The next one that compiles tidies up, unless somebody is at work."""
    compile_c(SOURCE, 1)
    (own / ".part-folder").mkdir()
    (own / ".part-folder" / "rod.c").write_text("half")
    (own / ".part-file").write_text("half")
    with lock(own, shared=True):
        compile_c(SOURCE, 2)
        assert (own / ".part-folder").exists()
    compile_c(SOURCE, 3)
    assert not list(own.glob(".part-*"))
    assert len(list(own.glob("*.so"))) == 3


def test_a_library_that_cannot_be_loaded_is_said_in_words(
    own: Path, c_compiler: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A cache on a file system that runs nothing; a run then goes on in numpy."""

    def refused(*_: object) -> None:
        raise OSError("failed to map segment from shared object")

    monkeypatch.setattr("geocosserat.kernel.load.NativeRod", refused)
    r = discretise(changed("planar plain"), 2, 1)
    with pytest.raises(CompileError, match=r"can be loaded: failed to map segment.*; set GEOCOSSERAT_CACHE"):
        load(kernel_text(r.structure), r, "c")
    assert run(changed("planar plain", run=SHORT)).solution.backend == "numpy"


RACE = """
import sys
from pathlib import Path
from typing import Any
from geocosserat.kernel.compile import compile_c
print(compile_c(Path(sys.argv[1]).read_text(), 2).name)
"""


def test_processes_that_compile_the_same_kernel_at_once_all_succeed(own: Path, c_compiler: str) -> None:
    """Four at a time, one library, no litter."""
    source = ROOT / "generated" / "planar_clamped_free.c"
    command = [sys.executable, "-c", RACE, str(source)]
    pipes: dict[str, Any] = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True}
    racing = [subprocess.Popen(command, cwd=ROOT, env=dict(os.environ), **pipes) for _ in range(4)]
    names = set()
    for process in racing:
        out, errors = process.communicate(timeout=100)
        assert process.returncode == 0, errors
        names.add(out.strip())
    assert len(names) == 1
    assert [path.name for path in own.iterdir()] == list(names)


def test_two_rods_of_one_kernel_do_not_disturb_each_other(c_compiler: str) -> None:
    """One library, two meshes: each kernel owns its numbers and its work space."""
    rods = [discretise(changed("planar plain", rod={"length": length}), n, 2) for length, n in ((1.0, 3), (2.0, 5))]
    kernels = [load(kernel_text(r.structure), r, "c") for r in rods]
    alone = []
    for r, k in zip(rods, kernels, strict=True):
        y = r.state + 0.1
        out = np.empty_like(y)
        k.rate(0.0, y, out)
        alone.append(out)
    for r, k, wanted in zip(rods[::-1], kernels[::-1], alone[::-1], strict=True):
        out = np.empty_like(wanted)
        k.rate(0.0, r.state + 0.1, out)
        np.testing.assert_array_equal(out, wanted)
