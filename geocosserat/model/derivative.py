"""The derivative of an expression with respect to one of its names."""

from __future__ import annotations

from collections.abc import Callable

from geocosserat.model.tree import Binary, Call, Expression, Negate, Number, Symbol


def derivative(e: Expression, name: str) -> Expression:
    """d e / d name, with what is literally zero left out.

    A step has the derivative zero (its jump is not seen); that of ``abs`` is 1 or -1, and 0 at zero.
    """
    match e:
        case Symbol(other):
            return Number(float(other == name))
        case Negate(operand):
            return -derivative(operand, name)
        case Binary("+", left, right):
            return derivative(left, name) + derivative(right, name)
        case Binary("-", left, right):
            return derivative(left, name) - derivative(right, name)
        case Binary("*", left, right):
            return derivative(left, name) * right + left * derivative(right, name)
        case Binary("/", left, right):
            return (derivative(left, name) - e * derivative(right, name)) / right
        case Binary("**", base, power):
            by_base = power * base ** (power - 1) * derivative(base, name)
            return by_base + e * Call("log", base) * derivative(power, name)
        case Call(function, argument):
            return _SLOPE[function](argument) * derivative(argument, name)
        case _:
            return Number(0.0)


_SLOPE: dict[str, Callable[[Expression], Expression]] = {
    "sin": lambda x: Call("cos", x),
    "cos": lambda x: -Call("sin", x),
    "tan": lambda x: 1 + Call("tan", x) ** 2,
    "exp": lambda x: Call("exp", x),
    "log": lambda x: 1 / x,
    "sqrt": lambda x: 0.5 / Call("sqrt", x),
    "tanh": lambda x: 1 - Call("tanh", x) ** 2,
    "sinh": lambda x: Call("cosh", x),
    "cosh": lambda x: Call("sinh", x),
    "abs": lambda x: 2 * Call("heaviside", x) - 1,
    "heaviside": lambda x: Number(0.0),
}
