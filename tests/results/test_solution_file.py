"""Solution files come back as they were saved, or not at all."""

from __future__ import annotations

import io
import os
import random
import time
import zipfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import h5netcdf
import h5py
import numpy as np
import pytest
import xarray
from hypothesis import given, settings
from hypothesis import strategies as st

from geocosserat.results import netcdf, seal
from geocosserat.results.errors import FileError
from geocosserat.results.netcdf import dataset, load, save
from geocosserat.results.solution import SHAPES, Solution
from tests.results.motions import SCENE, rolling, unrolling, unwinding

ANY_NUMBER = st.floats(allow_nan=True, allow_infinity=True, allow_subnormal=True)
ANY_TEXT = st.text(max_size=40)


@pytest.fixture
def small() -> Solution:
    """A solution whose file is small enough to try every byte."""
    return rolling(frames=3, elements=1, degree=2)


@pytest.mark.parametrize("make", [rolling, unrolling, unwinding])
def test_a_solution_comes_back_bit_for_bit(make, tmp_path: Path) -> None:
    """Planar and spatial, saved and loaded, are the same record."""
    solution = make()
    path = save(solution, tmp_path / "solution.nc")
    assert path == tmp_path / "solution.nc"
    assert load(path) == solution


@settings(max_examples=25, deadline=None)
@given(
    numbers=st.lists(ANY_NUMBER, min_size=3, max_size=3), optional=st.none() | ANY_NUMBER, length=ANY_NUMBER,
    text=ANY_TEXT, counts=st.dictionaries(ANY_TEXT, st.integers(0, 10**15), max_size=3),
    seconds=st.dictionaries(ANY_TEXT, ANY_NUMBER, max_size=3), provenance=st.dictionaries(ANY_TEXT, ANY_TEXT),
    reached=st.booleans(),
)
def test_nothing_that_a_solution_can_hold_is_lost(
    tmp_path_factory: pytest.TempPathFactory, numbers: list[float], optional: float | None, length: float, text: str,
    counts: dict[str, int], seconds: dict[str, float], provenance: dict[str, str], reached: bool,
) -> None:
    """Any numbers (NaN, infinities, subnormal ones), any text, None, and dictionaries of any keys."""
    solution = replace(
        rolling(frames=3, elements=1, degree=2), work=np.array(numbers), requested=optional, length=length, title=text,
        scene=text, reason=text, provenance=provenance, reached=reached, estimated=None,
        evaluations={"rate": 1, "jacobian": 2, "steps": 3} | counts,
        seconds={"derive": 0.1, "compile": 0.2, "plan": 0.3, "solve": 0.4} | seconds,
    )
    path = save(solution, tmp_path_factory.mktemp("any") / "solution.nc")
    assert load(path) == solution


def test_a_large_scene_is_kept_whole(tmp_path: Path) -> None:
    """The text of a scene may have a megabyte, more than the attributes of some formats can hold."""
    solution = rolling(scene="# comment\n" * 100_000)
    assert load(save(solution, tmp_path / "solution.nc")).scene == solution.scene


def test_saving_twice_gives_the_same_bytes(tmp_path: Path) -> None:
    """No clock and no chance enters a file, so files can be compared."""
    one, other = (save(unwinding(), tmp_path / name).read_bytes() for name in ("one.nc", "other.nc"))
    assert one == other


def test_an_older_file_is_replaced(tmp_path: Path) -> None:
    """Saving to the same name leaves the new solution alone in the folder."""
    path = tmp_path / "solution.nc"
    save(rolling(), path)
    save(unrolling(), path)
    assert load(path) == unrolling()
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize("make", [rolling, unwinding])
def test_xarray_opens_the_file_with_the_agreed_names(make, tmp_path: Path) -> None:
    """Dimensions, variables, coordinates, and attributes that say what each variable is and in which units."""
    solution = make()
    path = save(solution, tmp_path / "solution.nc")
    with xarray.open_dataset(path, engine="h5netcdf") as data:
        for name, dimensions in SHAPES.items():
            array = getattr(solution, name)
            if array is None:
                assert name not in data
                continue
            assert data[name].dims == dimensions
            assert np.array_equal(data[name].values, array)
            assert data[name].attrs["units"]
            assert data[name].attrs["long_name"]
        assert set(data.sizes) == {"time", "node", "point", "component", "axis", "frame"}
        assert set(data.coords) == {"time", "u", "u_point"}
        assert "u" in data["position"].coords
        assert "u_point" in data["turn"].coords
        assert data["turn"].attrs["components"].split() == list(solution.group.strain)
        assert data["twist"].attrs["components"].split() == list(solution.group.twist)
        assert data["stress"].attrs["components"].split() == list(solution.group.stress)
        assert data.attrs["scene"] == SCENE
        assert '"kernel": "abc"' in data.attrs["provenance"]
        assert len(data.attrs["checksum"]) == len(seal.BLANK)


