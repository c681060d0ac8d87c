"""The semi-discrete rod is that of the derived field equations: they are compared term by term, in numbers."""

from pathlib import Path

import pytest
import sympy as sp

from geocosserat.derivation.equations import derive
from geocosserat.discretisation.pointwise import pointwise
from geocosserat.discretisation.structuring import structure_of
from geocosserat.model.expressions import evaluate
from geocosserat.model.scene import load_scene

EXAMPLES = sorted((Path(__file__).parents[2] / "examples").glob("*.toml"))
PLACE = sp.Rational(3, 10)


def _numbers(e: sp.Expr, values: dict[sp.Basic, sp.Expr]) -> sp.Expr:
    """The value of e: slopes and fields first, then places and parameters, in 30 digits."""
    slopes = {k: v for k, v in values.items() if isinstance(k, sp.Derivative)}
    rest = {k: v for k, v in values.items() if k not in slopes}
    return sp.N(e.subs(slopes).subs(rest).doit(), 30)


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda p: p.stem)
def test_the_pointwise_kernel_is_what_the_field_equations_say(path: Path) -> None:
    """Strain rate, stress and pull equal compatibility, law and ad*_E of the derivation at a random state."""
    model = load_scene(path).model
    equations, points = derive(model), pointwise(structure_of(model))
    d = equations.group.dimension
    u = next(s for s in equations.turn[0].args if s.name == "u")
    draw = [sp.Rational(7 * k % 23 - 11, 13) for k in range(1, 3 * d + 1)]
    turn, value, slope = draw[:d], draw[d : 2 * d], draw[2 * d :]
    parameters = {sp.Symbol(name): sp.Rational(str(v)) for name, v in model.parameters.items()}
    known: dict[sp.Basic, sp.Expr] = {
        **dict(zip(equations.turn, turn, strict=True)),
        **dict(zip(equations.twist, value, strict=True)),
        **{sp.Derivative(v, u): s for v, s in zip(equations.twist, slope, strict=True)},
        u: PLACE,
    }
    for symbol in set().union(*(e.right.free_symbols for e in equations.stress_law)) - {u}:
        if symbol.name in model.parameters:
            known[symbol] = parameters[sp.Symbol(symbol.name)]

    # the kernel's inputs, at the same state
    at_point = {**model.parameters, "u": float(PLACE)}
    inputs = {
        **dict(zip(points.state, turn, strict=True)),
        **{sp.Symbol(f"value_{i + 1}"): v for i, v in enumerate(value)},
        **{sp.Symbol(f"slope_{i + 1}"): s for i, s in enumerate(slope)},
        **{
            sp.Symbol(c.name): sp.Float(evaluate(c.expression, at_point), 30)
            for c in structure_of(model).coefficients
            if c.expression is not None and not c.timed and c.place in ("uniform", "point")
        },
    }
    rates = [_numbers(e.right, known) for e in equations.compatibility]
    stress = [_numbers(e.right, known) for e in equations.stress_law]
    kernel_stress = {name: sp.N(e.subs(inputs), 30) for name, e in points.stress.items()}
    kernel_rates = [sp.N(e.subs(inputs), 30) for e in points.strain_rate.values()]
    assert len(rates) == len(kernel_rates) == d
    for derived, generated in zip(rates, kernel_rates, strict=True):
        assert abs(derived - generated) <= 1e-13 * (1 + abs(derived))
    for derived, generated in zip(stress, kernel_stress.values(), strict=True):
        assert abs(derived - generated) <= 1e-12 * (1 + abs(derived))

    # ad*_E S: what the balance has besides the slope of the stress and the wrench
    bound = {**known, **{f: sp.Integer(0) for f in equations.wrench}}
    bound |= {sp.Derivative(s, u): sp.Integer(0) for s in equations.stress}
    bound |= dict(zip(equations.stress, stress, strict=True))
    coadjoint = [_numbers(e.residual, bound) for e in equations.balance]
    named = {sp.Symbol(name): v for name, v in zip(points.stress, stress, strict=True)}
    pull = [sp.N(e.subs({**inputs, **named}), 30) for e in points.pull.values()]
    for derived, generated in zip(coadjoint, pull, strict=True):
        assert abs(derived + generated) <= 1e-12 * (1 + abs(derived))
