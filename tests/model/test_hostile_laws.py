"""Laws that are made to do harm: refused at once with one line, or answered in bounded time; nothing in them runs."""

from __future__ import annotations

import json
import resource
import sys
import time
import tracemalloc
from collections.abc import Iterator
from contextlib import contextmanager
from functools import partial
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner
from hypothesis import given, settings
from hypothesis import strategies as st

from geocosserat.bounded import OutOfBounds, bounded
from geocosserat.cli import main
from geocosserat.conductor.check import check
from geocosserat.model.errors import InputError
from geocosserat.model.law import LAW_KEYS, Law, load_law
from geocosserat.passivity.check import check as check_law
from tests.model.trees import texts

pytestmark = pytest.mark.usefixtures("patience")

HEAD = 'name = "hostile"\nmotion = "planar"\n'
MOST_MEMORY = 50 * 2**20
VERDICTS = ("passive", "active", "driven", "undecided")


def moment(e: str) -> str:
    """A law file whose moment is one expression."""
    return f'{HEAD}[stress]\nM = "{e}"\n'


def tables(*lines: str) -> str:
    """A law file with more lines."""
    return HEAD + "\n".join(lines) + "\n"


STRESS = ("[stress]", "M = 'Pi'")


def own(name: str) -> str:
    """A law file with an open parameter of this name."""
    return tables("[parameters]", f"{name} = {{ symbol = true }}", *STRESS)


