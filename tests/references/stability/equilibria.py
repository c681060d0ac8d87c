"""Bent equilibria of the scenes, and their leading growths: a table of what `buckled`, `bend45` and `bent` compute."""

from dataclasses import dataclass, field

from tests.references.stability import bend45, bent, buckled, columns
from tests.references.stability.straight import Rod

THICK = Rod(1.0, 40.0, 16.0, 1.0, 2.0, 0.02)


@dataclass(frozen=True)
class Equilibrium:
    """A state of rest of `examples/stability/<scene>.toml` with `settings`.

    tip: its place (length). growth: the leading eigenvalue (1 / time), negative if it is stable. branches: how many
    equilibria there are, this one, its mirror image and the straight one included.
    """

    scene: str
    tip: tuple[float, ...]
    growth: float
    settings: dict[str, float] = field(default_factory=dict)
    branches: int = 1


def all_equilibria() -> tuple[Equilibrium, ...]:
    """The table, to ten digits and more."""
    return (
        Equilibrium("column_buckled", (0.7542062541327575, 0.5153178409737772),
                    -1.0868109555436307, {"load": 2.5}, branches=3),
        Equilibrium("column_buckled", (0.22389199567437265, 0.8095091735790614),
                    -4.7230231775871125, {"load": 3.5}, branches=3),
        Equilibrium("column_buckled", (-0.3371516352554362, 0.7602309829656304),
                    -10.299864857224746, {"load": 6.0}, branches=3),
        Equilibrium("bend45", (58.53593262077532, 22.112614520452055, 40.48026158044724),
                    -0.18485846807462475, {"load": 300.0, "torsion": 702885.0}),
        Equilibrium("bend45", (51.969717355199926, 18.36927564287973, 48.704788627668385),
                    -0.2215017419644508, {"load": 450.0, "torsion": 702885.0}),
        Equilibrium("bend45", (46.89192478142149, 15.557785823972075, 53.60736926567675),
                    -0.25940366134336174, {"load": 600.0, "torsion": 702885.0}),
        Equilibrium("bend45", (47.15043857362894, 15.684800534038864, 53.47485879182532),
                    -0.25863337610312936, {"load": 600.0, "torsion": 833333.3333333334}),
    )  # fmt: skip


def column(load: float) -> tuple[buckled.Tip, bent.State]:
    """The buckled column of the scene, towards positive y."""
    tip = buckled.tip(THICK, load)
    stiffness, friction = (40.0, 16.0, 1.0, 1.0, 1.0, 1.0), (1.0, 2.0, 1.0, 1.0, 1.0, 0.02)
    base = (-load, 0.0, 0.0, 0.0, 0.0, tip.bend)
    return tip, bent.State(1.0, stiffness, friction, (1.0, 0.0, 0.0, 0.0, 0.0, 0.0), base, bent.PLANE)


def second_load() -> float:
    """The load (force) at which the column's second pair of buckled shapes begins: of three times as many waves."""
    return columns.dead_load(Rod(1.0 / 3.0, THICK.k1, THICK.k2, THICK.bend))


def bend(load: float, torsion: float) -> tuple[tuple[float, ...], bent.State]:
    """The tip of the 45 degree bend, and its state."""
    found = bend45.solve(load, torsion)
    return tuple(found.tip_position.tolist()), bend45.state(found, torsion)
