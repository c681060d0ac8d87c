"""Kernels of the cast, each built once a session, and the oracle beside them."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest
from numpy.typing import NDArray

from geocosserat.conductor.kernels import kernel_text
from geocosserat.discretisation.semidiscrete import SemiDiscrete
from geocosserat.kernel.compile import compile_c, compiler
from geocosserat.kernel.load import load
from geocosserat.kernel.native import NativeRod
from geocosserat.kernel.pure import NumpyRod
from tests.discretisation import oracle
from tests.discretisation.rods import JOINED, NAMES, SIZES, given, random_state, rod, scene

Array = NDArray[np.float64]
T = 0.37
"""The instant at which kernels are compared."""


class Case(NamedTuple):
    """A rod of the cast on a mesh, and the language of its kernel."""

    name: str
    elements: int
    degree: int
    backend: str

    def __str__(self) -> str:
        return f"{self.name}, {self.elements} of degree {self.degree}, {self.backend}"


def cases(backends: Iterable[str] = ("numpy", "c"), names: Iterable[str] = NAMES) -> list[Case]:
    """Every rod on every mesh in numpy; in C every rod on one, those with most in them on all, and some at degree 8."""
    most = {"everything": SIZES, "stirred": (*SIZES, (2, 8)), "ring": SIZES, "reeled": SIZES[1:]}
    numpy = [Case(name, *size, "numpy") for name in names for size in SIZES]
    c = [Case(name, *size, "c") for name in names for size in most.get(name.split()[1], SIZES[1:2])]
    return [*(numpy if "numpy" in backends else []), *(c if "c" in backends else [])]


_libraries: dict[tuple[str, int], Future[Path]] = {}


@contextmanager
def workshop(wanted: Iterable[Case]) -> Iterator[None]:
    """Compiles the C kernels of these cases ahead, two at a time."""
    with ThreadPoolExecutor(2) as pool:
        for case in wanted:
            if compiler() is not None and case.backend == "c" and (case.name, case.degree) not in _libraries:
                text = kernel_text(rod(*case[:3]).structure)
                _libraries[case.name, case.degree] = pool.submit(compile_c, text.c, case.degree)
        try:
            yield
        finally:
            pool.shutdown(cancel_futures=True)


@cache
def kernel(case: Case) -> NativeRod | NumpyRod:
    """The kernel of a case; the test is skipped if it is in C and there is no compiler."""
    if case.backend == "c":
        if compiler() is None:
            pytest.skip("no C compiler on the path, or CC is set to none")
        if (case.name, case.degree) in _libraries:
            _libraries[case.name, case.degree].result()
    r = rod(*case[:3])
    return load(kernel_text(r.structure), r, case.backend)


def like(case: Case, r: SemiDiscrete) -> NativeRod | NumpyRod:
    """The kernel of a case given the numbers of another rod, which must have the same structure and degree."""
    kernel(case)
    return load(kernel_text(r.structure), r, case.backend)


@cache
def reference(name: str, elements: int, degree: int) -> oracle.Rod:
    """The oracle of a rod on a mesh."""
    r = rod(name, elements, degree)
    return oracle.Rod(scene(name), r.mesh.edges, degree, r.base, given(r))


def rate(case: Case, t: float, y: Array) -> Array:
    out = np.full_like(y, np.nan)
    kernel(case).rate(t, y, out)
    return out


def state(case: Case, seed: int = 1) -> Array:
    return random_state(rod(*case[:3]), seed)


@cache
def reference_rate(name: str, elements: int, degree: int, t: float, seed: int) -> Array:
    """The oracle's rate at a random state, rounded to doubles."""
    y = random_state(rod(name, elements, degree), seed)
    return oracle.floats(reference(name, elements, degree).rate(t, y))


@cache
def reference_derivative(name: str, elements: int, degree: int, seed: int) -> tuple[Array, Array]:
    """A random direction, and the oracle's derivative of the rate in it at a random state."""
    y = random_state(rod(name, elements, degree), seed)
    direction = np.random.default_rng(100 + seed).normal(size=len(y))
    return direction, oracle.floats(reference(name, elements, degree).derivative(T, y, direction))


def turns(case: Case) -> int:
    """How many state entries are turns or stresses at points."""
    r = rod(*case[:3])
    return len(r.structure.state_names) * len(r.mesh.u_point)


def whole(blocks: tuple[Array, Array, Array], joined: bool) -> Array:
    """The block-tridiagonal matrix of (lower, diagonal, upper); of a ring, with the two blocks that join its ends."""
    n, b = blocks[1].shape[:2]
    matrix = np.zeros((n, b, n, b))
    for shift, entries in zip((-1, 0, 1), blocks, strict=True):
        for e in range(n):
            if 0 <= e + shift < n or (joined and n > 1):
                matrix[e, :, (e + shift) % n] += entries[e]
    return matrix.reshape(n * b, n * b)


def eliminated(case: Case, blocks: tuple[Array, Array, Array]) -> Array:
    """The derivatives of the rates of turns that blocks stand for, in the order of the state; poses of the elements'
    left ends, which have rows of their own, follow from the turns."""
    n, b = blocks[1].shape[:2]
    p, d = case.degree, turns(case) // (n * case.degree)
    matrix = whole(blocks, case.name in JOINED)
    place = np.arange(n * b).reshape(n, b)
    own, poses = place[:, : p * d], place[:, p * d :].ravel()
    order = own.reshape(n, p, d).transpose(2, 0, 1).ravel()
    follow = np.linalg.solve(matrix[np.ix_(poses, poses)], matrix[np.ix_(poses, order)])
    return matrix[np.ix_(order, order)] - matrix[np.ix_(order, poses)] @ follow


def implicit(case: Case, J: Array, gamma: float) -> Array:
    """mask - gamma J, what the block solve is the inverse of: rows of frozen modes are those of J."""
    held = np.flatnonzero(rod(*case[:3]).algebraic)
    matrix = np.eye(len(J)) - gamma * J
    matrix[held] = J[held]
    return matrix