FILES: dict[str, tuple[str | bytes, str]] = {
    # code
    "import": (moment("__import__('os').mkdir('owned')"), 'M: .*the character "\'" is not available'),
    "attribute": (moment("h1.__class__"), r"M: .*the character '\.' is not available"),
    "index": (moment("h1[0]"), r"M: .*the character '\[' is not available; group with \( \)"),
    "comprehension": (moment("[x for x in (1,)]"), r"M: .*the character '\[' is not available"),
    "lambda": (moment("(lambda: 1)()"), "M: .*the character ':' is not available"),
    "walrus": (moment("(h1 := 2)"), "M: .*the character ':' is not available"),
    "f-string": (moment("f'{h1}'"), 'M: .*the character "\'" is not available'),
    "repeated string": (moment("'a'*10**9"), 'M: .*the character "\'" is not available'),
    "two statements": (moment("h1; h2"), "M: .*the character ';' is not available"),
    "matrix product": (moment("h1 @ h2"), "M: .*the character '@' is not available"),
    "dunder": (moment("__class__"), "M: .*the name __class__ is not known"),
    "builtin": (moment("open(1)"), "M: .*there is no function open"),
    "keyword": (moment("h1 if h2 else Pi"), "M: .*expected an operator before 'if'"),
    # characters that look like others, or like nothing
    "Cyrillic name": (moment("h1 + \u0435"), r"M: .*U\+0435 \(CYRILLIC SMALL LETTER IE\) is not ASCII"),
    "Cyrillic function": (moment("\u0435xp(h1)"), r"M: .*U\+0435 \(CYRILLIC SMALL LETTER IE\)"),
    "full-width digits": (moment("\uff11\uff10*Pi"), r"M: .*U\+FF11 \(FULLWIDTH DIGIT ONE\)"),
    "full-width name": (moment("\uff48\uff11"), r"M: .*U\+FF48 \(FULLWIDTH LATIN SMALL LETTER H\)"),
    "zero-width joiner": (moment("h\u200d1"), r"M: .*U\+200D \(ZERO WIDTH JOINER\)"),
    "right to left": (moment("h1\u202e"), r"M: .*U\+202E \(RIGHT-TO-LEFT OVERRIDE\)"),
    "no-break space": (moment("h1\u00a0+1"), r"M: .*U\+00A0 \(NO-BREAK SPACE\)"),
    "minus sign": (moment("h1 \u2212 1"), r"M: .*U\+2212 \(MINUS SIGN\)"),
    "NUL": (moment("h1\0"), r"valid TOML, found Illegal character '\\x00'"),
    "escaped NUL": (moment("h1\\u0000"), r"M: .*the character '\\x00' is not available"),
    "escape codes in the name": (tables('title = "\\u001b[31m"'), "title: expected one of name, motion"),
    "line break in the name": ('name = "a\\nb"\nmotion = "planar"\n', r"name: expected one line .*'a\\nb'"),
    "lone surrogate": (tables('reference = "\\ud800"'), "valid TOML, found Escaped character is not a Unicode scalar"),
    "not UTF-8": (moment("h1").encode() + b"\xe9", "line 5: expected UTF-8 text, found the byte 0xe9"),
    "UTF-16": (moment("h1").encode("utf-16-le"), "valid TOML"),
    # names of parameters
    "parameter with a line break": (own('"a\\nb"'), r"'a\\nb': expected a name"),
    "Cyrillic parameter": (own('"\\u0430"'), r"'\\u0430': expected a name"),
    "parameter with a space": (own('"a b"'), "'a b': expected a name"),
    "parameter of 65 letters": (own("a" * 65), "expected a name"),
    "parameter that is a function": (own("sin"), "sin: expected a name of your"),
    "parameter that is a strain": (tables("[parameters]", "Pi = 1", *STRESS), "Pi: expected a name of your own"),
    "5000 parameters": (
        tables("[parameters]", *(f"k{i} = 1" for i in range(5000)), *STRESS), "at most 1000 parameters, found 5000"
    ),
    "5000 open parameters": (
        tables("[parameters]", *(f"k{i} = {{ symbol = true }}" for i in range(5000)), *STRESS),
        "at most 1000 parameters, found 5000",
    ),
    "circle": (tables("[parameters]", "a = 'b'", "b = 'a'", *STRESS), "does not depend on itself, found a -> b -> a"),
    "itself": (tables("[parameters]", "a = 'a'", *STRESS), "does not depend on itself, found a -> a"),
    "long circle": (
        tables("[parameters]", *(f"k{i} = 'k{(i + 1) % 900}'" for i in range(900)), *STRESS),
        r"does not depend on itself, found (k\d+ -> ){5}\.\.\.;",
    ),
    "of an open one": (
        tables("[parameters]", "a = { symbol = true }", "b = '2*a'", *STRESS), "parameters.b: .*the name a is not known"
    ),
    # numbers
    "9000 digits": (moment("9" * 9000 + "*h1"), "M: .*the number is too large"),
    "5000 digits": (tables("[stress]", "M = " + "9" * 5000), "valid TOML, found Exceeds the limit"),
    "4000 digits": (tables("[stress]", "M = " + "9" * 4000), "M: .*an integer of 13288 bits; the number is too large"),
    "9000 hex digits": (tables("[stress]", "M = 0x" + "f" * 9000), "M: .*found an integer of 36000 bits"),
    "large exponent": (moment("1e99999*h1"), "M: .*the number is too large"),
    "inf": (tables("[stress]", "M = inf"), "M: expected a finite number, found inf"),
    "nan": (tables("[stress]", "M = nan"), "M: expected a finite number, found nan"),
    "inf by name": (moment("inf*h1"), "M: .*the name inf is not known"),
    "nan in the reference": (tables("reference = [nan, 0, 0]", *STRESS), "reference.0: expected a finite number"),
    "inf in the domain": (tables("[domain]", "h1 = [-inf, inf]", *STRESS), "domain.h1.0: expected a finite number"),
    "nan in the friction": (tables("[friction]", "matrix = [nan, 1, 1]"), "matrix.0: expected a finite number"),
    "infinite parameter": (tables("[parameters]", "a = '9**9**9'", *STRESS), r"a: .*found '9\*\*9\*\*9' = inf"),
    "infinite bound": (tables("[domain]", "h1 = [0, '9**9**9']", *STRESS), r"domain.h1.1: .*'9\*\*9\*\*9' = inf"),
    # size and depth
    "1 MB line": (moment("h1" + " " * 1_000_000), "expected at most 1 MB, found more"),
    "long line": (moment("+".join(["h1"] * 5000)), "line 4: expected lines of at most 12000 characters"),
    "5000 terms": (
        tables("[stress]", 'M = """', "+\n".join(["h1*Pi"] * 5000) + '"""'), "has 34998 characters, at most 10000"
    ),
    "3000 terms": (moment("+".join(["h1"] * 3000)), "more than 100 levels deep; group long sums with parentheses"),
    "brackets": (moment("(" * 3000 + "h1" + ")" * 3000), "nested more than 100 levels deep"),
    "open brackets": (moment("(" * 9000), "nested more than 100 levels deep"),
    "signs": (moment("-" * 5000 + "h1"), "nested more than 100 levels deep"),
    "tower of powers": (moment("**".join(["h1"] * 2000)), "nested more than 100 levels deep"),
    "tower of exponentials": (moment("exp(" * 1000 + "h1" + ")" * 1000), "nested more than 100 levels deep"),
    # bombs of TOML
    "dotted key": (tables("a." * 5900 + "a = 1"), "at most 8 levels of nesting, found more"),
    "dotted keys": ("\n".join(f"k{i}." + "a." * 5900 + "a = 1" for i in range(80)), "at most 8 levels of nesting"),
    "quoted dotted keys": ("\n".join(f"k{i}." + '"=".' * 2900 + "a = 1" for i in range(80)), "at most 8 levels"),
    "dotted keys after long strings": (
        "\n".join(f'k{i} = {{ a = """\n"""", ' + "b." * 5900 + "a = 1 }" for i in range(80)), "at most 8 levels"
    ),
    "dotted headers": ("\n".join(f"[k{i}." + "a." * 5900 + "a]" for i in range(80)), "at most 8 levels of nesting"),
    "nested lists": (tables("reference = " + "[" * 5000 + "]" * 5000), "at most 8 levels of nesting"),
    "nested tables": (tables("a = " + "{a=" * 3900 + "1"), "at most 8 levels of nesting|valid TOML"),
    "20000 tables": (tables(*["[[stress]]"] * 20_000), "stress: expected a table, found a list of 20000"),
    "20000 keys": (tables("[stress]", *(f"F{i} = 1" for i in range(20_000))), "stress.F0: expected one of F1, F2, M"),
    "long key": (tables("[stress]", "M" * 11_000 + " = 1"), r"stress\.'M{57}\.\.\.': expected one of F1, F2, M"),
    "unclosed": (tables("[stress]", 'M = "' + '\\"' * 5000), "valid TOML"),
    "a date": (tables("[stress]", "M = 1979-05-27"), "M: expected a number or an expression, found a date"),
}  # fmt: skip


