"""Text to expression: a whitelist tokenizer and precedence climbing. Nothing is ever evaluated as Python.

The grammar is Python's for the same characters: ``**`` binds tightest and to the right, then the sign,
then ``* /``, then ``+ -``.
Length, depth and number of nodes are bounded, so that no text takes long or exhausts the stack.
"""

from __future__ import annotations

import difflib
import math
import re
import unicodedata
from collections.abc import Iterable
from dataclasses import dataclass
from typing import cast

from geocosserat.model.tree import (
    FUNCTIONS,
    MAX_CHARACTERS,
    MAX_DEPTH,
    MAX_NODES,
    Binary,
    Call,
    Expression,
    ExpressionError,
    Negate,
    Number,
    Operator,
    Symbol,
)

_TOKEN = re.compile(
    r"(?P<number>(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][+-]?[0-9]+)?)"
    r"|(?P<name>[A-Za-z_][A-Za-z0-9_]*)"
    r"|(?P<mark>\*\*|[-+*/()])"
)
_PRECEDENCE = {"+": 1, "-": 1, "*": 2, "/": 2, "**": 4}
_SIGN_PRECEDENCE = 3
_INSTEAD = {
    "^": "write ** for a power",
    ",": "a function takes one argument, and a decimal is written with a point",
    "[": "group with ( )",
    "{": "group with ( )",
    "%": "only + - * / ** are available",
    "=": "a step is written heaviside(u - 0.5)",
    "<": "a step is written heaviside(u - 0.5)",
    ">": "a step is written heaviside(u - 0.5)",
}
_ONLY = "only numbers, names, + - * / **, parentheses and the listed functions are available"


def parse(text: str | int | float, allowed: Iterable[str]) -> Expression:
    """Read one expression in which the names ``allowed``, ``pi`` and the functions may occur.

    A number is taken as it is. Raises ExpressionError with the position and what to do: for anything that is
    not numbers, ``+ - * / **``, parentheses, those names and functions; for booleans and numbers that are not
    finite; for more than 10 000 characters, 100 levels or 5 000 nodes.
    """
    if isinstance(text, bool):
        raise ExpressionError(f"expected a number or an expression, found the boolean {str(text).lower()}")
    if isinstance(text, int | float):
        return _number(text)
    if not isinstance(text, str):
        raise ExpressionError(f"expected a number or an expression, found {type(text).__name__}")
    return _Parser(_tokens(text), frozenset(allowed)).whole()


def nearest(name: str, known: Iterable[str]) -> str | None:
    """The known name most like this one, or None if none is like it."""
    if len(name) > 100:  # difflib takes quadratic time
        return None
    found = difflib.get_close_matches(name, sorted(known), n=1)
    if found:
        return found[0]
    folded = {other.lower(): other for other in known}
    return folded.get(name.lower())


def _number(value: int | float) -> Number:
    try:
        return Number(float(value))
    except OverflowError:
        raise ExpressionError("the number is too large: it must be below 1.8e308") from None


@dataclass(frozen=True, slots=True)
class _Token:
    kind: str  # number | name | mark | end
    text: str
    position: int


def _tokens(text: str) -> list[_Token]:
    if len(text) > MAX_CHARACTERS:
        raise ExpressionError(f"the expression has {len(text)} characters, at most {MAX_CHARACTERS} are read")
    tokens: list[_Token] = []
    position = 0
    while position < len(text):
        if text[position] in " \t\r\n":
            position += 1
            continue
        match = _TOKEN.match(text, position)
        if match is None:
            raise _unreadable(text[position], position)
        tokens.append(_Token(str(match.lastgroup), match.group(), position))
        position = match.end()
    tokens.append(_Token("end", "", len(text)))
    return tokens


def _unreadable(character: str, position: int) -> ExpressionError:
    if not character.isascii():
        name = unicodedata.name(character, "no name")
        return ExpressionError(
            f"the character U+{ord(character):04X} ({name}) is not ASCII; write plain letters and signs",
            position,
        )
    hint = _INSTEAD.get(character, _ONLY)
    return ExpressionError(f"the character {character!r} is not available; {hint}", position)