def test_dataset_opens_a_good_file_and_refuses_a_bad_one(tmp_path: Path) -> None:
    """The way to xarray checks the file first."""
    path = save(rolling(), tmp_path / "solution.nc")
    with dataset(path) as data:
        assert float(data["angle"][-1, -1]) == pytest.approx(2 * np.pi)
    path.write_bytes(path.read_bytes()[:-1])
    with pytest.raises(FileError, match="checksum"):
        dataset(path)


def test_every_flipped_byte_breaks_the_seal(small: Solution, tmp_path: Path) -> None:
    """All bytes, one after the other, each with a random change."""
    good = save(small, tmp_path / "solution.nc").read_bytes()
    chance = random.Random(1)
    assert seal.intact(good)
    unnoticed = []
    for position in range(len(good)):
        bad = bytearray(good)
        bad[position] ^= chance.randrange(1, 256)
        if seal.intact(bytes(bad)):
            unnoticed.append(position)
    assert unnoticed == []


def test_a_flipped_byte_is_refused_on_loading(tmp_path: Path) -> None:
    """Positions all over the file, its header and the checksum among them; the message names the file."""
    path = save(unwinding(), tmp_path / "solution.nc")
    good = path.read_bytes()
    chance = random.Random(2)
    mark = good.index(seal.MARK.encode())
    positions = {0, 8, 100, len(good) - 1, mark, mark + 30, *(chance.randrange(len(good)) for _ in range(100))}
    for position in sorted(positions):
        bad = bytearray(good)
        bad[position] ^= 1 << chance.randrange(8)
        path.write_bytes(bad)
        with pytest.raises(FileError, match=r"solution\.nc: expected .*checksum.*found|\(the checksum differs\)"):
            load(path)
    path.write_bytes(good)
    assert load(path) == unwinding()


def test_a_truncated_or_prolonged_file_is_refused(small: Solution, tmp_path: Path) -> None:
    """Any shorter file, and one with bytes appended."""
    path = save(small, tmp_path / "solution.nc")
    good = path.read_bytes()
    for bad in (*(good[:size] for size in range(0, len(good), 97)), good[:-1], good + b"\0"):
        path.write_bytes(bad)
        with pytest.raises(FileError, match=r"solution\.nc: expected"):
            load(path)


