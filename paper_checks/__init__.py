"""The paper, statement by statement: M. Yan, M. Warda, B. Németh, L. Kikuchi, R. Adhikari, "Geometric Field Theory for
Elastohydrodynamics of Cosserat Rods". One module a section; a record for each statement, or part of one.
"""

from paper_checks import (
    beam_limits,
    conclusion,
    coordinates,
    cosserat_rods,
    elastohydrodynamics,
    forms,
    lie_groups,
    linearisation,
    moving_frames,
    table,
    work,
)

SECTIONS = (
    cosserat_rods.SECTION,
    moving_frames.SECTION,
    lie_groups.SECTION,
    forms.SECTION,
    table.SECTION,
    elastohydrodynamics.SECTION,
    work.SECTION,
    linearisation.SECTION,
    coordinates.SECTION,
    beam_limits.SECTION,
    conclusion.SECTION,
)
