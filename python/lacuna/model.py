"""Models: how a machine is supposed to move."""

from __future__ import annotations

import html
import json
import os
import warnings
from pathlib import Path
from typing import Any, Callable, Dict, List, Mapping, Optional, Tuple, Union

from . import law, traced
from ._lacuna import CallError, InputError
from ._lacuna import Model as Native
from ._lacuna import demo as _demo
from .nodes import Untraceable
from .record import Record
from .result import Fields
from .work import Remark

#: What every function takes for a model.
ModelLike = Union["Model", str, "os.PathLike[str]", Mapping[str, Any]]


class Model:
    """A model, how it is sampled, and the effects that extend it.

    Made by :meth:`from_file`, :meth:`from_toml`, :meth:`from_dict` or :meth:`from_function`. Its
    methods are the functions of the module with the model as their first argument.
    """

    def __init__(self, native: Native, path: Optional[str] = None) -> None:
        self._native = native
        self._path = path
        #: Why a function is called at every step, where one is.
        self._untraced = ""
        self._signals = Fields(json.loads(native.signals()))

    @classmethod
    def from_file(cls, path: Union[str, "os.PathLike[str]"]) -> "Model":
        """Reads a model file, TOML or JSON.

        Raises :class:`InputError` with file, line, column and key of what is wrong.
        """
        return cls(Native.from_file(path), os.fspath(path))

    @classmethod
    def from_toml(cls, text: str) -> "Model":
        """Reads the text of a model file."""
        return cls(Native.from_text(text, "text", False))

    @classmethod
    def from_dict(cls, model: Mapping[str, Any]) -> "Model":
        """Takes a model file's keys as a dictionary."""
        text = json.dumps(model, default=lambda value: value.tolist())
        return cls(Native.from_text(text, "dict", True))

    @classmethod
    def from_function(
        cls,
        derivative: Optional[Callable[..., Any]] = None,
        *,
        states: Any = (),
        inputs: Any,
        outputs: Any,
        parameters: Any = (),
        output: Optional[Callable[..., Any]] = None,
        channels: Any = (),
        coordinates: Any = (),
        coordinate: Optional[Callable[..., Any]] = None,
        discrete: bool = False,
        sampling_time: Optional[float] = None,
        integrator: Optional[Mapping[str, Any]] = None,
        hold: str = "zero",
        trace: bool = True,
    ) -> "Model":
        """A model written in Python.

        The functions are called once with symbols, which gives their equations: the model is then what
        it would be in a model file (:meth:`to_toml` shows it), as fast, and good for every command. That
        needs functions of numpy, of `math`, `min`, `max` and arithmetic, no branches on values, and channels
        that enter linearly. What was read is compared with the function at random points.

        Where it cannot be read, or with ``trace=False``, the function is called at every step: some hundred
        times slower, for :func:`simulate` and :func:`diagnose` alone, in this process only; a warning says
        why.

        Parameters
        ----------
        derivative
            ``f(x, u, theta)`` gives dx/dt, or the next state of a ``discrete`` model: one value per
            state. Arguments are named tuples, ``x.v`` or ``x[1]``; further arguments called ``w``
            (what enters the ``channels``, one value each, 0 in the model as it is) and ``t`` (time
            in s) are given to a function that takes them. Where it is called at every step, it gets
            arrays of shape ``(n,)`` if it understands them (numpy functions), else numbers. Left out
            with the states, where ``output`` is all there is (inverse dynamics).
        states, inputs, outputs, channels, coordinates
            Names, or a dictionary of names to units or to ``{"unit": .., "quantity": ..}``; a state
            may have ``initial``. Dry friction and its kin are looked for on coordinates of the
            quantity ``"velocity"``.
        parameters
            A dictionary of names to values, or to ``{"value": .., "unit": .., "min": .., "max": ..,
            "fixed": ..}``.
        output
            ``f(x, u, theta)`` gives the outputs; without it they are the first states.
        coordinate
            ``f(x, u, theta)`` gives the ``coordinates``; without it they are the states.
        sampling_time, integrator, hold
            As in a model file: s; ``{"method": "rk4", "substeps": 1}``; ``"zero"`` or ``"first"``.
        trace
            Whether the functions are read as equations where they can be. They must then depend on their
            arguments alone.
        """
        declared = {
            "inputs": law.entries("inputs", inputs),
            "states": law.entries("states", states),
            "outputs": law.entries("outputs", outputs),
            "parameters": law.entries("parameters", parameters),
            "channels": law.entries("channels", channels),
            "coordinates": law.entries("coordinates", coordinates),
        }
        law.unique(declared)
        if (coordinate is None) != (not declared["coordinates"]):
            raise CallError("coordinates= and coordinate= go together: names, and the function of their values")
        answers = law.Answers(declared, derivative, output, coordinate)
        sampling: Dict[str, Any] = {"hold": hold}
        if sampling_time is not None:
            sampling["sampling_time"] = sampling_time
        if integrator is not None:
            sampling["integrator"] = dict(integrator)
        why = "trace=False"
        if trace:
            try:
                # what the comparison teaches of a function is not what its use may begin with
                read = law.Answers(declared, derivative, output, coordinate)
                return cls.from_dict({**sampling, "model": {"equations": traced.equations(declared, read, discrete)}})
            except (Untraceable, InputError) as error:
                why = str(error)
        text = json.dumps({"discrete": discrete, **declared}, default=float)
        model = cls(Native.written(text, json.dumps(sampling), answers))
        model._untraced = why
        return model

    @property
    def inputs(self) -> Dict[str, str]:
        """Unit of every input."""
        return {signal.name: signal.unit for signal in self._signals.inputs}

    @property
    def outputs(self) -> Dict[str, str]:
        """Unit of every output."""
        return {signal.name: signal.unit for signal in self._signals.outputs}

    @property
    def states(self) -> Dict[str, Fields]:
        """Unit, quantity and initial value of every state."""
        return {state.name: state for state in self._signals.states}

    @property
    def parameters(self) -> Dict[str, Fields]:
        """Value, unit, bounds of every parameter, and whether it is fixed."""
        return {parameter.name: parameter for parameter in self._signals.parameters}

    @property
    def channels(self) -> Dict[str, str]:
        """Unit of every place where something unmodelled may enter."""
        return {signal.name: signal.unit for signal in self._signals.channels}

    @property
    def coordinates(self) -> Dict[str, str]:
        """Unit of everything that it may depend on."""
        return {signal.name: signal.unit for signal in self._signals.coordinates}

    @property
    def sampling_time(self) -> Optional[float]:
        """The step in s that the model states."""
        value: Optional[float] = self._signals.sampling_time
        return value

    def to_toml(self) -> str:
        """The text of its model file."""
        return self._native.to_toml()

    def save(self, path: Union[str, "os.PathLike[str]"]) -> None:
        """Writes its model file."""
        self._native.save(path, ["Written by lacuna from Python."])

    def export(
        self, folder: Union[str, "os.PathLike[str]"], to: str = "fmu", name: str = "model"
    ) -> List[Path]:
        """Writes the model, its effects included, as a program that needs no lacuna.

        Parameters
        ----------
        folder
            Where the files go; it is made, and files of the same names are replaced.
        to
            ``"fmu"`` (FMI 2.0 and 3.0, co-simulation), ``"c"`` (C99), ``"matlab"`` or ``"python"``;
            each but the first with a test that it is the same simulation.
        name
            Name of functions and files: letters, digits and underscores, a letter first.

        Gives the paths. What holds of the exported model alone is a warning (:class:`Remark`). Units for
        ``"fmu"`` hold a binary where a C compiler is installed, and always the source.
        """
        files, remarks = self._native.export(folder, to, name)
        for remark in remarks:
            warnings.warn(remark, Remark, stacklevel=2)
        return list(files)

    def simulate(self, record: Any, **settings: Any) -> Any:
        """As :func:`lacuna.simulate`."""
        return verbs.simulate(self, record, **settings)

    def estimate(self, record: Any, **settings: Any) -> Any:
        """As :func:`lacuna.estimate`."""
        return verbs.estimate(self, record, **settings)

    def check(self, record: Any, **settings: Any) -> Any:
        """As :func:`lacuna.check`."""
        return verbs.check(self, record, **settings)

    def diagnose(self, record: Any, test: Any = None, **settings: Any) -> Any:
        """As :func:`lacuna.diagnose`."""
        return verbs.diagnose(self, record, test, **settings)

    def fit(self, record: Any, **settings: Any) -> Any:
        """As :func:`lacuna.fit`."""
        return verbs.fit(self, record, **settings)

    def plan(self, record: Any, **settings: Any) -> Any:
        """As :func:`lacuna.plan`."""
        return verbs.plan(self, record, **settings)

    def look(self, record: Any, **settings: Any) -> Any:
        """As :func:`lacuna.look` with a model: what it leaves unexplained."""
        return verbs.look(record, self, **settings)

    def __repr__(self) -> str:
        def listed(signals: Any) -> str:
            return ", ".join(signals) or "nothing"

        where = f"{self._path}: " if self._path else ""
        effects = f", {self._signals.effects} effects" if self._signals.effects else ""
        return (
            f"Model({where}{listed(self.inputs)} -> {listed(self.outputs)}; "
            f"states {listed(self.states)}; parameters {listed(self.parameters)}{effects})"
        )

    def _repr_html_(self) -> str:
        rows = "".join(
            f"<tr><td>{html.escape(p.name)}</td><td>{p.value:.6g}</td><td>{html.escape(p.unit)}</td>"
            f"<td>{'fixed' if p.fixed else ''}</td></tr>"
            for p in self.parameters.values()
        )
        head = "<tr><th>parameter</th><th>value</th><th>unit</th><th></th></tr>"
        return f"<p>{html.escape(repr(self))}</p><table>{head}{rows}</table>"


def model_of(model: ModelLike) -> Model:
    """A model of whatever can be one: a path, a dictionary."""
    if isinstance(model, Model):
        return model
    if isinstance(model, Mapping):
        return Model.from_dict(model)
    if isinstance(model, (str, os.PathLike)):
        return Model.from_file(model)
    raise CallError(f"a model cannot be made of {type(model).__name__}\n  try: a path, a dictionary, a Model")


def demo() -> Tuple[Model, Record, Record]:
    """Two masses between springs, and two records of a machine with something that the model lacks.

    Gives the model, the record to diagnose (3000 samples at 0.05 s) and the one to test on.
    """
    model, record, test = _demo()
    return Model(model), Record._of(record), Record._of(test)


from . import verbs  # noqa: E402  (verbs needs the class above)