def test_a_damaged_file_never_reaches_the_hdf5_library(
    small: Solution, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """That library can hang on one."""
    path = save(small, tmp_path / "solution.nc")
    path.write_bytes(path.read_bytes()[:-1])
    monkeypatch.setattr(netcdf.h5netcdf, "File", lambda *_: pytest.fail("reached"))
    with pytest.raises(FileError, match="cut short, damaged or changed"):
        load(path)


def _hdf5() -> bytes:
    image = io.BytesIO()
    with h5py.File(image, "w") as file:
        file["x"] = np.arange(3)
    return image.getvalue()


def _zip() -> bytes:
    image = io.BytesIO()
    with zipfile.ZipFile(image, "w") as file:
        file.writestr("a", "b")
    return image.getvalue()


@pytest.mark.parametrize(
    ("content", "found"),
    [(b"", "an empty file"), (b"hello", "a file of another kind"), (_zip(), "a file of another kind"),
     (_hdf5(), "an HDF5 file without one")],
)
def test_a_foreign_file_is_refused_by_its_name(content: bytes, found: str, tmp_path: Path) -> None:
    """The message says what was found instead and what to do."""
    path = tmp_path / "other.nc"
    path.write_bytes(content)
    with pytest.raises(FileError, match=rf"other\.nc: expected a solution file .*, found {found}; give a file"):
        load(path)


def test_a_missing_file_or_a_folder_is_refused_by_its_name(tmp_path: Path) -> None:
    """As FileError, which is an OSError, with the system's own words."""
    with pytest.raises(FileError, match=r"none\.nc: expected a solution file, found No such file.*; give the path"):
        load(tmp_path / "none.nc")
    with pytest.raises(OSError, match="found Is a directory"):
        load(tmp_path)


def test_a_file_of_another_version_is_refused(
    small: Solution, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Whole and ours, but not of the format that this version reads."""
    with monkeypatch.context() as patch:
        patch.setattr(netcdf, "FORMAT", "geocosserat solution 99")
        path = save(small, tmp_path / "solution.nc")
    with pytest.raises(FileError, match=r"expected the format .* 3', found .* 99'; read it with the version"):
        load(path)


def test_a_scene_may_quote_the_checksum_of_another_file(tmp_path: Path) -> None:
    """In a comment, say, about where its numbers came from."""
    quoted = rolling(scene=f"# from {seal.MARK}{'ab' * 32}\n")
    assert load(save(quoted, tmp_path / "solution.nc")) == quoted
    before, after = seal.seal((quoted.scene + seal.BLANK).encode()), seal.seal((seal.BLANK + quoted.scene).encode())
    assert seal.intact(before)
    assert seal.intact(after)


def test_the_seal_needs_its_one_blank() -> None:
    """Otherwise it would not be known which digits to fill in."""
    with pytest.raises(ValueError, match=r"expected the text .* once in the file, found it 2 times; take it out"):
        seal.seal(2 * seal.BLANK.encode())
    with pytest.raises(ValueError, match="found it 0 times"):
        seal.seal(b"")


@pytest.mark.parametrize("harm", [seal.BLANK, seal.MARK * 100], ids=["a blank checksum", "a hundred of them"])
def test_a_scene_that_leaves_no_room_for_a_checksum_is_one_message(harm: str, tmp_path: Path) -> None:
    """Nothing is written that could not be read again."""
    with pytest.raises(FileError, match=r"solution\.nc: expected .*; checksum: .*take it out of the scene"):
        save(rolling(scene=f"# {harm}\n"), tmp_path / "solution.nc")
    assert list(tmp_path.iterdir()) == []


def test_a_file_full_of_checksums_is_refused_at_once(tmp_path: Path, patience: None) -> None:
    """Each would take as long to try as the file is large."""
    path = tmp_path / "solution.nc"
    path.write_bytes((seal.MARK + "0" * 64).encode() * 20_000)
    with pytest.raises(FileError, match="the checksum differs"):
        load(path)


def _forged(path: Path, change: Callable[[h5py.File], None]) -> None:
    """A file changed by somebody who can make checksums too."""
    image = io.BytesIO(path.read_bytes())
    with h5py.File(image, "r+") as file:
        change(file)
        file.attrs["checksum"] = seal.BLANK
    path.write_bytes(seal.seal(image.getvalue()))


def _without(name: str) -> Callable[[h5py.File], None]:
    return lambda file: file.__delitem__(name)


def _with(name: str, value: Any) -> Callable[[h5py.File], None]:
    return lambda file: file.attrs.__setitem__(name, value)


def _huge(file: h5py.File) -> None:
    """A few bytes that claim to be as many numbers as no memory holds."""
    del file["work"]
    file.create_dataset("work", (10**12,), dtype="f8", chunks=(1000,), fillvalue=1.0)


@pytest.mark.parametrize(
    "change",
    [
        _without("position"), _with("plan", "[" * 100_000), _with("plan", "{"), _with("elements", 10**18),
        _with("elements", "many"), _with("motion", "sideways"), _with("evaluations", "[1]"), _with("contents", "NaN x"),
        _with("length", "a\nb"), _huge,
    ],
)  # fmt: skip
def test_a_forged_file_is_one_message(change: Callable[[h5py.File], None], tmp_path: Path, patience: None) -> None:
    """Whatever is in it, with a right checksum: within bounds of time and memory, and on one line."""
    path = save(rolling(), tmp_path / "solution.nc")
    _forged(path, change)
    with pytest.raises(FileError, match=r"^[^\n]*solution\.nc: expected the contents of a solution file, found others"):
        load(path)


def test_a_library_that_hangs_on_a_file_or_dies_of_it_is_ended(
    tmp_path: Path, patience: None, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It works in a process of its own."""
    path = save(rolling(), tmp_path / "solution.nc")
    for harm, said in ((lambda *_: time.sleep(100), "more than 0.2"), (lambda *_: os.abort(), "ended early")):
        monkeypatch.setattr(netcdf, "MOST_SECONDS", 0.2)
        monkeypatch.setattr(netcdf.h5netcdf, "File", harm)
        with pytest.raises(FileError, match=rf"found others \(.*{said}"):
            load(path)


def test_the_file_needs_no_other_reader_than_hdf5(tmp_path: Path) -> None:
    """Plain h5py and h5netcdf see the numbers and the scene."""
    solution = rolling()
    path = save(solution, tmp_path / "solution.nc")
    with h5py.File(path) as plain, h5netcdf.File(path) as file:
        assert np.array_equal(plain["position"][...], solution.position)
        scene: Any = file.attrs["scene"]
        assert scene == plain.attrs["scene"] == SCENE
