"""What the rod is made of: frozen modes, rotations without friction, a reference that moves; and how it starts."""

from __future__ import annotations

from typing import Any

import pytest

from geocosserat.model.errors import InputError
from geocosserat.model.expressions import Number, parse, to_text
from geocosserat.model.scene import load_scene
from tests.model.scenes import PLANAR, SPATIAL, changed


def load(*entries: tuple[str, Any], scene: dict[str, Any] = PLANAR) -> Any:
    """The scene with entries changed."""
    for path, value in entries:
        scene = changed(scene, path, value)
    return load_scene(scene)


# frozen modes


@pytest.mark.parametrize(
    ("written", "read"),
    [([], ()), (["h1"], ("h1",)), (["Pi", "h1"], ("h1", "Pi")), (["h2", "h1", "h2", "h2"], ("h1", "h2"))],
)
def test_frozen_modes_are_kept_once_and_in_the_order_of_the_strains(written: list[str], read: tuple[str, ...]) -> None:
    """The order in which they are written means nothing, so equal rods are equal."""
    model = load(("rod.frozen", written)).model
    assert model.frozen == read
    assert model.held == tuple(name in read for name in ("h1", "h2", "Pi"))


def test_any_but_all_modes_may_be_frozen() -> None:
    """In space too: five of six leave one bend."""
    model = load(("rod.frozen", ["Pi2", "Pi1", "h3", "h2", "h1"]), scene=SPATIAL).model
    assert model.frozen == ("h1", "h2", "h3", "Pi1", "Pi2")
    assert model.held == (True, True, True, True, True, False)
    assert "frozen     h1, h2, h3, Pi1, Pi2" in str(model)


def test_frozen_modes_may_be_set_from_outside() -> None:
    """A setting freezes them, or none."""
    scene = load_scene(PLANAR, ['rod.frozen=["h1"]'])
    assert scene.model.frozen == ("h1",)
    assert load_scene(scene.source, ["rod.frozen=[]"]).model.frozen == ()


def test_a_frozen_mode_starts_at_its_reference() -> None:
    """What is written differently but means the same is the same; free modes start anywhere."""
    frozen = ("rod.frozen", ["h1", "Pi"])
    reference = ("rod.reference", ["1", 0, "2*sin(pi*u) + t"])
    assert load(frozen, reference, ("start.strain", [1, 0.3, "-2*sin(pi*u - pi)"])).start
    wording = (
        r"^scene: start.strain.2: expected Pi at its reference, since it is frozen, found a difference of 0.1; "
        r"write the reference here, or leave start.strain out$"
    )
    with pytest.raises(InputError, match=wording):
        load(frozen, reference, ("start.strain", [1, 0.3, "2*sin(pi*u) + 0.1"]))
    with pytest.raises(InputError, match=r"start.strain.0: expected h1 at its reference"):
        load(frozen, reference, ("start.strain", ["1 + 0.5*(heaviside(u - 0.7) - heaviside(u - 0.7001))", 0, 0]))


def test_how_near_a_frozen_mode_starts_is_judged_in_the_units_of_the_rod() -> None:
    """A curvature of a rod of a micrometre is large, and so is its rounding; of a kilometre, both are small."""
    frozen = ("rod.frozen", ["Pi"])
    tiny, huge = ("rod.length", 1e-6), ("rod.length", 1e3)
    assert load(frozen, tiny, ("rod.reference", [1, 0, "1e6/3"]), ("start.strain", [1, 0, 333333.33333333])).start
    assert load(frozen, tiny, ("start.strain", [1, 0, 1e-5])).start
    with pytest.raises(InputError, match=r"start.strain.2: expected Pi at its reference"):
        load(frozen, tiny, ("start.strain", [1, 0, 0.1]))
    with pytest.raises(InputError, match=r"start.strain.2: expected Pi at its reference"):
        load(frozen, huge, ("start.strain", [1, 0, 1e-9]))


# friction


def test_a_rotation_may_have_no_friction() -> None:
    """The number zero in its whole row and column; in space each rotation by itself."""
    assert load(("rod.friction.2", 0)).model.friction[2] == (Number(0.0),) * 3
    assert load(("rod.friction.2", "0")).model.friction[2][2] == Number(0.0)
    for zeros in ([3], [5], [3, 4], [3, 4, 5]):
        friction = [0 if i in zeros else 1 + i for i in range(6)]
        model = load(("rod.friction", friction), scene=SPATIAL).model
        assert [model.friction[i][i] == Number(0.0) for i in range(6)] == [i in zeros for i in range(6)]


@pytest.mark.parametrize("nothing", ["1e-2*(1 - 1)", "-0", -0.0, "sin(0)"])
def test_no_friction_may_be_written_as_any_zero(nothing: object) -> None:
    """The model is that of the number 0, by which all else knows rotations without friction."""
    assert load(("rod.friction.2", nothing)).model == load(("rod.friction.2", 0)).model
    assert load(("rod.friction.2", nothing)).model.friction[2] == (Number(0.0),) * 3


def test_what_rotations_have_friction_may_be_coupled() -> None:
    """A full matrix with one row and column of zeros; the rest must still be positive definite."""
    rows = [[1 + i if i == j else 0.0 for j in range(6)] for i in range(6)]
    rows[4][4] = 0.0
    rows[0][5] = rows[5][0] = 0.5
    assert load(("rod.friction", rows), scene=SPATIAL).model.friction[0][5] == Number(0.5)
    rows[0][5] = rows[5][0] = 3.0
    with pytest.raises(InputError, match=r"rod.friction: expected a positive definite matrix, found the eigenvalue -"):
        load(("rod.friction", rows), scene=SPATIAL)


@pytest.mark.parametrize("key", ["stiffness", "friction"])
@pytest.mark.parametrize("i", [0, 1])
def test_a_parameter_that_is_zero_is_not_the_number_zero(key: str, i: int) -> None:
    """Equations have a term for a parameter, whatever its value, and may not divide by it."""
    with pytest.raises(InputError, match=rf"rod.{key}: expected a positive definite matrix, found .* = 0 at u = 0"):
        load(("parameters.none", 0.0), (f"rod.{key}.{2 * i}", "none"))


# reference


@pytest.mark.parametrize(
    ("reference", "start"),
    [
        (["1", "0", "2*u"], "1, 0, 2*u"),
        (["1", "0", "3*sin(2*pi*t)"], "1, 0, 0"),
        (["1 + load*t", "t", "3*sin(2*pi*(u - t))"], "1, 0, 3*sin(2*pi*u)"),
        (["exp(-t)", "0", "u*cos(t) + heaviside(u - 0.5)*(1 - cos(t))"], "1, 0, u"),
        (["1", "0", "tanh(100*(t - 1))"], "1, 0, -1"),
    ],
)
def test_the_rod_starts_at_the_reference_of_time_zero(reference: list[str], start: str) -> None:
    """With what is then zero or one worked out, so that a start that is straight has no curvature at all."""
    scene = load(("rod.reference", reference))
    assert scene.model.reference[2] == parse(reference[2], {"u", "t"})
    assert ", ".join(to_text(e) for e in scene.start.strain) == start


def test_the_reference_may_use_the_relative_place_and_time() -> None:
    """A travelling wave: s becomes u/length, t stays."""
    model = load(("rod.length", 4), ("rod.reference", [1, 0, "sin(2*pi*(s - t))"])).model
    assert model.reference[2] == parse("sin(2*pi*(u/4 - t))", {"u", "t"})
