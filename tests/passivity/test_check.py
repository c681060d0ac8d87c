"""`check`: the record, the JSON fields, the files, and the exit codes of the program."""

from __future__ import annotations

import json
import os
import tomllib
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner, Result

import geocosserat
from geocosserat.cli import main
from geocosserat.model.errors import InputError
from geocosserat.model.law import load_law
from geocosserat.model.toml_text import to_toml
from geocosserat.passivity.check import check
from tests.passivity.zoo import OPEN, ZOO, planar

FIELDS = {
    "law", "name", "motion", "verdict", "grade", "conditions", "reasons", "stress", "viscous", "wrench", "friction",
    "stability", "symmetry", "assumptions", "not_checked", "seconds",
}  # fmt: skip
INNER = {
    "stress": {"conservative", "energy", "witness"},
    "wrench": {"closed", "exact", "energy", "periods", "witness"},
    "friction": {"dissipative", "margin"},
}
ALL_PARTS = ("all parts", "all parts, one of them odd")
ODD = planar({"F1": "10*(h1 - 1)", "F2": "10*h2 + a*Pi", "M": "Pi - a*h2"}, name="odd", parameters={"a": OPEN})


def call(*words: str) -> Result:
    """The program in this process."""
    return CliRunner().invoke(main, ("check", *words))


@pytest.fixture
def law(tmp_path: Path) -> Any:
    """Writes a law file, returns its name."""

    def write(values: Any, name: str = "law.toml") -> str:
        path = tmp_path / name
        path.write_text(to_toml(dict(values)))
        return str(path)

    return write


@pytest.mark.parametrize("name", ALL_PARTS)
def test_fields_have_all_keys_of_the_contract(name: str) -> None:
    """Of the whole and of every part; JSON without NaN, back and forth the same."""
    fields = check(load_law(ZOO[name].law)).fields
    assert set(fields) >= FIELDS
    assert all(set(fields[part]) >= inner for part, inner in INNER.items())
    assert json.loads(json.dumps(fields, allow_nan=False)) == fields
    assert fields["motion"] == "planar"
    assert all(set(reason) == {"part", "verdict", "grade", "why"} for reason in fields["reasons"])


def test_the_witness_has_its_loop_and_work() -> None:
    """Exact numbers are texts; the bounds hold the work."""
    witness = check(load_law(ZOO["odd, shear and bend"].law)).fields["stress"]["witness"]
    assert set(witness) >= {"loop", "work", "low", "high"}
    assert set(witness["loop"]) >= {"kind", "centre", "along", "radii"}
    assert witness["low"] <= witness["work"] <= witness["high"]
    assert sorted(witness["loop"]["along"]) == ["Pi", "h2"]
    a, b = (float(Fraction(r)) for r in witness["loop"]["radii"])
    assert witness["work"] == pytest.approx(6 * 3.141592653589793 * a * b)  # curl 6 times the area


def test_a_wrench_witness_has_its_loop_and_work() -> None:
    """Words, coordinates, twist and bounds; a period where there is one."""
    fields = check(load_law(ZOO["couple"].law)).fields["wrench"]
    assert (fields["closed"], fields["exact"], fields["energy"]) == (True, False, None)
    assert fields["periods"][0]["work"] == pytest.approx(0.6 * 3.141592653589793)
    assert set(fields["witness"]) >= {"loop", "work", "low", "high", "twist"}


def test_what_a_law_does_not_have_is_not_there() -> None:
    """None in the fields, and said under what was not checked."""
    answer = check(load_law(ZOO["friction, definite"].law))
    assert answer.fields["stress"] is None
    assert answer.fields["wrench"] is None
    assert "stress: the law has none" in answer.not_checked
    assert "wrench: the law has none" in answer.not_checked
    assert not any(text.startswith("friction") for text in answer.not_checked)


def test_brief_leaves_out_what_has_no_say() -> None:
    """The same verdict, without stability and symmetry, and says so."""
    law = load_law(ZOO["all parts"].law)
    full, brief = check(law), check(law, brief=True)
    assert (full.verdict, full.grade, full.parts) == (brief.verdict, brief.grade, brief.parts)
    assert full.stability is not None
    assert full.symmetry is not None
    assert brief.stability is None
    assert brief.symmetry is None
    assert any("left out" in text for text in brief.not_checked)


