"""Effects of one's own: registered or refused, and tried before they are relied upon."""

from __future__ import annotations

import inspect
import re
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

import geocosserat
from geocosserat import effects
from geocosserat.effects import Effect, Expression, Key, Pair, Seen, Vector, nothing, register
from geocosserat.model.effects import registry
from geocosserat.model.effects.catalogue import EFFECTS, kinds
from geocosserat.model.effects.effect import Shape
from geocosserat.model.errors import InputError
from geocosserat.model.expressions import FUNCTIONS, Call, Number, Symbol, evaluate
from geocosserat.model.scene import load_scene
from geocosserat.model.seen import seen
from tests.model.posed import read, scene_with, wrench


def test_the_tests_forget_what_they_registered() -> None:
    """Only what comes with the program is known before, and is known in the order of the alphabet."""
    assert kinds() == tuple(sorted(each.kind for each in EFFECTS))


def made(**attributes: Any) -> type[Effect]:
    """An effect with one number that pushes up; with other attributes."""
    parts = {"kind": "push", "keys": {"strength": Key("scalar")}, "__annotations__": {"strength": Vector}} | attributes
    return dataclass(frozen=True)(type("Push", (Effect,), parts))  # type: ignore[no-any-return]


# registering


def test_a_registered_effect_is_one_like_the_others() -> None:
    """Known to scenes, to settings, to messages; values checked, printed and written by its keys."""
    Push = made(potential=lambda self, seen: -self.strength[0] * seen.position[-1])
    assert register(Push) is Push
    assert "push" in kinds()
    scene = load_scene(scene_with("push", 2, {"strength": "load*t"}), ["effects.0.strength=3*u"])
    (effect,) = scene.model.effects
    assert effect == Push((Number(3.0) * Symbol("u"),))  # type: ignore[call-arg]
    assert "effect     push of strength (3*u)\n" in str(scene)
    assert load_scene(scene.source).model == scene.model
    np.testing.assert_allclose(wrench(effect, np.eye(3)), [0, 1.2, 0], rtol=1e-15)
    with pytest.raises(InputError, match=r"effects\.0\.strength: expected a finite value, found inf at t = 0"):
        load_scene(scene_with("push", 2, {"strength": "1/t"}))
    with pytest.raises(InputError, match=r"found 'pusch'; did you mean push\?"):
        load_scene(scene_with("pusch", 2, {}))
    with pytest.raises(InputError, match=r"effects\.0\.strengh: .* did you mean effects\.0\.strength\?"):
        load_scene(scene_with("push", 2, {"strength": 1}), ["effects.0.strengh=1"])


def test_an_effect_may_have_no_keys() -> None:
    """Then it is the same wherever it is named."""
    register(made(keys={}, __annotations__={}))
    assert str(read("push", 2, {})) == "push"
    assert read("push", 3, {}).needs(seen(3)) == "nothing"


def test_every_shape_of_a_key_arrives_as_documented() -> None:
    """So many expressions, and as the formulas ask for them."""
    keys = {shape: Key(shape) for shape in Shape.__args__}  # type: ignore[attr-defined]
    register(made(keys=keys, __annotations__=dict.fromkeys(keys, Vector)))
    values: dict[str, Any] = {"scalar": 1, "world": [1, 2], "body": [1, 2], "moment": 1, "matrix": [[1, 2], [3, 4]]}
    assert [len(v) for v in read("push", 2, values).values().values()] == [1, 2, 2, 1, 4]
    values = {"scalar": 1, "world": [1, 2, 3], "body": [1, 2, 3], "moment": [1, 2, 3], "matrix": [1, 2, 3]}
    assert [len(v) for v in read("push", 3, values).values().values()] == [1, 3, 3, 3, 9]


def test_registering_again_replaces_and_another_of_that_kind_is_refused() -> None:
    """A module may be read twice; two effects of one kind would shadow each other."""
    register(made())
    again = register(made())
    assert registry.kind("push") is again
    for other in (made(__qualname__="Other"), made(__module__="elsewhere")):
        wording = "Push: expected a kind of its own, found push, which is that of Push; rename it"
        with pytest.raises(ValueError, match=wording):
            register(other)
    with pytest.raises(ValueError, match="found weight, which is that of Weight"):
        register(made(kind="weight"))
    assert registry.kind("push") is again


NO_KEYS = type("NoKeys", (Effect,), {"kind": "push"})


@pytest.mark.parametrize(
    ("wrong", "error", "wording"),
    [
        (3, TypeError, "3: expected a subclass of Effect, found none; derive it from Effect"),
        (int, TypeError, "int: expected a subclass of Effect, found none"),
        (type("Bare", (Effect,), {}), TypeError, "Bare: expected kind and keys, found none; write kind = 'a name'"),
        (NO_KEYS, TypeError, "NoKeys: expected kind and keys, found none"),
        (type("Plain", (Effect,), {"kind": "push", "keys": {"strength": Key("scalar")}}), TypeError,
         "Plain: expected a dataclass whose fields are its keys strength, found none; write one field for each"),
        (made(keys={}), TypeError, r"fields are its keys \(none\), found strength"),
        (made(keys={"strength": Key("scalar"), "depth": Key("scalar")}), TypeError, "strength, depth, found strength;"),
        (made(keys={"depth": Key("scalar"), "strength": Key("scalar")},
              __annotations__={"strength": Vector, "depth": Vector}), TypeError,
         "keys depth, strength, found strength, depth; write one field for each key, in that order"),
        (made(kind="Push"), ValueError, "Push: expected a word, found 'Push'; use a-z 0-9 _, first a letter, last no"),
        (made(kind="push2"), ValueError, "expected a word, found 'push2'"),
        (made(kind="push-up"), ValueError, "expected a word, found 'push-up'"),
        (made(kind=""), ValueError, "expected a word, found ''"),
        (made(kind=3), ValueError, "expected a word, found 3"),
        (made(kind="p" * 32), ValueError, "expected a word, found 'p"),
        (made(keys={"Strength": Key("scalar")}), ValueError, "expected a word, found 'Strength'"),
        (made(keys={"kind": Key("scalar")}), ValueError, "expected keys other than kind, found kind; rename it"),
        (dataclass(type("Loose", (Effect,), {"kind": "push", "keys": {"strength": Key("scalar")},
                                             "__annotations__": {"strength": Vector}})), TypeError,
         "Loose: expected a frozen dataclass, found one that can be changed; add frozen=True"),
    ],
)  # fmt: skip
def test_what_is_no_effect_is_refused(wrong: Any, error: type[Exception], wording: str) -> None:
    """When it is registered, not when a scene uses it."""
    before = kinds()
    with pytest.raises(error, match=wording):
        register(wrong)
    assert kinds() == before


