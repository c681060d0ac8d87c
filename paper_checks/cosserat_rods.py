"""Section II: kinematics and dynamics as vectors in the world."""

import numpy as np
import sympy as sp

from geocosserat.referee.motion import Motion, cross, dot
from geocosserat.referee.statement import Check, Section

SECTION = Section("Cosserat rods")


@SECTION.states("(1)", "h is the slope of the centreline", r"\boldsymbol{r}'=\boldsymbol{h}", part="(1a)")
def centreline_slope() -> Check:
    rod = Motion()
    h, _ = rod.split(rod.turn)
    return Check(printed=rod.world(h), derived=rod.du(rod.position), defines=True, fields=rod)


@SECTION.states(
    "(1)", "the frame turns along the rod about Pi", r"\boldsymbol{e}_i'=\boldsymbol{\Pi}\times\boldsymbol{e}_i", part="(1b)"
)
def frame_slope() -> Check:
    rod = Motion()
    _, Pi = rod.split(rod.turn)
    return Check(
        printed=[cross(rod.world(Pi), e) for e in rod.frame],
        derived=[rod.du(e) for e in rod.frame],
        defines=True,
        fields=rod,
    )


@SECTION.states("(2)", "v is the velocity of the centreline", r"\dot{\boldsymbol{r}}=\boldsymbol{v}", part="(2a)")
def centreline_rate() -> Check:
    rod = Motion()
    v, _ = rod.split(rod.twist)
    return Check(printed=rod.world(v), derived=rod.dt(rod.position), defines=True, fields=rod)


@SECTION.states(
    "(2)", "the frame turns in time about Omega", r"\dot{\boldsymbol{e}}_i=\boldsymbol{\Omega}\times\boldsymbol{e}_i", part="(2b)"
)
def frame_rate() -> Check:
    rod = Motion()
    _, Omega = rod.split(rod.twist)
    return Check(
        printed=[cross(rod.world(Omega), e) for e in rod.frame],
        derived=[rod.dt(e) for e in rod.frame],
        defines=True,
        fields=rod,
    )


@SECTION.states(
    "(3)", "mixed derivatives of the centreline agree", r"\dot{\boldsymbol{h}}-\boldsymbol{v}'=0", part="(3a)"
)
def centreline_is_compatible() -> Check:
    rod = Motion()
    (h, _), (v, _) = rod.split(rod.turn), rod.split(rod.twist)
    return Check(
        printed=np.zeros(3, dtype=int),
        derived=rod.dt(rod.world(h)) - rod.du(rod.world(v)),
        fields=rod,
    )


@SECTION.states(
    "(3)",
    "mixed derivatives of the frame agree, as vectors",
    r"\dot{\boldsymbol{\Pi}}-\boldsymbol{\Omega}'=\boldsymbol{\Pi}\times\boldsymbol{\Omega}",
    r"\dot{\boldsymbol{\Pi}}-\boldsymbol{\Omega}'=\boldsymbol{\Omega}\times\boldsymbol{\Pi}",
    remark="The sign is that of the components in the moving frame, (18), not that of the vectors. Table I has the two "
    "the other way round.",
    part="(3b)",
)
def frame_is_compatible() -> Check:
    rod = Motion()
    (_, Pi), (_, Omega) = rod.split(rod.turn), rod.split(rod.twist)
    return Check(
        printed=cross(rod.world(Pi), rod.world(Omega)),
        derived=rod.dt(rod.world(Pi)) - rod.du(rod.world(Omega)),
        corrected=cross(rod.world(Omega), rod.world(Pi)),
        fields=rod,
    )
