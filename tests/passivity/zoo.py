"""Laws whose verdict is known, and why: plain mappings, as a law file says them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

Plain = dict[str, Any]

STRAIN: Final = {"planar": ("h1", "h2", "Pi"), "spatial": ("h1", "h2", "h3", "Pi1", "Pi2", "Pi3")}
STRESS: Final = {"planar": ("F1", "F2", "M"), "spatial": ("F1", "F2", "F3", "M1", "M2", "M3")}
OPEN: Final[Mapping[str, Any]] = {"symbol": True}
POSITIVE: Final[Mapping[str, Any]] = {"symbol": True, "positive": True}


@dataclass(frozen=True)
class Known:
    """A law and what is known of it. conditions: what must be said of its open parameters, whole or in part.

    grade: at least that. faint: whether the work of its witness is lost in the rounding of double precision.
    slow: whether deciding it takes more than a second.
    """

    law: Mapping[str, Any]
    verdict: str
    why: str
    grade: str | None = "proved"
    conditions: tuple[str, ...] = ()
    faint: bool = False
    slow: bool = False


def planar(stress: Mapping[str, Any] | None = None, **more: Any) -> Plain:
    """A law in the plane; stress: one expression a component."""
    return {"motion": "planar", **({"stress": dict(stress)} if stress else {}), **more}


def spatial(stress: Mapping[str, Any] | None = None, **more: Any) -> Plain:
    """The same in space."""
    return {"motion": "spatial", **({"stress": dict(stress)} if stress else {}), **more}


def linear(rows: list[list[Any]], **more: Any) -> Plain:
    """Stress K (E - (1, 0, ...)), from the rows of K."""
    motion = "planar" if len(rows) == 3 else "spatial"
    turns = [f"({name} - 1)" if name == "h1" else name for name in STRAIN[motion]]
    stress = {
        component: " + ".join(f"({k})*{turn}" for k, turn in zip(row, turns, strict=True) if k != 0)
        for component, row in zip(STRESS[motion], rows, strict=True)
    }
    return {"motion": motion, "stress": stress, **more}


def gradient(motion: str, density: str, **more: Any) -> Plain:
    """A law that is written as an energy density."""
    return {"motion": motion, "energy": {"density": density}, **more}


def world(fx: str, fy: str, m: str = "0", **more: Any) -> Plain:
    """A force in the plane, given along the axes of the world, and a couple."""
    wrench = {"f1": f"({fx})*cos(theta) + ({fy})*sin(theta)", "f2": f"({fy})*cos(theta) - ({fx})*sin(theta)", "m": m}
    return {"motion": "planar", "wrench": wrench, **more}


def world3(fx: str, fy: str, fz: str, m: Sequence[str] = ("0", "0", "0"), **more: Any) -> Plain:
    """A force in space, given along the axes of the world, and a couple along those of the frame."""
    forces = {f"f{i}": f"({fx})*e{i}x + ({fy})*e{i}y + ({fz})*e{i}z" for i in (1, 2, 3)}
    return {"motion": "spatial", "wrench": {**forces, **{f"m{i + 1}": e for i, e in enumerate(m)}}, **more}


def friction(rows: list[Any], motion: str = "planar", **more: Any) -> Plain:
    """A law of friction alone."""
    return {"motion": motion, "friction": {"matrix": rows}, **more}


FULL: Final[list[list[Any]]] = [[9, 1, -2], [1, 7, 0.5], [-2, 0.5, 3]]
FULL_SPATIAL: Final[list[list[Any]]] = [
    [90, 3, -2, 1, 0.5, -4], [3, 80, 5, -1.5, 2, 0.25], [-2, 5, 70, 0.75, -3, 1], [1, -1.5, 0.75, 6, 0.1, -0.2],
    [0.5, 2, -3, 0.1, 5, 0.3], [-4, 0.25, 1, -0.2, 0.3, 4],
]  # fmt: skip
SPD: Final = [[2, 1, 0], [1, 2, 0.5], [0, 0.5, 1]]


def _with(rows: list[list[Any]], i: int, j: int, entry: Any) -> list[list[Any]]:
    """The rows with one entry replaced."""
    return [[entry if (a, b) == (i, j) else k for b, k in enumerate(row)] for a, row in enumerate(rows)]


_SKEW = "the tangent of a linear law is K, and K is not symmetric"
_ODD = "odd elasticity: the skew part of K turns a cycle of two strains into work"

LINEAR: dict[str, Known] = {
    "diagonal": Known(planar({"F1": "10*(h1 - 1)", "F2": "10*h2", "M": "Pi"}), "passive", "K is symmetric"),
    "full K": Known(linear(FULL), "passive", "K is symmetric"),
    "full K, not symmetric": Known(linear(_with(FULL, 0, 2, -1)), "active", _SKEW),
    "full K in space": Known(linear(FULL_SPATIAL), "passive", "K is symmetric"),
    "full K in space, not symmetric": Known(linear(_with(FULL_SPATIAL, 1, 4, 2.5)), "active", _SKEW),
    "full K in space, one unit in the last place": Known(
        linear(_with(FULL_SPATIAL, 1, 4, "2.0000000000000004")), "active", _SKEW, faint=True
    ),
    "indefinite K": Known(linear([[-1, 2, 0], [2, 1, 0], [0, 0, 1]]), "passive",
                          "symmetric; that the energy has no minimum is said under stability"),
    "prestressed": Known(planar({"F1": "3 + 10*(h1 - 1) + 2*Pi", "F2": "-1 + h2", "M": "Pi - 0.5 + 2*h1"}), "passive",
                         "a constant stress is the gradient of a linear energy"),
    "prestressed and odd": Known(planar({"F1": "3 + 10*(h1 - 1)", "F2": "2*h2 + Pi", "M": "0.5 + Pi - h2"}), "active",
                                 "a constant stress does no work once round; the odd couple does"),
    "curved at rest": Known(linear(FULL, reference=[1, 0, 2]), "passive", "K is symmetric wherever energies begin"),
    "odd, stretch and bend": Known(planar({"F1": "10*(h1 - 1) + Pi", "F2": "10*h2", "M": "Pi - (h1 - 1)"}),
                                   "active", _ODD),
    "odd, shear and bend": Known(planar({"F1": "10*(h1 - 1)", "F2": "10*h2 + 3*Pi", "M": "Pi - 3*h2"}), "active", _ODD),
    "odd, bend and bend": Known(
        spatial({"F1": "9*(h1 - 1)", "F2": "9*h2", "F3": "9*h3", "M1": "2*Pi1", "M2": "Pi2 + 0.3*Pi3",
                 "M3": "Pi3 - 0.3*Pi2"}), "active", _ODD),
    "odd, bend and twist": Known(
        spatial({"F1": "9*(h1 - 1)", "F2": "9*h2", "F3": "9*h3", "M1": "2*Pi1 + 0.5*Pi2", "M2": "Pi2 - 0.5*Pi1",
                 "M3": "Pi3"}), "active", _ODD),
    "odd, stretch and twist": Known(
        spatial({"F1": "9*(h1 - 1) + 0.2*Pi1", "F2": "9*h2", "F3": "9*h3", "M1": "2*Pi1 - 0.2*(h1 - 1)", "M2": "Pi2",
                 "M3": "Pi3"}), "active", _ODD),
    "chiral": Known(
        spatial({"F1": "9*(h1 - 1) + 0.2*Pi1", "F2": "9*h2", "F3": "9*h3", "M1": "2*Pi1 + 0.2*(h1 - 1)", "M2": "Pi2",
                 "M3": "Pi3"}), "passive", "stretch and twist coupled symmetrically, as in a helical cable"),
}  # fmt: skip

_SQUARE = "(h1 - 1)**2*(1 + Pi**2)"
_HILLS = " + ".join(f"cosh({name})" for name in STRAIN["spatial"])
_ALL_SIX = {
    component: f"sinh({name})*(1 + cos(h1*Pi1))" + (f" - {partner}*sin(h1*Pi1)*({_HILLS})" if partner else "")
    for component, name, partner in zip(
        STRESS["spatial"], STRAIN["spatial"], ("Pi1", "", "", "h1", "", ""), strict=True)
}  # fmt: skip
DISGUISED: dict[str, Known] = {
    "log cosh": Known(planar({"F1": "tanh(h1 - 1 + h2)", "F2": "tanh(h1 - 1 + h2) + h2**3", "M": "sin(2*Pi)"}),
                      "passive", "the gradient of log cosh(h1 - 1 + h2) + h2^4/4 + sin(Pi)^2"),
    "rational": Known(planar({"F1": f"2*(h1 - 1)*(1 + Pi**2)/(1 + {_SQUARE})",
                              "M": f"2*Pi*(h1 - 1)**2/(1 + {_SQUARE})"}),
                      "passive", "the gradient of log(1 + (h1 - 1)^2 (1 + Pi^2))"),
    "rational, nearly": Known(planar({"F1": f"2*(h1 - 1)*(1 + Pi**2)/(1 + {_SQUARE})",
                                      "M": f"2.0001*Pi*(h1 - 1)**2/(1 + {_SQUARE})"}),
                              "active", "one coefficient of a gradient is changed"),
    "a quotient": Known(planar({"F1": "1/(2 + h2)", "F2": "-h1/(2 + h2)**2"}, domain={"h2": [-1, 1]}), "passive",
                        "the gradient of h1/(2 + h2)"),
    "double angle as a square of a sine": Known(
        planar({"F1": "cos(2*h1)*h2", "F2": "0.5*sin(2*h1)", "M": "Pi"}), "passive", "the gradient of sin(2 h1) h2/2"),
    "double angle in two guises": Known(
        planar({"F1": "(1 - 2*sin(h1)**2)*h2", "F2": "sin(h1)*cos(h1)", "M": "Pi"}), "passive",
        "cos 2x = 1 - 2 sin(x)^2 makes it symmetric"),
    "double angle in two guises, nearly": Known(
        planar({"F1": "(1 - 2*sin(h1)**2)*h2", "F2": "sin(h1)*cos(h1) + 1e-9*h1", "M": "Pi"}), "active",
        "a curl of 1e-9 is left", faint=True),
    "exponential and its square": Known(
        planar({"F1": "2*exp(2*h1)*h2", "F2": "exp(h1)**2"}), "passive", "exp(2x) = exp(x)^2"),
    "sum of angles": Known(
        planar({"F1": "cos(h1 + h2)", "F2": "cos(h1)*cos(h2) - sin(h1)*sin(h2)"}), "passive",
        "the theorem of addition"),
    "hyperbolic": Known(planar({"F1": "(exp(h1) - exp(-h1))/2*cosh(h2)", "F2": "cosh(h1)*sinh(h2)"}), "passive",
                        "the gradient of cosh(h1) cosh(h2)"),
    "tanh through exponentials": Known(
        planar({"F2": "Pi*(1 - tanh(h2)**2)", "M": "(exp(2*h2) - 1)/(exp(2*h2) + 1)"}), "passive",
        "tanh x = (e^2x - 1)/(e^2x + 1), and its slope is 1 - tanh(x)^2"),
    "tangent": Known(planar({"F2": "Pi*(1 + tan(h2)**2)", "M": "sin(h2)/cos(h2)"}, domain={"h2": [-1, 1]}), "passive",
                     "the gradient of Pi tan(h2)"),
    "a spring of the length": Known(
        planar({"F1": "h1*(1 - 1/sqrt(h1**2 + h2**2))", "F2": "h2*(1 - 1/sqrt(h1**2 + h2**2))", "M": "Pi"}),
        "passive", "a function of |h| alone, times h"),
    "a spring of the length in space": Known(
        spatial({**{f"F{i}": f"h{i}*(5 - 5/sqrt(h1**2 + h2**2 + h3**2))" for i in (1, 2, 3)},
                 **{f"M{i}": f"Pi{i}*(1 + Pi1**2 + Pi2**2 + Pi3**2)" for i in (1, 2, 3)}}),
        "passive", "functions of |h| and |Pi| alone, times h and Pi"),
    "swirl in space": Known(
        spatial({"F1": "9*(h1 - 1) + 0.1*Pi1*Pi2", "F2": "4*h2", "F3": "4*h3", "M1": "Pi1 + 0.3*Pi2",
                 "M2": "Pi2 - 0.3*Pi1 + sin(Pi3)", "M3": "Pi3"}), "active", "not one of its couplings is symmetric"),
    "all six coupled": Known(spatial(_ALL_SIX), "passive",
                             "the gradient of (1 + cos(h1 Pi1)) times the sum of all hyperbolic cosines", slow=True),
    "all six coupled, nearly": Known(
        spatial(_ALL_SIX | {"M3": _ALL_SIX["M3"] + " + 1e-12*h2**3"}), "active", "a curl of 1e-12 between two of six",
        faint=True, slow=True),
    "power of a strain": Known(
        planar({"F1": "Pi*h1**(Pi - 1)", "M": "h1**Pi*log(h1)"}, domain={"h1": [0.1, 3]}), "passive",
        "the gradient of h1^Pi"),
    "fiftieth powers": Known(planar({"F1": "50*h2**50*h1**49", "F2": "50*h1**50*h2**49"}), "passive",
                             "the gradient of (h1 h2)^50"),
    "fiftieth powers, nearly": Known(
        planar({"F1": "50*h2**50*h1**49", "F2": "60*h1**50*h2**49"}), "active", "one coefficient is changed"),
    "a thirtieth decimal": Known(planar({"F1": "tanh(h1 - 1) + 1e-30*h2", "F2": "h2"}), "active", "a curl of 1e-30",
                                   faint=True),
    "a fortieth decimal": Known(planar({"F1": "10*(h1 - 1) + 1e-40*Pi", "F2": "h2", "M": "Pi"}), "active",
                                "a curl of 1e-40"),
    "a thirtieth decimal in space": Known(
        linear(_with(FULL_SPATIAL, 5, 3, "-0.2 + 1e-30")), "active", "a curl of 1e-30 on a full K", faint=True),
    "a curl that vanishes at rest": Known(planar({"F1": "(h1 - 1)**2*h2**2", "F2": "h2"}), "active",
                                          "the tangent is symmetric at the reference, but not around it"),
}  # fmt: skip

_AWAY = "((h1 - 1)**2 + h2**2)"
_VORTEX = {"F1": f"-h2/{_AWAY}", "F2": f"(h1 - 1)/{_AWAY}", "M": "Pi"}
SINGULAR: dict[str, Known] = {
    "vortex": Known(planar(_VORTEX), "active", "no curl anywhere, and 2 pi of work once round the line"),
    "vortex of curvature and shear": Known(planar({"F2": "-Pi/(h2**2 + 4*Pi**2)", "M": "h2/(h2**2 + 4*Pi**2)"}),
                                           "active", "the loop must go round an ellipse"),
    "vortex about another state": Known(
        planar({"F1": "-h2/((h1 - 3)**2 + h2**2)", "F2": "(h1 - 3)/((h1 - 3)**2 + h2**2)"}), "active",
        "its line is far from the reference"),
    "vortex outside the domain": Known(planar(_VORTEX, reference=[1.5, 0, 0], domain={"h1": [1.1, 2]}), "passive",
                                       "no loop in the domain goes round the line"),
    "vortex cut by the domain": Known(planar(_VORTEX, reference=[1, 0.2, 0], domain={"h2": [0.1, 1]}), "passive",
                                      "the domain lies on one side of the line"),
    "two vortices": Known(
        planar({"F1": "-h2/((h1 - 1)**2 + h2**2) + h2/((h1 - 3)**2 + h2**2)",
                "F2": "(h1 - 1)/((h1 - 1)**2 + h2**2) - (h1 - 3)/((h1 - 3)**2 + h2**2)"}), "active",
        "far away they cancel; round one of them they do not"),
    "vortex in disguise": Known(
        planar({"F1": "-h2*exp(h1 - 1)/((exp(h1 - 1) - 1)**2 + h2**2)",
                "F2": "(exp(h1 - 1) - 1)/((exp(h1 - 1) - 1)**2 + h2**2)"}), "active",
        "the angle of exp(h1 - 1) - 1 and h2", slow=True),
    "vortex and coupling, both open": Known(
        planar({"F1": f"-a*h2/{_AWAY} + b*Pi", "F2": f"a*(h1 - 1)/{_AWAY}"}, parameters={"a": OPEN, "b": OPEN}),
        "active", "passive where a = b = 0: that b = 0 is needed, and is not enough", slow=True),
    "vortex in space": Known(
        spatial({"F1": "9*(h1 - 1)", "F2": "9*h2 - h3/(h2**2 + h3**2)", "F3": "9*h3 + h2/(h2**2 + h3**2)",
                 "M1": "Pi1", "M2": "Pi2", "M3": "Pi3"}), "active", "2 pi of work once round the axis"),
    "radial and singular": Known(planar({"F1": f"(h1 - 1)/{_AWAY}", "F2": f"h2/{_AWAY}", "M": "Pi"}), "passive",
                                 "the gradient of a logarithm: singular on a line, without period"),
    "a pole in space": Known(
        spatial({f"F{i}": f"h{i}/(h1**2 + h2**2 + h3**2)**2" for i in (1, 2, 3)}), "passive",
        "a central field: its singular set has no holes that a loop could go round"),
    "infinite at full compression": Known(planar({"F1": "h1 - 1/h1", "F2": "h2", "M": "Pi"}, domain={"h1": [0.1, 5]}),
                                          "passive", "the gradient of h1^2/2 - log h1"),
}  # fmt: skip

STEPS: dict[str, Known] = {
    "tension only": Known(planar({"F1": "10*heaviside(h1 - 1)*(h1 - 1)", "F2": "h2", "M": "Pi"}), "passive",
                          "a function of h1 alone"),
    "two-sided spring": Known(
        planar({"F1": "10*(h1 - 1)*heaviside(h1 - 1) + 2*(h1 - 1)*heaviside(1 - h1)", "F2": "abs(h2)*h2"}), "passive",
        "each component is a function of its own strain"),
    "coupled with a kink": Known(planar({"F1": "abs(h1 - 1)*h2**2", "F2": "h2*(h1 - 1)*abs(h1 - 1)"}), "passive",
                                 "the gradient of (h1 - 1) |h1 - 1| h2^2/2"),
    "a step that does work": Known(planar({"F2": "heaviside(h1 - 1)*h2", "M": "Pi"}), "active",
                                   "no curl beside the step; a loop across it does work"),
    "a step elsewhere": Known(planar({"F2": "heaviside(h1 - 1.5)*h2", "M": "Pi"}), "active",
                              "no curl beside the step; a loop across it does work"),
    "a step outside the domain": Known(
        planar({"F2": "heaviside(h1 - 1.5)*h2", "M": "Pi"}, domain={"h1": [0.5, 1.4]}), "passive",
        "the step is never reached"),
    "a kink in the wrong component": Known(planar({"F2": "abs(h1 - 1)", "M": "Pi"}), "active",
                                           "d F2 / d h1 is a sign, and d F1 / d h2 is nothing"),
    "a step along its normal": Known(planar({"F2": "heaviside(h2 - Pi)", "M": "-heaviside(h2 - Pi)"}), "passive",
                                     "the gradient of a ramp of h2 - Pi"),
    "a step across its normal": Known(planar({"F2": "heaviside(h2 - Pi)", "M": "heaviside(h2 - Pi)"}), "active",
                                      "the jump has a part along the surface"),
    "a modulus as a root": Known(
        planar({"F1": "(h1 - 1)/sqrt((h1 - 1)**2)*h2**2/2", "F2": "sqrt((h1 - 1)**2)*h2"}), "passive",
        "the gradient of |h1 - 1| h2^2/2"),
    "a step that opens with a modulus": Known(
        planar({"F2": "a*heaviside(h1 - 1)*h2", "M": "Pi"}, parameters={"a": OPEN}), "active",
        "no curl beside the step", conditions=("passive if a = 0",)),
    "a step and a coupling, both open": Known(
        planar({"F2": "a*heaviside(h1 - 1)*h2 + b*Pi"}, parameters={"a": OPEN, "b": OPEN}), "active",
        "passive where a = b = 0: that b = 0 is needed, and is not enough", slow=True),
    "twist that bends one way only": Known(
        spatial({"F1": "9*(h1 - 1)", "F2": "9*h2", "F3": "9*h3", "M1": "Pi1", "M2": "Pi2 + 0.5*abs(Pi1)", "M3": "Pi3"}),
        "active", "a bending couple that follows |twist|, with nothing in return"),
}  # fmt: skip

OPENED: dict[str, Known] = {
    "odd with an open modulus": Known(
        planar({"F1": "k1*(h1 - 1)", "F2": "k1*h2 + a*Pi", "M": "k3*Pi - a*h2"},
               parameters={"k1": 10.0, "a": OPEN, "k3": POSITIVE}), "active", "skew part 2 a",
        conditions=("if and only if a = 0",)),
    "two couplings": Known(
        planar({"F1": "k1*(h1 - 1) + k12*h2", "F2": "k21*(h1 - 1) + 5*h2", "M": "Pi"},
               parameters={"k1": POSITIVE, "k12": OPEN, "k21": OPEN}), "active", "K is symmetric if k12 = k21",
        conditions=("if and only if", "k12", "k21")),
    "a positive coupling": Known(
        planar({"F1": "10*(h1 - 1)", "F2": "10*h2 + a*Pi", "M": "Pi - a*h2"}, parameters={"a": POSITIVE}), "active",
        "a = 0 is excluded"),
    "an open modulus that does not matter": Known(
        planar({"F1": "k*(h1 - 1)/(1 + b*(h1 - 1)**2)", "F2": "exp(-c)*h2", "M": "Pi"},
               parameters={"k": OPEN, "b": POSITIVE, "c": OPEN}), "passive", "each component has its own strain"),
    "an open exponent rate": Known(
        planar({"F1": "a*exp(a*h1)*h2", "F2": "exp(b*h1)"}, parameters={"a": POSITIVE, "b": POSITIVE}), "active",
        "the gradient of exp(a h1) h2 only if a = b"),
    "a parameter with a value": Known(
        planar({"F1": "10*(h1 - 1)", "F2": "10*h2 + a*Pi", "M": "Pi - a*h2"}, parameters={"a": 0.0}), "passive",
        "an odd law whose odd modulus is nothing"),
}  # fmt: skip

VARYING: dict[str, Known] = {
    "active curvature": Known(planar({"F1": "10*(h1 - 1)", "F2": "10*h2", "M": "Pi - sin(2*t - 5*u)"}), "driven",
                              "a muscle: an energy at every instant, which changes"),
    "stiffening in time": Known(gradient("planar", "(1 + 0.5*sin(t))*(h1 - 1)**2 + h2**2 + Pi**2"), "driven",
                                "the energy depends on time"),
    "odd and timed": Known(planar({"F1": "10*(h1 - 1)", "F2": "10*h2 + sin(t)*Pi", "M": "Pi - sin(t)*h2"}), "active",
                           "at fixed t it has no energy"),
    "time that cancels": Known(planar({"F1": "(sin(t)**2 + cos(t)**2)*(h1 - 1)", "F2": "h2", "M": "Pi"}), "passive",
                               "sin^2 + cos^2 = 1"),
    "tapered": Known(planar({"F1": "10*(1 - u/2)*(h1 - 1)", "F2": "10*(1 - u/2)*h2", "M": "(1 - u/2)**2*Pi"}),
                     "passive", "an energy at every u"),
    "stiffness with a step along the rod": Known(
        planar({"F1": "(2 + heaviside(u - 0.5))*(h1 - 1) + sin(u)*Pi", "F2": "h2", "M": "sin(u)*(h1 - 1) + Pi"}),
        "passive", "an energy at every u"),
    "odd in the middle": Known(planar({"F1": "10*(h1 - 1)", "F2": "10*h2 + u*(1 - u)*Pi", "M": "Pi - u*(1 - u)*h2"}),
                               "active", "odd for 0 < u < 1"),
    "a density": Known(gradient("planar", "5*(log(h1)*h1 - h1) + 3*h2**2 + 0.5*Pi**2/h1**2 + cos(Pi*h2)",
                                domain={"h1": [0.2, 4]}), "passive", "written as an energy"),
    "a density in space": Known(
        gradient("spatial", "50*(h1 - 1)**2 + 40*(h2**2 + h3**2) + (Pi1 - 2)**2 + log(1 + Pi2**2 + h1**2*Pi3**2)"),
        "passive", "written as an energy"),
}  # fmt: skip

_ELASTIC = {"F1": "10*(h1 - 1)", "F2": "10*h2", "M": "Pi"}
LOSSES: dict[str, Known] = {
    "Kelvin-Voigt": Known(planar({**_ELASTIC, "M": "Pi + 0.1*Pi_dot", "F1": "10*(h1 - 1) + 0.5*h1_dot"}), "passive",
                          "viscosities above zero"),
    "Kelvin-Voigt without viscosity": Known(
        planar({**_ELASTIC, "M": "Pi + c*Pi_dot"}, parameters={"c": 0.0}), "passive", "no viscosity at all"),
    "Kelvin-Voigt, negative": Known(planar({**_ELASTIC, "M": "Pi - 0.1*Pi_dot"}), "active",
                                    "a viscosity below zero gives energy"),
    "Kelvin-Voigt with a workless coupling": Known(
        planar({**_ELASTIC, "F2": "10*h2 + 0.3*Pi_dot", "M": "Pi - 0.3*h2_dot + 0.1*Pi_dot"}), "passive",
        "a skew viscosity does no work"),
    "Kelvin-Voigt that depends on strain": Known(
        planar({**_ELASTIC, "M": "Pi + (1 + h2**2)*Pi_dot"}), "passive", "never below 1"),
    "Kelvin-Voigt, cubic": Known(planar({**_ELASTIC, "M": "Pi + Pi_dot**3"}), "passive", "its power is a fourth power"),
    "Kelvin-Voigt, quadratic": Known(planar({**_ELASTIC, "M": "Pi + 0.1*Pi_dot**2"}), "active",
                                     "its power changes sign with the rate"),
    "Kelvin-Voigt, odd": Known(planar({"F1": "10*(h1 - 1)", "F2": "10*h2 + Pi", "M": "Pi - h2 + 0.1*Pi_dot"}),
                               "active", "slow cycles outdo any viscosity"),
    "friction, definite": Known(friction(SPD), "passive", "symmetric and positive definite"),
    "friction, diagonal": Known(friction([1, 2, 0.01]), "passive", "above zero"),
    "friction, semidefinite": Known(friction([[1, 1, 0], [1, 1, 0], [0, 0, 1]]), "passive",
                                    "there is a motion without friction, and none that gains"),
    "friction, skew": Known(friction([[1, 3, 0], [-3, 1, 0], [0, 0, 1]]), "passive", "the skew part does no work"),
    "friction, indefinite": Known(friction([[1, 2, 0], [2, 1, 0], [0, 0, 1]]), "active", "one eigenvalue is -1"),
    "friction, barely indefinite": Known(
        friction([["1 - 1e-20", 1, 0], [1, 1, 0], [0, 0, 1]]), "active", "a determinant of -1e-20"),
    "friction in space": Known(
        friction([[3 if i == j else 0.5 if i < j else 0.25 for j in range(6)] for i in range(6)], "spatial"),
        "passive", "strictly dominant diagonal"),
    "friction along the rod": Known(friction([[1, "u", 0], ["u", 1, 0], [0, 0, 1]]), "undecided",
                                    "definite for 0 <= u < 1, semidefinite at the end: seen at samples", grade=None),
    "friction along the rod, definite": Known(friction([[1, "u/2", 0], ["u/2", 1, 0], [0, 0, 1]]), "passive",
                                              "definite for 0 <= u <= 1"),
    "friction with an open coupling": Known(
        friction([["1", "b", "0"], ["b", "4", "0"], ["0", "0", "1"]], parameters={"b": OPEN}), "undecided",
        "definite if b^2 < 4", grade=None),
    "all parts": Known(planar({**_ELASTIC, "M": "Pi + 0.1*Pi_dot"}, friction={"matrix": SPD},
                              wrench={"f1": "-sin(theta)", "f2": "-cos(theta)"}), "passive", "each part is passive"),
    "all parts, one of them odd": Known(
        planar({**_ELASTIC, "F2": "10*h2 + Pi"}, friction={"matrix": SPD},
               wrench={"f1": "-sin(theta)", "f2": "-cos(theta)"}), "active", "the stress is odd"),
}  # fmt: skip

_TRAP = "3*(0.5 - x)", "3*(-0.2 - y)", "3*(0.1 - z)"
_AWAY3 = "(x**2 + y**2 + z**2)**1.5"
_SPIN = "0.1", "-0.5", "0.9"
WRENCHES: dict[str, Known] = {
    "weight": Known(world("0.2", "-1 - u"), "passive", "a force fixed in the world"),
    "weight in space": Known(world3("0.2", "0.1", "-1"), "passive", "a force fixed in the world"),
    "follower": Known(planar(wrench={"f1": "0.5"}), "driven", "a force that turns with the body"),
    "follower in space": Known(spatial(wrench={"f1": "0.5", "f3": "0.1"}), "driven", "turns with the body"),
    "couple": Known(planar(wrench={"m": "0.3"}), "driven", "closed, and does work with every turn"),
    "couple in space": Known(spatial(wrench={"m3": "1"}), "driven", "a couple that turns with the body"),
    "field": Known(planar(wrench={"m": "0.4*(-1*cos(theta) - 3*sin(theta)) - 0.1*(3*cos(theta) - sin(theta))"}),
                   "passive", "a magnetic moment in a constant field"),
    "field in space": Known(
        spatial(wrench={"m2": "-0.4*(3*e3x - e3y + 2*e3z)", "m3": "0.4*(3*e2x - e2y + 2*e2z)"}), "passive",
        "a magnetic moment in a constant field"),
    "turning field": Known(planar(wrench={"m": "0.4*(sin(t)*cos(theta) - cos(t)*sin(theta))"}), "driven",
                           "the field turns with time"),
    "flow": Known(world("0.3 + 2*y", "1 - 0.5*x", "-1.25"), "driven", "drag in a flow that shears"),
    "flow without vorticity": Known(world("0.3 + 2*x", "1 - 2*y"), "passive", "the same friction in both directions"),
    "flow past a slender body": Known(
        planar(wrench={"f1": "(0.3 + 2*y)*cos(theta) + 1*sin(theta)", "f2": "2*(cos(theta) - (0.3 + 2*y)*sin(theta))",
                       "m": "-0.3"}), "driven", "twice the friction across"),
    "flow in space": Known(
        world3("2*y + z", "1 - 0.5*x + 0.2*z", "-2 + 3*x - y + 0.1*z",
               ["0.2*(" + " + ".join(f"({s})*e{i}{a}" for s, a in zip(_SPIN, "xyz", strict=True)) + ")"
                for i in (1, 2, 3)]), "driven", "drag in a flow that shears"),
    "trap": Known(world("2*(1 - x)", "2*(0.2 - y)"), "passive", "a spring to the world"),
    "trap in space": Known(world3(*_TRAP), "passive", "a spring to the world"),
    "trap that swirls": Known(world("1 - x - 0.1*y", "-y + 0.1*x"), "driven", "a spring with a curl"),
    "vortex in place": Known(world("-y/(x**2 + y**2)", "x/(x**2 + y**2)"), "driven",
                             "closed, and does 2 pi of work once round the origin"),
    "central force": Known(world("x/(x**2 + y**2)", "y/(x**2 + y**2)"), "passive", "the gradient of a logarithm"),
    "central force in space": Known(world3(f"x/{_AWAY3}", f"y/{_AWAY3}", f"z/{_AWAY3}"), "passive",
                                    "Coulomb's law", slow=True),
    "line vortex in space": Known(world3("-y/(x**2 + y**2)", "x/(x**2 + y**2)", "0"), "driven",
                                  "closed, and does 2 pi of work once round the axis", slow=True),
    "alignment": Known(spatial(wrench={"m1": "e2z*e3z", "m2": "-e1z*e3z"}), "passive",
                       "the third axis seeks the vertical, either way"),
    "square of a sine": Known(planar(wrench={"m": "sin(theta)**2"}), "driven", "its mean over a turn is 1/2"),
    "square of a sine without its mean": Known(planar(wrench={"m": "sin(theta)**2 - 0.5"}), "passive",
                                               "its mean over a turn is nothing"),
    "motor": Known(planar(wrench={"m": "sin(3*t)"}), "driven", "depends on time"),
    "torsion spring": Known(planar(wrench={"m": "-0.7*theta"}), "passive",
                            "theta counts turns: on the covering group it has an energy"),
    "open couple": Known(planar(wrench={"m": "a - sin(theta)"}, parameters={"a": OPEN}), "driven",
                         "a periodic potential but for 2 pi a a turn", conditions=("a = 0",)),
}  # fmt: skip

ZOO: Final[dict[str, Known]] = {
    **LINEAR, **DISGUISED, **SINGULAR, **STEPS, **OPENED, **VARYING, **LOSSES, **WRENCHES,
}  # fmt: skip
