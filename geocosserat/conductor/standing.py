"""The rod of a scene as a system of equations for where it rests."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.polynomial import legendre
from numpy.typing import NDArray

from geocosserat.conductor.closed import Closed
from geocosserat.conductor.held import Held
from geocosserat.conductor.simulate import tolerances, unit_of_energy
from geocosserat.discretisation.mesh import Array, Mesh
from geocosserat.discretisation.pose import Poses
from geocosserat.discretisation.sampling import friction_of, left_of_friction, slowest
from geocosserat.discretisation.semidiscrete import SemiDiscrete, discretise
from geocosserat.discretisation.structure import RodStructure, present
from geocosserat.kernel.library import KernelText
from geocosserat.kernel.load import load
from geocosserat.kernel.native import NativeRod
from geocosserat.kernel.pure import NumpyRod
from geocosserat.model.errors import InputError
from geocosserat.model.expressions import Number, evaluate, symbols
from geocosserat.model.formulas import formulas
from geocosserat.model.law import rates
from geocosserat.model.records import End, RodModel, Scene
from geocosserat.model.seen import seen
from geocosserat.solver.consistent import consistent
from geocosserat.statics.linear import Linear
from geocosserat.statics.newton import NotAtRest, size
from geocosserat.statics.pencil import Complex
from geocosserat.statics.sparse import Sparse
from geocosserat.statics.system import LARGEST, System

STRAYS = 1e-2
"""A motion that moves an end from where it is held by more than this, relative to the rest, is not one of the rod's."""

SAME = 1e-6
"""Difference, relative to the whole, below which two states are one."""

TURNED = 1e-3
"""Difference of strains, and of bends in radians over the length, below which they are one if they lie alike."""


@dataclass(frozen=True, eq=False)
class Standing:
    """A rod on a mesh, its kernel, and the equations of its rest.

    held: how small motions of a rod grow that an end holds, or drives; None of one that nothing does.
    """

    scene: Scene
    rod: SemiDiscrete
    kernel: NativeRod | NumpyRod
    text: KernelText
    system: System
    held: Held | None

    def poses(self, x: Array) -> Poses:
        return self.rod.poses(self.system.state(x))

    def scaled(self, scale: Array) -> "Standing":
        """The same in other natural sizes (n,)."""
        system = replace(self.system, scale=scale)
        held = self.held and replace(self.held, system=replace(self.held.system, scale=scale))
        return replace(self, system=system, held=held)

    def spectrum(self, linear: Linear | Sparse | None, x: Array) -> tuple[Complex, Complex]:
        """Growth rates and motions as `Linear.spectrum`, of the rod alone; one that is held needs no `linear`.

        Raises NotAtRest if they cannot be computed.
        """
        try:
            if self.held is not None:
                twist, _, _ = self.kernel.observe(0.0, self.system.state(x))
                return self.held.spectrum(x, twist.T if self.held.driven else np.zeros_like(twist.T), self.system.rate)
            assert linear is not None
            growth, motions = linear.spectrum(self.system.rate)
        except np.linalg.LinAlgError as error:
            raise NotAtRest(f"small motions about the state cannot be computed: {error}") from error
        kept = [i for i in range(len(growth)) if not self._strays(x, motions[:, i])]
        return growth[kept], motions[:, kept]

    def energy(self, x: Array) -> float:
        return self.kernel.observe(0.0, self.system.state(x))[2]

    def same(self, x: Array, y: Array) -> bool:
        """Whether two states of rest are one: in the same place, or one turned into the other without resistance."""
        here, there = self.poses(x), self.poses(y)
        apart = np.linalg.norm(here.position - there.position, axis=1).max() / self.scene.model.length
        if max(apart, np.abs(here.rotation - there.rotation).max()) < SAME:
            return size(self._turn(x) - self._turn(y)) < TURNED
        one, other = self.energy(x), self.energy(y)
        if abs(one - other) > SAME * max(abs(one), abs(other)):
            return False
        growth = [self.spectrum(self.system.linear(z), z)[0] for z in (x, y)]
        if any(np.abs(g).min(initial=np.inf) > SAME * self.system.rate for g in growth):
            return False  # nothing turns without resistance
        few = min(3, *map(len, growth))
        return bool(np.abs(growth[0][:few] - growth[1][:few]).max() < 1e3 * SAME * self.system.rate)

    def _turn(self, x: Array) -> Array:
        """The turn in natural sizes: a rod that is twisted by whole turns lies as one that is not."""
        turn = self.rod.turn(self.system.state(x)).copy()
        turn[self.rod.structure.group.translations :] *= self.scene.model.length
        return turn

    def displaced(self, x: Array, motion: Complex) -> Complex:
        """(nodes, space) how the nodes move with a motion (n,), complex as it is; per unit of it."""
        h = 1e-6
        parts = []
        for part in (motion.real, motion.imag):
            there, here = (self.poses(self.system.moved(x, sign * h * part)).position for sign in (1, -1))
            parts.append((there - here) / (2 * h))
        return parts[0] + 1j * parts[1]

    def _strays(self, x: Array, motion: Complex) -> bool:
        structure = self.rod.structure
        far = structure.right if structure.base == "left" else structure.left
        if far.kind == "free" or structure.joined:
            return False
        h = 1e-6
        node = -1 if structure.base == "left" else 0
        moved = []
        for part in (motion.real, motion.imag):
            there, here = (self.poses(self.system.moved(x, sign * h * part)) for sign in (1, -1))
            shift = np.linalg.norm(there.position - here.position, axis=1) / self.scene.model.length
            turn = np.linalg.norm(there.rotation - here.rotation, axis=(1, 2))
            moved.append((shift, turn))
        shift, turn = (np.hypot(*pair) for pair in zip(*moved, strict=True))
        gone = shift[node] + (turn[node] if far.kind == "clamped" else 0.0)
        return bool(gone > STRAYS * (shift + turn).max())

    def from_mesh(self, other: "Standing", x: Array) -> Array:
        """Coordinates on this mesh of a state on another one."""
        y, old = self.system.start.copy(), other.system.state(x)
        rows = len(self.rod.structure.state_names)
        here, there = (s.rod.mesh.elements * s.rod.mesh.degree for s in (self, other))
        fields = old[: rows * there].reshape(rows, there)
        y[: rows * here] = _at(other.rod.mesh, fields, self.rod.mesh.u_point).ravel()
        carried = self.rod.structure.carried
        y[rows * here : rows * here + carried] = old[rows * there : rows * there + carried]
        return y[self.system.kept] / self.system.scale


