"""How one expression is written: dots and primes, short products, decimals; as text and as LaTeX."""

from __future__ import annotations

import re
import unicodedata
from abc import ABC, abstractmethod
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, Final

import sympy as sp
from sympy.core.function import AppliedUndef
from sympy.printing.latex import tex_greek_dictionary
from sympy.printing.pretty.pretty_symbology import greek_unicode

from geocosserat.derivation.notation import T, U, has_fields, is_field

SUM, PRODUCT, POWER, ATOM = 1, 2, 3, 4
"""How strongly the outermost part of a written expression binds."""

Written = tuple[str, int]

MINUS, PRIME = "\N{MINUS SIGN}", "\N{PRIME}"
_DOTS = {0: "", 1: "\N{COMBINING DOT ABOVE}", 2: "\N{COMBINING DIAERESIS}"}
_LOW, _HIGH = (str.maketrans("0123456789", digits) for digits in ("₀₁₂₃₄₅₆₇₈₉", "⁰¹²³⁴⁵⁶⁷⁸⁹"))
_PARTS = re.compile(r"([A-Za-z]+?)_?([0-9]*)([xyz]?)")
_LIKE_A_RATE = re.compile(r"_[tu]+$")
# products read like cross products, what turns first; single fields in the order of the group
_IN_PRODUCTS = ("Pi", "Omega", "h", "v", "F", "M", "f", "m", "e", "theta")
_ALONE = ("h", "v", "Pi", "Omega", "F", "M", "f", "m", "e", "theta")


class Script(ABC):
    """Writes expressions; ``taken``: names that parameters must be told apart from."""

    minus = "-"
    space = " "

    def __init__(self, taken: Iterable[str] = ()) -> None:
        self.taken = frozenset(taken)
        self._written: dict[sp.Expr, Written] = {}

    def write(self, e: sp.Expr) -> str:
        """One expression."""
        return self._write(e)[0]

    def terms(self, e: sp.Expr) -> list[str]:
        """The terms of a sum, each with its sign but a leading plus, to be joined by spaces."""
        parts = _ordered_terms(e) if e.is_Add else [e]
        signed = [(_negative(x), -x if _negative(x) else x) for x in parts]
        positive = next((k for k, (negative, _) in enumerate(signed) if not negative), 0)
        signed.insert(0, signed.pop(positive))
        out = []
        for k, (negative, x) in enumerate(signed):
            text, strength = self._write(x)
            sign = self.minus + (" " if k else "") if negative else "+ " if k else ""
            out.append(sign + (self.bracket(text) if strength == SUM and negative else text))
        return out

    def _write(self, e: sp.Expr) -> Written:
        if e not in self._written:
            self._written[e] = self._newly(e)
        return self._written[e]

    def _newly(self, e: sp.Expr) -> Written:
        if e.is_Add:
            return " ".join(self.terms(e)), SUM
        if _negative(e):
            return self.terms(e)[0], SUM
        if e.is_Rational:
            return self._rational(e)
        if isinstance(e, sp.Symbol):
            # F_1 and F1 look alike, and x_t is the rate of x
            name = f"{e.name}_par" if _LIKE_A_RATE.sub("", e.name).replace("_", "") in self.taken else e.name
            return self.name(name), ATOM
        if is_field(e):
            orders = {U: 0, T: 0, **dict(e.variable_count)} if isinstance(e, sp.Derivative) else {U: 0, T: 0}
            base = e.expr if isinstance(e, sp.Derivative) else e
            written = self.field(base.func.__name__, int(orders[U]), int(orders[T]))
            # a field at one place, as joined ends have it
            return written + ("" if base.args[0] == U else f"({self.write(base.args[0])})"), ATOM
        if e.is_Mul or (e.is_Pow and _inverse(e)):
            return self._product(e)
        if e.is_Pow and e.exp == sp.Rational(1, 2):
            return self.call("sqrt", self.write(e.base)), ATOM
        if e.is_Pow:
            return self.power(self._at_least(e.base, ATOM), e.exp), POWER
        if e in (sp.pi, sp.E):
            return self.name("pi" if e is sp.pi else "e"), ATOM
        if isinstance(e, sp.Function) and (len(e.args) == 1 or isinstance(e, sp.Heaviside)):
            # the value of a step at the step is fixed for all, see convert
            return self.call(type(e).__name__.lower(), self.write(e.args[0])), ATOM
        return self.other(e), SUM

    def _rational(self, e: sp.Rational) -> Written:
        written = decimal(e)
        return self.number(written) if written else self.quotient([(str(e.p), ATOM)], [(str(e.q), ATOM)])

    def _product(self, e: sp.Expr) -> Written:
        number, rest = e.as_coeff_Mul()
        above: list[Written] = []
        below: list[Written] = []
        if written := decimal(number):
            above += [self.number(written)] if number != 1 else []
        else:
            above += [(str(number.p), ATOM)] if number.p != 1 else []
            below += [(str(number.q), ATOM)]
        for factor in sorted(sp.Mul.make_args(rest), key=_rank):
            if _inverse(factor):
                below.append(self._write(1 / factor))
            elif factor != 1:
                above.append(self._write(factor))
        return self.quotient(above, below) if below else (self.juxtaposed(above), PRODUCT)

    def juxtaposed(self, factors: Sequence[Written]) -> str:
        """Factors side by side, sums in brackets."""
        if len(factors) == 1:
            return factors[0][0]
        return self.space.join(self.bracket(text) if strength == SUM else text for text, strength in factors)

    def _at_least(self, e: sp.Expr, needed: int) -> str:
        text, strength = self._write(e)
        return text if strength >= needed else self.bracket(text)

    @abstractmethod
    def name(self, name: str) -> str:
        """A symbol."""

    @abstractmethod
    def field(self, name: str, primes: int, dots: int) -> str:
        """A field, or its derivative of those orders along the rod and in time."""

    @abstractmethod
    def number(self, written: str) -> Written:
        """A decimal number."""

    @abstractmethod
    def bracket(self, inner: str) -> str:
        """Something in brackets."""

    @abstractmethod
    def call(self, function: str, argument: str) -> str:
        """A function of one argument."""

    @abstractmethod
    def power(self, base: str, exponent: sp.Expr) -> str:
        """A power of something already in brackets if need be."""

    @abstractmethod
    def quotient(self, above: Sequence[Written], below: Sequence[Written]) -> Written:
        """A fraction; nothing above means one."""

    @abstractmethod
    def other(self, e: sp.Expr) -> str:
        """Anything else, in sympy's own way."""


