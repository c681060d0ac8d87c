"""Kernels that exist as text: found, kept, and never used when damaged."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from geocosserat.codegen.identity import identity
from geocosserat.codegen.source import generate
from geocosserat.conductor.kernels import kernel_text
from geocosserat.discretisation.structuring import structure_of
from geocosserat.kernel.library import find, store
from tests.discretisation.rods import changed, load, scene

STRUCTURE = structure_of(scene("planar twisted").model)
NAME = identity(STRUCTURE)


@pytest.fixture
def own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A cache of this test alone."""
    monkeypatch.setenv("GEOCOSSERAT_CACHE", str(tmp_path / "cache"))
    return tmp_path / "cache"


def test_a_kernel_is_generated_once_and_found_again(own: Path) -> None:
    """The second time it comes from the cache, text for text."""
    assert find(NAME) is None
    first, second = kernel_text(STRUCTURE), kernel_text(STRUCTURE)
    assert (first.origin, second.origin) == ("generated", "cache")
    assert (first.c, first.numpy, first.signature) == (second.c, second.numpy, second.signature)
    assert first.c == generate(STRUCTURE).c
    assert [path.name for path in own.iterdir()] == [f"{NAME}.json"]


def record(path: Path, **changes: Any) -> bytes:
    return json.dumps({**json.loads(path.read_text()), **changes}).encode()


DAMAGE: dict[str, Callable[[Path], bytes]] = {
    "cut off": lambda path: path.read_bytes()[:1000],
    "empty": lambda path: b"",
    "not text": lambda path: b"\xff\xfe\x00garbage",
    "another kind of JSON": lambda path: b"[]",
    "nothing": lambda path: b"null",
    "a number": lambda path: b"7",
    "a text": lambda path: b'"c"',
    "without its code": lambda path: json.dumps({"digest": "0"}).encode(),
    "code that is a number": lambda path: record(path, c=7),
    "other C": lambda path: record(path, c=json.loads(path.read_text())["c"] + " "),
    "other Python": lambda path: record(path, numpy="import os"),
    "another signature": lambda path: record(path, signature={"turn": []}),
    "another digest": lambda path: record(path, digest="0" * 64),
    "no digest": lambda path: record(path, digest=None),
}


@pytest.mark.parametrize("damage", DAMAGE)
def test_a_damaged_kernel_is_generated_again_and_never_used(own: Path, damage: str) -> None:
    """Whatever happened to the file."""
    good = kernel_text(STRUCTURE)
    path = own / f"{NAME}.json"
    path.write_bytes(DAMAGE[damage](path))
    assert find(NAME) is None
    again = kernel_text(STRUCTURE)
    assert again.origin == "generated"
    assert (again.c, again.numpy, again.signature) == (good.c, good.numpy, good.signature)
    assert kernel_text(STRUCTURE).origin == "cache"


@pytest.mark.parametrize("mode", [0o620, 0o602])
def test_a_kernel_that_others_may_have_written_is_never_used(own: Path, mode: int) -> None:
    """Its text is run; a checksum that anybody can make is no proof of who wrote it."""
    kernel_text(STRUCTURE)
    (own / f"{NAME}.json").chmod(mode)
    assert find(NAME) is None
    assert kernel_text(STRUCTURE).origin == "generated"
    assert kernel_text(STRUCTURE).origin == "cache"


def test_a_file_that_is_nested_deeply_is_damage(own: Path) -> None:
    """Of which JSON makes another error."""
    kernel_text(STRUCTURE)
    (own / f"{NAME}.json").write_text("[" * 100_000)
    assert find(NAME) is None


def test_the_kernel_of_another_rod_is_not_taken_for_this_one(own: Path) -> None:
    """A file of the cache under another name is damage too."""
    kernel_text(STRUCTURE)
    other = structure_of(changed("planar twisted", ends={"right": load("planar", 1, 0, 0, 0, 0, 0)}).model)
    (own / f"{NAME}.json").rename(own / f"{identity(other)}.json")
    assert find(identity(other)) is None


def test_a_cache_that_cannot_be_written_is_no_reason_to_fail(monkeypatch: pytest.MonkeyPatch) -> None:
    """The kernel is used all the same, and generated again next time."""

    def full(*_: object) -> None:
        raise OSError("no space left")

    monkeypatch.setattr("geocosserat.kernel.library.write_whole", full)
    assert store("0" * 64, "c", "numpy", {}).origin == "generated"
    assert find("0" * 64) is None


def test_shipped_kernels_need_no_cache(monkeypatch: pytest.MonkeyPatch) -> None:
    """The commonest rods run even where no folder can be written."""

    def none() -> Path:
        raise PermissionError("no cache")

    monkeypatch.setattr("geocosserat.kernel.library.cache_folder", none)
    assert kernel_text(structure_of(scene("planar plain").model)).origin == "shipped"


WARM = """
import sys
from geocosserat.codegen.identity import identity
from geocosserat.discretisation.structuring import structure_of
from geocosserat.kernel.library import find
from geocosserat.model.scene import load_scene
found = find(identity(structure_of(load_scene(sys.argv[1]).model)))
print(found.origin, "sympy" in sys.modules, "jinja2" in sys.modules)
"""


def test_a_shipped_kernel_is_found_without_symbolic_algebra(examples: Path) -> None:
    """In a fresh process: neither sympy nor the templates' language is imported."""
    root = Path(__file__).parents[2]
    done = subprocess.run(
        [sys.executable, "-c", WARM, str(examples / "cantilever.toml")], cwd=root, capture_output=True, text=True,
        check=True,
    )  # fmt: skip
    assert done.stdout.split() == ["shipped", "False", "False"]