def _at(mesh: Mesh, fields: Array, u: Array) -> Array:
    """Fields given at the Gauss points (rows, points), as polynomials in each element, at u."""
    n, p = mesh.elements, mesh.degree
    element = np.clip(np.searchsorted(mesh.edges, u, side="right") - 1, 0, n - 1)
    x = (u - (mesh.edges[element] + mesh.half[element])) / mesh.half[element]
    modes = fields.reshape(-1, n, p) @ np.linalg.inv(legendre.legvander(mesh.reference.points, p - 1)).T
    found: Array = np.einsum("rmk,mk->rm", modes[:, element], legendre.legvander(x, p - 1))
    return found


def check_standing(scene: Scene) -> None:
    """Raises InputError if a scene has nothing that could be at rest."""
    model = scene.model
    if any("t" in symbols(e) for e in formulas(scene)):
        raise InputError("a scene that does not vary with t", "a formula of t", "put a number in its place", key="t")
    kinds = {model.left.kind, model.right.kind}
    if "driven" in kinds and "free" not in kinds:
        raise InputError(
            "a driven end opposite to a free one", "an end that is held there", "set it free", key="ends"
        )


def stand(scene: Scene, size: tuple[int, int], kernel_text: Callable[[RodStructure], KernelText]) -> Standing:
    """The rod of a scene on a mesh of (elements, degree), on numpy unless the scene wants C: few states are looked at,
    and nothing has to be compiled for them.

    Raises InputError if the scene turns for ever in what it sees of the world.
    """
    # the motions of a large rod are told by its own kernel: node by node their matrices are dense
    large = size[0] * size[1] * scene.model.group.dimension > LARGEST
    held = not large and _is_held(scene.model)
    still = held and "driven" not in (scene.model.left.kind, scene.model.right.kind)
    rod, text, kernel, system = _system(_plainly_dragged(scene) if still else scene, size, kernel_text)
    structure = rod.structure
    if structure.prescribed and structure.sight != "nothing":
        raise InputError(
            "a driven end in a scene that looks the same from it at all times",
            "effects or loads fixed in the world",
            "use `run`: there is a periodic state at best",
            key="ends",
        )
    friction = friction_of(scene.model, rod.mesh, 0.0 if held else left_of_friction(scene.run))
    motions = None
    if still:
        motions = Held(rod, kernel, system, friction, driven=False)
    elif held:
        other, _, plain, its = _system(_plainly_dragged(_halted(scene)), size, kernel_text)
        motions = Held(other, plain, its, friction, driven=True)
    return Standing(scene, rod, kernel, text, system, motions)


