"""What docs/laws.md shows works as it says, and the laws under examples/laws are what they say."""

from __future__ import annotations

import json
import re
import shlex
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner, Result

import geocosserat
from geocosserat.algebra.groups import SE2, SE3
from geocosserat.cli import main
from geocosserat.conductor.scene import MOST_SECONDS
from geocosserat.model.errors import InputError
from geocosserat.model.law import LAW_KEYS, PARTS, load_law, pose_names, rates
from geocosserat.passivity.check import check as check_law
from geocosserat.passivity.verdict import GRADES
from tests.conftest import ROOT

pytestmark = pytest.mark.slow

TEXT = (ROOT / "docs" / "laws.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"^```(\w+)\n(.*?)^```", TEXT, re.MULTILINE | re.DOTALL)
LAWS = sorted((ROOT / "examples" / "laws").glob("*.toml"))
LISTED = dict(re.findall(r"^\| `(\w+\.toml)` \| (\w+) \|", TEXT, re.MULTILINE))
CODES = {"passive": 0, "active": 1, "driven": 1, "undecided": 3}
LAW, SCENE = (text for language, text in BLOCKS if language == "toml")
ODD = ROOT / "examples" / "laws" / "odd_planar.toml"


def command(text: str) -> Result:
    """What a line of the page prints, and its code."""
    return CliRunner().invoke(main, shlex.split(text.partition("#")[0].replace("geocosserat ", "", 1)))


def named(heading: str) -> list[str]:
    """The words in backquotes in the last row of the page that begins with a heading."""
    row = re.findall(rf"^\| {re.escape(heading)} \|(.*)$", TEXT, re.MULTILINE)[-1]
    return re.findall(r"`(\w+)`", re.sub(r"\(.*?\)", "", row))


def test_every_law_is_listed_with_its_verdict() -> None:
    """None is missing, none is there that is not listed."""
    assert set(LISTED) == {path.name for path in LAWS}


@pytest.mark.parametrize("path", LAWS, ids=lambda path: path.stem)
def test_an_example_is_what_the_page_and_its_first_line_say(path: Path) -> None:
    """By the command: verdict, proved; the first line is a comment, the second the name."""
    first, second = path.read_text(encoding="utf-8").splitlines()[:2]
    assert first.startswith("# ")
    assert 60 < len(first) <= 120
    assert re.fullmatch(r'name += "[^"]+"', second)
    result = CliRunner().invoke(main, ["check", str(path), "--json"])
    found = json.loads(result.stdout)
    assert (found["verdict"], found["grade"]) == (LISTED[path.name], "proved")
    assert result.exit_code == CODES[found["verdict"]]
    assert found["verdict"] in first.lower()
    text = str(load_law(path))
    assert found["name"] in text


def test_the_examples_show_what_the_page_says_of_them() -> None:
    """Which is stable, which is not, which has a condition, a witness, an energy, and why."""
    found = {path.stem: geocosserat.check(path) for path in LAWS}
    stable = {name for name, f in found.items() if f.stability["parabolic"] and f.stability["definite"]}
    assert stable == {"isotropic", "tension_stiffening", "piecewise", "odd_planar", "beating", "motor", "kelvin_voigt"}
    assert found["tension_stiffening"].stability["convex"] is True
    assert found["tension_stiffening"].stability["grades"]["definite"] == "proved"
    assert found["hertz"].stability["lost"][0]["where"]["h1"] == pytest.approx(1.0)
    assert found["isotropic"].symmetry["words"].startswith("alike in all directions across the axis")
    assert found["odd_planar"].conditions == ["passive if and only if a = 0"]
    assert found["vortex"].stress["curl"] == []
    assert found["vortex"].stress["witness"]["work"] == pytest.approx(2 * np.pi)
    assert found["kelvin_voigt"].viscous["dissipative"] is True
    assert found["kelvin_voigt"].viscous["grade"] == "proved"
    assert found["beating"].stress["timed"] is True
    assert found["beating"].stress["conservative"] is True
    assert found["motor"].wrench["exact"] is False
    assert found["motor"].stress["conservative"] is True


def test_the_law_of_the_page_is_a_law() -> None:
    """As printed; with the line that is commented out, too."""
    law = load_law(LAW)
    assert (dict(law.parameters), dict(law.open)) == ({"k": 40.0, "b": 1.0}, {"a": "real"})
    assert dict(load_law(LAW.replace("# c =", "c =")).open) == {"a": "real", "c": "positive"}
    assert geocosserat.check(LAW).conditions == ["passive if and only if a = 0"]
    same = load_law(ODD)
    assert (law.name, law.stress, law.friction) == (same.name, same.stress, same.friction)


def test_the_page_lists_every_key_and_every_name() -> None:
    """Keys of a law; names of strains, rates, stresses, configurations and wrenches, in both motions."""
    keys = re.findall(r"^\| `(\w+)` \|", TEXT.split("| table or key |")[1], re.MULTILINE)[: len(LAW_KEYS)]
    assert keys == list(LAW_KEYS)
    assert f"At least one of the last {'four' if len(PARTS) == 4 else ''} must be there" in TEXT
    rows = {row: cells for row, *cells in re.findall(r"^\| ([a-z ]+) \| ([^|`]+) \| ([^|`]+) \|$", TEXT, re.MULTILINE)}
    for i, group in enumerate((SE2, SE3)):
        assert rows["strains"][i].split() == list(group.strain)
        assert rows["their rates"][i].split() == list(rates(group))
        assert rows["stress"][i].split() == list(group.stress)
        assert rows["wrench"][i].split() == list(group.wrench)
    assert rows["configuration"][0].split() == list(pose_names(SE2))
    start, end = rows["configuration"][1].split(" ... ")
    assert list(pose_names(SE3))[: len(start.split())] == start.split()
    assert pose_names(SE3)[-1] == end


def test_a_law_knows_neither_the_length_nor_mixed_tables() -> None:
    """What the page says cannot be written is refused."""
    with pytest.raises(InputError, match="the name s is not known"):
        load_law(LAW.replace("a*Pi", "a*Pi*s"))
    with pytest.raises(InputError, match=r"either \[stress\] or \[energy\]"):
        load_law(LAW + "[energy]\ndensity = 'Pi**2'\n")
    with pytest.raises(InputError, match=r"\[stress\], \[energy\], \[wrench\] or \[friction\], found nothing"):
        load_law("motion = 'planar'\n")


def test_the_commands_of_the_page_do_what_it_says(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Those for any law, on the odd rod."""
    text = next(text for language, text in BLOCKS if language == "text" and "check LAW " in text)
    monkeypatch.chdir(tmp_path)
    plain, with_value, out, as_json = (
        command(line.replace("LAW", str(ODD)).replace("DIR", "out")) for line in text.splitlines()
    )
    assert [result.exit_code for result in (plain, with_value, out, as_json)] == [1] * 4
    assert plain.stdout.startswith("odd planar rod: active, proved\ncondition ")
    assert "condition" not in with_value.stdout
    files = {path.name for path in (tmp_path / "out").iterdir()}
    assert files == {"witness_stress.toml", "law.png", "law.tex", "check.json"}
    written = json.loads((tmp_path / "out" / "check.json").read_text(encoding="utf-8"))
    assert list(json.loads(as_json.stdout)) == [*written, "files"]
    assert command(f"geocosserat check {ODD} --set a=0").exit_code == 0
    assert command(f"geocosserat check {ODD} --set z=0").exit_code == 2


def test_the_witness_of_the_page_shows_what_the_law_gives(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    """Both lines as printed; in the ledger stand zero and minus 2 pi a / 100, twice."""
    text = next(text for language, text in BLOCKS if language == "text" and "witness_stress" in text)
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    monkeypatch.chdir(tmp_path)
    check, run = text.splitlines()
    assert command(check).exit_code == 1
    result = command(f"{run} --json")
    assert result.exit_code == 0
    ledger = json.loads(result.stdout)["ledger"]
    given = 2 * np.pi * 0.3 / 100
    assert f"2 pi a / 100 = {given:.5f}" in TEXT
    assert ledger["dissipated"] == pytest.approx(-given, rel=1e-8)
    assert ledger["work"] == pytest.approx(-given, rel=1e-8)
    assert abs(ledger["stored"]) < 1e-9


def test_a_wrench_is_shown_on_a_bead(tmp_path: Path) -> None:
    """That of the motors: what the ledger calls dissipated is what the wrench gave, negative."""
    found = geocosserat.check(ROOT / "examples" / "laws" / "motor.toml", tmp_path / "out")
    assert sorted(path.name for path in found.files) == ["check.json", "law.tex", "witness_wrench.toml"]
    run = geocosserat.run(tmp_path / "out" / "witness_wrench.toml")
    assert run.ledger["dissipated"] == pytest.approx(-found.wrench["witness"]["work"], rel=1e-6)


def test_a_law_that_time_drives_has_no_scene() -> None:
    """As the page says."""
    assert check_law(load_law(ROOT / "examples" / "laws" / "beating.toml")).scenes == {}


def test_the_scene_of_the_page_is_fed_by_its_law(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Beside the laws, as printed: its energy rises and falls as said, and the ledger closes."""
    (tmp_path / "laws").symlink_to(ROOT / "examples" / "laws")
    (tmp_path / "scene.toml").write_text(SCENE, encoding="utf-8")
    run = geocosserat.run(tmp_path / "scene.toml")
    energy = run.solution.energy
    assert f"rises from {energy[0]:.3f} to {energy.max():.3f}" in TEXT
    assert energy[-1] < energy[0]
    assert run.solution.dissipated.min() == pytest.approx(energy[0] - energy.max(), rel=1e-3)
    assert run.ledger["residual"] < 1e-5
    assert run.contents["law"] == {"name": "odd planar rod", "verdict": "active", "grade": "proved"}
    assert "the law odd planar rod is active" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("changes", "wording"),
    [
        ({"wrench": {"f1": "theta"}}, "theta must be the argument of cos or sin"),
        ({"stress": {"M": "Pi + Pi_dot**3"}}, "a stress that is linear in the rates of strain"),
        ({"parameters": {"a": {"symbol": True}}}, "a parameter left open"),
    ],
)
def test_what_cannot_be_run_is_refused(changes: dict[str, Any], wording: str) -> None:
    """An angle by itself, rates that are not linear, and parameters left open."""
    law = {"motion": "planar", "stress": {"M": "Pi"}, "friction": {"matrix": [1, 2, 0.01]}, **changes}
    scene = {"rod": {"motion": "planar", "length": 1.0, "law": law}, "run": {"until": 0.1}}
    with pytest.raises(InputError, match=wording):
        geocosserat.run(scene)


def test_the_page_lists_every_field() -> None:
    """Of the answer, and of its parts; in the order of the program."""
    odd = geocosserat.check(ODD)
    sentence = TEXT.split("fields of `--json`\n")[1].split("What the law")[0]
    assert re.findall(r"`(\w+)`", re.sub(r"\(of each part:.*?\)", "", sentence)) == list(odd.fields)
    assert named("`stress`") == list(odd.stress)
    assert named("`friction`, `viscous`") == list(odd.friction)
    assert named("`wrench`") == list(geocosserat.check(ROOT / "examples" / "laws" / "motor.toml").wrench)
    for name in (*odd.stress["witness"], *odd.stress["witness"]["loop"], *odd.reasons[0]):
        assert f"`{name}`" in TEXT
    late = geocosserat.check(ODD, seconds=0.0)
    sentence = re.findall(r"out of time or memory has only\n(.*)\.", TEXT)[0]
    assert re.findall(r"`(\w+)`", sentence) == list(late.fields)
    assert geocosserat.check(ODD, values={"a": 0.3}).verdict == "active"
    assert 'geocosserat.check(law, values={"a": 0.3})' in TEXT


def test_the_page_says_every_verdict_grade_and_bound() -> None:
    """Verdicts with their codes, grades from the most certain, seconds."""
    rows = dict(re.findall(r"^\| `(passive|active|driven|undecided)` \| .* \| (\d) \|$", TEXT, re.MULTILINE))
    assert {name: int(code) for name, code in rows.items()} == CODES
    assert re.findall(r"^\| `(proved|probable|sampled)` \|", TEXT, re.MULTILINE) == list(reversed(GRADES))
    assert f"more than {MOST_SECONDS:g} seconds" in TEXT
