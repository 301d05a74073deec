"""Values of which only the law is known: a function that is called with them shows its equations.

Every operation makes a node of a graph (operator overloading: Griewank and Walther, "Evaluating
Derivatives", 2nd ed., 2008, section 6.1). A model file holds a law as f(x, u, theta) plus the sum of
gain_j(x, u, theta) w_j, so that a symbol is its value where w = 0, and a factor for each w_j.
"""

from __future__ import annotations

import builtins
import math
import types
from typing import Any, Callable, Dict, List, Mapping, Optional, Sequence

import numpy as np

from .nodes import NOTHING, Node, Untraceable, add, divide, multiply, negative, number, subtract, text_of


class Symbol:
    """A value, and how it grows with each thing that enters the channels; numpy's functions take it."""

    def __init__(self, value: Node, gains: Optional[Mapping[str, Node]] = None) -> None:
        self.value, self.gains = value, dict(gains or {})

    def _with(self, other: Any, of: Callable[[Node, Node], Node]) -> "Symbol":
        """A sum or a difference."""
        other = symbol(other)
        names = dict.fromkeys([*self.gains, *other.gains])
        gains = {w: of(self.gains.get(w, NOTHING), other.gains.get(w, NOTHING)) for w in names}
        return Symbol(of(self.value, other.value), gains)

    def __add__(self, other: Any) -> "Symbol":
        return self._with(other, add)

    def __sub__(self, other: Any) -> "Symbol":
        return self._with(other, subtract)

    def __mul__(self, other: Any) -> "Symbol":
        other = symbol(other)
        if self.gains and other.gains:
            raise Untraceable("what enters the channels is multiplied by itself")
        gains = {w: multiply(gain, other.value) for w, gain in self.gains.items()}
        gains.update((w, multiply(self.value, gain)) for w, gain in other.gains.items())
        return Symbol(multiply(self.value, other.value), gains)

    def __truediv__(self, other: Any) -> "Symbol":
        other = symbol(other)
        if other.gains:
            raise Untraceable("something is divided by what enters the channels")
        return Symbol(divide(self.value, other.value), {w: divide(g, other.value) for w, g in self.gains.items()})

    def __neg__(self) -> "Symbol":
        return Symbol(negative(self.value), {w: negative(gain) for w, gain in self.gains.items()})

    def __pos__(self) -> "Symbol":
        return self

    def __abs__(self) -> "Symbol":
        return _call("abs", self)

    def __pow__(self, other: Any) -> "Symbol":
        return _call("pow", self, other)

    def __radd__(self, other: Any) -> "Symbol":
        return symbol(other) + self

    def __rsub__(self, other: Any) -> "Symbol":
        return symbol(other) - self

    def __rmul__(self, other: Any) -> "Symbol":
        return symbol(other) * self

    def __rtruediv__(self, other: Any) -> "Symbol":
        return symbol(other) / self

    def __rpow__(self, other: Any) -> "Symbol":
        return _call("pow", other, self)

    def clip(self, low: Any = None, high: Any = None, **_: Any) -> "Symbol":
        """As ``numpy.clip``."""
        above = self if low is None else _call("max", self, low)
        return above if high is None else _call("min", above, high)

    def _compared(self, *_: Any) -> Any:
        raise Untraceable("it compares values, or branches on one")

    __bool__ = __lt__ = __le__ = __gt__ = __ge__ = __eq__ = __ne__ = _compared
    __hash__ = object.__hash__

    def __float__(self) -> float:
        raise Untraceable("it asks for a value as a number")

    def __array_ufunc__(self, ufunc: Any, method: str, *inputs: Any, **settings: Any) -> Any:
        if method != "__call__" or settings:
            return NotImplemented
        if any(isinstance(value, np.ndarray) and value.ndim > 0 for value in inputs):
            # element by element, by the methods and operators above
            return ufunc(*(np.array(value, dtype=object) for value in inputs))
        function = FUNCTIONS.get(ufunc.__name__)
        return NotImplemented if function is None else function(*inputs)

    def __repr__(self) -> str:
        return text_of(self.value, {})


def symbol(value: Any) -> Symbol:
    """A symbol, or a number as one."""
    return value if isinstance(value, Symbol) else Symbol(number(float(value)))


def _call(name: str, *arguments: Any) -> Symbol:
    symbols = [symbol(value) for value in arguments]
    if any(s.gains for s in symbols):
        raise Untraceable(f"what enters the channels stands within `{name}`")
    return Symbol(Node(name, *(s.value for s in symbols)))


