"""A state of rest, by the quickest way that gets there."""

from geocosserat.kernel.contract import Array
from geocosserat.statics.newton import NotAtRest, Rest, newton, relax
from geocosserat.statics.path import Eased, begin, follow
from geocosserat.statics.system import System


def find(system: System, x: Array) -> Rest:
    """The state of rest that is reached from x: by Newton's method; or where the rod relaxes to; or where the path
    leads on which forces that hold it at x are taken away.

    Raises NotAtRest if none of them gets there, with what each met.
    """
    met = []
    for name, way in (("at once", newton), ("relaxing", relax), ("eased", _eased)):
        try:
            return way(system, x)
        except NotAtRest as error:
            met.append(f"{name}: {error}")
    raise NotAtRest("; ".join(met))


def _eased(system: System, x: Array) -> Rest:
    eased = Eased(system, system.residual(x))
    for place in follow(eased, begin(eased, x, 0.0, 1.0)):
        x = place.x
    if place.p < 1.0:
        raise NotAtRest("taking away what holds the rod leads back to where it began")
    return newton(system, x)
