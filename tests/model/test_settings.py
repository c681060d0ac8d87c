"""Settings: ``key=value`` changes a scene as if the file had been edited."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from geocosserat.model.errors import InputError
from geocosserat.model.expressions import Number, parse
from geocosserat.model.scene import load_scene
from geocosserat.model.schema import scene_paths
from geocosserat.model.settings import apply_settings
from tests.model.scenes import PLANAR, changed

EXAMPLES = sorted((Path(__file__).parents[2] / "examples").glob("*.toml"))


@pytest.mark.parametrize(
    ("setting", "path", "value"),
    [
        ("kappa=1e5", "parameters.kappa", 1e5),
        ("parameters.kappa=1e5", "parameters.kappa", 1e5),
        (" kappa = 1e5 ", "parameters.kappa", 1e5),
        ("kappa=2*load", "parameters.kappa", "2*load"),
        ("kappa='2*load'", "parameters.kappa", "2*load"),
        ("kappa=.5", "parameters.kappa", ".5"),
        ("rod.length=2", "rod.length", 2),
        ("rod.length=pi/2", "rod.length", "pi/2"),
        ("rod.stiffness.2=load", "rod.stiffness.2", "load"),
        ("rod.stiffness=[1, 2, 3]", "rod.stiffness", [1, 2, 3]),
        ("rod.reference=['1', '0', 'u']", "rod.reference", ["1", "0", "u"]),
        ("start.angle=1", "start.angle", 1),
        ("ends.right.force=[0, -2]", "ends.right.force", [0, -2]),
        ("ends.right.force.1=sin(t)", "ends.right.force.1", "sin(t)"),
        ("ends.right.frame=body", "ends.right.frame", "body"),
        ("ends.left.kind=free", "ends.left.kind", "free"),
        ("effects.0.force=[1, 0]", "effects.0.force", [1, 0]),
        ("effects.0.force.0=u", "effects.0.force.0", "u"),
        ("effects=[]", "effects", []),
        ("run.until=3", "run.until", 3),
        ("run.degree=12", "run.degree", 12),
        ("run.method=radau", "run.method", "radau"),
        ("title=A = B", "title", "A = B"),
    ],
)
def test_a_setting_is_an_edit(setting: str, path: str, value: Any) -> None:
    """Setting a path and writing the value there give the same scene, whether or not the key was there."""
    by_setting, by_edit = load_scene(PLANAR, [setting]), load_scene(changed(PLANAR, path, value))
    assert by_setting == by_edit


@pytest.mark.parametrize("path", scene_paths())
def test_every_path_of_the_format_can_be_set(path: str) -> None:
    """What is known to the format can be set even if the file does not have it."""
    values = changed(PLANAR, "title", "x")
    apply_settings(values, [f"{path}=7"], "scene")
    target: Any = values
    for step in path.split("."):
        target = target[step]
    assert target == 7


def test_the_last_setting_wins_and_settings_see_each_other() -> None:
    """Settings apply in their order."""
    scene = load_scene(PLANAR, ["load=1", "effects=[{kind='weight', force=[0,0]}]", "effects.0.force.1=7", "load=3"])
    assert scene.model.parameters["load"] == 3.0
    assert scene.model.effects[0].force == (Number(0.0), Number(7.0))


def test_a_parameter_of_others_follows_them() -> None:
    """Setting one parameter changes those defined by it."""
    scene = load_scene(changed(PLANAR, "parameters.double", "2*load"), ["load=5"])
    assert scene.model.parameters["double"] == 10.0


def test_a_parameter_goes_before_a_key_of_the_same_name() -> None:
    """A parameter called ``title`` is still a parameter."""
    scene = load_scene(changed(PLANAR, "parameters.title", 1), ["title=2"])
    assert (scene.title, scene.model.parameters["title"]) == ("untitled", 2.0)


def test_one_setting_may_be_given_without_a_list() -> None:
    """A single string is one setting, not a list of characters."""
    assert load_scene(PLANAR, "rod.length=3").model.length == 3.0  # the length is a setting


@pytest.mark.parametrize(
    ("setting", "wording"),
    [
        (
            "kapa=1",
            r"scene: kapa: expected a parameter of the scene or a path in it, found neither; did you mean k",
        ),
        ("rod.lenght=1", r"rod.lenght: .* did you mean rod.length\?"),
        ("length=1", r"length: .* did you mean rod.length\?"),
        ("rodlength=1", r"did you mean rod.length\?"),
        ("zzz=1", r"zzz: .* set a parameter \(kappa, load\) or a path such as rod.length"),
        ("parameters.new=1", r"parameters.new: .* found neither; set a parameter \(kappa, load\)"),
        ("rod=1", "rod: .* rod is a table: set rod.motion, rod.length"),
        ("ends.right=1", "ends.right is a table: set ends.right.kind"),
        ("effects.0=1", "effects.0 is a table: set "),
        ("effects.force=1", r"did you mean effects.0.force\?"),
        ("effects.0.forse=1", r"did you mean effects.0.force\?"),
        (
            "effects.1.force=[0, 1]",
            "effects: expected an index from 0 to 0, found '1'; or set effects as a whole",
        ),
        (
            "rod.stiffness.3=1",
            "rod.stiffness: expected an index from 0 to 2, found '3'; or set rod.stiffness as a whole",
        ),
        ("rod.stiffness.-1=1", "expected an index from 0 to 2, found '-1'"),
        (
            "rod.stiffness.0.0=1",
            "rod.stiffness.0: expected a table or a list, found 'kappa'; set rod.stiffness.0 as a",
        ),
        ("rod.length.x=1", "rod.length: expected a table or a list, found 1.0"),
        ("kappa", "--set: expected key=value, found 'kappa'; write for example rod.length=2"),
        ("kappa=", "--set: expected key=value"),
        ("=1", "--set: expected key=value"),
        ("", "--set: expected key=value"),
        ("kappa=true", "parameters.kappa: expected a number, found the boolean true"),
        ("kappa=[1]", r"parameters.kappa: expected a number, found \[1\]"),
        ("kappa=nan", "parameters.kappa: expected a finite number, found nan"),
        ("kappa=1\nrod.length = 2", "parameters.kappa: expected a number or an expression"),
        ("kappa=" + "[" * 5000, "parameters.kappa: expected a number or an expression"),
        ("a" * 5000 + "=1", "found neither"),
        ("a." * 5000 + "=1", "found neither"),
        ("\x1b[31m=1", r"'\\x1b\[31m': expected a parameter"),
        ("rod.length=0", "rod.length: expected a positive number, found 0"),
    ],
)
def test_a_setting_of_nothing_known_is_refused(setting: str, wording: str) -> None:
    """Neither a parameter nor a path: the nearest of both is suggested."""
    with pytest.raises(InputError, match=wording) as caught:
        load_scene(PLANAR, [setting])
    assert str(caught.value).isprintable()
    assert len(str(caught.value)) < 400


def test_a_setting_into_what_is_no_table_is_refused() -> None:
    """The file is wrong there, and the message says where."""
    with pytest.raises(InputError, match="rod: expected a table or a list, found 3; set rod as a whole"):
        load_scene(changed(PLANAR, "rod", 3), ["rod.length=1"])


@pytest.mark.parametrize("file", EXAMPLES, ids=lambda file: file.stem)
def test_the_source_of_a_changed_scene_is_the_changed_scene(file: Path) -> None:
    """What is kept beside a solution loads to the scene that was solved, settings and all."""
    scene = load_scene(file, ["run.until=0.125", "run.frames=7", 'title="quoted" \\ title'])
    again = load_scene(scene.source)
    assert (again.title, again.model, again.start, again.run) == (
        scene.title,
        scene.model,
        scene.start,
        scene.run,
    )
    assert scene.run.until == 0.125
    assert scene.run.frames == 7
    assert again.source == scene.source


def test_the_source_of_a_mapping_is_toml() -> None:
    """A scene built in Python can be saved as a file."""
    scene = load_scene(changed(PLANAR, "rod.reference", ("1", 0, "2*u")))
    again = load_scene(scene.source)
    assert (again.model, again.start, again.run) == (scene.model, scene.start, scene.run)
    assert again.model.reference[2] == parse("2*u", {"u"})