def _function(name: str) -> Callable[..., Any]:
    return lambda *arguments: _call(name, *arguments)


def _logarithm(x: Any, base: Any = None) -> Any:
    found = _call("log", x)
    return found if base is None else found / _call("log", base)


#: Functions of numpy and of `math` by their names there.
FUNCTIONS: Dict[str, Callable[..., Any]] = {
    **{name: _function(name) for name in ("sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh")},
    **{name: _function(name) for name in ("exp", "sqrt", "sign", "atan2", "pow")},
    **{"arc" + name: _function("a" + name) for name in ("sin", "cos", "tan", "tan2")},
    **{name: _function("abs") for name in ("absolute", "fabs")},
    **{name: _function("max") for name in ("maximum", "fmax")},
    **{name: _function("min") for name in ("minimum", "fmin")},
    **{name: _function("pow") for name in ("power", "float_power")},
    **{name: lambda x: symbol(x) * (math.pi / 180.0) for name in ("deg2rad", "radians")},
    **{name: lambda x: symbol(x) * (180.0 / math.pi) for name in ("rad2deg", "degrees")},
    "add": lambda x, y: symbol(x) + y,
    "subtract": lambda x, y: symbol(x) - y,
    "multiply": lambda x, y: symbol(x) * y,
    "divide": lambda x, y: symbol(x) / y,
    "negative": lambda x: -symbol(x),
    "positive": symbol,
    "square": lambda x: symbol(x) * x,
    "reciprocal": lambda x: 1.0 / symbol(x),
    "hypot": lambda x, y: _call("sqrt", symbol(x) * x + symbol(y) * y),
    "log": _logarithm,
    "log10": lambda x: _logarithm(x, 10.0),
    "log2": lambda x: _logarithm(x, 2.0),
}


def _method(name: str) -> Callable[[Symbol], Any]:
    return lambda self: FUNCTIONS[name](self)


# numpy asks the elements of its arrays of objects by methods
for _name in ("sin", "cos", "tan", "arcsin", "arccos", "arctan", "sinh", "cosh", "tanh", "exp", "log", "log10", "sqrt"):
    setattr(Symbol, _name, _method(_name))


class _Math:
    """The module `math`, for symbols too."""

    def __getattr__(self, name: str) -> Any:
        own, symbolic = getattr(math, name), FUNCTIONS.get(name)
        if symbolic is None:
            return own
        return lambda *values: (symbolic if any(isinstance(v, Symbol) for v in values) else own)(*values)


def _extreme(name: str) -> Callable[..., Any]:
    """`max` or `min`, for symbols too."""

    def extreme(*arguments: Any, **settings: Any) -> Any:
        several = len(arguments) == 1 and not isinstance(arguments[0], Symbol)
        values: Sequence[Any] = list(arguments[0]) if several else arguments
        if settings or not any(isinstance(value, Symbol) for value in values):
            return getattr(builtins, name)(*arguments, **settings)
        found = values[0]
        for value in values[1:]:
            found = _call(name, found, value)
        return found

    return extreme


def _for_symbols(function: Any) -> Any:
    """The function with `math`, `max` and `min` that take symbols, and so the functions of its module
    that it calls."""
    if not isinstance(function, types.FunctionType):
        return function
    own, shim = function.__globals__, _Math()
    theirs = {id(getattr(math, name)): name for name in FUNCTIONS if hasattr(math, name)}
    seen: Dict[str, Any] = {"max": _extreme("max"), "min": _extreme("min")}

    def renewed(f: types.FunctionType) -> Any:
        copy = types.FunctionType(f.__code__, seen, f.__name__, f.__defaults__, f.__closure__)
        copy.__kwdefaults__ = f.__kwdefaults__
        return copy

    for name, value in own.items():
        if value is math:
            seen[name] = shim
        elif id(value) in theirs:
            seen[name] = getattr(shim, theirs[id(value)])
        elif isinstance(value, types.FunctionType) and value.__globals__ is own:
            seen[name] = renewed(value)
        else:
            seen[name] = value
    return renewed(function)


def traced(function: Callable[..., Any], arguments: Sequence[Any], more: Mapping[str, Any], rows: int) -> List[Symbol]:
    """What a function gives for symbols: one per row."""
    found = _for_symbols(function)(*arguments, **more)
    values = [found] if isinstance(found, Symbol) else list(np.asarray(found, dtype=object).reshape(-1))
    if len(values) != rows:
        raise Untraceable(f"{len(values)} values come back, where {rows} are declared")
    return [symbol(value) for value in values]
