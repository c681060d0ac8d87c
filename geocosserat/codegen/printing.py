"""Tapes and the user's expressions as lines of C or numpy."""

from collections.abc import Callable
from math import copysign

import sympy as sp
from sympy.printing.c import C99CodePrinter
from sympy.printing.numpy import NumPyPrinter

from geocosserat.codegen.tape import Tape
from geocosserat.model.expressions import Binary, Call, Expression, Negate, Number, Symbol


class _C(C99CodePrinter):  # type: ignore[misc]
    """C99 with small whole powers written as products, and constants as numbers: strict C99 has no M_PI."""

    def __init__(self) -> None:
        super().__init__({"math_macros": {}})

    def _print_NumberSymbol(self, expr: sp.NumberSymbol) -> str:
        return repr(float(expr))

    _print_Pi = _print_Exp1 = _print_NumberSymbol

    def _print_Pow(self, expr: sp.Pow) -> str:
        base, power = expr.as_base_exp()
        if power.is_Integer and 2 <= power <= 4:
            return "(" + "*".join([self.parenthesize(base, 50)] * int(power)) + ")"
        if power.is_Integer and power < 0:
            return f"(1.0/({self._print(sp.Pow(base, -power))}))"
        return str(super()._print_Pow(expr))

    def _print_step(self, expr: sp.Function) -> str:
        return f"heaviside({self._print(expr.args[0])})"

    def _print_size(self, expr: sp.Function) -> str:
        return f"fabs({self._print(expr.args[0])})"

    def _print_Rational(self, expr: sp.Rational) -> str:
        return f"{int(expr.p)}.0/{int(expr.q)}.0"

    def _print_Integer(self, expr: sp.Integer) -> str:
        return f"{int(expr)}.0"


class _NumPy(NumPyPrinter):  # type: ignore[misc]
    """numpy under its usual short name."""

    _module = "np"

    def __init__(self) -> None:
        super().__init__({"fully_qualified_modules": True})

    def _print_step(self, expr: sp.Function) -> str:
        return f"np.heaviside({self._print(expr.args[0])}, 0.5)"

    def _print_size(self, expr: sp.Function) -> str:
        return f"np.abs({self._print(expr.args[0])})"

    def _module_format(self, fqn: str, register: bool = True) -> str:
        return str(super()._module_format(fqn, register)).replace("numpy.", "np.", 1)


Printed = tuple[list[tuple[str, str]], list[tuple[str, str]]]


def print_tape(tape: Tape, language: str) -> Printed:
    """(steps, outputs) of a tape as (name, code) pairs; `language` is "c" or "numpy"."""
    printer = _C() if language == "c" else _NumPy()
    steps = [(str(name), str(printer.doprint(e))) for name, e in tape.steps]
    return steps, [(name, str(printer.doprint(e))) for name, e in tape.outputs]


_C_NAMES = {"abs": "fabs"}
_NUMPY_NAMES = {"abs": "np.abs"}


def print_expression(e: Expression, language: str, name: Callable[[str], str]) -> str:
    """A user's expression as fully parenthesised code; `name` says how each symbol is written."""

    def go(node: Expression) -> str:
        match node:
            case Number(value):
                # a sign gets parentheses, that of -0.0 too: in C "--" would count down
                return f"({value!r})" if copysign(1.0, value) < 0 else repr(float(value))
            case Symbol(symbol):
                return name(symbol)
            case Negate(operand):
                return f"(-{go(operand)})"
            case Call("heaviside", argument) if language == "numpy":
                return f"np.heaviside({go(argument)}, 0.5)"
            case Call(function, argument):
                names = _C_NAMES if language == "c" else _NUMPY_NAMES
                written = names.get(function, function if language == "c" else f"np.{function}")
                return f"{written}({go(argument)})"
            case Binary("**", left, right):
                return f"pow({go(left)}, {go(right)})" if language == "c" else f"({go(left)} ** {go(right)})"
            case Binary(operator, left, right):
                return f"({go(left)} {operator} {go(right)})"
        raise TypeError(f"expected an expression, found {type(node).__name__}")

    return go(e)