def test_a_law_that_cannot_be_evaluated_is_not_passive(monkeypatch: pytest.MonkeyPatch) -> None:
    """A part that fails is undecided, with the reason; it cannot vanish from the verdict."""

    def fails(law: Any) -> Any:
        raise TypeError("no such function")

    for name, what in (("check_stress", "stress"), ("wrench_answer", "wrench"), ("friction_answer", "friction")):
        with monkeypatch.context() as patch:
            patch.setattr(f"geocosserat.passivity.check.{name}", fails)
            answer = check(load_law(ZOO["all parts"].law))
        assert (answer.verdict, answer.grade) == ("undecided", None)
        assert f"{what}: no such function" in answer.not_checked
        assert any(reason["part"] == what for reason in answer.fields["reasons"])
        json.dumps(answer.fields, allow_nan=False)


def test_a_failure_of_stability_does_not_change_the_verdict(monkeypatch: pytest.MonkeyPatch) -> None:
    """It is said under what was not checked."""

    def fails(*_: Any) -> Any:
        raise TypeError("no such function")

    monkeypatch.setattr("geocosserat.passivity.check.stability", fails)
    answer = check(load_law(ZOO["all parts"].law))
    assert (answer.verdict, answer.grade) == ("passive", "proved")
    assert "stability: no such function" in answer.not_checked


def test_the_python_function_has_the_fields_as_attributes() -> None:
    """From a mapping, without files."""
    answer = geocosserat.check(ODD)
    assert answer.verdict == "active"
    assert answer.conditions == ["passive if and only if a = 0"]
    assert answer.stress["conservative"] is False
    assert answer.files == ()
    with pytest.raises(AttributeError, match="it has"):
        _ = answer.nonsense


def test_files_are_written_once(tmp_path: Path) -> None:
    """A scene for each witness, a picture, a passage and what was found; none of them is replaced unasked."""
    out = tmp_path / "out"
    answer = geocosserat.check(ODD, out)
    assert sorted(file.name for file in answer.files) == ["check.json", "law.png", "law.tex", "witness_stress.toml"]
    assert {file.name for file in answer.files} == {file.name for file in out.iterdir()}
    assert json.loads((out / "check.json").read_text())["verdict"] == "active"
    scene = tomllib.loads((out / "witness_stress.toml").read_text())
    assert scene["rod"]["law"]["name"] == "odd"
    assert (out / "law.png").read_bytes().startswith(b"\x89PNG")
    before = {file.name: file.read_bytes() for file in out.iterdir()}
    with pytest.raises(InputError, match="none of these files"):
        geocosserat.check(ODD, out)
    assert {file.name: file.read_bytes() for file in out.iterdir()} == before
    geocosserat.check(ODD, out, values={"a": 0.5}, overwrite=True)
    assert tomllib.loads((out / "witness_stress.toml").read_text())["rod"]["law"]["parameters"]["a"] == 0.5


def test_no_witness_of_an_earlier_check_is_left_beside_a_passive_verdict(tmp_path: Path) -> None:
    """What is overwritten is the whole answer; other files are left alone."""
    (tmp_path / "notes.txt").write_text("mine")
    geocosserat.check(ODD, tmp_path, values={"a": 0.5})
    assert (tmp_path / "witness_stress.toml").exists()
    geocosserat.check(ODD, tmp_path, values={"a": 0.0}, overwrite=True)
    assert not (tmp_path / "witness_stress.toml").exists()
    assert (tmp_path / "notes.txt").read_text() == "mine"


def test_the_scene_file_of_a_witness_runs(tmp_path: Path) -> None:
    """By its path, as the program would run it: the law's gain is in the ledger."""
    answer = geocosserat.check(ODD, tmp_path, values={"a": 2.0})
    ledger = geocosserat.run(tmp_path / "witness_stress.toml", settings=["run.backend=numpy"]).ledger
    assert ledger["dissipated"] == pytest.approx(-answer.stress["witness"]["work"], rel=1e-6)


