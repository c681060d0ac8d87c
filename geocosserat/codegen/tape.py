"""Ordered tapes: straight-line programs in place of expression trees.

A tape is what common-subexpression elimination leaves behind. It is the only form that gets counted,
differentiated and printed: trees repeat themselves, tapes do not.
"""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import sympy as sp


@dataclass(frozen=True)
class Tape:
    """Steps (name, expression) evaluated in order, then the outputs in terms of inputs and steps."""

    steps: tuple[tuple[sp.Symbol, sp.Expr], ...]
    outputs: tuple[tuple[str, sp.Expr], ...]

    @property
    def operations(self) -> int:
        """Additions, multiplications, divisions, powers and function calls of one evaluation."""
        expressions = [e for _, e in self.steps] + [e for _, e in self.outputs]
        return int(sum(e.count_ops(visual=False) for e in expressions))

    @property
    def inputs(self) -> frozenset[str]:
        """Names the tape needs from outside."""
        own = {name for name, _ in self.steps}
        used = {s for e in [e for _, e in self.steps] + [e for _, e in self.outputs] for s in e.free_symbols}
        return frozenset(s.name for s in used - own)

    def only(self, names: Iterable[str]) -> "Tape":
        """The same with just the outputs of these names, as far as there are such, and the steps that they need."""
        wanted = set(names)
        return _prune(Tape(self.steps, tuple((name, e) for name, e in self.outputs if name in wanted)))


def record(outputs: Mapping[str, sp.Expr], prefix: str = "x", given: Mapping[str, sp.Expr] | None = None) -> Tape:
    """The tape of named expressions; `prefix` names its intermediate steps.

    given: named intermediate results that the outputs use by name; each becomes a step.

    Source: sympy's cse with order="none"; the default order costs hundreds of times more for the same result.
    """
    given = given or {}
    before, named = _eliminate(given, f"{prefix}g")
    after, reduced = _eliminate(outputs, prefix)
    kept = [(sp.Symbol(name), e) for name, e in zip(given, named, strict=True)]
    return Tape((*before, *kept, *after), tuple(zip(outputs, reduced, strict=True)))


def _eliminate(named: Mapping[str, sp.Expr], prefix: str) -> tuple[list[tuple[sp.Symbol, sp.Expr]], list[sp.Expr]]:
    steps, reduced = sp.cse([sp.S.Zero + e for e in named.values()], symbols=sp.numbered_symbols(prefix), order="none")
    return steps, reduced


def jacobian(tape: Tape, variables: Sequence[sp.Symbol], name: str, prefix: str = "d") -> Tape:
    """Tape of the derivatives ``name_i_j`` (1-based, zeros left out) of the outputs with respect to `variables`.

    A forward sweep: each step's derivative is a combination of the derivatives of the steps before it.
    """
    derivatives: dict[sp.Symbol, list[sp.Expr]] = {
        v: [sp.Integer(int(i == j)) for j in range(len(variables))] for i, v in enumerate(variables)
    }

    def chain(expression: sp.Expr) -> list[sp.Expr]:
        total = [sp.Integer(0)] * len(variables)
        for s in sorted(expression.free_symbols & derivatives.keys(), key=str):
            partial = expression.diff(s)
            for j, inner in enumerate(derivatives[s]):
                if inner != 0 and partial != 0:
                    total[j] += partial * inner
        return total

    steps: list[tuple[sp.Symbol, sp.Expr]] = []
    for target, expression in tape.steps:
        steps.append((target, expression))
        derivatives[target] = []
        for j, value in enumerate(chain(expression)):
            if value.is_Number or value.is_Symbol:
                derivatives[target].append(value)
            else:
                symbol = sp.Symbol(f"{prefix}{target.name}_{j}")
                steps.append((symbol, value))
                derivatives[target].append(symbol)
    outputs = [
        (f"{name}_{i + 1}_{j + 1}", value)
        for i, (_, expression) in enumerate(tape.outputs)
        for j, value in enumerate(chain(expression))
        if value != 0
    ]
    return _prune(Tape(tuple(steps), tuple(outputs)))


def _prune(tape: Tape) -> Tape:
    """Drops the steps that no output needs."""
    needed = set().union(*(e.free_symbols for _, e in tape.outputs)) if tape.outputs else set()
    kept: list[tuple[sp.Symbol, sp.Expr]] = []
    for target, expression in reversed(tape.steps):
        if target in needed:
            kept.append((target, expression))
            needed |= expression.free_symbols
    return Tape(tuple(reversed(kept)), tape.outputs)
