"""All cases, family by family."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations_with_replacement
from typing import Any

from benchmarks.torture.case import Case, planar, spatial

FREE = {"kind": "free"}
CLAMPED = {"kind": "clamped"}


def stiffness() -> Iterator[Case]:
    """Stiff against soft modes, up to the slender limit."""
    for ratio in (1e6, 1e8, 1e10):
        yield Case(f"planar, stiffness 1:{ratio:.0e}", "stiffness", planar(rod__stiffness=[ratio, ratio, 1.0]))
        yield Case(
            f"spatial, stiffness 1:{ratio:.0e}",
            "stiffness",
            spatial(rod__stiffness=[ratio, 0.5 * ratio, 0.5 * ratio, 0.7, 1.0, 1.2]),
        )
    for thin in (1e-2, 1e-3, 1e-5):
        k, g = thin**-2, thin**2
        yield Case(
            f"slender, radius {thin:.0e}",
            "stiffness",
            spatial(rod__stiffness=[k, 0.3 * k, 0.3 * k, 0.7, 1.0, 1.0], rod__friction=[1.0, 2.0, 2.0, g, g, g]),
        )
    yield Case(
        "stretched stiff rod",
        "stiffness",
        planar(rod__stiffness=[1e10, 1e10, 1.0], start__strain=["1 + 1e-3*s", "1e-3", "1"]),
    )
    yield Case("soft in stretch", "stiffness", planar(rod__stiffness=[1e-6, 1e-6, 1.0], run__until=0.5))
    yield Case(
        "coupled stiffness, almost singular",
        "stiffness",
        planar(rod__stiffness=[[1e4, 0, 0], [0, 1e4, 99.9999], [0, 99.9999, 1.0]]),
    )


def friction() -> Iterator[Case]:
    """Friction of rotations next to nothing, or nothing; and very unequal."""
    for ratio in (1e-4, 1e-8, 0):
        yield Case(f"planar, rotational friction {ratio:g}", "friction", planar(rod__friction=[1.0, 2.0, ratio]))
        yield Case(
            f"spatial, rotational friction {ratio:g}", "friction", spatial(rod__friction=[1.0, 2.0, 2.0] + 3 * [ratio])
        )
    yield Case("friction along 1e-6 of that across", "friction", planar(rod__friction=[1e-6, 1.0, 1e-3]))
    yield Case("friction 1e8 for turning", "friction", planar(rod__friction=[1.0, 2.0, 1e8]))
    yield Case(
        "twist without friction, free ends",
        "friction",
        spatial(rod__friction=[1.0, 2.0, 2.0, 0, 0.01, 0.01], ends={"left": FREE, "right": FREE}),
    )


def steps() -> Iterator[Case]:
    """Coefficients with jumps along the rod."""
    jump = "heaviside(s - 0.5)"
    yield Case("stiffness with a jump of 1e4", "jumps", planar(rod__stiffness=[1e4, 1e4, f"1 + 9999*{jump}"]))
    yield Case(
        "stiffness with a jump of 1e8, in space",
        "jumps",
        spatial(rod__stiffness=[1e6, 1e6, 1e6, 1.0, f"1 + 1e8*{jump}", 1.0]),
    )
    yield Case(
        "friction with a jump of 1e4", "jumps", planar(rod__friction=[f"1 + 9999*{jump}", f"2 + 19998*{jump}", 0.01])
    )
    yield Case(
        "reference with jumps",
        "jumps",
        planar(rod__reference=[1, 0, f"10 - 30*{jump} + 20*heaviside(s - 0.9)"], start__strain=["1", "0", "0"]),
    )
    yield Case(
        "reference with jumps, in space",
        "jumps",
        spatial(rod__reference=[1, 0, 0, f"20*{jump}", f"-20*{jump}", "5"], start__strain=None),
    )
    many = " + ".join(f"{(-1) ** i * 8}*heaviside(s - {i / 11 + 0.01:.3f})" for i in range(1, 11))
    yield Case("ten jumps of curvature", "jumps", planar(rod__reference=[1, 0, many], start__strain=["1", "0", "0"]))
    yield Case("a jump at a thousandth", "jumps", planar(rod__stiffness=[1e4, 1e4, "1 + 99*heaviside(s - 0.999)"]))


def rough() -> Iterator[Case]:
    """Starts that no mesh resolves: noise at every Gauss point, high wave numbers."""
    noise = "0.3*sin(91234.567*s) + 0.3*sin(67891.234*s**2)"
    mesh: dict[str, Any] = {"run__elements": 32, "run__degree": 2, "run__rtol": 1e-7, "run__accuracy": None}
    yield Case(
        "white noise, planar",
        "rough",
        planar(start__strain=[f"1 + 0.3*({noise})", f"0.3*({noise})", f"20*({noise})"], **mesh),
    )
    yield Case(
        "white noise, spatial",
        "rough",
        spatial(
            start__strain=[f"1 + 0.3*({noise})", f"0.3*({noise})", "0.1", f"9*({noise})", f"20*({noise})", "1"], **mesh
        ),
    )
    yield Case(
        "white noise, stiff",
        "rough",
        planar(
            rod__stiffness=[1e8, 1e8, 1.0],
            start__strain=[f"1 + 0.3*({noise})", f"0.3*({noise})", f"20*({noise})"],
            **mesh,
        ),
    )
    yield Case(
        "white noise, frozen",
        "rough",
        planar(rod__frozen=["h1", "h2"], start__strain=["1", "0", f"20*({noise})"], **mesh),
    )
    yield Case("high wave number", "rough", planar(start__strain=["1", "0", "20*sin(40*pi*s)"]))
    yield Case(
        "noise too fine to be seen",
        "rough",
        planar(start__strain=["1", "0", f"20*({noise})"]),
    )


def huge() -> Iterator[Case]:
    """Strains far from small."""
    soft = [1e2, 1e2, 1.0]
    for h in (0.05, 1e-4, 0, -0.5):
        yield Case(
            f"stretch {h:g} at the start",
            "huge strains",
            planar(rod__stiffness=soft, start__strain=[f"{h:g}", "0", "1"]),
        )
    yield Case("stretched ten times", "huge strains", planar(rod__stiffness=soft, start__strain=["10", "1", "5"]))
    yield Case(
        "stretch -1 in space",
        "huge strains",
        spatial(start__strain=["-1", "0.2", "0.1", "1", "2", "3"], rod__stiffness=[1e2, 50, 50, 1, 1, 1]),
    )
    turns = 200 * 3.141592653589793
    yield Case("a hundred turns of bend", "huge strains", planar(start__strain=["1", "0", f"{turns}"]))
    yield Case(
        "a hundred turns of twist and bend",
        "huge strains",
        spatial(start__strain=["1", "0", "0", f"{turns}", "0", "20"], run__until=0.01),
    )
    yield Case(
        "pressed to nothing",
        "huge strains",
        planar(
            rod__stiffness=soft,
            ends__right={"kind": "free", "force": [-200.0, 0.0]},
            start__strain=None,
            run__until=0.1,
        ),
    )
    yield Case(
        "blown up by drag: a flow that stretches for ever",
        "huge strains",
        planar(
            rod__stiffness=[1e-9, 1e-9, 1.0],
            effects=[{"kind": "flow", "gradient": [[50, 0], [0, -50]], "velocity": [0, 0]}],
            ends={"left": FREE, "right": FREE},
            start__strain=None,
            run__until=0.5,
        ),
    )


def shocks() -> Iterator[Case]:
    """Loads that jump, and loads faster than anything else."""
    tip = {"kind": "free", "frame": "world"}
    yield Case("step load", "shocks", planar(ends__right={**tip, "force": [0, "-300*heaviside(t - 0.01)"]}))
    yield Case(
        "step load on and off",
        "shocks",
        spatial(
            ends__right={
                **tip,
                "force": [0, "-300*heaviside(t - 0.01) + 300*heaviside(t - 0.02)", "1000*heaviside(t - 0.03)"],
            }
        ),
    )
    yield Case("pulse", "shocks", planar(ends__right={**tip, "force": [0, "-2000*exp(-((t - 0.025)/1e-4)**2)"]}))
    yield Case(
        "shaken at 1e5",
        "shocks",
        planar(ends__right={**tip, "force": ["30*sin(1e5*t)", "30*cos(1e5*t)"]}, run__until=0.01),
    )
    yield Case(
        "base driven at 2000", "shocks", planar(ends__left={"kind": "driven", "twist": [0, 0, "600*cos(2000*t)"]})
    )
    yield Case(
        "base jerked",
        "shocks",
        planar(ends__left={"kind": "driven", "twist": ["50*heaviside(t - 0.01)*heaviside(0.02 - t)", 0, 0]}),
    )
    yield Case(
        "follower hammer",
        "shocks",
        planar(effects=[{"kind": "follower", "force": [0, "5000*sin(3000*t)**9"]}], run__until=0.02),
    )
    yield Case(
        "muscle as fast as can be",
        "shocks",
        planar(rod__reference=[1, 0, "10*sin(5000*t)*sin(2*pi*s)"], start__strain=None, run__until=0.02),
    )


def long() -> Iterator[Case]:
    """A million relaxation times, and hundreds of periods."""
    yield Case("a million relaxation times, planar", "long", planar(run__until=1e5))
    yield Case("a million relaxation times, spatial", "long", spatial(run__until=1e5))
    yield Case(
        "a million relaxation times under weight",
        "long",
        spatial(effects=[{"kind": "weight", "force": [0, 0, -3]}], run__until=1e5),
    )
    yield Case(
        "a million relaxation times, free in space", "long", spatial(ends={"left": FREE, "right": FREE}, run__until=1e5)
    )
    yield Case("a million relaxation times, frozen", "long", planar(rod__frozen=["h1", "h2"], run__until=1e5))
    yield Case(
        "three hundred periods",
        "long",
        planar(ends__left={"kind": "driven", "twist": [0, 0, "3*cos(20*t)"]}, run__until=100.0, run__accuracy=1e-4),
    )
    yield Case("next to no time", "long", planar(run__until=1e-12))


def units() -> Iterator[Case]:
    """The same rods in metres where they are microns long, and kilometres."""
    for name, L, B, g in (
        ("microns", 1e-5, 1e-24, 1e-3),
        ("kilometres", 1e4, 1e14, 1e3),
        ("atoms", 1e-10, 1e-28, 1e-3),
    ):
        T = g * L**4 / B
        k = 1e4 * B / L**2
        yield Case(
            f"{name}, planar",
            "units",
            planar(
                rod__length=L,
                rod__stiffness=[k, k, B],
                rod__friction=[g, 2 * g, 0.01 * g * L**2],
                start__strain=["1", "0", f"{3 / L!r}*(1 - s)**2*(1 + 2*s)"],
                run__until=0.05 * T,
            ),
        )
        yield Case(
            f"{name}, spatial, loaded",
            "units",
            spatial(
                rod__length=L,
                rod__stiffness=[k, k, k, 0.7 * B, B, B],
                rod__friction=[g, 2 * g, 2 * g] + 3 * [0.01 * g * L**2],
                start__strain=None,
                ends__right={"kind": "free", "frame": "world", "force": [0, 0, -5 * B / L**2]},
                run__until=0.05 * T,
            ),
        )
        yield Case(
            f"{name}, frozen",
            "units",
            planar(
                rod__length=L,
                rod__stiffness=[k, k, B],
                rod__friction=[g, 2 * g, 0.01 * g * L**2],
                rod__frozen=["h1", "h2"],
                start__strain=["1", "0", f"{3 / L!r}*(1 - s)**2*(1 + 2*s)"],
                run__until=0.05 * T,
            ),
        )


def turning() -> Iterator[Case]:
    """Rotations by half a turn and by hundreds, tangents that turn back, rods through themselves."""
    yield Case(
        "base spun by a hundred turns",
        "rotations",
        spatial(
            ends__left={"kind": "driven", "twist": [0, 0, 0, "200*pi", 0, 0]},
            run__until=1.0,
            start__strain=None,
            rod__reference=[1, 0, 0, 0, 0.5, 0],
        ),
    )
    yield Case(
        "base of a bent Kirchhoff rod spun by thirty turns",
        "rotations",
        spatial(
            rod__frozen=["h1", "h2", "h3"],
            ends__left={"kind": "driven", "twist": [0, 0, 0, "200*pi", 0, 0]},
            run__until=0.3,
            start__strain=None,
            rod__reference=[1, 0, 0, 0, 0.5, 0],
        ),
    )
    yield Case(
        "base turned by a hundred turns, planar",
        "rotations",
        planar(ends__left={"kind": "driven", "twist": [0, 0, "20*pi"]}, run__until=10.0),
    )
    yield Case(
        "tip spun by a torque",
        "rotations",
        spatial(ends__right={"kind": "free", "torque": [9.0, 0.3, 0.0]}, run__until=0.3),
    )
    yield Case(
        "rolled up ten turns",
        "rotations",
        planar(rod__reference=[1, 0, "20*pi"], start__strain=["1", "0", "0"], run__until=0.02),
    )
    yield Case(
        "rolled up by a couple, half a turn",
        "rotations",
        spatial(ends__right={"kind": "free", "torque": [0, 0, 3.15]}, start__strain=None, run__until=1.0),
    )
    yield Case(
        "turned back by a dead load",
        "rotations",
        planar(
            ends__right={"kind": "free", "frame": "world", "force": [-60.0, 0.0]},
            start__strain=["1", "0", "0.01"],
            run__until=0.5,
        ),
    )
    yield Case(
        "turned back by a dead load, in space",
        "rotations",
        spatial(
            ends__right={"kind": "free", "frame": "world", "force": [-60.0, 0.0, 0.0]},
            start__strain=["1", "0", "0", "0.1", "0.01", "0.02"],
            run__until=0.5,
        ),
    )
    eight = 2 * 3.141592653589793 * 2.404825557695773
    yield Case(
        "figure of eight",
        "rotations",
        planar(ends={"joined": True}, start__strain=["1", "0", f"{eight!r}*cos(2*pi*s)"], run__until=0.01),
    )
    yield Case(
        "through itself",
        "rotations",
        planar(rod__reference=[1, 0, "-6*pi"], start__strain=["1", "0", "6*pi"], run__until=0.02),
    )
    yield Case(
        "free magnet in a turning field",
        "rotations",
        spatial(
            effects=[{"kind": "field", "moment": [1, 0, 0], "field": ["30*cos(100*t)", "30*sin(100*t)", 0.1]}],
            ends={"left": FREE, "right": FREE},
            start__strain=None,
            run__until=1.0,
        ),
    )
    yield Case(
        "pinned and wound up",
        "rotations",
        planar(ends__left={"kind": "pinned", "torque": 40.0}, run__until=0.5, start__strain=None),
    )


def large() -> Iterator[Case]:
    """Many elements, and very high degree."""
    mesh: dict[str, Any] = {"run__accuracy": None, "run__frames": 3, "run__until": 0.001}
    yield Case(
        "10 000 elements of degree 1", "size", planar(run__elements=10_000, run__degree=1, run__rtol=1e-5, **mesh)
    )
    yield Case(
        "10 000 elements of degree 4", "size", planar(run__elements=10_000, run__degree=4, run__rtol=1e-4, **mesh)
    )
    yield Case(
        "10 000 elements of degree 1, in space",
        "size",
        spatial(run__elements=10_000, run__degree=1, run__rtol=1e-4, **mesh),
    )
    yield Case(
        "degree 64 on one element", "size", planar(run__elements=1, run__degree=64, run__rtol=1e-6, run__accuracy=None)
    )
    yield Case(
        "degree 64 on one element, in space",
        "size",
        spatial(run__elements=1, run__degree=64, run__rtol=1e-6, run__accuracy=None),
    )
    yield Case(
        "one element of degree 1", "size", planar(run__elements=1, run__degree=1, run__rtol=1e-6, run__accuracy=None)
    )


def unstable() -> Iterator[Case]:
    """States that are left: out of the plane, by snapping, by flutter."""
    yield Case(
        "overcurved ring leaves its plane",
        "instabilities",
        spatial(
            rod__reference=[1, 0, 0, 0, 0, "6*pi"],
            start__strain=["1", "0", "0", "1e-6*cos(4*pi*s)", "1e-6*sin(4*pi*s)", "2*pi"],
            ends={"joined": True},
            run__until=0.05,
        ),
    )
    for what, until in (
        ("leaves its plane", 0.05),
        ("halfway out of its plane", 0.004),
        ("about to leave its plane", 0.003),
    ):
        yield Case(
            f"overcurved inextensible ring {what}",
            "instabilities",
            spatial(
                rod__frozen=["h1", "h2", "h3"],
                rod__reference=[1, 0, 0, 0, 0, "6*pi"],
                start__strain=["1", "0", "0", "1e-6*cos(4*pi*s)", "1e-6*sin(4*pi*s)", "2*pi"],
                ends={"joined": True},
                run__until=until,
            ),
        )
    yield Case(
        "inextensible column that still buckles at the end",
        "instabilities",
        planar(
            rod__frozen=["h1", "h2"],
            ends__right={"kind": "free", "frame": "world", "force": [-40.0, 1e-3]},
            start__strain=None,
            run__until=0.05,
        ),
    )
    yield Case(
        "column buckles",
        "instabilities",
        planar(
            ends__right={"kind": "free", "frame": "world", "force": [-10.0, 1e-3]}, start__strain=None, run__until=1.0
        ),
    )
    yield Case(
        "column stays straight",
        "instabilities",
        planar(ends__right={"kind": "free", "frame": "world", "force": [-10.0, 0]}, start__strain=None, run__until=0.5),
    )
    yield Case(
        "arch snaps",
        "instabilities",
        planar(
            rod__stiffness=[1e3, 1e3, 1.0],
            start__strain=["1", "0", "1.5*pi*sin(2*pi*(s - 0.25))"],
            rod__reference=["0.98", "0", "0"],
            ends__right=CLAMPED,
            effects=[{"kind": "weight", "force": [0, "-300*heaviside(t - 0.05)"]}],
            run__until=0.3,
            run__accuracy=1e-4,
        ),
    )
    yield Case(
        "follower load flutters",
        "instabilities",
        planar(ends__right={"kind": "free", "force": [-60.0, 0.1]}, start__strain=None, run__until=0.6),
    )
    yield Case(
        "spun rod whirls",
        "instabilities",
        spatial(
            ends__left={"kind": "driven", "twist": [0, 0, 0, 2000.0, 0, 0]},
            start__strain=["1", "0", "0", "0", "0.01", "0"],
            run__until=0.2,
            run__accuracy=1e-4,
        ),
    )
    yield Case(
        "twisted rod makes a loop",
        "instabilities",
        spatial(
            start__strain=["1", "0", "0", "30", "0.01", "0.02"],
            ends={"left": CLAMPED, "right": CLAMPED},
            run__until=0.3,
        ),
    )


def constrained() -> Iterator[Case]:
    """Sets of constraints that are next to singular, or are."""
    straight: dict[str, Any] = {"start__strain": None}
    held = {"left": CLAMPED, "right": CLAMPED}
    weight = [{"kind": "weight", "force": [0, -3]}]
    yield Case(
        "straight, inextensible, held at both ends",
        "constraints",
        planar(rod__frozen=["h1", "h2"], ends=held, effects=weight, **straight),
    )
    yield Case(
        "nearly straight, inextensible, held at both ends",
        "constraints",
        planar(
            rod__frozen=["h1", "h2"], rod__reference=[1, 0, "1e-7*cos(2*pi*s)"], ends=held, effects=weight, **straight
        ),
    )
    yield Case(
        "curved, inextensible, held at both ends",
        "constraints",
        planar(
            rod__frozen=["h1", "h2"],
            rod__reference=[1, 0, "3*cos(2*pi*s)"],
            start__strain=["1", "0", "3*cos(2*pi*s)"],
            ends=held,
            effects=weight,
        ),
    )
    yield Case(
        "only twist is left",
        "constraints",
        spatial(rod__frozen=["h1", "h2", "h3", "Pi2", "Pi3"], start__strain=["1", "0", "0", "5*s", "0", "0"]),
    )
    yield Case(
        "one bend is left, no rotational friction",
        "constraints",
        spatial(
            rod__frozen=["h1", "h2", "h3", "Pi1", "Pi2"],
            rod__friction=[1, 2, 2, 0, 0, 0],
            start__strain=["1", "0", "0", "0", "0", "3*(1 - s)"],
        ),
    )
    yield Case(
        "inextensible ring",
        "constraints",
        planar(
            rod__frozen=["h1", "h2"],
            ends={"joined": True},
            start__strain=["1", "0", "2*pi + 6*cos(4*pi*s)"],
            run__until=0.01,
        ),
    )
    yield Case(
        "inextensible, ends pinned, twice as stiff as nothing",
        "constraints",
        planar(
            rod__frozen=["h1"],
            ends={"left": {"kind": "pinned"}, "right": {"kind": "pinned"}},
            effects=weight,
            **straight,
        ),
    )
    yield Case(
        "Kirchhoff rod, both ends held, twisted",
        "constraints",
        spatial(rod__frozen=["h1", "h2", "h3"], ends=held, start__strain=["1", "0", "0", "20", "0", "0"]),
    )
    yield Case(
        "frozen reference that moves",
        "constraints",
        planar(rod__frozen=["Pi"], rod__reference=[1, 0, "20*sin(100*t)*s"], **straight),
    )
    yield Case(
        "frozen, driven against its constraint",
        "constraints",
        planar(
            rod__frozen=["h1", "h2"],
            ends={"left": {"kind": "driven", "twist": ["-20", 0, 0]}, "right": CLAMPED},
            **straight,
        ),
    )


EFFECTS: dict[str, tuple[dict[str, Any], dict[str, Any]]] = {
    "weight": ({"force": [3, -9]}, {"force": [3, 1, -9]}),
    "follower": ({"force": ["-5*sin(40*t)", 8]}, {"force": ["-5*sin(40*t)", 8, 2]}),
    "couple": ({"torque": "5*cos(pi*s)"}, {"torque": ["5*cos(pi*s)", 1, -3]}),
    "field": (
        {"moment": [1, 0.3], "field": ["9*cos(99*t)", "9*sin(99*t)"]},
        {"moment": [1, 0.3, 0], "field": ["9*cos(99*t)", "9*sin(99*t)", 2]},
    ),
    "flow": (
        {"gradient": [[0, 20], [-5, 0]], "velocity": [1, -2]},
        {"gradient": [[0, 20, 0], [-5, 0, 3], [0, 0, 0]], "velocity": [1, -2, 0]},
    ),
    "trap": (
        {"stiffness": "50*exp(-t)", "centre": [0.5, "0.2*sin(50*t)"]},
        {"stiffness": "50*exp(-t)", "centre": [0.5, "0.2*sin(50*t)", 0.1]},
    ),
}


def pairs() -> Iterator[Case]:
    """Every pair of effects, each also with itself."""
    for one, other in combinations_with_replacement(EFFECTS, 2):
        for made, dimension in ((planar, 0), (spatial, 1)):
            effects = [{"kind": kind, **EFFECTS[kind][dimension]} for kind in (one, other)]
            ends = (
                {"left": FREE, "right": FREE} if (one, other) != ("trap", "trap") else {"left": CLAMPED, "right": FREE}
            )
            where = ("planar", "spatial")[dimension]
            yield Case(f"{one} and {other}, {where}", "pairs", made(effects=effects, ends=ends))


def laws() -> Iterator[Case]:
    """Rods whose energy is no square, or that answer to rates."""
    motion = {
        "name": "hardening",
        "motion": "planar",
        "energy": {"density": "50*(h1 - 1)**2 + 50*h2**2 + Pi**2/2 + 0.1*Pi**4"},
    }
    yield Case("hardening rod", "laws", planar(rod__law=motion, rod__stiffness=None))
    cosh = {"name": "exponential", "motion": "planar", "energy": {"density": "50*(h1 - 1)**2 + 50*h2**2 + 2*cosh(Pi)"}}
    yield Case(
        "rod that hardens like an exponential",
        "laws",
        planar(rod__law=cosh, rod__stiffness=None, start__strain=["1", "0", "9*(1 - s)"]),
    )
    two = {
        "name": "bistable",
        "motion": "planar",
        "energy": {"density": "500*(h1 - 1)**2 + 500*h2**2 + 0.05*(Pi**2 - 9)**2"},
    }
    yield Case(
        "bistable rod",
        "laws",
        planar(rod__law=two, rod__stiffness=None, start__strain=["1", "0", "0.1*sin(3*pi*s)"], run__until=0.3),
    )
    viscous = {
        "name": "creeping",
        "motion": "planar",
        "stress": {"F1": "1e3*(h1 - 1)", "F2": "1e3*h2", "M": "Pi + 1e-3*Pi_dot"},
    }
    yield Case("creeping rod", "laws", planar(rod__law=viscous, rod__stiffness=None))


FAMILIES = (
    stiffness,
    friction,
    steps,
    rough,
    huge,
    shocks,
    long,
    units,
    turning,
    large,
    unstable,
    constrained,
    pairs,
    laws,
)


def cases() -> list[Case]:
    """All of them; names are theirs alone."""
    found = [case for family in FAMILIES for case in family()]
    assert len({case.name for case in found}) == len(found)
    return found
