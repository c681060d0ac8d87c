"""The program: what it prints where, its exit codes, and how it puts what is wrong."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner, Result

import geocosserat
from geocosserat.cli import main
from geocosserat.conductor import run as running
from geocosserat.locks import lock
from geocosserat.results.errors import FileError
from tests.model.refusals import REFUSALS, SPATIAL_REFUSALS
from tests.model.scenes import PLANAR, SPATIAL, changed
from tests.referee import paper

ROOT = Path(__file__).parents[1]
QUICK = ("--set", "run.elements=1", "--set", "run.degree=4", "--set", "run.frames=3", "--set", "run.backend=numpy")
FIELDS = {
    "scene", "motion", "unknowns", "method", "elements", "degree", "until", "tip", "base", "energy", "ledger", "error",
    "evaluations", "seconds", "files", "fell_back",
}  # fmt: skip
INNER = {
    "tip": {"position", "rotation"},
    "base": {"position", "rotation"},
    "energy": {"start", "end"},
    "ledger": {"stored", "dissipated", "work", "residual"},
    "error": {"requested", "estimated"},
    "evaluations": {"rate", "jacobian", "steps"},
    "seconds": {"derive", "compile", "plan", "solve"},
}


@pytest.fixture
def cantilever(examples: Path) -> str:
    return str(examples / "cantilever.toml")


def call(*words: str) -> Result:
    """The program in this process."""
    return CliRunner().invoke(main, words)


def program(*words: str, **environment: str) -> subprocess.CompletedProcess[str]:
    """The program in a process of its own."""
    command = [sys.executable, "-m", "geocosserat", *words]
    environment = {**os.environ, **environment}
    return subprocess.run(command, capture_output=True, text=True, cwd=ROOT, timeout=120, check=False, env=environment)


def refused(result: Result | subprocess.CompletedProcess[str]) -> str:
    """The one message of a call that was refused: code 2, one line on standard error, nothing on standard output."""
    code = result.exit_code if isinstance(result, Result) else result.returncode
    assert (code, result.stdout) == (2, "")
    (line,) = result.stderr.splitlines()
    assert line.startswith("geocosserat: ")
    assert line.isprintable()
    return line.removeprefix("geocosserat: ")


def test_json_is_one_object_with_the_agreed_fields_and_nothing_else(cantilever: str, tmp_path: Path) -> None:
    """In a process of its own, with files: standard output parses as it stands, standard error is empty."""
    out = tmp_path / "out"
    done = program("run", cantilever, *QUICK, "--out", str(out), "--json")
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.count("\n") == 1
    fields = json.loads(done.stdout)
    assert set(fields) >= FIELDS
    assert all(set(fields[name]) >= inner for name, inner in INNER.items())
    assert fields["scene"] == cantilever
    assert "angle" in fields["tip"]
    assert len(fields["tip"]["rotation"]) == 2
    assert [Path(file).name for file in fields["files"]] == ["solution.nc", "picture.png", "summary.json"]
    assert json.loads((out / "summary.json").read_text()) == fields
    assert geocosserat.load(out / "solution.nc").position[-1, -1].tolist() == fields["tip"]["position"]


def test_json_in_space_has_matrices_and_no_angle(examples: Path) -> None:
    """Rotation by rows."""
    fields = json.loads(call("run", str(examples / "helix.toml"), *QUICK, "--json").stdout)
    assert "angle" not in fields["tip"]
    assert [len(row) for row in fields["tip"]["rotation"]] == [3, 3, 3]
    assert fields["base"]["position"] == [0.0, 0.0, 0.0]


def test_without_json_the_ledger_and_the_tip_are_printed(cantilever: str) -> None:
    """For people."""
    result = call("run", cantilever, *QUICK)
    assert result.exit_code == 0
    assert result.stderr == ""
    for word in ("cantilever relaxing", "tip", "ledger", "stored", "dissipated", "work", "error", "cost"):
        assert word in result.stdout


def test_accuracy_and_settings_reach_the_run(cantilever: str) -> None:
    """--accuracy is the error requested; --set changes any key; the last one counts."""
    words = ("--accuracy", "1e-3", "--set", "run.backend=numpy", "--set", "kappa=7", "--set", "kappa=50", "--json")
    fields = json.loads(call("run", cantilever, *words).stdout)
    assert fields["error"]["requested"] == 1e-3
    assert fields["error"]["estimated"] <= 1e-3
    direct = geocosserat.run(cantilever, settings=["kappa=50", "run.backend=numpy"], accuracy=1e-3)
    assert fields["tip"] == direct.tip


def test_a_run_that_cannot_go_on_ends_with_three_and_keeps_what_it_has(cantilever: str, tmp_path: Path) -> None:
    """One line says why; the JSON, and the files, hold what was reached. Nothing else is printed."""
    words = ("--set", "run.rtol=1e-30", "--set", "run.atol=1e-300", "--out", str(tmp_path), "--json")
    done = program("run", cantilever, *QUICK, *words)
    assert done.returncode == 3
    (line,) = done.stderr.splitlines()
    assert line.startswith("geocosserat: not reached: CVODE stopped at t = 0")
    fields = json.loads(done.stdout)
    assert fields["reached"] is False
    assert fields["until"] < 0.05
    assert geocosserat.load(tmp_path / "solution.nc").reason == fields["reason"]


def test_a_singular_motion_ends_with_three(cantilever: str) -> None:
    """Curled up a million times it cannot be followed; whatever libraries print, one line and one object come out."""
    curled = ("--set", 'start.strain=["1", "0", "1e8"]', "--set", "run.method=cvode")
    done = program("run", cantilever, *QUICK, *curled, "--json")
    assert done.returncode == 3, done.stderr
    assert len(done.stderr.splitlines()) == 1
    assert json.loads(done.stdout)["reached"] is False


@pytest.mark.parametrize(
    ("base", "path", "value", "message"),
    [(PLANAR, *case) for case in REFUSALS] + [(SPATIAL, *case) for case in SPATIAL_REFUSALS],
)
def test_every_wrong_scene_is_refused_in_one_line(
    base: dict[str, Any], path: str, value: Any, message: str, tmp_path: Path
) -> None:
    """With the file in front of the key; no folder is made for it."""
    scene = tmp_path / "scene.toml"
    entries = changed(base, path, value).items()
    scene.write_text("".join(f"{json.dumps(key)} = {_inline(entry)}\n" for key, entry in entries), encoding="utf-8")
    line = refused(call("run", str(scene), "--out", str(tmp_path / "out"), "--json"))
    assert line.startswith(f"{scene}: ")
    assert "expected" in line
    assert "found" in line
    assert [file.name for file in tmp_path.iterdir()] == ["scene.toml"]


def _inline(value: Any) -> str:
    """TOML on one line, also of what no scene may hold."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{json.dumps(key)} = {_inline(inner)}" for key, inner in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(_inline, value)) + "]"
    return json.dumps(value)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (None, "expected a readable file, found no such file or directory; check the path"),
        (b"", "rod: expected a table, found nothing"),
        (b"rod = ", "expected valid TOML, found Invalid value"),
        (b"title = '\xff'", "line 1: expected UTF-8 text, found the byte 0xff"),
        (b"#" + b"x" * 1_000_001, "expected at most 1 MB, found more"),
        (b"\x00", "expected valid TOML, found"),
    ],
)
def test_a_file_that_is_no_scene_is_refused_in_one_line(content: bytes | None, message: str, tmp_path: Path) -> None:
    """Missing, empty, cut short, of another encoding, too large, binary: the file is named."""
    scene = tmp_path / "scene.toml"
    if content is not None:
        scene.write_bytes(content)
    assert refused(call("run", str(scene))).startswith(f"{scene}: {message}")


