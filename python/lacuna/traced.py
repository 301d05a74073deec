"""The keys of a model file for a model whose law is a Python function, where it can be read."""

from __future__ import annotations

from typing import Any, Callable, Dict, List, Mapping, Sequence

import numpy as np

from .law import Answers
from .nodes import NOTHING, ONE, Node, Untraceable, shared, text_of, values_of
from .symbols import Symbol, traced

#: Points at which what was read is compared with the function, and how far both may be apart, relative
#: to the largest value.
POINTS = 30
APART = 1e-9

Declared = Mapping[str, Sequence[Mapping[str, Any]]]


def equations(declared: Declared, answers: Answers, discrete: bool) -> Dict[str, Any]:
    """The table ``[model.equations]``.

    Raises whatever the function raises for symbols, and :class:`Untraceable` where it cannot be read or
    what was read has other values.
    """
    try:
        read = _read(declared, answers)
        _check(declared, answers, read)
    except Untraceable:
        raise
    except Exception as error:
        raise Untraceable(f"{type(error).__name__}: {error}") from error
    laws, outputs, coordinates = read["derivative"], read["output"], read["coordinates"]
    gains = [(channel["name"], i, law.gains.get(channel["name"], NOTHING))
             for channel in declared["channels"] for i, law in enumerate(laws)]  # fmt: skip
    roots = [s.value for s in [*laws, *outputs, *coordinates]] + [gain for _, _, gain in gains]
    taken = {entry["name"] for group in declared.values() for entry in group}
    named: Dict[int, str] = {}
    variables: List[Dict[str, str]] = []
    for node in shared(roots):
        value = text_of(node, named)
        named[id(node)] = _free_name(taken)
        variables.append({"name": named[id(node)], "value": value})

    def text(node: Node) -> str:
        return text_of(node, named)

    key = "next" if discrete else "derivative"
    states = [e["name"] for e in declared["states"]]
    return {
        "inputs": list(declared["inputs"]),
        "states": [{**e, key: text(s.value)} for e, s in zip(declared["states"], laws)],
        "outputs": [{**e, "value": text(s.value)} for e, s in zip(declared["outputs"], outputs)],
        "variables": variables,
        "parameters": [{"value": 0.0, **e} for e in declared["parameters"]],
        "channels": [
            {**e, "into": [{"state": states[i], "gain": text(gain)} for w, i, gain in gains if w == e["name"] and gain is not NOTHING]}
            for e in declared["channels"]
        ],
        "coordinates": [{**e, "value": text(s.value)} for e, s in zip(declared["coordinates"], coordinates)],
    }  # fmt: skip


def _free_name(taken: "set[str]") -> str:
    k = 1
    while f"part_{k}" in taken:
        k += 1
    taken.add(f"part_{k}")
    return f"part_{k}"


def _read(declared: Declared, answers: Answers) -> Dict[str, List[Symbol]]:
    """What the functions give for symbols; outputs and coordinates are the first states where no
    function gives them."""

    def named(group: str) -> List[Symbol]:
        return [Symbol(Node("name", entry["name"])) for entry in declared[group]]

    states = named("states")
    entering = [Symbol(NOTHING, {entry["name"]: ONE}) for entry in declared["channels"]]
    more = {"w": answers.w(*entering), "t": Symbol(Node("name", "time"))}
    arguments = (answers.x(*states), answers.u(*named("inputs")), answers.theta(*named("parameters")))
    found: Dict[str, List[Symbol]] = {}
    for which, function in answers.functions.items():
        if which == "coordinates" and not declared["coordinates"]:
            found[which] = []
        elif function is None:
            found[which] = states[: answers.rows[which]]
        else:
            takes = {name: more[name] for name in answers.takes[which]}
            found[which] = traced(function, arguments, takes, answers.rows[which])
        if which != "derivative" and any(s.gains for s in found[which]):
            raise Untraceable(f"what enters the channels stands in the {which}")
    return found


def _check(declared: Declared, answers: Answers, read: Mapping[str, Sequence[Symbol]]) -> None:
    """Compares what was read with what the functions give, at random points around the values that are
    declared: a function may do something else for numbers than for symbols."""
    random = np.random.default_rng(0)
    size = np.resize([0.1, 1.0, 10.0], POINTS)

    def drawn(group: str, one: Callable[[Mapping[str, Any]], Any]) -> Any:
        return np.array([one(entry) for entry in declared[group]]).reshape(len(declared[group]), POINTS)

    def around(entry: Mapping[str, Any]) -> Any:
        return float(entry.get("initial", 0.0)) + size * random.standard_normal(POINTS)

    def near(entry: Mapping[str, Any]) -> Any:
        value = float(entry.get("value", 0.0)) * (1 + 0.1 * random.standard_normal(POINTS))
        return np.clip(value, entry.get("min", -np.inf), entry.get("max", np.inf))

    x, u, w = (drawn(group, around) for group in ("states", "inputs", "channels"))
    theta, time = drawn("parameters", near), 0.7
    given = {"states": x, "inputs": u, "channels": w, "parameters": theta}
    names = {e["name"]: row for group, rows in given.items() for e, row in zip(declared[group], rows)}
    names["time"] = time
    if not declared["channels"]:
        w = np.zeros_like(x)
    for which, symbols in read.items():
        if answers.functions[which] is None or not symbols:
            continue
        with np.errstate(all="ignore"):
            theirs = answers(which, x, u, theta, w, time)
            values = values_of([s.value for s in symbols], names)
            gains = [(i, c, g) for i, s in enumerate(symbols) for c, g in s.gains.items()]
            for (i, c, _), gain in zip(gains, values_of([g for _, _, g in gains], names)):
                values[i] = values[i] + gain * names[c]
        ours = np.array([np.broadcast_to(np.asarray(v, dtype=float), (POINTS,)) for v in values])
        both = np.isfinite(ours) & np.isfinite(theirs)
        if np.any(np.isfinite(ours) != np.isfinite(theirs)) or not np.any(both):
            raise Untraceable("outside of its domain it does something else")
        scale = np.max(np.abs(theirs[both]))
        if np.max(np.abs(ours[both] - theirs[both])) > APART * scale:
            raise Untraceable("it gives other values for numbers than for symbols")