def _system(
    scene: Scene, size: tuple[int, int], kernel_text: Callable[[RodStructure], KernelText]
) -> tuple[SemiDiscrete, KernelText, NativeRod | NumpyRod, System]:
    """The rod of a scene, its kernel, and the equations of its rest."""
    rod = discretise(scene, *size, anchored=True)
    text = kernel_text(rod.structure)
    kernel = load(text, rod, "c" if scene.run.backend == "c" else "numpy")
    kept, around = _mattering(rod)
    scale = tolerances(rod, 1.0, None, unit_of_energy(scene, rod, kernel))[kept]
    closure = Closed(rod) if scene.model.joined else None
    rate = slowest(scene.model, friction_of(scene.model, rod.mesh, left_of_friction(scene.run)))
    return rod, text, kernel, System(kernel, consistent(kernel, 0.0, rod.state), kept, scale, around, rate, closure)


def _is_held(model: RodModel) -> bool:
    """Whether it is known how the rod moves where it rests: not at all, or as its driven end does; and its stress does
    not answer to rates."""
    kinds = {model.left.kind, model.right.kind}
    if model.joined and model.effects:  # which may drive it on and on
        return False
    if not (model.joined or kinds & {"clamped", "driven"} or kinds == {"pinned"}):
        return False
    frame, answers = seen(model.group.space), set(rates(model.group))
    flows = any(present((*velocity, *spin)) for velocity, spin in (effect.medium(frame) for effect in model.effects))
    viscous = model.law is not None and any(answers & symbols(e) for e in model.law.stress or ())
    return not flows and not viscous


def _halted(scene: Scene) -> Scene:
    """The scene with its driven end clamped."""
    model = scene.model
    left, right = (End("clamped") if end.kind == "driven" else end for end in (model.left, model.right))
    return replace(scene, model=replace(model, left=left, right=right))


def _plainly_dragged(scene: Scene) -> Scene:
    """The scene with a friction that is the same for all motions of the rod: it has no part in where the rod rests, and
    makes round-off small."""
    model, length = scene.model, scene.model.length
    across = float(evaluate(model.friction[0][0], {**model.parameters, "u": length / 2}))
    group = model.group
    sizes = [across] * group.translations + [across * length**2] * group.rotations
    friction = tuple(tuple(Number(x if i == j else 0.0) for j in range(len(sizes))) for i, x in enumerate(sizes))
    return replace(scene, model=replace(model, friction=friction))


def _mattering(rod: SemiDiscrete) -> tuple[NDArray[np.intp], NDArray[np.bool_]]:
    """Indices of the entries of the state that the rod's rest depends on, and which of them form a unit quaternion:
    the turn, stresses, and of the pose of a base what is seen of it and may change."""
    structure = rod.structure
    fields = len(structure.state_names) * rod.mesh.elements * rod.mesh.degree
    space = structure.group.translations
    base = structure.left if structure.base == "left" else structure.right
    seen = structure.sight if structure.carried else "nothing"
    pose = np.zeros(structure.carried, dtype=bool)
    pose[:space] = seen == "pose" and base.kind == "free"
    pose[space:] = seen != "nothing"
    kept = np.concatenate([np.arange(fields), fields + np.flatnonzero(pose)])
    around = np.zeros(len(kept), dtype=bool)
    if structure.carried == 7 and seen != "nothing":
        around[-4:] = True
    return kept, around
