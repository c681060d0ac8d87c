"""The rods of a scene while one of its values changes."""

from collections import OrderedDict
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from geocosserat.conductor.standing import Standing, check_standing, stand
from geocosserat.discretisation.mesh import Array
from geocosserat.discretisation.structure import RodStructure
from geocosserat.kernel.library import KernelText
from geocosserat.model.errors import InputError
from geocosserat.model.records import Scene
from geocosserat.model.scene import load_scene
from geocosserat.statics.crossing import Spectrum
from geocosserat.statics.linear import Linear
from geocosserat.statics.newton import NotAtRest
from geocosserat.statics.path import Place
from geocosserat.statics.pencil import Complex
from geocosserat.statics.sparse import Sparse

NEIGHBOUR = 1e-5
"""Of the interval: how far apart residuals are compared to see how they change with the value."""

KEPT = 64
"""Rods that are kept, for a path comes back to the same values."""


@dataclass(frozen=True)
class Over:
    """A value of a scene and the interval that it goes through."""

    key: str
    first: float
    last: float

    def at(self, p: float) -> float:
        """The value at p in [0, 1]."""
        return float(self.first + (self.last - self.first) * p)

    def setting(self, p: float) -> str:
        return f"{self.key}={self.at(p)!r}"


def read_over(text: str) -> Over:
    """`key=a:b` as a value and its interval.

    Raises InputError.
    """
    key, equals, interval = text.partition("=")
    parts = interval.split(":")
    try:
        first, last = (float(part) for part in parts)
    except ValueError:
        first = last = float("nan")
    if not equals or not key.strip() or not np.isfinite([first, last]).all() or first == last:
        raise InputError("KEY=A:B with two numbers that differ", repr(text), "write for example P=0:5", key="--over")
    if key.strip().startswith("run."):
        asked = "a value of the rod or of what acts on it"
        raise InputError(asked, key.strip(), "how long a run takes has no part in rest", key="--over")
    return Over(key.strip(), first, last)


class Rods:
    """A family of rods on one mesh, as a path of states of rest takes it (`statics.path.Family`)."""

    def __init__(
        self,
        scene: Scene,
        over: Over,
        size: tuple[int, int],
        kernel_text: Callable[[RodStructure], KernelText],
    ) -> None:
        self.scene, self.over, self.size, self.kernel_text = scene, over, size, kernel_text
        self._rods: OrderedDict[float, Standing] = OrderedDict()
        self.first = self._stand(0.0)

    def at(self, p: float) -> Standing:
        """The rod at p in [0, 1].

        Raises NotAtRest if there is none.
        """
        if p not in self._rods:
            try:
                standing = self._stand(p)
            except InputError as error:
                raise NotAtRest(f"no rod at {self.over.key} = {self.over.at(p):.6g}: {error}") from error
            self._rods[p] = standing.scaled(self.first.system.scale)
        self._rods.move_to_end(p)
        while len(self._rods) > KEPT:
            self._rods.popitem(last=False)
        return self._rods[p]

    def _stand(self, p: float) -> Standing:
        scene = load_scene(self.scene.source, [self.over.setting(p)])
        check_standing(scene)
        return stand(scene, self.size, self.kernel_text)

    def residual(self, x: Array, p: float) -> Array:
        return self.at(p).system.residual(x)

    def linear(self, x: Array, p: float) -> Linear | Sparse:
        return self.at(p).system.linear(x)

    def slope(self, x: Array, p: float) -> Array:
        beside = p + NEIGHBOUR if p + NEIGHBOUR <= 1.0 else p - NEIGHBOUR
        return (self.residual(x, beside) - self.residual(x, p)) / (beside - p)

    def moved(self, x: Array, step: Array) -> Array:
        return self.first.system.moved(x, step)

    @property
    def spectrum(self) -> Spectrum:
        def spectrum(place: Place) -> tuple[Complex, Complex]:
            standing = self.at(place.p)
            return standing.spectrum(None if standing.held else standing.system.linear(place.x), place.x)

        return spectrum
