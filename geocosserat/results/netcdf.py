"""Solution files: netCDF-4 through h5netcdf, which imports in a tenth of the time of xarray.

A file holds every field of a Solution: arrays as variables, the rest as attributes (None is an absent one, a
dictionary or list is JSON), and a checksum over all bytes. xarray, ncdump and any HDF5 tool read it.
"""

from __future__ import annotations

import io
import json
import os
from collections.abc import Mapping
from dataclasses import fields
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import h5netcdf

from geocosserat.bounded import MEMORY, bounded
from geocosserat.results import seal
from geocosserat.results.atomic import write_bytes
from geocosserat.results.errors import FileError
from geocosserat.results.solution import SHAPES, TEXTS, Solution

if TYPE_CHECKING:
    import xarray

FORMAT = "geocosserat solution 3"
MOST_SECONDS, LEAST_RATE, COPIES = 30.0, 20e6, 8
"""What reading may take: seconds, for so many bytes of the file another one, and memory for so many copies of it."""

_OBJECTS = ("evaluations", "seconds", "contents", "provenance", "plan", "fell_back")
_INTEGERS = ("elements", "degree", "unknowns", "reached")
_NUMBERS = ("length", "requested", "estimated")

# what each variable is, and its dimension in words: any consistent set of units will do
_MEANING: Mapping[str, tuple[str, str]] = {
    "time": ("time", "time"),
    "u": ("distance along the rod at rest, of the nodes", "length"),
    "u_point": ("distance along the rod at rest, of the Gauss points", "length"),
    "position": ("position of the rod, world components", "length"),
    "rotation": ("rotation matrix, whose column i is the frame vector e_i", "1"),
    "angle": ("angle of the frame vector e_1 to the x axis, unwrapped", "radian"),
    "twist": ("velocity of the configuration, moving frame", "length/time for v, 1/time for Omega"),
    "turn": ("strain of the configuration, moving frame", "1 for h, 1/length for Pi"),
    "stress": ("force and moment across the section, moving frame", "force for F, force x length for M"),
    "energy": ("stored elastic energy", "force x length"),
    "dissipated": ("energy taken by friction since the start", "force x length"),
    "work": ("work done on the rod since the start by its ends and the effects", "force x length"),
}


def save(solution: Solution, path: str | os.PathLike[str]) -> Path:
    """Write a solution file, atomically: at `path` there is the whole file or what was there before.

    Raises FileError when it cannot be written.
    """
    try:
        sealed = seal.seal(_image(solution))
    except ValueError as error:
        raise FileError(path, "a scene that leaves room for a checksum", "another one", str(error)) from None
    return write_bytes(path, sealed)


def load(path: str | os.PathLike[str]) -> Solution:
    """The solution in a file, equal bit for bit to the one that was saved.

    Raises FileError when the file is missing, is not a solution file, or differs in any byte from what was
    written.
    """
    sealed = _verified(path)
    size, seconds = len(sealed), MOST_SECONDS + len(sealed) / LEAST_RATE
    try:
        return Solution(**bounded(partial(_contents, path, sealed), seconds, MEMORY + COPIES * size))
    except FileError:
        raise
    except Exception as error:  # the library may make anything of a file that was written to do harm
        said = " ".join(str(error).split())[:200] or type(error).__name__
        raise FileError(path, "the contents of a solution file", f"others ({said})", "repeat the run") from None


def _contents(path: str | os.PathLike[str], sealed: bytes) -> dict[str, Any]:
    """The fields of a solution."""
    with h5netcdf.File(io.BytesIO(sealed), "r") as file:
        attributes = dict(file.attrs)
        if attributes.get("format") != FORMAT:
            raise FileError(path, f"the format {FORMAT!r}", repr(attributes.get("format")),
                            "read it with the version that wrote it, named in its attribute `provenance`")
        values: dict[str, Any] = {name: file.variables[name][...] for name in SHAPES if name in file.variables}
    values |= {name: json.loads(attributes.get(name, "null")) for name in _OBJECTS}
    values |= {name: attributes[name] for name in (*TEXTS, *_INTEGERS)}
    values |= {name: attributes.get(name) for name in _NUMBERS}
    return {field.name: values.get(field.name) for field in fields(Solution)}


def dataset(path: str | os.PathLike[str]) -> xarray.Dataset:
    """The file as an xarray data set, after the same checks as `load`; xarray takes a while to import.

    Raises FileError as `load` does.
    """
    import xarray

    load(path)  # which a process of its own does within bounds; xarray reads what it did
    return xarray.open_dataset(Path(path), engine="h5netcdf")


def _image(solution: Solution) -> bytes:
    """The bytes of the file with a blank checksum. Written in memory: the disk then sees one plain write."""
    image = io.BytesIO()
    arrays = {name: array for name in SHAPES if (array := getattr(solution, name)) is not None}
    with h5netcdf.File(image, "w") as file:
        file.dimensions = {dimension: size for name, array in arrays.items()
                           for dimension, size in zip(SHAPES[name], array.shape, strict=True)}
        for name, array in arrays.items():
            variable = file.create_variable(name, SHAPES[name], data=array)
            variable.attrs.update(_attributes(solution, name, SHAPES[name]))
        file.attrs["format"] = FORMAT
        file.attrs["checksum"] = seal.BLANK
        for name in TEXTS:
            file.attrs[name] = getattr(solution, name)
        for name in _INTEGERS:
            file.attrs[name] = int(getattr(solution, name))
        for name in _NUMBERS:
            if (value := getattr(solution, name)) is not None:
                file.attrs[name] = value
        for name in _OBJECTS:
            file.attrs[name] = json.dumps(getattr(solution, name))
    return image.getvalue()


def _attributes(solution: Solution, name: str, dimensions: tuple[str, ...]) -> dict[str, str]:
    long_name, units = _MEANING[name]
    attributes = {"long_name": long_name, "units": units}
    # so that readers of CF files take u and u_point for coordinates
    for size, coordinate in (("node", "u"), ("point", "u_point")):
        if size in dimensions and name != coordinate:
            attributes["coordinates"] = coordinate
    group = solution.group
    names = {"twist": group.twist, "turn": group.strain, "stress": group.stress}.get(name)
    if names is not None:
        attributes["components"] = " ".join(names)
    return attributes


def _verified(path: str | os.PathLike[str]) -> bytes:
    """The bytes of a file that is certainly ours and unchanged; the HDF5 library can hang on any other."""
    try:
        sealed = Path(path).read_bytes()
    except OSError as error:
        raise FileError(path, "a solution file", error.strerror or str(error),
                        "give the path of a file that `run` has written") from error
    if not seal.marked(sealed):
        raise FileError(path, "a solution file with its checksum", _kind(sealed),
                        "give a file that `run` has written, whole")
    if not seal.intact(sealed):
        raise FileError(path, "the bytes that were written", "other ones (the checksum differs)",
                        "copy the file again or repeat the run: it was cut short, damaged or changed")
    return sealed


def _kind(data: bytes) -> str:
    if not data:
        return "an empty file"
    if data.startswith(b"\x89HDF\r\n\x1a\n"):
        return "an HDF5 file without one"
    return "a file of another kind"
