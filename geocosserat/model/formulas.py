"""All formulas of a scene that may vary along the rod or in time, in one place: whoever looks for steps or narrow
features in them looks at all."""

from collections.abc import Iterator

from geocosserat.model.effects.law_wrench import LawWrench
from geocosserat.model.expressions import Call, Expression, steps, symbols
from geocosserat.model.records import Scene


def formulas(scene: Scene) -> Iterator[Expression]:
    """Shape at rest and at the start, stiffness, friction, effects, the law, loads and twists of the ends."""
    model = scene.model
    yield from (*model.reference, *scene.start.strain)
    for row in (*model.stiffness, *model.friction):
        yield from row
    for effect in model.effects:
        for vector in effect.values().values():
            yield from vector
        if isinstance(effect, LawWrench):
            yield from effect.law.wrench or ()
    if model.law is not None:
        yield from model.law.stress or ()
    for end in (model.left, model.right):
        for load in (end.force, end.torque, end.twist):
            yield from load or ()


def stepping(scene: Scene, variable: str) -> Iterator[Expression]:
    """The steps in them that depend on nothing but u or t, and parameters; not those that depend on the rod."""
    for e in formulas(scene):
        for argument in steps(e):
            if variable in symbols(argument) and symbols(argument) <= {variable, *scene.model.parameters}:
                yield Call("heaviside", argument)
