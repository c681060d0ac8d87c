"""Every loss of stability that is known here: the scene, the parameter, the value, and growths on either side.

`all_values` lists them as numbers, to ten digits and more; `FAMILIES` holds the problems of most of them, by which they
can be computed again (those of the joined ring are in `michell`).
"""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

from tests.references.stability import columns, filament, greenhill, heavy, michell, odd, whirling
from tests.references.stability.linear import Problem
from tests.references.stability.straight import Rod


@dataclass(frozen=True)
class Value:
    """A loss of stability of the scene `examples/stability/<scene>.toml` as its parameter `over` grows in the interval.

    frequency (radians / time): 0 if it diverges. growths: of two values of the parameter, one before and one after, the
    leading eigenvalue, 1 / time; of a pair that with positive imaginary part; of a spun rod as seen from its base.
    multiplicity: of the leading eigenvalue, or pair. zeros: growths beside it that are zero at all values.
    """

    scene: str
    over: str
    interval: tuple[float, float]
    value: float
    frequency: float
    growths: tuple[tuple[float, complex], tuple[float, complex]]
    multiplicity: int = 1
    zeros: int = 0

    @property
    def kind(self) -> Literal["divergence", "flutter"]:
        """Whether it leaves its state for good or begins to swing."""
        return "flutter" if self.frequency else "divergence"


# the rods of the scenes: length, k1, k2, bend; frictions across and of tilting
THICK = Rod(1.0, 40.0, 16.0, 1.0, 2.0, 0.02)
STIFF = Rod(1.0, 200.0, 80.0, 1.0, 2.0, 0.02)
BENDING = Rod(1.0, math.inf, math.inf, 1.0, 2.0, 0.0)
RING = michell.Ring(1.0, (2000.0, 800.0, 800.0, 0.8, 1.0, 1.0), (1.0, 2.0, 2.0, 0.05, 0.02, 0.02), 2.0 * math.pi)
THIN_RING = michell.Ring(1.0, (math.inf, math.inf, math.inf, 0.8, 1.0, 1.0), (1.0, 2.0, 2.0, 0.05, 0.0, 0.0))

FAMILIES: dict[str, Callable[[Any], Problem]] = {
    "column_dead": lambda load: columns.loaded(THICK, load),
    "column_dead_limit": lambda load: columns.loaded(BENDING, load),
    "column_dead_spatial": lambda load: columns.loaded(THICK, load),  # in its softer plane
    "column_pinned": lambda growth: columns.grown(THICK, growth, "pinned"),
    "column_clamped": lambda growth: columns.grown(THICK, growth, "clamped"),
    "heavy": lambda weight: heavy.standing(THICK, weight),
    "heavy_limit": lambda weight: heavy.standing(BENDING, weight),
    "twist": lambda twist: greenhill.twisted(THICK, 0.8 * twist, 5.0),
    "twist_limit": lambda twist: greenhill.twisted(BENDING, twist),
    "ring_held": lambda twist: michell.held(RING, float(twist)),
    "follower_tip": lambda load: filament.pushed_at_tip(STIFF, load),
    "follower_tip_limit": lambda load: filament.pushed_at_tip(BENDING, load),
    "follower_tip_spatial": lambda load: filament.pushed_at_tip(STIFF, load),
    "follower_along": lambda density: filament.pushed_along(STIFF, density),
    "follower_along_limit": lambda density: filament.pushed_along(BENDING, density),
    "whirl": lambda spin: whirling.spun(THICK, 0.05, spin),
    "whirl_limit": lambda spin: whirling.spun(BENDING, 1.0, spin),
    "odd": lambda a: odd.free([[40.0, 0.0, 0.0], [0.0, 16.0, a], [0.0, 0.0, 1.0]], (1.0, 2.0, 0.02)),
}


