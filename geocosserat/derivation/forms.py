"""The forms in which a rod's equations can be laid out; each makes a Document of the same FieldEquations."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Final

from geocosserat.derivation import layout
from geocosserat.derivation.closure import closure
from geocosserat.derivation.coordinate_form import coordinates
from geocosserat.derivation.document import Document, Formula, Section
from geocosserat.derivation.limit_form import limit_form
from geocosserat.derivation.linear_form import linearised
from geocosserat.derivation.records import FieldEquations


def document(equations: FieldEquations, form: str = "intrinsic", chart: str | None = None) -> Document:
    """The equations in that form, ready to print.

    ValueError for a form or a chart that there is not, and for a chart where the form takes none.
    """
    if form not in FORMS:
        raise ValueError(f"form: expected one of {', '.join(FORMS)}, found {form!r}; choose one of these")
    if form in CHARTED:
        return CHARTED[form](equations, chart)
    if chart is not None:
        raise ValueError(f"chart: expected none for the form {form}, found {chart!r}; leave it out")
    return FORMS[form](equations)


def intrinsic(equations: FieldEquations) -> Document:
    """The form in the Lie algebra: turn, twist, stress and wrench in the moving frame."""
    sections = [
        Section(
            "Compatibility",
            equations.rates,
            Formula("Ė = V' + ad_E V", "E_t = V_u + ad_E V", r"\dot E = V' + \mathrm{ad}_E V"),
        ),
        *layout.constraints(equations),
        Section(
            "Balance",
            equations.balance,
            Formula(
                "Σ' + ad*_E Σ + j = 0", "S_u + ad*_E S + j = 0", r"\Sigma' + \mathrm{ad}^*_E \Sigma + j = 0"
            ),
        ),
        layout.stress(equations),
        layout.wrench(equations),
        *layout.world(equations),
        replace(layout.motion(equations), remark=closure(equations)),
        *layout.ends(equations),
        *layout.work(equations),
    ]
    return Document(
        layout.title(equations), layout.names(equations), layout.parameters(equations), tuple(sections)
    )


FORMS: Final[dict[str, Callable[[FieldEquations], Document]]] = {
    "intrinsic": intrinsic,
    "coordinates": coordinates,
    "linearised": linearised,
    "limit": limit_form,
}
CHARTED: Final[dict[str, Callable[[FieldEquations, str | None], Document]]] = {"coordinates": coordinates}
"""The forms that are written in a chart."""
