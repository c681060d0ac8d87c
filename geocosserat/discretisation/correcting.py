"""A rod of a law, with one more stress at each point: numbers that whoever integrates may set, and nothing else knows.

What the stress of a law does in a step that is not short is not what its energy changes by. A stress beside it can make
up for that (solver/kept.py), for the balance of power of the scheme holds with any stress. It belongs to no energy and
to no loss: the books of the rod are those of its law.
"""

from dataclasses import replace

import numpy as np

from geocosserat.discretisation.semidiscrete import SemiDiscrete
from geocosserat.discretisation.structure import Coefficient, RodStructure
from geocosserat.model.expressions import Number, Symbol


def correctable(structure: RodStructure) -> bool:
    """Whether there is a law with an energy that time does not change. That of a stiffness is a square, of which the
    methods themselves keep the balance."""
    return structure.law is not None and structure.law.energy != Number(0.0) and not structure.active


def corrected(rod: SemiDiscrete) -> SemiDiscrete:
    """The same rod with corrections of the stress of its free modes, in order the last rows of `point`; zero so far."""
    structure = rod.structure
    law = structure.law
    assert law is not None, "only a law is corrected"
    stress, remainder, added = list(law.stress), list(law.remainder), []
    for i, name in enumerate(structure.group.stress):
        if not structure.frozen[i]:
            added.append(Coefficient(f"correction_{name}", "point", Number(0.0)))
            stress[i] = stress[i] + Symbol(added[-1].name)
            if structure.viscous[i]:  # whose loss is all that the stress in the state does not store
                remainder[i] = remainder[i] - Symbol(added[-1].name)
    whole = replace(law, stress=tuple(stress), remainder=tuple(remainder))
    return replace(
        rod,
        structure=replace(structure, law=whole, coefficients=(*structure.coefficients, *added)),
        point=np.concatenate([rod.point, np.zeros((len(added), rod.mesh.elements * rod.mesh.degree))]),
    )