@pytest.mark.parametrize("path", ["", "/", "/dev/null/x", "x" * 300])
def test_a_path_that_leads_nowhere_is_refused_in_one_line(path: str) -> None:
    """A folder, no path at all, one through a file, one too long."""
    assert "expected a readable file" in refused(call("run", path))


@pytest.mark.parametrize(
    ("setting", "message"),
    [
        ("kapa=1", "kapa: expected a parameter of the scene or a path in it, found neither; did you mean kappa?"),
        ("rod.lenght=1", "rod.lenght: .*did you mean rod.length?"),
        ("kappa", "--set: expected key=value, found 'kappa'; write for example rod.length=2"),
        ("rod.length=long", "rod.length: expected a number or an expression of the parameters"),
        ("kappa=nan", "parameters.kappa: expected a finite number, found nan"),
        ("run.accuracy=1e-20", "run.accuracy: expected a number between 1e-15 and 1, found 1e-20"),
    ],
)
def test_a_wrong_setting_is_refused_in_one_line(setting: str, message: str, cantilever: str) -> None:
    """The scene's file and the key are named, and the nearest known one."""
    line = refused(call("run", cantilever, "--set", setting))
    assert line.startswith(f"{cantilever}: ")
    assert all(part in line for part in message.split(".*"))


@pytest.mark.parametrize("accuracy", ["nan", "inf", "0", "-1e-3", "2"])
def test_a_wrong_accuracy_is_refused_in_one_line(accuracy: str, cantilever: str) -> None:
    """As in the scene."""
    assert "run.accuracy: expected a" in refused(call("run", cantilever, f"--accuracy={accuracy}"))


