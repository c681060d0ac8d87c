"""Files and texts: unreadable, hostile or odd ones are refused at once, with the line if there is one."""

from __future__ import annotations

import pickle
from pathlib import Path
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from geocosserat.model.errors import InputError
from geocosserat.model.reading import read
from geocosserat.model.scene import load_scene
from geocosserat.model.toml_text import to_toml

SCENE = """\
title = "a scene"
[rod]
motion = "planar"
length = 1.0
stiffness = [1e4, 1e4, 1.0]
friction = [1.0, 2.0, 0.01]
[run]
until = 1.0
"""


def test_a_file_and_its_text_give_the_same_scene(tmp_path: Path) -> None:
    """A path as str or Path, the text itself: the same model; the file is remembered."""
    file = tmp_path / "scene.toml"
    file.write_text(SCENE, encoding="utf-8")
    by_text = load_scene(SCENE)
    for path in (file, str(file)):
        scene = load_scene(path)
        assert (scene.model, scene.start, scene.run) == (by_text.model, by_text.start, by_text.run)
        assert scene.source == by_text.source == SCENE
        assert scene.path == str(file)
    assert by_text.path is None


@pytest.mark.parametrize("content", ["\ufeff" + SCENE, SCENE.replace("\n", "\r\n")])
def test_files_of_other_editors_are_read(tmp_path: Path, content: str) -> None:
    """A byte order mark and carriage returns do no harm."""
    file = tmp_path / "scene.toml"
    file.write_bytes(content.encode())
    assert load_scene(file).title == "a scene"


@pytest.mark.parametrize(
    ("content", "wording"),
    [
        (
            b"title = \xff\n",
            r"scene.toml: line 1: expected UTF-8 text, found the byte 0xff; save the file as UTF-8",
        ),
        (b"a = 1\nb = '\xe9'\n", "line 2: expected UTF-8 text, found the byte 0xe9"),
        (b"a = \n", r"scene.toml: expected valid TOML, found .*line 1.*; correct that line"),
        (
            b"[rod]\nlength = 1\nlength = 2\n",
            r"expected valid TOML, found Cannot overwrite a value \(at line 3",
        ),
        (b"[rod\nlength = 1\n", "expected valid TOML, found .*line 1"),
        (b"a = 1\0\n", "expected valid TOML, found .*line 1"),
        (b"", r"rod: expected a table, found nothing; write \[rod\]"),
        (b"a = " + b"9" * 9000 + b"\n", "expected valid TOML"),
        (b"rod = 2000-01-01\nrun = {}\n", "rod: expected a table, found a date"),
        (b"x" * 1_000_001, "expected at most 1 MB, found more"),
        (b"\xff" * 1_000_001, "expected at most 1 MB, found more"),
        (b"\xc3\xa9\n" * 400_000, "expected at most 1 MB, found more"),
        (
            b"a = 1 # " + b"x" * 12_000 + b"\n",
            "line 1: expected lines of at most 12000 characters, found one of 12008",
        ),
        (b"a = [\n" + b"[\n" * 100_000, "expected (at most 8 levels|valid TOML)"),
        (
            b"a = " + b"[" * 5900 + b"]" * 5900 + b"\n",
            "expected at most 8 levels of nesting, found more; write it flatter",
        ),
        (b"a." * 5900 + b"a = 1\n", "expected at most 8 levels of nesting"),
        (b"[" + b"a." * 5900 + b"a]\n", "expected at most 8 levels of nesting"),
        (b"[a]\n" * 200_000, "expected valid TOML, found Cannot declare"),
        (b"\n".join(b"k%d = 1" % i for i in range(60_000)), "k0: expected one of title"),
        (
            b"[parameters]\n" + b"".join(b"k%d = 'k%d'\n" % (i, i + 1) for i in range(1000)),
            "k1000 is not known",
        ),
        (b"[parameters]\n" + b"".join(b"k%d = 'k%d'\n" % (i, (i + 1) % 1000) for i in range(1000)), "itself"),
        (
            b"[parameters]\n" + b"".join(b"k%d = 1\n" % i for i in range(60_000)),
            "at most 1000 parameters, found 60000",
        ),
        (b"[rod]\n'" + b"k" * 11_000 + b"' = 1\n[run]\n", "found an unknown key"),
        (b"[rod]\nmotion = '" + b"k" * 11_000 + b"'\n[run]\n", r"rod.motion: .* found 'k{57}\.\.\.'"),
        (b'"a\\u001b[31m\\nb" = 1\n', r"'a\\x1b\[31m\\nb': expected one of"),
    ],
    ids=range(25),
)
@pytest.mark.usefixtures("patience")
def test_a_file_that_is_no_scene_is_refused_at_once(tmp_path: Path, content: bytes, wording: str) -> None:
    """Wrong encoding, wrong syntax, wrong size, made to take forever: one short message, quickly."""
    file = tmp_path / "scene.toml"
    file.write_bytes(content)
    with pytest.raises(InputError, match=wording) as caught:
        load_scene(file)
    assert len(str(caught.value)) < 800
    assert str(caught.value).isprintable()


