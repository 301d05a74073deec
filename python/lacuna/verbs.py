"""The program's commands as functions."""

from __future__ import annotations

import json
import os
import warnings
from typing import Any, Callable, Dict, List, Mapping, Optional, Sequence, Union

from . import _lacuna as native
from . import law
from ._lacuna import CallError
from .model import Model, ModelLike, model_of
from .record import Record, RecordLike, records
from .result import Check, Diagnosis, Estimate, Fit, Look, Plan, Simulation
from .work import Answer, Progress, Remark, settle

_COMMON = """

    Parameters of all functions
    ---------------------------
    inputs, outputs
        Columns for the model's inputs and outputs, in its order; without them they are found by
        name, else by the letters ``u1..`` and ``y1..``.
    rename
        Other names for columns, the old one first.
    repair
        Makes an irregular clock regular.
    seed, threads
        Of random numbers; how many threads work (default: all). The same seed gives the same
        numbers with any number of threads.
    progress
        Called as ``progress(done, doing)`` with ``done`` from 0 to 1; ``False``: silence; by
        default a line in a terminal, a text in a notebook.

    Raises :class:`InputError` for a model or record that is wrong, :class:`CallError` for a call
    that is, :class:`WorkError` where the work fails, each in the program's words. Ctrl-C once ends
    with what is known (the result has ``interrupted``), twice at once.
    """


def _documented(function: Callable[..., Any]) -> Callable[..., Any]:
    function.__doc__ = (function.__doc__ or "").rstrip() + _COMMON
    return function


def _strings(names: Union[None, str, Sequence[str]]) -> List[str]:
    return [names] if isinstance(names, str) else [str(name) for name in names or ()]


class _Call:
    """One call: its settings as JSON, its records, and what it is from."""

    def __init__(self, verb: str, model: Optional[ModelLike], data: Any, settings: Dict[str, Any]) -> None:
        self.progress: Progress = settings.pop("progress", None)
        self.model = None if model is None else model_of(model)
        self.records = records(data)
        for key in ("inputs", "outputs", "only", "without", "fix"):
            if key in settings:
                settings[key] = _strings(settings[key])
        rename: Mapping[str, str] = settings.pop("rename", None) or {}
        settings["rename"] = [[str(old), str(new)] for old, new in rename.items()]
        self.settings = settings
        self.verb = verb
        self.files: List[List[str]] = []
        if self.model is not None and self.model._path:
            self.files.append(["model", self.model._path])
        for record in self.records:
            self.add_file("data", record)

    def add_file(self, role: str, record: Record) -> None:
        if record._path and [role, record._path] not in self.files:
            self.files.append([role, record._path])

    def text(self) -> str:
        known = {key: value for key, value in self.settings.items() if value not in (None, [], False, 0)}
        given = [f"{role}={path!r}" for role, path in self.files]
        given += [f"{key}={value!r}" for key, value in known.items() if key not in ("title", "threads")]
        extra = {"command": f"lacuna.{self.verb}({', '.join(given)})", "files": self.files}
        return json.dumps({**self.settings, **extra}, default=lambda value: value.tolist())

    def tables(self) -> List[native.Table]:
        return [record._table for record in self.records]

    @property
    def own(self) -> native.Model:
        """The model, where there has to be one."""
        if self.model is None:
            raise CallError(f"{self.verb}: no model was given")
        return self.model._native

    def settle(self, start: Callable[[], native.Job]) -> Answer:
        slow = []
        if self.model is not None and self.model._native.is_written:
            slow.append(law.slow(self.model._untraced))
            warnings.warn(slow[0], Remark, stacklevel=4)
        answer = settle(start(), self.progress)
        answer[4].extend(slow)
        return answer


def _only(record: RecordLike) -> Record:
    found = records(record)
    if len(found) != 1:
        raise CallError(f"{len(found)} records, where one is wanted")
    return found[0]


@_documented
def simulate(
    model: ModelLike,
    record: RecordLike,
    *,
    init: Optional[int] = None,
    inputs: Sequence[str] = (),
    outputs: Sequence[str] = (),
    rename: Optional[Mapping[str, str]] = None,
    repair: bool = False,
    threads: Optional[int] = None,
    progress: Progress = None,
) -> Simulation:
    """Simulates a model along the inputs of a record (a free run).

    The initial state is estimated from the first ``init`` samples, which the figures leave out;
    ``init=0`` holds the model's own, and without it as many are taken as the start's influence
    lasts. Outputs that the record holds are compared.
    """
    call = _Call("simulate", model, _only(record), {k: v for k, v in locals().items() if k not in ("model", "record")})
    table = call.records[0]._table
    return Simulation(call.settle(lambda: native.simulate(call.own, table, call.text())))


@_documented
def estimate(
    model: Optional[ModelLike],
    record: Union[RecordLike, Sequence[RecordLike]],
    *,
    fix: Sequence[str] = (),
    optimiser: Union[None, str, Mapping[str, Any]] = None,
    order: Optional[int] = None,
    sampling_time: Optional[float] = None,
    inputs: Sequence[str] = (),
    outputs: Sequence[str] = (),
    rename: Optional[Mapping[str, str]] = None,
    repair: bool = False,
    seed: int = 0,
    threads: Optional[int] = None,
    progress: Progress = None,
) -> Estimate:
    """Fits the free parameters of a model to one record or several, with intervals.

    ``model=None`` makes a linear model of the records alone, of the given ``order`` or of one
    that the records tell; ``sampling_time`` (s) is for records without a clock. ``fix`` holds
    parameters; ``optimiser`` is a name or its settings as in ``lacuna estimate --optimiser``.
    """
    given = {k: v for k, v in locals().items() if k not in ("model", "record")}
    if isinstance(optimiser, str):
        given["optimiser"] = {optimiser: {}}
    call = _Call("estimate", model, record, given)
    if call.model is None:
        return Estimate(call.settle(lambda: native.linear(call.tables(), call.text())))
    return Estimate(call.settle(lambda: native.estimate(call.own, call.tables(), call.text())))


