"""The kinds of effect that scenes may name, and what a class must be to become one of them."""

from __future__ import annotations

import re
from dataclasses import fields, is_dataclass
from typing import TypeVar

from geocosserat.model.effects.effect import Effect

E = TypeVar("E", bound="type[Effect]")
_WORD = re.compile(r"[a-z]([a-z0-9_]{0,29}[a-z_])?")
"""Kernels call coefficients by kind and key, and number them; so no number at the end."""
_KINDS: dict[str, type[Effect]] = {}


def register(effect: E) -> E:
    """Makes a kind of effect known to scenes; to be used as a decorator, above that of the dataclass.

    Raises TypeError if it is no effect, or its fields are not its keys, ValueError if a name is no word, or another
    effect has that kind.
    """
    name = getattr(effect, "__name__", repr(effect))
    if not (isinstance(effect, type) and issubclass(effect, Effect)):
        raise TypeError(f"{name}: expected a subclass of Effect, found none; derive it from Effect")
    if not (hasattr(effect, "kind") and hasattr(effect, "keys")):
        raise TypeError(f"{name}: expected kind and keys, found none; write kind = 'a name' and keys = {{...}}")
    for word in (effect.kind, *effect.keys):
        if not (isinstance(word, str) and _WORD.fullmatch(word)):
            raise ValueError(f"{name}: expected a word, found {word!r}; use a-z 0-9 _, first a letter, last no digit")
    if "kind" in effect.keys:
        raise ValueError(f"{name}: expected keys other than kind, found kind; rename it: it says which effect is meant")
    names = tuple(field.name for field in fields(effect)) if is_dataclass(effect) else ()
    if names != tuple(effect.keys):
        raise TypeError(
            f"{name}: expected a dataclass whose fields are its keys {', '.join(effect.keys) or '(none)'}, "
            f"found {', '.join(names) or 'none'}; write one field for each key, in that order"
        )
    if names and not effect.__dataclass_params__.frozen:
        raise TypeError(f"{name}: expected a frozen dataclass, found one that can be changed; add frozen=True")
    known = _KINDS.get(effect.kind)
    if known is not None and (known.__module__, known.__qualname__) != (effect.__module__, effect.__qualname__):
        raise ValueError(
            f"{name}: expected a kind of its own, found {effect.kind}, which is that of {known.__name__}; rename it"
        )
    _KINDS[effect.kind] = effect
    return effect


def kinds() -> tuple[str, ...]:
    """Every known kind, in the order of the alphabet."""
    return tuple(sorted(_KINDS))


def kind(name: str) -> type[Effect]:
    """The effect of that kind."""
    return _KINDS[name]
