"""Section IX: the equations as the conclusion has them."""

import sympy as sp

from geocosserat.algebra.groups import SE3
from geocosserat.referee.motion import Motion
from geocosserat.referee.statement import Check, Section
from paper_checks.lie_groups import change

SECTION = Section("Discussion and conclusion")

du, dt = sp.symbols("du dt")


@SECTION.states("I64", "the kinematics in one equation", r"d\varphi=\varphi\,\xi")
def kinematics_as_forms() -> Check:
    rod = Motion()
    phi, E, V = rod.configuration, SE3.hat(rod.turn), SE3.hat(rod.twist)
    return Check(
        printed=phi @ (E * du + V * dt),
        derived=change(rod, rod.turn) * du + change(rod, rod.twist) * dt,
        fields=rod,
    )


@SECTION.states(
    "I65",
    "the balance as forms",
    r"\mathcal{D}^*\Sigma+j\,du=0",
    r"D^*\Sigma+j\,du=0",
    remark="The script D* of (36) gives a function, j du is a one-form: no sum of the two can vanish unless each does. "
    "(38) has both right forms: the other D* with j du, or the script one with j.",
)
def balance_as_forms() -> Check:
    rod = Motion()
    E, Sigma = rod.turn, rod.stress
    function = rod.du(Sigma) + SE3.coad(E) @ Sigma
    return Check(
        printed=-(rod.du(Sigma) + SE3.coad(E) @ Sigma),
        derived=rod.wrench * du,
        corrected=-(rod.du(Sigma) + SE3.coad(E) @ Sigma) * du,
        also=[("without du: the script D* with j", -function, rod.wrench)],
        fields=rod,
    )
