"""Where the rod of a scene rests, on ever finer meshes."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

from geocosserat.conductor.simulate import Clock
from geocosserat.conductor.standing import Standing, stand
from geocosserat.discretisation.structure import RodStructure
from geocosserat.kernel.library import KernelText
from geocosserat.model.records import Scene
from geocosserat.planning.gap import position_gap
from geocosserat.planning.settings import SIZES
from geocosserat.statics.find import find
from geocosserat.statics.newton import NotAtRest, Rest, newton
from geocosserat.statics.pencil import Complex
from geocosserat.statics.system import LARGEST

LARGEST_BLIND = 250
"""Unknowns beyond which a state of rest is not searched for that coarser meshes do not have."""


@dataclass(frozen=True, eq=False)
class State:
    """A state of rest on a mesh. estimated: by how far it lies from that of the mesh before, relative to the length, or
    None if there is none; rounds: of Newton's method."""

    standing: Standing
    rest: Rest
    estimated: float | None
    rounds: int

    @property
    def spectrum(self) -> tuple[Complex, Complex]:
        return self.standing.spectrum(self.rest.linear, self.rest.x)


class Stander:
    """Sets the rods of a scene up on any mesh; the clock says how long that takes."""

    def __init__(self, scene: Scene, kernel_text: Callable[[RodStructure], KernelText], clock: Clock) -> None:
        self.scene, self.kernel_text, self.clock = scene, kernel_text, clock

    def on(self, size: tuple[int, int]) -> Standing:
        with self.clock("derive"):
            return stand(self.scene, size, self.kernel_text)

    def sizes(self) -> tuple[tuple[int, int], ...]:
        """Meshes to try, by growing size: those whose matrices may be dense, or the one that the scene wants."""
        run, d = self.scene.run, self.scene.model.group.dimension
        if run.elements is not None or run.degree is not None:
            return ((run.elements or 1, run.degree or 16),)
        return tuple(size for size in SIZES if size[0] * size[1] * d <= LARGEST)

    def states(self, first: State | None = None) -> Iterator[State]:
        """The state of rest on ever finer meshes, from the start of the scene, or from a first state on; meshes too
        coarse to have one are passed over.

        Raises NotAtRest if none has.
        """
        last, done = first, 0
        if first is not None:
            done = first.standing.rod.mesh.elements * first.standing.rod.mesh.degree
        failure: NotAtRest | None = None
        for size in self.sizes():
            if size[0] * size[1] <= done:
                continue
            standing = self.on(size)
            guess = standing.system.x if last is None else standing.from_mesh(last.standing, last.rest.x)
            try:
                with self.clock("solve"):  # a state that others lie beside is not to be left for one of them
                    rest = find(standing.system, guess) if first is None else newton(standing.system, guess)
            except NotAtRest as error:
                failure = error
                if len(standing.system.x) > LARGEST_BLIND:
                    break
                continue
            last = State(standing, rest, None if last is None else _apart(last, standing, rest), rest.rounds)
            yield last
        if last is None and failure is not None:
            raise failure


def _apart(last: State, standing: Standing, rest: Rest) -> float:
    """How far a state lies from that of another mesh, relative to the length."""
    positions, finer = last.standing.poses(last.rest.x).position, standing.poses(rest.x).position
    gap = position_gap(last.standing.rod.mesh, positions, standing.rod.mesh, finer)
    return gap / standing.scene.model.length
