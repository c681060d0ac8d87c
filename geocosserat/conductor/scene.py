"""The scene that a user names, and the law of its rod."""

import os
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import replace
from functools import partial
from typing import Any

from geocosserat.bounded import OutOfBounds, bounded
from geocosserat.model.effects.law_wrench import LawWrench
from geocosserat.model.law import Law
from geocosserat.model.records import Scene
from geocosserat.model.scene import load_scene

SceneLike = str | os.PathLike[str] | Mapping[str, Any] | Scene
MOST_SECONDS = 30.0
"""What the question whether a law is passive may take; it is undecided then."""


def load_any(scene: SceneLike, settings: Sequence[str] = ()) -> Scene:
    """The scene itself, or the one that a path, TOML text or mapping describes, with `settings` applied.

    Raises InputError as `load_scene`.
    """
    if isinstance(scene, Scene):
        return _stored(load_scene(scene.source, settings) if settings else scene)
    return _stored(load_scene(scene, settings))


def _stored(scene: Scene) -> Scene:
    """The scene, with what is found of the energy and the potential of a law that is written as stress and wrench."""
    model = scene.model
    if all(law.energy is not None and law.wrench is None for law in laws_of(scene)):
        return scene
    from geocosserat.passivity.storing import stored

    with suppress(OutOfBounds):  # then all that the law does counts as lost
        model = bounded(partial(stored, model), MOST_SECONDS)
    return replace(scene, model=model)


def laws_of(scene: Scene) -> list[Law]:
    """The law of the rod, or none."""
    found = [effect.law for effect in scene.model.effects if isinstance(effect, LawWrench)]
    return [scene.model.law] if scene.model.law else found