def all_values() -> tuple[Value, ...]:
    """The table."""
    return (
        Value("column_dead", "load", (1.0, 4.0), 2.273560670654354, 0.0,
              ((2.0, -0.6845232492198813), (2.5, 0.6014926548359416))),
        Value("column_dead_limit", "load", (1.0, 4.0), 2.4674011002723395, 0.0,
              ((2.0, -1.2496432839242515), (3.0, 1.4793284583683968))),
        Value("column_dead_spatial", "load", (1.0, 4.0), 2.273560670654354, 0.0,
              ((2.0, -0.6845232492198813), (2.5, 0.6014926548359416))),
        Value("column_pinned", "growth", (1.0, 1.3), 1.1724191778237174, 0.0,
              ((1.1, -12.322445731853898), (1.25, 13.35712689739068))),
        Value("column_clamped", "growth", (1.0, 1.6), 1.459381661895123, 0.0,
              ((1.4, -10.352371021698351), (1.5, 7.678400224234743))),
        Value("heavy", "weight", (1.0, 10.0), 6.971283400248639, 0.0,
              ((6.0, -0.7129062063351064), (8.0, 0.7813350717637111))),
        Value("heavy_limit", "weight", (1.0, 10.0), 7.837347438943484, 0.0,
              ((7.0, -0.6630374163496323), (9.0, 0.9217915827702313))),
        Value("twist", "twist", (1.0, 12.0), 9.924276001694098, 0.0,
              ((9.0, -39.4640396451552), (11.0, 105.50927455802564)), multiplicity=2),
        Value("twist_limit", "twist", (1.0, 10.0), 8.986818915818128, 0.0,
              ((8.0, -66.43087163144362), (9.5, 42.942014479212396)), multiplicity=2),
        Value("ring_held", "twist", (5.0, 12.0), 10.07137281793555, 0.0,
              ((9.0, -39.38051430187884), (11.0, 60.00421879426106))),
        Value("ring", "twist", (5.0, 12.0), 10.07137281793555, 0.0,
              ((9.0, -154.63599321706758), (11.0, 143.45325820123293)), multiplicity=2),
        Value("ring_limit", "twist", (5.0, 15.0), 13.603495231756634, 0.0,
              ((12.0, -581.2692318161629), (15.0, 581.6327743781065)), multiplicity=2, zeros=1),
        Value("follower_tip", "load", (5.0, 50.0), 28.071118097904833, 63.18617944337097,
              ((25.0, -10.630529834779809 + 55.3213047610373j), (30.0, 7.248261810732439 + 67.78235394320026j))),
        Value("follower_tip_limit", "load", (5.0, 50.0), 37.69543084031858, 95.62931788262655,
              ((30.0, -27.30895669073368 + 72.78154741461611j), (45.0, 28.07449930355842 + 114.83435209411505j))),
        Value("follower_tip_spatial", "load", (5.0, 50.0), 28.071118097904833, 63.18617944337097,
              ((25.0, -10.630529834779809 + 55.3213047610373j),
               (30.0, 7.248261810732439 + 67.78235394320026j)), multiplicity=2),
        Value("follower_along", "density", (5.0, 90.0), 56.51662153509345, 68.22984668151527,
              ((50.0, -11.245205168778488 + 58.173764667131465j), (65.0, 17.091891665112914 + 81.92532294267751j))),
        Value("follower_along_limit", "density", (5.0, 90.0), 76.10211907096544, 98.29541154988217,
              ((65.0, -19.303029376135687 + 81.6891960316058j), (85.0, 16.09873865797176 + 111.3390044202763j))),
        Value("whirl", "spin", (10.0, 300.0), 263.89760030546825, 167.9974169623277,
              ((240.0, -13.744947787849602 + 225.78875588560265j), (290.0, 47.1415342027841 + 130.33720439441421j))),
        Value("whirl_limit", "spin", (1.0, 12.0), 8.865135762509869, 2.5576581211050993,
              ((8.0, -1.3467726960135005 + 2.0235871323665933j), (10.0, 2.186546888654735 + 3.579982241975575j))),
        Value("odd", "a", (1.0, 20.0), 11.081566951451958, 20.460653030796824,
              ((11.0, -0.349070235541207 + 20.510464491680093j), (14.0, 10.133447711790193 + 15.461824257413827j))),
    )  # fmt: skip


def value(scene: str) -> Value:
    """That of one scene."""
    return next(entry for entry in all_values() if entry.scene == scene)
