"""The shipped kernels are what the generator writes today, for rods that people have."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from geocosserat.codegen.catalogue import catalogue, files, write
from geocosserat.codegen.identity import identity
from geocosserat.discretisation.structuring import structure_of
from geocosserat.kernel.library import find
from geocosserat.model.scene import load_scene
from geocosserat.shipped import shipped

COMMON = ("cantilever", "helix", "sinking", "elastica")
"""Examples that start at once: their kernels are shipped, or one of the same structure is."""


def test_the_shipped_kernels_are_what_the_generator_writes() -> None:
    """Byte for byte, every file and no other; after a change: make generated."""
    wanted = {name: content.encode() for name, content in files()}
    found = {path.name: path.read_bytes() for path in shipped("generated").iterdir() if path.is_file()}
    assert set(found) == set(wanted)
    different = [name for name in wanted if found[name] != wanted[name]]
    assert not different, f"expected what the generator writes, found other text in {different}; run make generated"


@pytest.mark.parametrize(("stem", "title", "values"), list(catalogue()), ids=lambda x: x if isinstance(x, str) else "")
def test_every_shipped_kernel_is_found_by_its_rod(stem: str, title: str, values: dict[str, object]) -> None:
    """Its own identity, both texts, and a title that says which rod it is for."""
    name = identity(structure_of(load_scene(values).model))
    found = find(name)
    assert found is not None
    assert (found.identity, found.origin, found.signature["identity"]) == (name, "shipped", name)
    assert title in found.c.splitlines()[0]
    assert found.c == (shipped("generated") / f"{stem}.c").read_text()


def test_no_two_shipped_kernels_are_the_same() -> None:
    """One entry for each structure."""
    names = [json.loads(path.read_text())["identity"] for path in shipped("generated").glob("*.json")]
    assert len(set(names)) == len(names) == len(list(catalogue()))


def test_writing_the_catalogue_removes_what_is_no_longer_in_it(tmp_path: Path) -> None:
    """And touches nothing but kernels."""
    for name in ("gone.c", "gone.json", "gone.py", "README.md"):
        (tmp_path / name).write_text("old")
    write(tmp_path)
    names = {path.name for path in tmp_path.iterdir()}
    assert names == {name for name, _ in files()} | {"README.md"}


@pytest.mark.parametrize("example", ["cantilever", "helix"])
def test_the_demonstrations_start_without_symbolic_algebra(examples: Path, example: str) -> None:
    """What one tries first has a shipped kernel."""
    found = find(identity(structure_of(load_scene(examples / f"{example}.toml").model)))
    assert found is not None
    assert found.origin == "shipped"
