"""Printed code computes what was meant: symbolic tapes and the user's expressions, in C and in numpy."""

from __future__ import annotations

import subprocess
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from types import ModuleType
from typing import Any

import cffi
import numpy as np
import pytest
import sympy as sp

from geocosserat.codegen.printing import print_expression, print_tape
from geocosserat.codegen.tape import Tape, jacobian, record
from geocosserat.kernel.compile import FLAGS
from geocosserat.model.expressions import Binary, Call, Expression, Negate, Number, Symbol, evaluate, parse
from tests.codegen import symbolic

HEAVISIDE = "static double heaviside(double x) { return x > 0.0 ? 1.0 : x < 0.0 ? 0.0 : 0.5; }\n"
PLACES = ((0.3, -1.2), (-0.7, 0.5), (1.4, 0.9), (0.0, -0.4))
"""Values of (u, t)."""


def compiled(folder: Path, tool: str, bodies: Sequence[str], arguments: str) -> list[Callable[..., float]]:
    """C functions f0, f1, ... with these bodies, all double."""
    source = "#include <math.h>\n" + HEAVISIDE
    signature = ", ".join(f"double {name}" for name in arguments)
    source += "".join(f"double f{i}({signature}) {{ {body} }}\n" for i, body in enumerate(bodies))
    (folder / "f.c").write_text(source)
    flags = [flag for flag in FLAGS if flag != "-O3"]
    done = subprocess.run([tool, *flags, "f.c", "-o", "f.so", "-lm"], cwd=folder, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    ffi = cffi.FFI()
    ffi.cdef("".join(f"double f{i}({signature});\n" for i in range(len(bodies))))
    lib: Any = ffi.dlopen(str(folder / "f.so"))
    _open.append(lib)
    return [getattr(lib, f"f{i}") for i in range(len(bodies))]


_open: list[Any] = []
"""Libraries stay open: their functions do not keep them so."""


def module(folder: Path, bodies: Sequence[str], arguments: str) -> list[Callable[..., Any]]:
    """Python functions f0, f1, ... with these bodies, loaded from a file."""
    text = "import numpy as np\n"
    for i, body in enumerate(bodies):
        text += f"def f{i}({', '.join(arguments)}):\n" + "".join(f"    {line}\n" for line in body.split("\n"))
    found = ModuleType("printed")
    exec(compile(text, str(folder / "printed.py"), "exec"), found.__dict__)  # a test's own text
    return [getattr(found, f"f{i}") for i in range(len(bodies))]


# the user's expressions

EDGE_CASES = [
    "u - -t", "-u**2", "(-u)**2", "-(-u)", "-(-(-u))", "--u", "u--t", "2**-1", "2**-u", "(u**2 + 1)**-1.5", "u**3",
    "(u - 3)**-3 + 1", "2**3**2", "(2**3)**2", "-2**2", "1 - 2 - 3", "1 - (2 - 3)", "8/4/2", "8/(4/2)", "8*4/2*3",
    "heaviside(u)", "heaviside(heaviside(u) - 0.5)", "heaviside(t - heaviside(u)*0.9)", "heaviside(0)", "heaviside(-0)",
    "heaviside(-u)*heaviside(u - 1)", "abs(-u)", "abs(abs(t) - 1)", "sqrt(abs(u))", "exp(-u**2)", "log(1 + u**2)",
    "tan(t)", "tanh(3*u)", "sinh(t)", "cosh(t)", "1e-300*1e300", "1e22", "123456789012345678", "0.1 + 0.2", "-0",
    "-0.0", "-(-0)", "-(-0.0)", "1 - -0", "2*-0", "pi", "-pi*u", "u*-t", "u/-2", "3", "-3", "sin(cos(sin(u)))",
]  # fmt: skip


def random_expression(rng: np.random.Generator, depth: int) -> Expression:
    """Finite wherever u and t are: what could leave a function's domain is kept inside it."""
    if depth == 0:
        kind = rng.integers(4)
        number = Number(float(rng.choice([0.0, -0.0, 1.0, -2.0, 0.1, -1.5, 3.0, rng.normal()])))
        return number if kind < 2 else Symbol("u" if kind == 2 else "t")

    def inner() -> Expression:
        return random_expression(rng, depth - 1)

    def positive() -> Expression:
        return Binary("+", Call("abs", inner()), Number(0.5))

    match rng.integers(10):
        case 0 | 1 | 2 | 3:
            return Binary(str(rng.choice(["+", "-", "*"])), inner(), inner())
        case 4:
            return Binary("/", inner(), positive() if rng.integers(2) else Negate(positive()))
        case 5:
            return Negate(inner())
        case 6:
            return Binary("**", positive(), Number(float(rng.choice([-3, -2, -1, -0.5, 0.0, 0.5, 2, 3]))))
        case 7:
            return Binary("**", Call("sin", inner()), Number(float(rng.integers(0, 4))))
        case 8:
            return Call(str(rng.choice(["sqrt", "log"])), positive())
    function = str(rng.choice(["sin", "cos", "tanh", "abs", "heaviside"]))
    return Call(function, inner())


def scale(e: Expression, values: Mapping[str, float]) -> float:
    """The largest number met on the way to the value of e."""
    own = abs(float(evaluate(e, values)))
    parts: list[Expression] = []
    match e:
        case Call(_, argument):
            parts = [argument]
        case Binary(_, left, right):
            parts = [left, right]
        case Negate(operand):
            parts = [operand]
    return max([own, *(scale(part, values) for part in parts)])


@pytest.fixture(scope="module")
def expressions() -> list[Expression]:
    """The edge cases, and 400 random trees without jumps that round-off could decide."""
    rng = np.random.default_rng(11)
    known = frozenset({"u", "t"})
    drawn = (random_expression(rng, int(rng.integers(1, 6))) for _ in range(1000))
    random = [e for e in drawn if all(settled(e, {"u": u, "t": t}) for u, t in PLACES)]
    return [*(parse(text, known) for text in EDGE_CASES), *random[:400]]


def settled(e: Expression, values: Mapping[str, float]) -> bool:
    """Whether every value on the way is moderate and no jump's argument is near zero without being zero."""
    parts: list[Expression] = []
    match e:
        case Call(function, argument):
            if function == "heaviside" and 0 < abs(float(evaluate(argument, values))) < 1e-3:
                return False
            parts = [argument]
        case Binary(_, left, right):
            parts = [left, right]
        case Negate(operand):
            parts = [operand]
    return abs(float(evaluate(e, values))) < 100 and all(settled(part, values) for part in parts)


def test_the_random_expressions_are_many_and_varied(expressions: list[Expression]) -> None:
    """The laws below are about something."""
    assert len(expressions) > 400
    values = [float(evaluate(e, {"u": 0.3, "t": -1.2})) for e in expressions]
    assert np.all(np.isfinite(values))
    assert len(set(values)) > 250


def test_expressions_in_c_have_the_values_they_are_written_to_have(
    expressions: list[Expression], tmp_path: Path, c_compiler: str
) -> None:
    """To 1e-14 of the largest number on the way, under the flags of the kernels."""
    bodies = [f"(void)u; (void)t; return {print_expression(e, 'c', str)};" for e in expressions]
    functions = compiled(tmp_path, c_compiler, bodies, "ut")
    for e, function in zip(expressions, functions, strict=True):
        for u, t in PLACES:
            wanted = float(evaluate(e, {"u": u, "t": t}))
            assert abs(function(u, t) - wanted) <= 1e-14 * max(1.0, scale(e, {"u": u, "t": t})), e


def test_expressions_in_numpy_have_the_values_they_are_written_to_have(
    expressions: list[Expression], tmp_path: Path
) -> None:
    """Also for arrays of u, entry by entry."""
    bodies = [f"return {print_expression(e, 'numpy', str)}" for e in expressions]
    us, ts = np.array([u for u, _ in PLACES]), np.array([t for _, t in PLACES])
    for e, function in zip(expressions, module(tmp_path, bodies, "ut"), strict=True):
        together = np.broadcast_to(function(us, ts), us.shape)
        for i, (u, t) in enumerate(PLACES):
            wanted, size = float(evaluate(e, {"u": u, "t": t})), max(1.0, scale(e, {"u": u, "t": t}))
            assert abs(float(function(u, t)) - wanted) <= 1e-14 * size, e
            assert abs(float(together[i]) - wanted) <= 1e-14 * size, e


@pytest.mark.parametrize("language", ["c", "numpy"])
def test_every_symbol_is_written_as_it_is_asked_for(language: str) -> None:
    """The coordinate and parameters are named by whoever prints."""
    e = parse("u*sin(half + u)", frozenset({"u", "half"}))
    printed = print_expression(e, language, lambda name: {"u": "r->u[n]", "half": "p_half"}[name])
    assert printed.replace("np.", "") == "(r->u[n] * sin((p_half + r->u[n])))"


def test_only_expressions_are_printed() -> None:
    """Text never passes through."""
    with pytest.raises(TypeError, match="expected an expression, found str"):
        print_expression("system(0)", "c", str)  # type: ignore[arg-type]


# symbolic tapes

x, y, z = sp.symbols(symbolic.NAMES)
R = sp.Rational
SYMBOLIC = [
    x**-1, x**-2, x**-3, x**-5, 1 / (x * y), (x + y) ** -2, -(x**2), (-x) ** 3, x**2 * y**3 / z**4, -x / 3,
    R(2, 3) * x, x / R(2, 3), sp.sqrt(1 + x**2), 1 / sp.sqrt(1 + x**2), (1 + x**2) ** R(3, 2), R(1, 3) ** x,
    (1 + x**2) ** y, -x - y, x - (y - z), x / (y / (2 + z**2)), (x * y) ** 2, (x + y) ** 4, (x + y) ** 5,
    -(x + 1) * -(y - 1), sp.sin(x) ** 2, sp.cos(x) ** -2, sp.Integer(2), sp.Integer(-3), R(-5, 7), sp.pi * x,
    sp.E * x, sp.sqrt(2) * x, 2 * x / sp.sqrt(sp.pi), sp.exp(-x), sp.log(2 + x), 2 * (x + y) / 3, (x / 3) ** 2,
    (-x / 2) ** 3, (R(2, 3) + x) ** 2, 1 / (1 / x + 1 / y), 1 / (x - y),
]  # fmt: skip


def body(tape: Tape, language: str) -> str:
    steps, ((_, code),) = print_tape(tape, language)
    declare, end = ("const double ", "; ") if language == "c" else ("", "\n")
    return "".join(f"{declare}{name} = {e}{end}" for name, e in steps) + f"return {code}{end.strip()}"


@pytest.fixture(scope="module")
def tapes() -> list[tuple[sp.Expr, Tape]]:
    """Hand-picked forms, their derivatives, and what mixing them makes."""
    rng = np.random.default_rng(3)
    forms = list(SYMBOLIC)
    for _ in range(60):
        a, b, c = (SYMBOLIC[i] for i in rng.integers(len(SYMBOLIC), size=3))
        forms.append(a * sp.sin(b) - (b + c) ** 2 / (1 + c**2) + (a + 2 * b) * c)
    found = [(e, record({"out": e})) for e in forms]
    for e in forms:
        slope = jacobian(record({"out": e}), (x,), "J")
        if slope.outputs:
            found.append((e.diff(x), slope))
    return found


@pytest.mark.parametrize("language", ["c", "numpy"])
def test_tapes_have_the_values_of_their_trees(
    tapes: list[tuple[sp.Expr, Tape]], language: str, tmp_path: Path, request: pytest.FixtureRequest
) -> None:
    """Powers of either sign, fractions, roots and signs: to 1e-13 of the value where it is well conditioned."""
    bodies = [body(tape, language) for _, tape in tapes]
    if language == "c":
        tool = request.getfixturevalue("c_compiler")
        functions = compiled(tmp_path, tool, [f"(void)x; (void)y; (void)z; {b}" for b in bodies], "xyz")
    else:
        functions = module(tmp_path, bodies, "xyz")
    for values in ((0.7, 1.3, -0.4), (1.9, -0.6, 0.8)):
        at = {s: symbolic.MP.mpf(v) for s, v in zip((x, y, z), values, strict=True)}
        for (e, _), function in zip(tapes, functions, strict=True):
            wanted = symbolic.evaluate(e.doit(), at)
            nudged = symbolic.evaluate(e.doit(), {s: v * (1 + symbolic.MP.mpf("1e-15")) for s, v in at.items()})
            assert abs(function(*values) - wanted) <= 1e-14 * (1 + abs(wanted)) + 30 * abs(nudged - wanted), e