class _Parser:
    """Every method returns an expression and its height, so that long sums are bounded like deep brackets."""

    def __init__(self, tokens: list[_Token], allowed: frozenset[str]) -> None:
        self._tokens = tokens
        self._next = 0
        self._allowed = allowed
        self._nodes = 0

    def whole(self) -> Expression:
        if self._token.kind == "end":
            raise ExpressionError("the expression is empty; write a number", self._token.position)
        expression, _ = self._sum(1, 0)
        if self._token.kind != "end":
            raise self._unexpected_follower()
        return expression

    @property
    def _token(self) -> _Token:
        return self._tokens[self._next]

    def _take(self) -> _Token:
        token = self._token
        self._next += 1
        return token

    def _built(self, expression: Expression, height: int, position: int) -> tuple[Expression, int]:
        self._nodes += 1
        if height > MAX_DEPTH:
            raise ExpressionError(
                f"the expression is more than {MAX_DEPTH} levels deep; group long sums with parentheses",
                position,
            )
        if self._nodes > MAX_NODES:
            raise ExpressionError(f"the expression has more than {MAX_NODES} parts; shorten it", position)
        return expression, height

    def _sum(self, lowest: int, depth: int) -> tuple[Expression, int]:
        """Precedence climbing: everything that binds at least as tightly as ``lowest``."""
        if depth > MAX_DEPTH:
            raise ExpressionError(
                f"the expression is nested more than {MAX_DEPTH} levels deep; write it flatter",
                self._token.position,
            )
        left, height = self._signed(depth)
        while (precedence := _PRECEDENCE.get(self._token.text, 0)) >= lowest:
            mark = self._take()
            # ** is right-associative, and its exponent may carry a sign
            tighter = _SIGN_PRECEDENCE if mark.text == "**" else precedence + 1
            right, right_height = self._sum(tighter, depth + 1)
            joined = Binary(cast(Operator, mark.text), left, right)
            left, height = self._built(joined, 1 + max(height, right_height), mark.position)
        return left, height

    def _signed(self, depth: int) -> tuple[Expression, int]:
        if self._token.text not in ("+", "-"):
            return self._atom(depth)
        mark = self._take()
        literal = self._token.kind == "number"
        operand, height = self._sum(_PRECEDENCE["**"], depth + 1)
        if mark.text == "+":
            return operand, height
        if literal and isinstance(operand, Number):
            return Number(-operand.value), height
        return self._built(Negate(operand), height + 1, mark.position)

    def _atom(self, depth: int) -> tuple[Expression, int]:
        token = self._take()
        if token.kind == "number":
            value = float(token.text)
            if not math.isfinite(value):
                raise ExpressionError("the number is too large: it must be below 1.8e308", token.position)
            return self._built(Number(value), 1, token.position)
        if token.kind == "name":
            return self._named(token, depth)
        if token.text == "(":
            inside, height = self._sum(1, depth + 1)
            self._close(token)
            return inside, height
        found = "the end" if token.kind == "end" else repr(token.text)
        raise ExpressionError(f"expected a number, a name or '(', found {found}", token.position)

    def _named(self, token: _Token, depth: int) -> tuple[Expression, int]:
        called = self._token.text == "("
        if token.text in FUNCTIONS:
            if not called:
                raise ExpressionError(f"{token.text} is a function; write {token.text}(...)", token.position)
            opening = self._take()
            argument, height = self._sum(1, depth + 1)
            self._close(opening)
            return self._built(Call(token.text, argument), height + 1, token.position)
        if token.text == "pi" and not called:
            return self._built(Number(math.pi), 1, token.position)
        if called:
            raise self._not_a_function(token)
        if token.text not in self._allowed:
            raise self._unknown(token)
        return self._built(Symbol(token.text), 1, token.position)

    def _close(self, opening: _Token) -> None:
        if self._token.text != ")":
            if self._token.kind == "end":
                raise ExpressionError("this parenthesis is never closed; add ')'", opening.position)
            raise self._unexpected_follower()
        self._take()

    def _not_a_function(self, token: _Token) -> ExpressionError:
        if token.text in self._allowed or token.text == "pi":
            hint = f"{token.text} is a number; write {token.text}*(...) for a product"
        else:
            like = nearest(token.text, FUNCTIONS)
            hint = f"did you mean {like}?" if like else "available: " + " ".join(FUNCTIONS)
        return ExpressionError(f"there is no function {_clipped(token.text)}; {hint}", token.position)

    def _unknown(self, token: _Token) -> ExpressionError:
        known = self._allowed | {"pi"}
        like = nearest(token.text, known | set(FUNCTIONS))
        hint = f"did you mean {like}?" if like else "known here: " + _listed(known)
        return ExpressionError(f"the name {_clipped(token.text)} is not known; {hint}", token.position)

    def _unexpected_follower(self) -> ExpressionError:
        token = self._token
        if token.kind == "mark" and token.text == ")":
            return ExpressionError("this ')' closes nothing; remove it", token.position)
        return ExpressionError(
            f"expected an operator before {_clipped(token.text)!r}; write products with *", token.position
        )


def _clipped(text: str) -> str:
    return text if len(text) <= 40 else text[:37] + "..."


def _listed(names: Iterable[str]) -> str:
    ordered = sorted(names)
    return " ".join(ordered[:20]) + (" ..." if len(ordered) > 20 else "")