@contextmanager
def little_memory() -> Iterator[None]:
    """At most 50 MB at any time inside, beyond what there was."""
    tracemalloc.start()
    try:
        yield
        assert tracemalloc.get_traced_memory()[1] < MOST_MEMORY
    finally:
        tracemalloc.stop()


@pytest.mark.parametrize("name", FILES)
def test_a_hostile_file_is_refused_at_once(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """By the command: code 2, one short line that names the place, little memory; nothing in it has run."""
    content, wording = FILES[name]
    monkeypatch.chdir(tmp_path)
    Path("law.toml").write_bytes(content if isinstance(content, bytes) else content.encode())
    with little_memory():
        result = CliRunner().invoke(main, ["check", "law.toml"])
    assert result.exit_code == 2
    assert isinstance(result.exception, SystemExit)
    assert result.output.startswith("geocosserat: law.toml: ")
    assert result.output.count("\n") == 1
    assert result.output[:-1].isprintable()
    assert len(result.output) < 1000
    with pytest.raises(InputError, match=wording):
        load_law("law.toml")
    assert [path.name for path in tmp_path.iterdir()] == ["law.toml"]


def test_a_refusal_takes_no_address_space() -> None:
    """What tracemalloc does not see, the system does: all files together raise the largest size by less than 50 MB."""
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    for content, _ in FILES.values():
        if isinstance(content, str):
            with pytest.raises(InputError):
                load_law(content)
    kilobytes = 1 if "linux" in sys.platform else 1024
    assert (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) / kilobytes < MOST_MEMORY / 1024


def test_the_name_of_a_file_is_printed_on_one_line(tmp_path: Path) -> None:
    """Whatever it is."""
    path = tmp_path / "a\nb\x1b[31m.toml"
    for content in (b"motion = 3", b"motion = ", b"\xff", b"x" * 1_000_001):
        path.write_bytes(content)
        with pytest.raises(InputError, match=r"a\\nb\\x1b\[31m\.toml': ") as caught:
            load_law(path)
        assert str(caught.value).isprintable()


TERMS = "+".join(f"h1**{i}*Pi**{i}" for i in range(1, 90))
PRODUCT = "*".join(f"(h1 + {i}*h2 + Pi)" for i in range(90))
EXPENSIVE: dict[str, dict[str, Any]] = {
    "power of a power": {"stress": {"M": "9**9**9"}},
    "power of a number": {"stress": {"M": "(3/7)**2000*h1"}},
    "large power": {"stress": {"M": "(1 + h1)**1000000"}},
    "largest power": {"stress": {"M": "h1**1e308"}},
    "least power": {"stress": {"M": "h1**(1/3)*Pi**1e-300"}},
    "power of a multiple": {"stress": {"M": "(2*h1)**1000000"}},
    "exponent with a large factor": {"stress": {"M": "2**(1e6*h1)"}},
    "exponential with a large factor": {"stress": {"M": "exp((1e6 + h1)*log(2))"}},
    "large power of a root": {"stress": {"M": "sqrt(2)**(1e6*h1)"}},
    "tower": {"stress": {"M": "h1**h1**h1**h1**h1*Pi"}},
    "power of a sum": {"stress": {"M": "(h1 + h2 + Pi)**200"}},
    "energy of a power": {"energy": {"density": "(h1 + h2 + Pi)**1000"}},
    "powers of powers": {"energy": {"density": "(((h1 + Pi)**50)**50)**50"}},
    "three exponentials": {"stress": {"M": "exp(exp(exp(h1**50)))"}},
    "ninety exponentials": {"energy": {"density": "exp(" * 90 + "h1*Pi" + ")" * 90}},
    "ninety steps inside each other": {"stress": {"M": "heaviside(" * 90 + "h1*Pi" + ")" * 90}},
    "ninety steps": {"stress": {"M": "+".join(f"heaviside(Pi - {i}/90)*h1" for i in range(90))}},
    "forty moduli": {"stress": {"M": "*".join(f"abs(Pi - {i}/90)" for i in range(40))}},
    "product of sums": {"stress": {"F1": PRODUCT, "M": PRODUCT}},
    "energy of a product": {"energy": {"density": PRODUCT}},
    "square of a sum": {"energy": {"density": f"({TERMS})**2"}},
    "power of a large number": {"stress": {"M": "(1e300 + 7)**(1/997)*h1"}},
    "exponential of a large number": {"stress": {"M": "exp(1000000)*h1"}},
    "exponential of a logarithm": {"stress": {"M": "exp(1e9*log(h1))*Pi"}},
    "large argument": {"stress": {"M": "sin(1e300)*h1 + cosh(1e300*h1)*Pi"}},
    "infinite": {"stress": {"M": "log(0)*h1"}},
    "undefined": {"stress": {"M": "0/0*h1"}},
    "divided by nothing": {"stress": {"M": "h1/(h2 - h2)"}},
    "tangent at its pole": {"stress": {"M": "tan(pi/2)*h1"}},
    "not real": {"stress": {"M": "log(-1 - h1**2)"}},
    "widest domain": {"stress": {"M": "Pi*h1**0.37"}, "domain": {"h1": [-1e308, 1e308]}},
    "narrowest domain": {"stress": {"M": "Pi/h1"}, "domain": {"h1": [1, 1.0000000000000002]}},
    "friction": {"friction": {"matrix": ["exp(exp(exp(u**50)))", "(1 + u)**200", "9**9**9"]}},
    "viscous": {"stress": {"M": "Pi_dot**201 + exp(exp(Pi_dot))"}},
    "wrench": {"wrench": {"f1": "(x + y + theta)**100", "m": "theta**theta"}},
    "chain of parameters": {
        "parameters": {f"k{i}": f"k{i + 1} + k{i + 1}" for i in range(900)} | {"k900": 1}, "stress": {"M": "k0*Pi"},
    },
    "open friction": {
        "motion": "spatial", "parameters": {f"a{i}": {"symbol": True} for i in range(6)},
        "friction": {"matrix": [[f"sin({i}*u + {j})**5 + a{i}" for i in range(6)] for j in range(6)]},
    },
    "open parameters": {
        "motion": "spatial", "parameters": {f"a{i}{j}": {"symbol": True} for i in range(6) for j in range(6)},
        "stress": {
            c: " + ".join(f"a{i}{j}*{n}*{n}" for j, n in enumerate(("h1", "h2", "h3", "Pi1", "Pi2", "Pi3")))
            for i, c in enumerate(("F1", "F2", "F3", "M1", "M2", "M3"))
        },
    },
    "spatial wrench": {
        "motion": "spatial",
        "wrench": {"f1": "exp(exp(x*e1x))**50", "m1": "(x + y + z + e1x)**60", "f2": "sqrt(x*x + y*y)/(x*x + z*z)**7"},
    },
}  # fmt: skip
NOT_PASSIVE = {
    "tower", "power of a sum", "three exponentials", "product of sums", "infinite", "undefined", "divided by nothing",
    "ninety steps", "wrench", "spatial wrench", "power of a large number", "open parameters", "not real",
}  # fmt: skip


@pytest.mark.parametrize("name", EXPENSIVE)
def test_what_is_costly_to_decide_ends_in_time(name: str) -> None:
    """With an answer, or undecided, in the time that is given and a little."""
    start = time.monotonic()
    with little_memory():
        law = load_law({"motion": "planar", **EXPENSIVE[name]})
    found = check(law, seconds=1)
    assert time.monotonic() - start < 20
    assert found.verdict in VERDICTS
    assert (found.grade is None) == (found.verdict == "undecided")
    assert not (name in NOT_PASSIVE and found.verdict == "passive")


def test_the_command_says_that_it_is_undecided_and_why(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """One line, or one JSON object, and code 3; the folder for the results is not left behind."""
    path = tmp_path / "law.toml"
    path.write_text(moment(PRODUCT), encoding="utf-8")
    monkeypatch.setattr("geocosserat.cli.check_law", partial(check, seconds=0.5))
    result = CliRunner().invoke(main, ["check", str(path), "--out", str(tmp_path / "out")])
    assert result.exit_code == 3
    assert result.output == "hostile: undecided; not checked: all: it took more than 0.5 seconds\n"
    assert not (tmp_path / "out").exists()


words = st.text(st.characters(codec="utf-8"), max_size=6)
PARTS = (*LAW_KEYS, "F1", "F2", "F3", "M", "M1", "f1", "m", "h1", "Pi", "density", "matrix", "symbol", "positive", "a")
keys = st.sampled_from(PARTS) | words
scalars = st.one_of(
    texts, words, st.booleans(), st.integers(), st.floats(), st.sampled_from(["planar", "spatial", "a*Pi", "k"])
)
anything = st.recursive(
    scalars, lambda inner: st.lists(inner, max_size=6) | st.dictionaries(keys, inner, max_size=4), max_leaves=12
)


@given(st.dictionaries(keys, anything, max_size=6), st.sampled_from([{}, {"motion": "planar"}, {"motion": "spatial"}]))
@settings(max_examples=150)
def test_any_tables_are_a_law_or_refused(given_tables: dict[str, Any], more: dict[str, Any]) -> None:
    """Nothing but InputError is raised, with a message on one line; what is read prints itself."""
    try:
        law = load_law({**given_tables, **more})
        said = str(law).replace("\n", " ")
    except InputError as error:
        said = str(error)
    assert said.isprintable()


@given(st.binary(max_size=200) | st.text("[]{}=.,'\"\\#\n abM01*(Pih", max_size=200).map(str.encode))
@settings(max_examples=150)
def test_any_bytes_are_a_law_or_refused(tmp_path_factory: pytest.TempPathFactory, content: bytes) -> None:
    """As the content of a file, by itself and after a valid beginning."""
    file = tmp_path_factory.getbasetemp() / "law.toml"
    for beginning in (b"", (HEAD + "[stress]\n").encode()):
        file.write_bytes(beginning + content)
        said = ""
        try:
            load_law(file)
        except InputError as error:
            said = str(error)
        assert said.isprintable()


def sums(names: tuple[str, ...]) -> st.SearchStrategy[str]:
    """Small expressions of some names, as one would write them."""
    leaves = st.sampled_from(names) | st.sampled_from(["1", "2", "0.5", "3e-3", "pi", "k", "a"])

    def grown(inner: st.SearchStrategy[str]) -> st.SearchStrategy[str]:
        return st.one_of(
            st.tuples(inner, st.sampled_from(["+", "-", "*", "/"]), inner).map(lambda p: f"({''.join(p)})"),
            st.tuples(st.sampled_from(["sin", "exp", "sqrt", "abs", "heaviside", "tanh", "log"]), inner).map(
                lambda p: f"{p[0]}({p[1]})"
            ),
            st.tuples(inner, st.sampled_from(["2", "3", "(-1)", "0.5"])).map(lambda p: f"({p[0]})**{p[1]}"),
        )

    return st.recursive(leaves, grown, max_leaves=4)


@st.composite
def laws(draw: st.DrawFn) -> Law:
    """Planar laws of small size, each part there or not."""
    turn = ("h1", "h2", "Pi")
    a = draw(st.sampled_from([0.3, {"symbol": True}]))
    found: dict[str, Any] = {"motion": "planar", "parameters": {"k": 2.0, "a": a}}
    part = draw(st.sampled_from(["stress", "energy", "wrench", "friction"]))
    if part == "stress":
        names = (*turn, "Pi_dot", "u", "t")
        found["stress"] = {c: draw(sums(names)) for c in draw(st.permutations(["F1", "F2", "M"]))[:2]}
    elif part == "energy":
        found["energy"] = {"density": draw(sums(turn))}
    elif part == "wrench":
        found["wrench"] = {c: draw(sums(("x", "y", "theta", "u"))) for c in ("f1", "m")}
    else:
        found["friction"] = {"matrix": draw(st.lists(sums(("u",)), min_size=3, max_size=3))}
    return load_law(found)


@given(laws())
@settings(max_examples=20, derandomize=True)
def test_a_small_law_gets_a_verdict(law: Law) -> None:
    """Whatever its expressions are; in a few seconds, or else it is undecided."""
    try:
        found = bounded(partial(check_law, law), 4)
    except OutOfBounds:
        return
    assert found.verdict in VERDICTS
    json.dumps(found.fields, allow_nan=False)