def test_a_folder_that_cannot_be_written_is_refused_before_anything_is_computed(
    cantilever: str, tmp_path: Path
) -> None:
    """A file in its place, a path through a file, a file system that takes nothing: for run and generate alike."""
    file = tmp_path / "file"
    file.write_text("mine")
    for out in (file, file / "inside", Path("/proc/none"), Path("/dev/null")):
        for command in (("run", *QUICK), ("generate", "--backend", "numpy")):
            line = refused(call(command[0], cantilever, *command[1:], "--out", str(out)))
            assert line.startswith("--out: expected a folder to write to, found ")
            assert str(out) in line
    assert file.read_text() == "mine"
    assert list(tmp_path.iterdir()) == [file]


def test_a_folder_that_fills_up_is_one_message(
    cantilever: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The disk is full when the results are written: the file is named and no part of one is left."""

    def full(*_: Any) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("os.fsync", full)
    monkeypatch.setattr("geocosserat.results.checkpoint.Keeper.EVERY", 1000.0)
    line = refused(call("run", cantilever, *QUICK, "--out", str(tmp_path)))
    assert "No space left on device" in line
    assert "solution.nc" in line
    assert "what was computed is lost" in line
    assert list(tmp_path.iterdir()) == []


def test_results_stay_unless_overwriting_was_asked_for(cantilever: str, tmp_path: Path) -> None:
    """The second run is refused and changes nothing; the third may."""
    words = ("run", cantilever, *QUICK, "--out", str(tmp_path))
    assert call(*words).exit_code == 0
    before = {file.name: file.read_bytes() for file in tmp_path.iterdir()}
    assert "say --overwrite" in refused(call(*words, "--set", "kappa=9"))
    assert {file.name: file.read_bytes() for file in tmp_path.iterdir()} == before
    assert call(*words, "--set", "kappa=9", "--overwrite").exit_code == 0
    assert {file.name for file in tmp_path.iterdir()} == set(before)
    assert (tmp_path / "solution.nc").read_bytes() != before["solution.nc"]


def test_without_a_compiler_the_program_runs_on_numpy_and_says_so(cantilever: str) -> None:
    """CC="": one line on standard error, the same tip; and if C was asked for, a refusal."""
    done = program("run", cantilever, "--json", CC="")
    assert done.returncode == 0
    assert done.stderr == "no C compiler found: running on numpy, with the same results in more time\n"
    fields = json.loads(done.stdout)
    assert fields["backend"] == "numpy"
    assert fields["tip"]["position"] == pytest.approx([0.82507706946494, 0.51831043029012], abs=1e-6)
    line = refused(program("run", cantilever, "--set", "run.backend=c", CC=""))
    assert "run.backend: expected a C compiler, found none on the path; install one, or set" in line


def test_a_compiler_that_fails_is_one_message(cantilever: str, tmp_path: Path) -> None:
    """With many words of its own; without --set run.backend=c the program goes on in numpy."""
    cc = tmp_path / "cc"
    cc.write_text("#!/bin/sh\necho one >&2\necho two >&2\nexit 1\n")
    cc.chmod(0o755)
    words = ("run", cantilever, "--set", "run.elements=1", "--set", "run.degree=4", "--json")
    line = refused(program(*words, "--set", "run.backend=c", CC=str(cc)))
    assert f"{cc} failed on a generated kernel" in line
    done = program(*words, CC=str(cc))
    assert done.returncode == 0
    assert json.loads(done.stdout)["backend"] == "numpy"


def test_equations_are_derived_as_text_latex_and_json(cantilever: str) -> None:
    """The scene's own model; plain text where the terminal takes no Unicode."""
    text, latex, fields = (
        call("derive", cantilever),
        call("derive", cantilever, "--latex"),
        call("derive", cantilever, "--json"),
    )
    assert (text.exit_code, latex.exit_code, fields.exit_code) == (0, 0, 0)
    assert "Planar rod" in text.stdout
    assert "\\section*{Planar rod" in latex.stdout
    both = json.loads(fields.stdout)
    assert both["text"] == text.stdout
    assert both["latex"] == latex.stdout
    assert both["form"] == "intrinsic"
    plain = program("derive", cantilever, PYTHONIOENCODING="ascii", PYTHONUTF8="0")
    assert plain.returncode == 0
    assert plain.stdout.isascii()
    assert "--form: expected one of intrinsic, coordinates" in refused(call("derive", cantilever, "--form", "other"))


def test_kernels_are_generated_into_a_folder(cantilever: str, tmp_path: Path) -> None:
    """The files are listed, with how to try them; again only with --overwrite; another language is refused."""
    words = ("generate", cantilever, "--backend", "numpy", "--out", str(tmp_path / "kernel"))
    result = call(*words)
    assert result.exit_code == 0
    files = {str(file) for file in (tmp_path / "kernel").iterdir()}
    *listed, hint = result.stdout.splitlines()
    assert set(listed) == files
    assert hint == f"try it: python {tmp_path / 'kernel'}/driver.py"
    assert "say --overwrite" in refused(call(*words))
    fields = json.loads(call(*words, "--overwrite", "--json").stdout)
    assert set(fields["files"]) == files
    assert fields["signature"]
    line = refused(call("generate", cantilever, "--backend", "rust", "--out", str(tmp_path / "other")))
    assert line == '--backend: expected "c" or "numpy", found \'rust\'; choose one of these'
    assert not (tmp_path / "other").exists()


@pytest.mark.parametrize("words", [("walk",), ("run",), ("run", "a.toml", "--ouput", "x"), ("generate", "a.toml")])
def test_a_wrong_command_line_ends_with_two_and_says_where_help_is(words: tuple[str, ...]) -> None:
    """Unknown commands and options, missing arguments."""
    result = call(*words)
    assert (result.exit_code, result.stdout) == (2, "")
    assert "--help" in result.stderr
    assert "Error: " in result.stderr


def test_help_and_version_need_no_scene() -> None:
    """And name every command."""
    text = call("--help")
    assert text.exit_code == 0
    assert all(command in text.stdout for command in ("run", "derive", "generate"))
    assert call("--version").stdout == f"geocosserat, version {geocosserat.__version__}\n"
    assert all(call(command, "-h").exit_code == 0 for command in ("run", "derive", "generate"))


def test_a_reader_that_leaves_early_is_no_error(cantilever: str) -> None:
    """geocosserat derive ... | head -1"""
    with subprocess.Popen(
        [sys.executable, "-m", "geocosserat", "derive", cantilever, "--latex"],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=ROOT,
    ) as process:  # fmt: skip
        assert process.stdout is not None
        assert process.stderr is not None
        process.stdout.close()
        assert process.stderr.read() == ""


@pytest.fixture
def interrupted(monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """A user presses Ctrl-C during the integration."""

    def stop(*_: Any, **__: Any) -> None:
        raise KeyboardInterrupt

    with monkeypatch.context() as patch:
        patch.setattr("geocosserat.conductor.simulate.integrate", stop)
        yield


def test_an_interrupt_ends_with_three_and_says_how_to_go_on(cantilever: str, tmp_path: Path, interrupted: None) -> None:
    """One line, no traceback, a checkpoint and no results."""
    result = call("run", cantilever, *QUICK, "--out", str(tmp_path))
    assert (result.exit_code, result.stdout) == (3, "")
    assert result.stderr == f"geocosserat: interrupted; go on with --out {tmp_path} --resume\n"
    assert not (tmp_path / "solution.nc").exists()


@pytest.mark.parametrize("library", ["click", "matplotlib"])
@pytest.mark.parametrize("error", ["KeyboardInterrupt", "ImportError('initialization failed')"])
def test_an_interrupt_during_imports_is_quiet(library: str, error: str, cantilever: str, tmp_path: Path) -> None:
    """At the start, or of what draws the picture; libraries may make other errors of it. What was written stays."""
    code = f"import os, signal\ntry: os.kill(os.getpid(), signal.SIGINT)\nexcept KeyboardInterrupt: raise {error}\n"
    (tmp_path / f"{library}.py").write_text(code)
    path, out = os.pathsep.join([str(tmp_path), str(ROOT)]), tmp_path / "out"
    done = program("run", cantilever, *QUICK, "--out", str(out), PYTHONPATH=path)
    assert (done.returncode, done.stdout, done.stderr) == (3, "", "geocosserat: interrupted\n")
    assert (out / "solution.nc").exists() == (library == "matplotlib")


@pytest.mark.parametrize("name", ["getsignal", "signal"])
def test_an_interrupt_as_the_program_begins_is_quiet(name: str) -> None:
    """Before it has seen to interrupts, and as it does so."""
    code = (
        "import signal\nfrom geocosserat.__main__ import main\n"
        f"whole = signal.{name}\n"
        "def interrupted(*given):\n    found = whole(*given)\n    signal.raise_signal(signal.SIGINT)\n"
        "    return found\n"
        f"signal.{name} = interrupted\nmain()"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout, done.stderr) == (3, "", "geocosserat: interrupted\n")


def test_an_interrupt_while_words_are_read_is_quiet() -> None:
    """Before any command has begun."""
    code = (
        "import signal, click\nfrom geocosserat.__main__ import main\n"
        "click.Group.parse_args = lambda *_: signal.raise_signal(signal.SIGINT)\nmain()"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stdout) == (3, "")
    assert done.stderr.strip() == "geocosserat: interrupted"


def test_resuming_nothing_is_refused_in_one_line(cantilever: str, tmp_path: Path) -> None:
    """No folder named, or none there."""
    assert "--resume: expected the folder of the interrupted run" in refused(call("run", cantilever, "--resume"))
    line = refused(program("run", cantilever, *QUICK, "--resume", "--out", str(tmp_path / "none")))
    assert "expected a checkpoint to go on from, found none" in line
    assert list(tmp_path.iterdir()) == []


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no device that is always full")
@pytest.mark.parametrize("words", [["--version"], ["derive"], ["run", *QUICK, "--json"], ["run", *QUICK]], ids=" ".join)
def test_output_that_goes_to_a_full_disk_is_one_message(words: list[str], cantilever: str) -> None:
    """What was computed cannot be told; that is said, with code 2."""
    command = [sys.executable, "-m", "geocosserat", *words, *([] if words == ["--version"] else [cantilever])]
    with open("/dev/full", "w") as full:
        done = subprocess.run(command, stdout=full, stderr=subprocess.PIPE, text=True, cwd=ROOT, timeout=120)
    assert done.returncode == 2
    (line,) = done.stderr.splitlines()
    assert line.startswith("geocosserat: expected files and output that can be written, found No space left on device")


def test_without_standard_output_nothing_is_told_and_nothing_is_wrong(cantilever: str) -> None:
    """As a job may be started, with it closed."""
    command = f"exec {sys.executable} -m geocosserat derive {cantilever} >&-"
    done = subprocess.run(command, shell=True, stderr=subprocess.PIPE, text=True, cwd=ROOT, timeout=120)
    assert (done.returncode, done.stderr) == (0, "")


@pytest.mark.parametrize("words", [["run", *QUICK], ["generate", "--backend", "c"], ["equilibrium"]], ids=" ".join)
def test_a_folder_that_another_run_writes_to_is_refused(words: list[str], cantilever: str, tmp_path: Path) -> None:
    """Even with --overwrite, and it stays as it is."""
    command, *more = words
    with lock(tmp_path):
        message = refused(call(command, cantilever, *more, "--out", str(tmp_path), "--overwrite"))
    assert message == (
        f"--out: expected a folder that nobody is writing to, found {tmp_path}, in use; wait, or choose another --out"
    )
    assert list(tmp_path.iterdir()) == []


def test_what_a_program_left_that_was_ended_while_it_wrote_is_removed(cantilever: str, tmp_path: Path) -> None:
    """By the next run into the folder; files of other names are nobody's business."""
    for name in (".0123456789ab.part", ".0123456789ab.party", "0123456789ab.part"):
        (tmp_path / name).write_text("half")
    assert call("run", cantilever, *QUICK, "--out", str(tmp_path)).exit_code == 0
    assert {path.name for path in tmp_path.iterdir()} == {
        ".0123456789ab.party", "0123456789ab.part", "solution.nc", "picture.png", "summary.json"
    }  # fmt: skip


def test_names_of_files_cannot_write_on_the_terminal(cantilever: str, tmp_path: Path) -> None:
    """They are shown as Python writes them."""
    message = refused(call("run", cantilever, "--out", str(tmp_path / "\x1b[31m\n"), "--resume"))
    assert r"\x1b[31m\n/checkpoint.npz: expected a checkpoint" in message


def test_a_disk_that_is_full_at_a_checkpoint_does_not_end_a_run(
    cantilever: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It says so, and comes to its end: there may be room by then."""

    def full(*_: object) -> None:
        raise FileError(tmp_path / "checkpoint.npz", "room", "none", "make some")

    monkeypatch.setattr("geocosserat.results.checkpoint.save_checkpoint", full)
    monkeypatch.setattr("geocosserat.results.checkpoint.Keeper.EVERY", 0.0)
    done = call("run", cantilever, *QUICK, "--out", str(tmp_path))
    assert done.exit_code == 0
    assert "no checkpoint could be written" in done.stderr
    assert (tmp_path / "solution.nc").exists()


def test_a_run_whose_results_do_not_fit_can_be_completed_when_there_is_room(
    cantilever: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Nothing that was computed is lost."""
    with monkeypatch.context() as patched:
        def full(*_: object) -> None:
            raise FileError(tmp_path / "solution.nc", "room", "none", "make some")

        patched.setattr(running, "save", full)
        assert refused(call("run", cantilever, *QUICK, "--out", str(tmp_path))).endswith(
            "make some, and go on with --resume: what was computed is kept"
        )
    assert [path.name for path in tmp_path.iterdir()] == ["checkpoint.npz"]
    steps = []
    monkeypatch.setattr("geocosserat.conductor.simulate.integrate", lambda *_: steps.append(1))
    assert call("run", cantilever, *QUICK, "--out", str(tmp_path), "--resume").exit_code == 0
    assert steps == []


@pytest.fixture
def short_paper(monkeypatch: pytest.MonkeyPatch) -> None:
    """Four statements in place of all."""
    monkeypatch.setattr("paper_checks.SECTIONS", paper.SECTIONS)


def test_the_paper_is_judged_statement_by_statement(short_paper: None) -> None:
    """A line for each, how many have which verdict, and what is right in place of what is not."""
    done = call("paper")
    assert (done.exit_code, done.stderr) == (0, "")
    lines = done.stdout.splitlines()
    assert ["(1a)", "definition", "the", "slope"] in [line.split() for line in lines]
    assert ["all", "1", "1", "1", "1", "0"] in [line.split() for line in lines]
    assert "corrected  \\dot\\Pi-\\Omega'=\\Pi\\times\\Omega" in lines


def test_verdicts_as_json_have_the_agreed_fields(short_paper: None) -> None:
    """One object and nothing else; a part only where there is one."""
    done = call("paper", "--json")
    assert (done.exit_code, done.stderr, done.stdout.count("\n")) == (0, "", 1)
    fields = json.loads(done.stdout)
    assert set(fields) == {"statements", "summary", "seconds", "files"}
    assert all(set(s) >= {"id", "verdict", "printed", "derived", "remark", "how"} for s in fields["statements"])
    assert [s.get("part") for s in fields["statements"]] == ["(1a)", "(1b)", None, None]
    assert [s["verdict"] for s in fields["statements"]] == ["definition", "misprint", "holds", "conditional"]
    assert fields["files"] == []


def test_a_statement_that_fails_ends_with_one(short_paper: None, monkeypatch: pytest.MonkeyPatch) -> None:
    """With all that is said otherwise, and why."""
    monkeypatch.setattr("paper_checks.SECTIONS", (*paper.SECTIONS, paper.failing()))
    done = call("paper")
    assert (done.exit_code, done.stderr) == (1, "")
    assert "decided    the printed form does not follow, and no other is given: refuted" in done.stdout
    done = call("paper", "--json")
    assert done.exit_code == 1
    assert json.loads(done.stdout)["statements"][-1]["verdict"] == "fails"


def test_the_page_is_written_once_unless_it_may_be_replaced(short_paper: None, tmp_path: Path) -> None:
    """Into a folder that is made for it; with --json, the file is named there."""
    file = tmp_path / "new" / "paper.html"
    done = call("paper", "--html", str(file))
    assert done.exit_code == 0
    assert done.stdout.splitlines()[-1] == f"wrote {file}"
    assert [f.name for f in file.parent.iterdir()] == ["paper.html"]
    page = file.read_bytes()
    assert b"Geometric Field Theory for Elastohydrodynamics of Cosserat Rods" in page
    file.write_text("mine")
    line = refused(call("paper", "--html", str(file)))
    assert line == f"--html: expected no such file yet, found {file}; choose another --html, or say --overwrite"
    assert file.read_text() == "mine"
    fields = json.loads(call("paper", "--html", str(file), "--overwrite", "--json").stdout)
    assert fields["files"] == [str(file)]
    assert file.read_bytes() == page


def test_a_page_that_cannot_be_written_is_refused_before_anything_is_judged(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A folder in its place, a path through a file, a file system that takes nothing."""

    def judged(*_: Any) -> None:
        raise AssertionError("expected a refusal first")

    monkeypatch.setattr("geocosserat.cli.review_paper", judged)
    file = tmp_path / "file"
    file.write_text("mine")
    assert refused(call("paper", "--html", str(tmp_path))).startswith(
        f"--html: expected a file to write, found {tmp_path}, a folder; name a file in it"
    )
    for target in (file / "paper.html", Path("/proc/none/paper.html"), tmp_path / ("x" * 300)):
        line = refused(call("paper", "--html", str(target)))
        assert line.startswith("--html: expected a file to write, found ")
        assert str(target) in line
    assert [f.name for f in tmp_path.iterdir()] == ["file"]


def test_a_disk_that_is_full_leaves_no_part_of_a_page(
    short_paper: None, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """One message."""

    def full(*_: Any) -> None:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr("os.fsync", full)
    assert "No space left on device" in refused(call("paper", "--html", str(tmp_path / "paper.html")))
    assert list(tmp_path.iterdir()) == []


def test_judging_may_be_interrupted(monkeypatch: pytest.MonkeyPatch) -> None:
    """One line, no traceback."""

    def stop(*_: Any) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("geocosserat.cli.review_paper", stop)
    done = call("paper")
    assert (done.exit_code, done.stdout, done.stderr) == (3, "", "geocosserat: interrupted\n")


@pytest.mark.slow
def test_the_whole_paper_is_judged_and_shown(tmp_path: Path) -> None:
    """In a process of its own: no statement fails, each is on the page, in the order of the paper's own list."""
    file = tmp_path / "paper.html"
    done = program("paper", "--json", "--html", str(file))
    assert (done.returncode, done.stderr) == (0, "")
    fields = json.loads(done.stdout)
    counts = fields["summary"]["total"]
    assert counts["fails"] == 0
    assert sum(counts.values()) == len(fields["statements"])
    assert file.read_text().count("<article") == len(fields["statements"])