def test_values_close_what_is_open() -> None:
    """With a = 0 the law is passive; a name that it does not have is refused."""
    assert geocosserat.check(ODD, values={"a": 0.0}).verdict == "passive"
    assert geocosserat.check(ODD, values={"a": 0.1}).conditions == []
    with pytest.raises(InputError, match="a parameter of the law"):
        geocosserat.check(ODD, values={"b": 0.1})


def test_out_of_time_is_undecided(tmp_path: Path) -> None:
    """No grade, the reason, no files, and no folder left behind."""
    out = tmp_path / "out"
    answer = geocosserat.check(ZOO["all six coupled"].law, out, seconds=0.05)
    assert (answer.found, answer.verdict, answer.grade, answer.files) == (None, "undecided", None, ())
    assert "seconds" in answer.not_checked[0]
    assert not out.exists()


@pytest.mark.parametrize(
    ("name", "code", "verdict"),
    [
        ("diagonal", 0, "passive"),
        ("odd, shear and bend", 1, "active"),
        ("couple", 1, "driven"),
        ("friction with an open coupling", 3, "undecided"),
    ],
)
def test_exit_codes(law: Any, name: str, code: int, verdict: str) -> None:
    """0 passive, 1 active or driven, 3 undecided; the verdict is in the first line."""
    done = call(law({"name": name, **ZOO[name].law}))
    assert done.exit_code == code
    assert done.stdout.splitlines()[0].startswith(f"{name}: {verdict}")
    assert done.stderr == ""


@pytest.mark.parametrize(
    "text",
    [
        'motion = "planar"\n[stress]\nF1 = "__import__(\'os\').system(\'x\')"\n',
        'motion = "planar"\n[stress]\nF4 = "h1"\n',
        'motion = "planar"\n',
        "motion = [\n",
        'motion = "planar"\n[stress]\nF1 = "h1"\n[energy]\ndensity = "h1"\n',
    ],
)
def test_a_bad_file_is_refused_with_one_message(tmp_path: Path, text: str) -> None:
    """Exit code 2, one line on standard error, nothing on standard output, with or without --json."""
    path = tmp_path / "law.toml"
    path.write_text(text)
    for words in ((str(path),), (str(path), "--json")):
        done = call(*words)
        assert (done.exit_code, done.stdout) == (2, "")
        assert len(done.stderr.splitlines()) == 1
        assert done.stderr.startswith("geocosserat: ")


def test_a_missing_file_is_refused(tmp_path: Path) -> None:
    """Exit code 2."""
    done = call(str(tmp_path / "none.toml"))
    assert done.exit_code == 2
    assert "found no such file" in done.stderr


@pytest.mark.parametrize("name", ["all parts", "odd, shear and bend", "friction with an open coupling"])
def test_json_is_one_object_and_nothing_else(law: Any, name: str) -> None:
    """One line, whatever the verdict is."""
    file = law(ZOO[name].law)
    done = call(file, "--json")
    assert done.stderr == ""
    assert done.stdout.count("\n") == 1
    fields = json.loads(done.stdout)
    assert set(fields) >= FIELDS | {"files"}
    assert fields["verdict"] == ZOO[name].verdict
    assert fields["law"] == file


def test_set_gives_values(law: Any) -> None:
    """The exit code follows the value; what is no number, or no parameter, is refused."""
    file = law(ODD)
    assert call(file).exit_code == 1
    assert call(file, "--set", "a=0").exit_code == 0
    assert call(file, "--set", "a=1e-9").exit_code == 1
    for setting in ("a", "a=x", "a=nan", "a=inf", "=1", "b=1", "a=__import__"):
        done = call(file, "--set", setting)
        assert (done.exit_code, done.stdout) == (2, ""), setting
        assert "--set" in done.stderr


def test_out_names_the_files(law: Any, tmp_path: Path) -> None:
    """On the terminal and in the JSON; a second time is refused unless --overwrite is said."""
    file, out = law(ODD), tmp_path / "found"
    done = call(file, "--out", str(out), "--json")
    assert done.exit_code == 1
    assert {os.path.basename(f) for f in json.loads(done.stdout)["files"]} == {f.name for f in out.iterdir()}
    assert call(file, "--out", str(out)).exit_code == 2
    again = call(file, "--out", str(out), "--overwrite")
    assert again.exit_code == 1
    assert "witness_stress.toml" in "".join(again.stdout.split())