@_documented
def check(
    model: ModelLike,
    record: Union[RecordLike, Sequence[RecordLike]],
    *,
    level: float = 0.01,
    memory: Optional[str] = None,
    inputs: Sequence[str] = (),
    outputs: Sequence[str] = (),
    rename: Optional[Mapping[str, str]] = None,
    repair: bool = False,
    threads: Optional[int] = None,
    progress: Progress = None,
) -> Check:
    """Asks whether records reject a model, at a level between 0 and 1; ``memory`` as in ``diagnose``."""
    if not 0 < level < 1:
        raise CallError(f"level is {level}, and a probability between 0 and 1 is wanted")
    call = _Call("check", model, record, {k: v for k, v in locals().items() if k not in ("model", "record")})
    return Check(call.settle(lambda: native.check(call.own, call.tables(), call.text())))


@_documented
def diagnose(
    model: Optional[ModelLike],
    record: Union[RecordLike, Sequence[RecordLike]],
    test: Optional[RecordLike] = None,
    *,
    only: Sequence[str] = (),
    without: Sequence[str] = (),
    fix: Sequence[str] = (),
    max_causes: int = 5,
    memory: Optional[str] = None,
    init: Optional[int] = None,
    sampling_time: Optional[float] = None,
    inputs: Sequence[str] = (),
    outputs: Sequence[str] = (),
    rename: Optional[Mapping[str, str]] = None,
    repair: bool = False,
    seed: int = 0,
    threads: Optional[int] = None,
    progress: Progress = None,
    out: Union[None, str, "os.PathLike[str]"] = None,
) -> Diagnosis:
    """Shows what a model gets wrong on records, names the cause, extends the model, measures the gain.

    A record is split by time, 70 % to fit and 30 % to choose; ``test`` is touched once, for
    scoring, and without it the last 20 % are kept for that. ``model=None`` estimates a linear
    model first and says what that gets wrong. ``only`` and ``without`` name effects, ``fix``
    parameters. ``memory`` is what it may take, such as ``"2GB"`` (half of the machine's without it);
    what does not fit is left out by rule and said. ``out`` is a folder for the files that the
    program writes.
    """
    title = "a linear model of the record"
    given = {k: v for k, v in locals().items() if k not in ("model", "record", "test", "out")}
    call = _Call("diagnose", model, record, given)
    if call.model is not None:
        given["title"] = call.model._path or "a model"
    tested = None if test is None else _only(test)
    if tested is not None:
        call.add_file("test", tested)
    table = None if tested is None else tested._table
    own = None if call.model is None else call.own
    found = Diagnosis(call.settle(lambda: native.diagnose(own, call.tables(), table, call.text())))
    if out is not None:
        found.save(out)
    return found


@_documented
def fit(
    model: ModelLike,
    record: Union[RecordLike, Sequence[RecordLike]],
    *,
    recipe: Optional[Mapping[str, Any]] = None,
    validate: Union[None, RecordLike, Sequence[RecordLike]] = None,
    test: Optional[RecordLike] = None,
    inputs: Sequence[str] = (),
    outputs: Sequence[str] = (),
    rename: Optional[Mapping[str, str]] = None,
    repair: bool = False,
    seed: int = 0,
    threads: Optional[int] = None,
    progress: Progress = None,
) -> Fit:
    """Trains a learned part beside a model, and an encoder of its initial states.

    ``recipe`` has the keys of ``lacuna fit --config``: ``structure``, ``encoder``,
    ``initialiser``, ``training``. Without ``validate`` the last 20 % of each record are kept for
    validation.
    """
    given = {k: v for k, v in locals().items() if k not in ("model", "record", "validate", "test")}
    call = _Call("fit", model, record, given)
    if call.own.is_written:
        raise CallError("a learned part needs the derivatives of its model: write the equations as [model.equations]")
    kept = [] if validate is None else [each._table for each in records(validate)]
    table = None if test is None else _only(test)._table
    return Fit(call.settle(lambda: native.fit(call.own, call.tables(), kept, table, call.text())))


@_documented
def plan(
    model: ModelLike,
    record: Union[RecordLike, Sequence[RecordLike]],
    *,
    only: Sequence[str] = (),
    fix: Sequence[str] = (),
    inputs: Sequence[str] = (),
    outputs: Sequence[str] = (),
    rename: Optional[Mapping[str, str]] = None,
    repair: bool = False,
    threads: Optional[int] = None,
    progress: Progress = None,
) -> Plan:
    """Says what records can see and tell apart, and which experiment would tell more."""
    call = _Call("plan", model, record, {k: v for k, v in locals().items() if k not in ("model", "record")})
    return Plan(call.settle(lambda: native.plan(call.own, call.tables(), call.text())))


@_documented
def look(
    record: Union[RecordLike, Sequence[RecordLike]],
    model: Optional[ModelLike] = None,
    *,
    sampling_time: Optional[float] = None,
    inputs: Sequence[str] = (),
    outputs: Sequence[str] = (),
    rename: Optional[Mapping[str, str]] = None,
    repair: bool = False,
    threads: Optional[int] = None,
    progress: Progress = None,
) -> Look:
    """Looks at records before any model; with a model, at the force that it leaves unexplained."""
    call = _Call("look", model, record, {k: v for k, v in locals().items() if k not in ("model", "record")})
    own = None if call.model is None else call.own
    return Look(call.settle(lambda: native.look(own, call.tables(), call.text())), call.records)