@dataclass(frozen=True)
class _Name:
    base: str
    index: str


def _parts(name: str) -> _Name | None:
    found = _PARTS.fullmatch(name)
    if not found or (found[3] and not found[2]):
        return None
    return _Name(found[1], found[2] + found[3])


def _changed(base: str) -> tuple[bool, str]:
    """Whether a letter stands for the small change of a field, dh of h, and of which."""
    return (True, base[1:]) if base[:1] == "d" and base[1:] in _ALONE else (False, base)


class Text(Script):
    """Plain text: with Greek letters, dots and primes, or ASCII (h1_t, v1_u)."""

    def __init__(self, taken: Iterable[str] = (), unicode: bool = True) -> None:
        super().__init__(taken)
        self.unicode = unicode
        self.minus = MINUS if unicode else "-"

    def name(self, name: str) -> str:
        parts = _parts(name)
        if not self.unicode or parts is None:
            return name
        return str(greek_unicode.get(parts.base, parts.base)) + parts.index.translate(_LOW)

    def field(self, name: str, primes: int, dots: int) -> str:
        if not self.unicode:
            return name + ("_" + "t" * dots + "u" * primes if primes or dots else "")
        parts = _parts(name) or _Name(name, "")
        before, base = _changed(parts.base)
        dotted = unicodedata.normalize("NFC", greek_unicode.get(base, base) + _DOTS[dots])
        return ("δ" if before else "") + dotted + parts.index.translate(_LOW) + PRIME * primes

    def number(self, written: str) -> Written:
        return written, ATOM

    def bracket(self, inner: str) -> str:
        return f"({inner})"

    def call(self, function: str, argument: str) -> str:
        return f"|{argument}|" if function == "abs" else f"{function}({argument})"

    def power(self, base: str, exponent: sp.Expr) -> str:
        if self.unicode and exponent.is_Integer and exponent > 0:
            return base + str(exponent).translate(_HIGH)
        return f"{base}^{self._at_least(exponent, ATOM)}"

    def quotient(self, above: Sequence[Written], below: Sequence[Written]) -> Written:
        over = self.juxtaposed(above) if above else "1"
        under = self.juxtaposed(below)
        over = self.bracket(over) if len(above) == 1 and above[0][1] == SUM else over
        under = under if len(below) == 1 and below[0][1] > PRODUCT else self.bracket(under)
        return f"{over}/{under}", PRODUCT

    def other(self, e: sp.Expr) -> str:
        return str(e)