def test_a_key_has_a_known_shape_and_varies_with_u_and_t_only() -> None:
    """Anything else is refused where it is written."""
    with pytest.raises(ValueError, match="expected a shape of scalar, world, body, moment, matrix, found 'vector'"):
        Key("vector")  # type: ignore[arg-type]
    with pytest.raises(
        ValueError, match='expected to vary with some of "ut", found \'us\'; write "", "u", "t" or "ut"'
    ):
        Key("scalar", "us")


# formulas


def of_space(self: Any, seen: Seen) -> Expression:
    return -self.strength[0] * seen.position[2]


def short(self: Any, seen: Seen) -> Pair:
    return nothing(seen.space), ()


def plain_number(self: Any, seen: Seen) -> Any:
    return (0.5,) * seen.space, nothing(seen.rotations)


def of_time(self: Any, seen: Seen) -> Expression:
    return seen.position[0] * Symbol("t")


def of_value(self: Any, seen: Seen) -> Expression:
    return seen.position[0] if self.strength[0] > 1 else seen.position[1]  # type: ignore[operator,no-any-return]


@pytest.mark.parametrize(
    ("formulas", "wording"),
    [
        ({"potential": of_space}, "found push, with IndexError: tuple index out of range; correct Push"),
        ({"wrench": short}, r"TypeError: wrench: expected 2 components and 1, found 2 and 0; fill up with nothing\("),
        ({"medium": short}, "TypeError: medium: expected 2 components and 1, found 2 and 0"),
        ({"wrench": plain_number}, r"wrench: expected expressions, found float; write Number\(...\) for a number"),
        ({"potential": of_time}, "expected only values of its keys and what is seen, found t; make it a key"),
        ({"potential": lambda self, seen: 3.0}, "AttributeError|TypeError"),
        ({"potential": of_value}, "TypeError: '>' not supported"),
    ],
)
def test_formulas_that_do_not_work_are_found_when_a_scene_is_read(formulas: dict[str, Any], wording: str) -> None:
    """One message with the place in the scene and the error of the formula, before any equation is made of it."""
    register(made(**formulas))
    start = r"^scene: effects\.0\.kind: expected an effect with formulas for the plane, found push, with "
    with pytest.raises(InputError, match=start) as caught:
        load_scene(scene_with("push", 2, {"strength": 2}))
    assert re.search(wording, str(caught.value))
    assert caught.value.__cause__ is not None


def test_formulas_of_space_alone_work_there() -> None:
    """An effect need not be for both motions."""
    register(made(potential=of_space))
    np.testing.assert_array_equal(wrench(read("push", 3, {"strength": 2}), np.eye(4)), [0, 0, 2, 0, 0, 0])


def test_formulas_may_name_symbols_of_the_run_only_through_keys() -> None:
    """A value may depend on t where its key says so."""
    register(made(potential=lambda self, seen: -self.strength[0] * seen.position[0]))
    np.testing.assert_allclose(wrench(read("push", 2, {"strength": "t"}), np.eye(3), t=0.7), [0.7, 0, 0])


# the public names


@pytest.mark.parametrize("name", sorted(set(FUNCTIONS) - {"heaviside"}))
def test_functions_make_expressions(name: str) -> None:
    """Of expressions and of numbers; of nothing else."""
    function = getattr(effects, "abs_" if name == "abs" else name)
    assert function(Symbol("u")) == Call(name, Symbol("u"))
    assert evaluate(function(0.25), {}) == evaluate(Call(name, Number(0.25)), {})
    with pytest.raises(TypeError, match="expected an expression or a number, found str"):
        function("u")


@pytest.mark.parametrize("module", [geocosserat, effects])
def test_public_names_are_listed_and_explained(module: Any) -> None:
    """In order, each there, each with a sentence if it is a function or a class."""
    names = module.__all__
    assert names == sorted(names)
    assert len(set(names)) == len(names)
    for name in names:
        thing = getattr(module, name)
        if inspect.isfunction(thing) or inspect.isclass(thing):
            assert thing.__doc__, name


def test_the_list_of_public_names() -> None:
    """What a script may rely on; a name is added on purpose, and never lost."""
    commands = ["check", "cost", "derive", "equilibrium", "generate", "load", "paper", "run", "stability"]
    assert geocosserat.__all__ == ["__version__", *commands]
    assert set(effects.__all__) >= {"Effect", "Key", "Seen", "register", "dot", "cross", "nothing", "sin", "abs_"}
    assert "heaviside" not in effects.__all__  # a jump in space would go unseen by the solver
