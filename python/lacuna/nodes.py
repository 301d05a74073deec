"""Expressions as graphs: numbers, names and operations on them, and their text in a model file."""

from __future__ import annotations

import math
from typing import Any, Callable, Dict, Iterable, List, Mapping, Sequence, Tuple

import numpy as np


class Untraceable(TypeError):
    """Why a function cannot be read as equations."""


class Node:
    """A number, a name, or an operation on other nodes."""

    __slots__ = ("operation", "arguments")

    def __init__(self, operation: str, *arguments: Any) -> None:
        self.operation, self.arguments = operation, arguments

    @property
    def inner(self) -> List["Node"]:
        """What it is an operation on."""
        return [a for a in self.arguments if isinstance(a, Node)]


#: 0, whatever it is multiplied by: what is not there in a sparse matrix.
NOTHING = Node("number", 0.0)
ONE = Node("number", 1.0)


def number(value: float) -> Node:
    """A node of one value."""
    if not math.isfinite(value):
        raise Untraceable(f"the number {value} stands in it")
    return NOTHING if value == 0.0 else Node("number", float(value))


def _is_one(node: Node) -> bool:
    return node.operation == "number" and bool(node.arguments[0] == 1.0)


def add(a: Node, b: Node) -> Node:
    """a + b."""
    if a is NOTHING or b is NOTHING:
        return b if a is NOTHING else a
    return Node("-", a, b.arguments[0]) if b.operation == "neg" else Node("+", a, b)


def subtract(a: Node, b: Node) -> Node:
    """a - b."""
    if b is NOTHING:
        return a
    return negative(b) if a is NOTHING else Node("-", a, b)


def multiply(a: Node, b: Node) -> Node:
    """a b."""
    if a is NOTHING or b is NOTHING:
        return NOTHING
    return b if _is_one(a) else a if _is_one(b) else Node("*", a, b)


def divide(a: Node, b: Node) -> Node:
    """a / b."""
    return a if a is NOTHING or _is_one(b) else Node("/", a, b)


def negative(a: Node) -> Node:
    """-a."""
    return a if a is NOTHING else Node("neg", a)


#: What the operations do to numbers.
NUMERIC: Dict[str, Callable[..., Any]] = {
    "+": np.add,
    "-": np.subtract,
    "*": np.multiply,
    "/": np.divide,
    "neg": np.negative,
    "pow": np.float_power,
    "atan2": np.arctan2,
    "max": np.maximum,
    "min": np.minimum,
    "abs": np.absolute,
    "asin": np.arcsin,
    "acos": np.arccos,
    "atan": np.arctan,
    **{name: getattr(np, name) for name in ("sin", "cos", "tan", "sinh", "cosh", "tanh", "exp", "log", "sqrt", "sign")},
}

#: How strongly an operation binds; functions and names bind strongest.
_STRENGTH = {"+": 1, "-": 1, "*": 2, "/": 2, "neg": 3, "pow": 4}
_ATOM = 5


def text_of(node: Node, named: Mapping[int, str], least: int = 0) -> str:
    """The expression of a node, in parentheses where it binds less than ``least``; the nodes in ``named``
    are their names there."""
    if id(node) in named:
        return named[id(node)]
    strength, inner = _STRENGTH.get(node.operation, _ATOM), node.inner
    if node.operation == "name":
        text = str(node.arguments[0])
    elif node.operation == "number":
        text = repr(node.arguments[0])
        text = text[:-2] if text.endswith(".0") else text
        strength = _STRENGTH["neg"] if text.startswith("-") else _ATOM
    elif node.operation == "neg":
        text = "-" + text_of(inner[0], named, strength)
    elif node.operation == "pow":
        text = f"{text_of(inner[0], named, _ATOM)}^{text_of(inner[1], named, _ATOM)}"
    elif strength < _ATOM:
        # in the order of the function: (a b) c and a (b c) are rounded differently
        space = " " if strength == 1 else ""
        left, right = text_of(inner[0], named, strength), text_of(inner[1], named, strength + 1)
        text = f"{left}{space}{node.operation}{space}{right}"
    else:
        text = f"{node.operation}({', '.join(text_of(a, named) for a in inner)})"
    return f"({text})" if strength < least else text


def shared(roots: Iterable[Node]) -> List[Node]:
    """Operations that stand in several places, each after what it is made of."""
    counts: Dict[int, int] = {}
    order: List[Node] = []
    work: List[Tuple[Node, bool]] = [(root, False) for root in roots][::-1]
    while work:
        node, is_done = work.pop()
        if is_done:
            order.append(node)
            continue
        counts[id(node)] = counts.get(id(node), 0) + 1
        if counts[id(node)] == 1:
            work.append((node, True))
            work.extend((a, False) for a in node.inner)
    return [node for node in order if counts[id(node)] > 1 and node.inner]


def values_of(roots: Sequence[Node], given: Mapping[str, Any]) -> List[Any]:
    """Values of nodes where those of the names are given."""
    known: Dict[int, Any] = {}

    def value(node: Node) -> Any:
        if id(node) not in known:
            if node.operation == "number":
                known[id(node)] = node.arguments[0]
            elif node.operation == "name":
                known[id(node)] = given[node.arguments[0]]
            else:
                known[id(node)] = NUMERIC[node.operation](*map(value, node.inner))
        return known[id(node)]

    return [value(root) for root in roots]