class Latex(Script):
    """LaTeX for math mode."""

    space = r" \, "
    _NAMED: Final = frozenset({"sin", "cos", "tan", "exp", "log", "tanh", "sinh", "cosh"})

    def name(self, name: str) -> str:
        return self._lettered(_parts(name), name, 0, 0)

    def field(self, name: str, primes: int, dots: int) -> str:
        parts = _parts(name)
        if parts is not None:
            changed, base = _changed(parts.base)
            before = r"\delta " if changed else ""
            return before + self._lettered(_Name(base, parts.index), name, primes, dots)
        return self._lettered(parts, name, primes, dots)

    @staticmethod
    def _lettered(parts: _Name | None, name: str, primes: int, dots: int) -> str:
        if parts is None:
            return r"\mathrm{" + name.replace("_", r"\_") + "}"
        base = parts.base
        if base in greek_unicode:
            letter = tex_greek_dictionary.get(base, rf"\{base}")
        else:
            letter = base if len(base) == 1 else rf"\mathrm{{{base}}}"
        dotted = rf"\{'d' * dots}ot{{{letter}}}" if dots else letter
        return dotted + (f"_{{{parts.index}}}" if parts.index else "") + "'" * primes

    def number(self, written: str) -> Written:
        mantissa, _, exponent = written.partition("e")
        if not exponent:
            return written, ATOM
        power = f"10^{{{int(exponent)}}}"
        return (power, POWER) if mantissa == "1" else (rf"{mantissa} \cdot {power}", PRODUCT)

    def bracket(self, inner: str) -> str:
        return rf"\left({inner}\right)"

    def call(self, function: str, argument: str) -> str:
        match function:
            case "abs":
                return rf"\left|{argument}\right|"
            case "sqrt":
                return rf"\sqrt{{{argument}}}"
            case "heaviside":
                return "H" + self.bracket(argument)
        name = rf"\{function}" if function in self._NAMED else rf"\operatorname{{{function}}}"
        return name + self.bracket(argument)

    def power(self, base: str, exponent: sp.Expr) -> str:
        return f"{base}^{{{self.write(exponent)}}}"

    def quotient(self, above: Sequence[Written], below: Sequence[Written]) -> Written:
        return rf"\frac{{{self.juxtaposed(above) if above else '1'}}}{{{self.juxtaposed(below)}}}", PRODUCT

    def other(self, e: sp.Expr) -> str:
        return str(sp.latex(e))


def decimal(number: sp.Rational) -> str | None:
    """The short decimal that is exactly this number >= 0, or None where a fraction reads better."""
    if number.q == 1 and (number.p < 10**6 or number.p % 10**4):
        return str(number.p)
    if 1 < number.q < 10:
        return None
    text = f"{float(number):.12g}".replace("e+0", "e").replace("e+", "e").replace("e-0", "e-")
    return text if Fraction(text) == Fraction(int(number.p), int(number.q)) else None


def _negative(e: sp.Expr) -> bool:
    return not e.is_Add and bool(e.as_coeff_Mul()[0] < 0)


def _inverse(e: sp.Expr) -> bool:
    return bool(e.is_Pow and e.exp.is_Rational and e.exp < 0)


def _ranks(e: sp.Expr, order: tuple[str, ...]) -> list[tuple[int, str, str]]:
    """Place in that order, letter and index of each field that occurs, the first to be read first."""
    parts = (_parts(f.func.__name__) for f in e.atoms(AppliedUndef))
    return sorted((order.index(p.base) if p.base in order else len(order), p.base, p.index) for p in parts if p)


def _term_rank(e: sp.Expr) -> tuple[int, list[tuple[int, str, str]]]:
    """Derivatives, products of fields, single fields, coordinates and parameters, numbers."""
    if derivatives := e.atoms(sp.Derivative):
        return 0, [rank for d in sorted(derivatives, key=str) for rank in _ranks(d, _ALONE)] + _ranks(e, _ALONE)
    names = _ranks(e, _IN_PRODUCTS)
    if len(names) > 1:
        return 1, names
    return (2 if names else 4 if e.is_number else 3), _ranks(e, _ALONE)


def _ordered_terms(e: sp.Expr) -> list[sp.Expr]:
    if has_fields(e):
        return sorted(e.args, key=lambda x: (_term_rank(x), x.sort_key()))
    return list(e.as_ordered_terms())


def _rank(e: sp.Expr) -> tuple[int, list[tuple[int, str, str]], Any]:
    """Coefficients before fields, derivatives last; fields in the order of the vector equations."""
    if not has_fields(e):
        return (-1 if e.is_number else 0 if e.is_Symbol else 1, [], e.sort_key())
    return (3 if e.has(sp.Derivative) else 2, _ranks(e, _IN_PRODUCTS), e.sort_key())