@pytest.mark.parametrize(
    ("path", "wording"),
    [
        (
            "missing.toml",
            "missing.toml: expected a readable file, found no such file or directory; check the path",
        ),
        (".", "expected a readable file, found is a directory"),
        ("", "expected a readable file, found no such file"),
        ("a\0b", r"'a\\x00b': expected a readable file, found embedded null"),
    ],
)
def test_a_path_to_no_file_says_so(path: str, wording: str) -> None:
    """Missing, a directory, not even a path."""
    with pytest.raises(InputError, match=wording):
        load_scene(path)


def test_an_endless_file_is_read_no_further_than_allowed() -> None:
    """/dev/zero has no end, and is too large."""
    with pytest.raises(InputError, match="/dev/zero: expected at most 1 MB"):
        load_scene("/dev/zero")


@pytest.mark.parametrize("thing", [3, None, ["a"]])
def test_only_paths_texts_and_mappings_are_scenes(thing: Any) -> None:
    """Anything else is refused by type."""
    with pytest.raises(InputError, match="scene: expected a path, TOML text or a mapping, found"):
        load_scene(thing)


def test_keys_of_a_mapping_are_words() -> None:
    """From Python a key could be anything."""
    with pytest.raises(InputError, match="rod: expected keys that are words, found 1"):
        load_scene({"rod": {1: 2}})


def test_a_mapping_inside_itself_is_refused() -> None:
    """No endless loop."""
    circle: dict[str, Any] = {}
    circle["rod"] = circle
    with pytest.raises(InputError, match="at most 8 levels"):
        load_scene(circle)


def test_an_error_survives_another_process() -> None:
    """A sweep sends errors between processes."""
    error = InputError("a number", "'x'", "write one", key="rod.length", file="scene.toml")
    again = pickle.loads(pickle.dumps(error))
    assert str(again) == str(error) == "scene.toml: rod.length: expected a number, found 'x'; write one"
    assert vars(again) == vars(error)


@given(st.binary(max_size=200) | st.text("[]{}=.,'\"\\#\n abc01", max_size=200).map(str.encode))
@settings(max_examples=300)
def test_any_bytes_are_a_scene_or_refused(tmp_path_factory: pytest.TempPathFactory, content: bytes) -> None:
    """No content of a file raises anything but InputError."""
    file = tmp_path_factory.getbasetemp() / "any.toml"
    file.write_bytes(content)
    with pytest.raises(InputError):
        load_scene(file)


words = st.text(st.characters(codec="utf-8"), max_size=8)
values = st.recursive(
    words | st.booleans() | st.integers(-(2**63), 2**63 - 1) | st.floats(allow_nan=False),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(words, inner, max_size=3),
    max_leaves=8,
)


@given(st.dictionaries(words, values, max_size=4))
@settings(max_examples=500)
def test_written_toml_reads_back(tables: dict[str, Any]) -> None:
    """``to_toml`` loses nothing of any tables: quotes, control characters, empty keys, lists of tables."""
    text = to_toml(tables)
    assert read(text + "\n").values == tables
