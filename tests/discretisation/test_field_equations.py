"""The semi-discrete rod is that of the derived field equations: they are compared term by term, in numbers."""

from pathlib import Path

import pytest
import sympy as sp

from geocosserat.derivation.equations import derive
from geocosserat.derivation.notation import T, U
from geocosserat.discretisation.pointwise import pointwise
from geocosserat.discretisation.structuring import structure_of
from geocosserat.model.expressions import evaluate
from geocosserat.model.scene import load_scene
from tests.discretisation.rods import CAST, FROZEN, VISCOUS

EXAMPLES = sorted((Path(__file__).parents[2] / "examples").glob("*.toml"))
SCENES = {**{path.stem: path for path in EXAMPLES}, **{name: CAST[name] for name in (*FROZEN, *VISCOUS)}}
PLACE, INSTANT = sp.Rational(3, 10), sp.Rational(2, 7)


def _numbers(e: sp.Expr, values: dict[sp.Basic, sp.Expr]) -> sp.Expr:
    """The value of e: slopes and fields first, then places and parameters, in 30 digits."""
    slopes = {k: v for k, v in values.items() if isinstance(k, sp.Derivative)}
    rest = {k: v for k, v in values.items() if k not in slopes}
    return sp.N(sp.sympify(e).subs(slopes).subs(rest).doit(), 30)


@pytest.mark.parametrize("name", SCENES)
def test_the_pointwise_kernel_is_what_the_field_equations_say(name: str) -> None:
    """Strain rate (of frozen modes less that of the reference), stress and pull equal compatibility, law and ad*_E of
    the derivation at a random state."""
    model = load_scene(SCENES[name]).model
    structure = structure_of(model)
    equations, points = derive(model), pointwise(structure)
    d, held = equations.group.dimension, structure.frozen
    draw = [sp.Rational(7 * k % 23 - 11, 13) for k in range(1, 5 * d + 1)]
    state, value, slope, speed, viscous = (draw[k * d : (k + 1) * d] for k in range(5))
    right_sides = [e.right for e in (*equations.compatibility, *equations.stress_law)]
    used = set().union(*(sp.sympify(e).free_symbols for e in (*right_sides, *equations.turn)))
    known: dict[sp.Basic, sp.Expr] = {
        **{s: sp.Float(model.parameters[s.name], 30) for s in used if s.name in model.parameters},
        **dict(zip(equations.twist, value, strict=True)),
        **{sp.Derivative(v, U): s for v, s in zip(equations.twist, slope, strict=True)},
        **{e: x for e, x, frozen in zip(equations.turn, state, held, strict=True) if not frozen},
        **{sp.Derivative(e, T): x for e, x, frozen in zip(equations.turn, speed, held, strict=True) if not frozen},
        U: PLACE,
        T: INSTANT,
    }
    given = {s: x for s, x in zip(equations.group.stress, state, strict=True)}

    # the kernel's inputs, at the same state
    at_point = {**model.parameters, "u": float(PLACE), "t": float(INSTANT)}
    at_point |= {f"p_{parameter}": x for parameter, x in model.parameters.items()}
    inputs = {
        **dict(zip(points.state, (*state, *viscous), strict=False)),
        **{sp.Symbol(f"rate_{i + 1}"): x for i, x in enumerate(speed)},
        **{sp.Symbol(f"value_{i + 1}"): v for i, v in enumerate(value)},
        **{sp.Symbol(f"slope_{i + 1}"): s for i, s in enumerate(slope)},
        **{
            sp.Symbol(c.name): sp.Float(evaluate(c.expression, at_point), 30)
            for c in structure.coefficients
            if c.expression is not None and c.place in ("uniform", "point")
        },
        **{sp.Symbol(f"slack_{s}"): sp.Integer(0) for s in equations.group.stress},
        sp.Symbol("t"): INSTANT,
    }
    kernel_rates = [sp.N(e.subs(inputs), 30) for e in points.strain_rate.values()]
    assert len(equations.compatibility) == len(kernel_rates) == d
    for e, frozen, generated in zip(equations.compatibility, held, kernel_rates, strict=True):
        derived = _numbers(e.right - (e.left if frozen else 0), known)
        assert abs(derived - generated) <= 1e-13 * (1 + abs(derived))

    law = {e.left.func.__name__: _numbers(e.right, known) for e in equations.stress_law}
    kernel_stress = {s: sp.N(e.subs(inputs), 30) for s, e in points.stress.items()}
    # of viscous modes the kernel has what the law says less the state
    gaps = zip(points.state[d:], viscous, points.gap.values(), strict=False)
    kernel_stress |= {str(s): sp.N(e.subs(inputs), 30) + x for s, x, e in gaps}
    assert set(law) == set(kernel_stress)
    for s, derived in law.items():
        assert abs(derived - kernel_stress[s]) <= 1e-12 * (1 + abs(derived))

    # ad*_E S: what the balance has besides the slope of the stress and the wrench
    stress = {s.func.__name__: law.get(s.func.__name__, given[s.func.__name__]) for s in equations.stress}
    bound = {**known, **{f: sp.Integer(0) for f in equations.wrench}}
    bound |= {sp.Derivative(s, U): sp.Integer(0) for s in equations.stress}
    bound |= {s: stress[s.func.__name__] for s in equations.stress}
    coadjoint = [_numbers(e.residual, bound) for e in equations.balance]
    named = {sp.Symbol(s): v for s, v in stress.items()}
    pull = [sp.N(e.subs({**inputs, **named}), 30) for e in points.pull.values()]
    for derived, generated in zip(coadjoint, pull, strict=True):
        assert abs(derived + generated) <= 1e-12 * (1 + abs(derived))
