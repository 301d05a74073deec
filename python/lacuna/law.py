"""Models whose law is a Python function, asked for many instants at once."""

from __future__ import annotations

import inspect
from collections import namedtuple
from typing import Any, Callable, Dict, List, Mapping, Optional, Sequence, Set

import numpy as np

from ._lacuna import CallError


def slow(why: str) -> str:
    """What is said where such a model is used."""
    because = f" ({why})" if why else ""
    return (
        f"this model's law is called in Python at every step{because}, which is some hundred times slower than "
        "its equations"
    )


def entries(what: str, given: Any) -> List[Dict[str, Any]]:
    """Declarations as a list: of names, of names and units, of names and tables."""
    if isinstance(given, str):
        given = [given]
    if not isinstance(given, Mapping):
        given = {name: "" for name in given}
    found = []
    for name, value in given.items():
        entry: Dict[str, Any] = {"name": str(name)}
        if isinstance(value, str):
            entry["unit"] = value
        elif isinstance(value, Mapping):
            entry.update(value)
        elif what == "parameters" and isinstance(value, (int, float, np.number)):
            entry["value"] = float(value)
        else:
            raise CallError(f"{what}: `{name}` is declared by {value!r}; a unit or a dictionary is wanted")
        found.append(entry)
    return found


def unique(groups: Mapping[str, Sequence[Dict[str, Any]]]) -> None:
    """Refuses a name that is given twice, coordinates apart: they may share that of their value."""
    known: Dict[str, str] = {}
    for group, members in groups.items():
        for member in members:
            name = member["name"]
            if name in known and (group != "coordinates" or known[name] == group):
                raise CallError(f"the name `{name}` is given twice: in {known[name]} and in {group}")
            known.setdefault(name, group)


class Answers:
    """Answers for a law: arrays of one row per signal and one column per instant."""

    def __init__(
        self,
        declared: Mapping[str, Sequence[Dict[str, Any]]],
        derivative: Optional[Callable[..., Any]],
        output: Optional[Callable[..., Any]],
        coordinates: Optional[Callable[..., Any]],
    ) -> None:
        def named(group: str) -> Any:
            return namedtuple(group, [e["name"] for e in declared[group]], rename=True)

        self.x, self.u = named("states"), named("inputs")
        self.theta, self.w = named("parameters"), named("channels")
        self.states, self.outputs = len(declared["states"]), len(declared["outputs"])
        self.has_channels = bool(declared["channels"])
        self.rows = {"derivative": self.states, "output": self.outputs}
        self.rows["coordinates"] = len(declared["coordinates"]) or self.states
        self.functions = {"derivative": derivative, "output": output, "coordinates": coordinates}
        self.takes = {which: _takes(which, f) for which, f in self.functions.items() if f is not None}
        if derivative is None and (self.states or self.has_channels):
            raise CallError("states or channels are declared, and no function gives the derivatives")
        if self.has_channels and "w" not in self.takes["derivative"]:
            raise CallError("channels are declared, and the function takes no argument `w` for them")
        if output is None and self.outputs > self.states:
            raise CallError("no output function is given, and there are more outputs than states")
        #: Whether a function takes arrays; told by the first call.
        self.whole: Dict[str, bool] = {}
        #: Functions that gave values once.
        self.worked: Set[str] = set()

    def __call__(self, which: str, x: Any, u: Any, theta: Any, w: Any, t: float) -> Any:
        function, count = self.functions[which], x.shape[1] if x.size else max(u.shape[1], theta.shape[1])
        if function is None:
            # outputs are the first states, coordinates the states
            return np.ascontiguousarray(x[: self.rows[which]])
        found = self._called(which, function, x, u, theta, w, t, count)
        if which == "derivative" and not self.has_channels:
            # without channels of its own, each derivative has one
            found = found + w
        return np.ascontiguousarray(found, dtype=np.float64)

    def _called(self, which: str, f: Any, x: Any, u: Any, theta: Any, w: Any, t: float, n: int) -> Any:
        takes = self.takes[which]

        def ask(x: Any, u: Any, theta: Any, w: Any) -> Any:
            more = {"w": self.w(*w) if self.has_channels else None, "t": t}
            return f(self.x(*x), self.u(*u), self.theta(*theta), **{k: more[k] for k in takes})

        def point(k: int) -> Any:
            each = [[float(v) for v in rows[:, k]] for rows in (x, u, theta, w)]
            values = np.asarray(ask(*each), dtype=np.float64).reshape(-1)
            if values.shape != (self.rows[which],):
                raise CallError(f"{which}: {values.size} values came back, where {self.rows[which]} are declared")
            return values

        def points() -> Any:
            """Instant by instant: outside of its domain a function that has worked before diverges."""
            found, fault = np.full((self.rows[which], n), np.nan), None
            finite = np.all([np.isfinite(rows).all(axis=0) for rows in (x, u, theta, w)], axis=0)
            for k in np.flatnonzero(finite):
                try:
                    found[:, k] = point(int(k))
                    self.worked.add(which)
                except (ArithmeticError, ValueError) as error:
                    fault = error
            if fault is not None and which not in self.worked:
                raise fault
            return found

        if not self.whole.get(which, True):
            return points()
        try:
            with np.errstate(all="ignore"):
                rows = [np.broadcast_to(np.asarray(v, dtype=np.float64), (n,)) for v in ask(x, u, theta, w)]
            found = np.stack(rows) if rows else np.empty((0, n))
        except Exception:
            # a function of single numbers; what is wrong with it shows below
            self.whole[which] = False
            return points()
        if which in self.whole:
            return found
        # the first call is checked instant by instant: arrays may mean something else to the function
        single = points()
        self.whole[which] = found.shape == single.shape and np.allclose(
            found[:, np.isfinite(single).all(axis=0)],
            single[:, np.isfinite(single).all(axis=0)],
            rtol=1e-12,
            atol=0,
        )
        return single


def _takes(which: str, function: Callable[..., Any]) -> List[str]:
    """Which of `w` and `t` a function takes beside x, u, theta."""
    names = list(inspect.signature(function).parameters)
    if len(names) < 3 or any(name not in ("w", "t") for name in names[3:]):
        raise CallError(f"{which}: takes ({', '.join(names)}), where (x, u, theta) and then w, t are wanted")
    return names[3:]
