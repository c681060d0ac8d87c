"""Altered transcriptions of a statement: a sign, an index, a factor, an order, a name."""

from __future__ import annotations

import ast
import copy
import sys
from collections.abc import Callable, Iterator
from typing import Any

from geocosserat.referee.statement import Check, Statement

PARTNERS = (
    ("h", "v"), ("Pi", "Omega"), ("E", "V"), ("F", "M"), ("f", "m"), ("F1", "F2"), ("f1", "f2"), ("h1", "h2"),
    ("v1", "v2"), ("c", "s"), ("x", "y"), ("du", "dt"), ("turn", "twist"), ("ad", "coad"),
)  # fmt: skip
"""Names that may be mistaken for each other."""


def mutants(statement: Statement, keyword: str) -> Iterator[tuple[str, Callable[[], Check]]]:
    """What was altered in the expression given for that keyword of the check, and the function with it."""
    tree = ast.parse(statement.code)
    place = _keyword(tree, keyword)
    for words, expression in _altered(place.value):
        changed = copy.deepcopy(tree)
        _keyword(changed, keyword).value = expression
        yield words, _function(changed, statement)


def _keyword(tree: ast.AST, name: str) -> ast.keyword:
    found = [k for k in ast.walk(tree) if isinstance(k, ast.keyword) and k.arg == name]
    assert len(found) == 1, f"expected one {name}= in the function that decides a statement, found {len(found)}"
    return found[0]


def _function(tree: ast.Module, statement: Statement) -> Callable[[], Check]:
    ast.fix_missing_locations(tree)
    names: dict[str, Any] = dict(vars(sys.modules[statement.check.__module__]))
    exec(compile(tree, f"<altered {statement.name}>", "exec"), names)
    check = names[statement.check.__name__]
    assert callable(check)
    return check  # type: ignore[no-any-return]


def _altered(expression: ast.expr) -> Iterator[tuple[str, ast.expr]]:
    nodes = list(ast.walk(expression))
    for k, node in enumerate(nodes):
        for words, alter in _alterations(node):
            changed = copy.deepcopy(expression)
            there = list(ast.walk(changed))[k]
            new = alter(there)
            if new is not None and k == 0:
                yield words, new
            elif new is not None:
                yield words, _Replace(there, new).visit(changed)
            else:
                yield words, changed
    array = ast.parse("__import__('numpy').asarray(0, dtype=object)", mode="eval").body
    for words, operator, number in (("a factor 2", ast.Mult(), 2), ("a term 1", ast.Add(), 1)):
        whole = copy.deepcopy(array)
        assert isinstance(whole, ast.Call)
        whole.args = [copy.deepcopy(expression)]
        yield words, ast.BinOp(whole, operator, ast.Constant(number))


class _Replace(ast.NodeTransformer):
    def __init__(self, old: ast.AST, new: ast.AST) -> None:
        self.old, self.new = old, new

    def generic_visit(self, node: ast.AST) -> ast.AST:
        return self.new if node is self.old else super().generic_visit(node)


def _alterations(node: ast.AST) -> Iterator[tuple[str, Callable[[Any], ast.expr | None]]]:
    """In words, and what changes a copy of the node in place, or makes another one."""
    match node:
        case ast.BinOp(op=ast.Add() | ast.Sub()):
            yield f"sign in {ast.unparse(node)}", _flip
        case ast.BinOp(op=ast.MatMult()):
            yield f"order in {ast.unparse(node)}", _swap_operands
        case ast.UnaryOp(op=ast.USub()):
            yield f"sign of {ast.unparse(node)}", lambda n: n.operand
        case ast.Constant(value=int(n)) if not isinstance(n, bool):
            yield f"number {n}", lambda m: ast.Constant(m.value + 1)
        case ast.Constant(value=str(text)) if "->" in text and "," in text:
            yield f"indices {text}", _swap_indices
        case ast.Call(func=ast.Name(id="cross"), args=[_, _]):
            yield f"order in {ast.unparse(node)}", lambda m: m.args.reverse()
        case ast.Attribute(attr="T"):
            yield f"transpose of {ast.unparse(node.value)}", lambda m: m.value
        case ast.Name(id=name) | ast.Attribute(attr=name):
            for pair in PARTNERS:
                if name in pair:
                    other = pair[1 - pair.index(name)]
                    yield f"{other} for {name}", lambda m, other=other: setattr(
                        m, "id" if isinstance(m, ast.Name) else "attr", other
                    )


def _flip(node: ast.BinOp) -> None:
    node.op = ast.Sub() if isinstance(node.op, ast.Add) else ast.Add()


def _swap_operands(node: ast.BinOp) -> None:
    node.left, node.right = node.right, node.left


def _swap_indices(node: ast.Constant) -> ast.expr:
    """The first two indices of the first operand."""
    text = str(node.value)
    first, rest = text.split(",", 1)
    return ast.Constant(first[1::-1] + first[2:] + "," + rest)
