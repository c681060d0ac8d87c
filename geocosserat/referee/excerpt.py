"""What decides a statement, cut out of its module as a program that runs as it stands and prints the verdict."""

from __future__ import annotations

import ast
import inspect
import sys
from collections.abc import Callable, Iterator

from geocosserat.referee.statement import Check, Section

_JUDGE = ast.ImportFrom("geocosserat.referee.statement", [ast.alias("verdict_on")], 0)


def runnable(check: Callable[[], Check]) -> str:
    """The imports that the check needs, all else that it uses of its module, the check, and a line that prints.

    Raises ValueError for a check that is no function at the top of a module.
    """
    module = sys.modules[check.__module__]
    source = inspect.getsource(module)
    tree = ast.parse(source)
    sections = {name for name, value in vars(module).items() if isinstance(value, Section)}
    places = {name: node for node in tree.body for name in _defined(node)}
    if not isinstance(places.get(check.__name__), ast.FunctionDef):
        raise ValueError(
            f"expected a function at the top of its module, found {check.__qualname__} of {check.__module__}; "
            "define it there"
        )
    wanted, waiting = set[str](), [check.__name__]
    while waiting:
        name = waiting.pop()
        if name in places and name not in wanted:
            wanted.add(name)
            waiting += _used(places[name], sections)
    imports, rest = [], []
    for node in tree.body:
        if isinstance(node, ast.Import | ast.ImportFrom):
            imports += _needed(node, wanted)
        elif wanted & set(_defined(node)):
            rest.append(_text(node, source, sections))
    return "\n\n\n".join([_written(imports), *rest, f"print(verdict_on({check.__name__}()))"]) + "\n"


def _defined(node: ast.stmt) -> Iterator[str]:
    """The names that a line at the top of a module defines."""
    match node:
        case ast.Import(names=names) | ast.ImportFrom(names=names):
            yield from (alias.asname or alias.name.split(".")[0] for alias in names)
        case ast.FunctionDef(name=name) | ast.ClassDef(name=name):
            yield name
        case ast.Assign() | ast.AnnAssign():
            yield from (n.id for n in ast.walk(node) if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Store))


def _decorators(node: ast.stmt, sections: set[str]) -> list[ast.expr]:
    """Those that stay: not the one that puts a check on record."""
    found = node.decorator_list if isinstance(node, ast.FunctionDef | ast.ClassDef) else []
    return [d for d in found if not any(isinstance(n, ast.Name) and n.id in sections for n in ast.walk(d))]


def _used(node: ast.stmt, sections: set[str]) -> list[str]:
    dropped: set[ast.AST] = set()
    if isinstance(node, ast.FunctionDef | ast.ClassDef):
        kept = _decorators(node, sections)
        dropped = {n for d in node.decorator_list if d not in kept for n in ast.walk(d)}
    return [n.id for n in ast.walk(node) if isinstance(n, ast.Name) and n not in dropped]


def _text(node: ast.stmt, source: str, sections: set[str]) -> str:
    kept = [f"@{ast.unparse(d)}\n" for d in _decorators(node, sections)]
    assert node.end_lineno is not None
    return "".join(kept) + "\n".join(source.splitlines()[node.lineno - 1 : node.end_lineno])


def _needed(node: ast.Import | ast.ImportFrom, wanted: set[str]) -> list[ast.Import | ast.ImportFrom]:
    if isinstance(node, ast.ImportFrom) and node.module == "__future__":
        return [node]
    names = [a for a in node.names if (a.asname or a.name.split(".")[0]) in wanted]
    if not names:
        return []
    return [ast.ImportFrom(node.module, names, node.level) if isinstance(node, ast.ImportFrom) else ast.Import(names)]


def _written(imports: list[ast.Import | ast.ImportFrom]) -> str:
    """One line a module, with what judges beside what it judges."""
    judges = [n for n in imports if isinstance(n, ast.ImportFrom) and n.module == _JUDGE.module]
    others = [n for n in imports if n not in judges]
    names = {a.name: a for n in (*judges, _JUDGE) for a in n.names}
    lines = [ast.unparse(n) for n in others]
    return "\n".join([*lines, ast.unparse(ast.ImportFrom(_JUDGE.module, [*names.values()], 0))])
