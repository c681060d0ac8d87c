"""Every loss of stability that is known here: the scene, the parameter, the value, and growths on either side.

`all_values` lists them as numbers; `Value.family` is what they were computed from, so that they can be computed again.
"""
import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Literal

from tests.references.stability import columns, filament, greenhill, heavy, whirling
from tests.references.stability.linear import Problem
from tests.references.stability.straight import Rod

THICK = Rod(1.0, 40.0, 16.0, 1.0, 2.0, 0.02)
STIFF = Rod(1.0, 200.0, 80.0, 1.0, 2.0, 0.02)
ONLY_BENDING = Rod(1.0, math.inf, math.inf, 1.0, 2.0, 0.0)
FAMILIES = {
 "column_dead": ("load", (0.5,4.0), lambda p: columns.loaded(THICK,p)),
 "column_dead_limit": ("load", (0.5,4.0), lambda p: columns.loaded(ONLY_BENDING,p)),
 "column_pinned": ("growth", (1.0,1.3), lambda p: columns.grown(THICK,p,"pinned")),
 "column_clamped": ("growth", (1.0,1.6), lambda p: columns.grown(THICK,p,"clamped")),
 "heavy": ("weight", (1,10), lambda p: heavy.standing(THICK,p)),
 "heavy_limit": ("weight", (1,10), lambda p: heavy.standing(ONLY_BENDING,p)),
 "twist": ("twist", (1,15), lambda p: greenhill.twisted(THICK,0.8*p,5.0)),
 "twist_limit": ("twist", (1,10), lambda p: greenhill.twisted(ONLY_BENDING,p)),
 "follower_tip": ("load", (5,50), lambda p: filament.pushed_at_tip(STIFF,p)),
 "follower_tip_limit": ("load", (5,50), lambda p: filament.pushed_at_tip(ONLY_BENDING,p)),
 "follower_along": ("density", (5,100), lambda p: filament.pushed_along(STIFF,p)),
 "follower_along_limit": ("density", (5,100), lambda p: filament.pushed_along(ONLY_BENDING,p)),
 "whirl": ("spin", (10,300), lambda p: whirling.spun(THICK,0.05,p)),
 "whirl_limit": ("spin", (1,12), lambda p: whirling.spun(ONLY_BENDING,1.0,p)),
}
