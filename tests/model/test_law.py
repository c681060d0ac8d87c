"""Laws read from files: what they say, how they are overridden, and how what is wrong in them is refused."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from geocosserat.algebra.groups import SE2, SE3
from geocosserat.model.errors import InputError
from geocosserat.model.expressions import Number, Symbol, evaluate, parse
from geocosserat.model.law import Law, load_law, pose_names, rates

ODD = """
name = "odd planar rod"
motion = "planar"
[parameters]
k1 = 10.0
a = { symbol = true }
k3 = { symbol = true, positive = true }
[domain]
h1 = [0.5, 2]
[stress]
F1 = "k1*(h1 - 1)"
F2 = "k1*h2 + a*Pi"
M = "k3*Pi - a*h2"
[friction]
matrix = [1, 2, 0.01]
"""


def law(**changes: Any) -> Law:
    """A planar law with some of its tables replaced."""
    return load_law({"motion": "planar", "stress": {"M": "Pi"}} | changes)


def test_a_law_says_what_its_file_says() -> None:
    """Parameters with and without a value, the domain, the reference, components that are left out."""
    read = load_law(ODD)
    assert (read.name, read.group, read.reference) == ("odd planar rod", SE2, (1.0, 0.0, 0.0))
    assert (dict(read.parameters), dict(read.open)) == ({"k1": 10.0}, {"a": "real", "k3": "positive"})
    assert read.domain == {"h1": (0.5, 2.0)}
    assert read.stress is not None
    assert read.stress[2] == parse("k3*Pi - a*h2", ["k3", "Pi", "a", "h2"])
    assert read.friction is not None
    assert [row[i] for i, row in enumerate(read.friction)] == [Number(1.0), Number(2.0), Number(0.01)]
    assert law().stress == (Number(0.0), Number(0.0), Symbol("Pi"))


def test_a_law_reads_back_from_its_own_source() -> None:
    """Whether it came as text or as a mapping."""
    for read in (load_law(ODD), law(wrench={"m": "x*sin(theta)"}, reference=[1, 0, "2"])):
        again = load_law(read.source)
        assert (again.stress, again.wrench, again.reference) == (read.stress, read.wrench, read.reference)
        assert (again.domain, again.open, again.parameters) == (read.domain, read.open, read.parameters)


def test_a_law_is_read_from_a_file_and_says_so(tmp_path: Path) -> None:
    """Its path is kept, and stands in front of what is wrong."""
    path = tmp_path / "odd.toml"
    path.write_text(ODD)
    assert load_law(path).path == str(path)
    path.write_text(ODD.replace("h1 - 1", "h3 - 1"))
    with pytest.raises(InputError, match=r"odd.toml: stress.F1: .*the name h3 is not known"):
        load_law(path)


def test_values_from_outside_take_the_place_of_the_laws_own() -> None:
    """Of parameters with a value, and of those left open."""
    read = load_law(ODD, {"a": 0.3, "k1": 5.0, "other": 1.0})
    assert (dict(read.parameters), dict(read.open)) == ({"k1": 5.0, "a": 0.3}, {"k3": "positive"})


def test_the_stress_of_an_energy_is_its_gradient() -> None:
    """Component by component, by the names of the turn."""
    read = load_law({"motion": "planar", "energy": {"density": "(h1 - 1)**2*Pi + h2*u"}})
    assert read.stress is not None
    values = {"h1": 1.5, "h2": 0.2, "Pi": 0.7, "u": 0.3}
    assert [evaluate(e, values) for e in read.stress] == pytest.approx([2 * 0.5 * 0.7, 0.3, 0.25])


def test_a_stress_of_rates_is_viscous() -> None:
    """Each component of the turn has a rate."""
    assert rates(SE2) == ("h1_dot", "h2_dot", "Pi_dot")
    assert law(stress={"M": "Pi + 0.1*Pi_dot"}).viscous
    assert not law().viscous


def test_a_wrench_is_written_of_the_configuration() -> None:
    """In space the axes of the frame, component by component."""
    assert len(pose_names(SE3)) == 12
    assert law(wrench={"f1": "x*cos(theta) + y*t"}).wrench is not None
    spatial = {"motion": "spatial", "wrench": {"m1": "e1x*z - e3y"}}
    assert load_law(spatial).wrench == (*(Number(0.0),) * 3, parse("e1x*z - e3y", pose_names(SE3)), *(Number(0.0),) * 2)


def test_a_law_prints_what_it_is() -> None:
    """Every part, in words of the field."""
    text = str(load_law(ODD))
    for part in ("odd planar rod, a law in SE(2)", "F2 = k1*h2 + a*Pi", "Omega = 0.01", "0.5 <= h1 <= 2", "k3 > 0"):
        assert part in text


REFUSALS: list[tuple[dict[str, Any], str]] = [
    ({"motion": "round"}, "motion: expected one of planar, spatial, found 'round'"),
    ({"stresses": {}}, r"law: stresses: expected one of name, .*, found an unknown key; did you mean stress\?"),
    ({"stress": {}}, "stress: expected some of F1, F2, M, found nothing"),
    ({"stress": {"F3": "1"}}, "stress.F3: expected one of F1, F2, M, found an unknown key"),
    ({"stress": {"M": "Pi + x"}}, "stress.M: .*the name x is not known"),
    ({"stress": {"M": "s"}}, "stress.M: .*the name s is not known"),
    ({"stress": {"M": True}}, "stress.M: expected a number or an expression, found the boolean true"),
    ({"stress": {"M": float("nan")}}, "stress.M: expected a finite number, found nan"),
    ({"energy": {"density": "Pi**2"}}, r"energy: expected either \[stress\] or \[energy\], found both"),
    ({"name": "two\nlines"}, "name: expected one line of at most 200 characters"),
    ({"reference": [1, 0]}, r"reference: expected a list of 3 \(h1, h2, Pi\), found a list of 2"),
    ({"wrench": {"f1": "e1x"}}, "wrench.f1: .*the name e1x is not known"),
    ({"wrench": {"f1": "Pi"}}, r"wrench.f1: .*the name Pi is not known"),
    ({"friction": {"matrix": [1, 2]}}, r"friction.matrix: expected a list of 3 \(v1, v2, Omega\).*, found a list of 2"),
    ({"friction": {"matrix": [[1, 0, 0], 2, 3]}}, "friction.matrix.1: expected a list of 3, found 2"),
    ({"friction": {}}, "friction.matrix: expected a list of 3 .*, found nothing"),
    ({"parameters": {"h1": 3}}, r"parameters.h1: expected a name of your own, found h1, which .*SE\(2\) law know"),
    ({"parameters": {"theta": 3}}, "parameters.theta: expected a name of your own"),
    ({"parameters": {"a": {"symbol": 1}}}, "parameters.a.symbol: expected symbol = true, found 1"),
    ({"parameters": {"a": {"symbol": True, "positive": "yes"}}}, "positive: expected true or false, found 'yes'"),
    ({"parameters": {"a": {"sign": 1}}}, "parameters.a.sign: expected one of symbol, positive"),
    ({"parameters": [1]}, "parameters: expected a table of numbers"),
    ({"domain": {"h1": 2}}, "domain.h1: expected two numbers, the least and the greatest strain, found 2"),
    ({"domain": {"h1": [2, 1]}}, "domain.h1: expected the least before the greatest"),
    ({"domain": {"h1": [2, 3]}}, r"domain.h1: expected an interval that holds the reference of h1, found 1, outside"),
    ({"domain": {"v1": [0, 1]}}, "domain.v1: expected one of h1, h2, Pi"),
]


@pytest.mark.parametrize(("changes", "wording"), REFUSALS)
def test_what_is_wrong_in_a_law_is_refused_with_place_and_remedy(changes: dict[str, Any], wording: str) -> None:
    """One line: the key, what was expected and what was found."""
    with pytest.raises(InputError, match=wording) as caught:
        law(**changes)
    assert "\n" not in str(caught.value)


def test_a_law_of_nothing_is_refused() -> None:
    """There must be something to look at."""
    with pytest.raises(InputError, match=r"expected \[stress\], \[energy\], \[wrench\] or \[friction\], found nothing"):
        load_law({"motion": "planar"})
