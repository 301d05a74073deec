"""Results as plain objects: attributes, the program's JSON as a dictionary, tables, pictures."""

from __future__ import annotations

import copy
import html
import json
import os
from pathlib import Path
from typing import TYPE_CHECKING, Any, Dict, List, Optional, Tuple, Union

if TYPE_CHECKING:
    from .model import Model
    from .record import Record
    from .work import Answer


class Fields(Dict[str, Any]):
    """A dictionary whose entries are attributes too; what stands in it reads the same way."""

    def __init__(self, entries: Dict[str, Any]) -> None:
        super().__init__({key: _fields(value) for key, value in entries.items()})

    def __getattr__(self, name: str) -> Any:
        try:
            return self[name]
        except KeyError:
            raise AttributeError(f"there is no `{name}` here; there are: {', '.join(self)}") from None

    def __dir__(self) -> List[str]:
        return [*super().__dir__(), *self]


def _fields(value: Any) -> Any:
    if isinstance(value, dict):
        return Fields(value)
    if isinstance(value, list):
        return [_fields(each) for each in value]
    return value


class Result:
    """What a function found.

    Every key of the program's JSON document is an attribute; :meth:`to_dict` is the document
    itself. ``noticed`` lists what was noticed in the records.
    """

    def __init__(self, answer: "Answer") -> None:
        text, self._arrays, self._texts, native, self.noticed = answer
        self._document: Dict[str, Any] = json.loads(text)
        self._fields = Fields(self._document)
        self._model: Optional["Model"] = None
        if native is not None:
            from .model import Model

            self._model = Model(native)

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_"):
            raise AttributeError(name)
        return getattr(self._fields, name)

    def __dir__(self) -> List[str]:
        return [*super().__dir__(), *self._document]

    def to_dict(self) -> Dict[str, Any]:
        """The program's JSON document as a dictionary."""
        return copy.deepcopy(self._document)

    @property
    def headline(self) -> str:
        """The result in a sentence."""
        return self._texts.get("headline", type(self).__name__)

    def save(self, folder: Union[str, "os.PathLike[str]"]) -> List[Path]:
        """Writes the files that the program writes into a folder, which is made; gives their paths."""
        into = Path(folder)
        into.mkdir(parents=True, exist_ok=True)
        written = []
        for name, text in self._texts.items():
            if "." in name:
                (into / name).write_text(text, encoding="utf-8")
                written.append(into / name)
        return written

    def plot(self, ax: Any = None) -> Any:
        """Draws the result; needs matplotlib. Gives the axes."""
        from . import plots

        return getattr(plots, type(self).__name__.lower())(self, ax)

    def __str__(self) -> str:
        return self.headline

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self.headline})"

    def _rows(self) -> Tuple[List[str], List[List[str]]]:
        """Head and lines of the table in a notebook."""
        return [], []

    def _repr_html_(self) -> str:
        head, rows = self._rows()
        lines = "<br>".join(html.escape(line) for line in self.headline.splitlines())
        if not rows:
            return f"<p><b>{lines}</b></p>"

        def line(tag: str, cells: List[str]) -> str:
            return "<tr>" + "".join(f"<{tag}>{html.escape(c)}</{tag}>" for c in cells) + "</tr>"

        return f"<p><b>{lines}</b></p><table>{line('th', head)}{''.join(line('td', r) for r in rows)}</table>"


def _number(value: Optional[float]) -> str:
    return "" if value is None else f"{value:.4g}"


class Simulation(Result):
    """A free run along a record."""

    @property
    def time(self) -> Any:
        """Time of every sample, s, shape ``(n,)``."""
        return self._arrays["time"]

    @property
    def outputs(self) -> Dict[str, Any]:
        """Every simulated output, shape ``(n,)``, in its unit; NaN where nothing could be simulated."""
        return self._of("simulated")

    @property
    def measured(self) -> Dict[str, Any]:
        """Every measured output of the record."""
        return self._of("measured")

    def _of(self, what: str) -> Dict[str, Any]:
        lead = what + ":"
        return {k[len(lead) :]: v for k, v in self._arrays.items() if k.startswith(lead)}

    @property
    def headline(self) -> str:
        """The figures in a line."""
        each = [f"{name}: RMSE {_number(m.rmse)}, fit {_number(m.fit_percent)} %" for name, m in self.metrics.items()]
        if self.diverged_at is not None:
            each.append(f"diverges at sample {self.diverged_at}")
        return "; ".join(each) or "a simulation of " + ", ".join(self.outputs)

    def _rows(self) -> Tuple[List[str], List[List[str]]]:
        rows = [[n, _number(m.rmse), _number(m.nrmse), _number(m.fit_percent)] for n, m in self.metrics.items()]
        return ["output", "RMSE", "NRMSE", "fit %"], rows


class Estimate(Result):
    """Estimated parameters; :attr:`model` has them."""

    @property
    def model(self) -> "Model":
        """The model with the estimated values."""
        assert self._model is not None
        return self._model

    def save(self, folder: Union[str, "os.PathLike[str]"]) -> List[Path]:
        """Writes ``model.toml`` into a folder, which is made; gives its path."""
        path = Path(folder) / "model.toml"
        path.parent.mkdir(parents=True, exist_ok=True)
        self.model.save(path)
        return [path]

    @property
    def headline(self) -> str:
        """How much better the model fits."""
        nrmse = self._fields["nrmse"]
        order = f"a linear model of order {self.order}: " if "order" in self._document else ""
        return f"{order}NRMSE {_number(nrmse.before)} before, {_number(nrmse.after)} after"

    def _rows(self) -> Tuple[List[str], List[List[str]]]:
        rows = [[p.name, _number(p.value), _number(p.std_error), p.unit] for p in self.parameters]
        return ["parameter", "value", "std error", "unit"], rows


class Check(Result):
    """Whether records reject a model; ``rejected`` is ``None`` where somebody stopped the check."""


class Diagnosis(Result):
    """What a model gets wrong, by name."""

    @property
    def extended(self) -> "Model":
        """The model extended by what was found."""
        assert self._model is not None
        return self._model

    @property
    def details(self) -> List[str]:
        """What the program says below the headline."""
        return self._texts.get("details", "").splitlines()

    @property
    def page(self) -> str:
        """The report: one HTML page that needs nothing else."""
        return self._texts["report.html"]

    @property
    def time(self) -> Any:
        """Time of every sample of the estimation record after its first, s, shape ``(n,)``."""
        return self._arrays["time"]

    @property
    def series(self) -> Dict[str, Dict[str, Any]]:
        """``measured``, ``before`` and ``after`` by output, shape ``(n,)``, on the estimation record."""
        found: Dict[str, Dict[str, Any]] = {}
        for key, values in self._arrays.items():
            what, _, name = key.partition(":")
            if what in ("measured", "before", "after"):
                found.setdefault(name, {})[what] = values
        return found

    @property
    def test_series(self) -> Dict[str, Dict[str, Any]]:
        """The same on the test record, or on the part that was kept for the test: nothing was fitted to it."""
        found: Dict[str, Dict[str, Any]] = {}
        for key, values in self._arrays.items():
            what, _, name = key.partition(":")
            if what.startswith("test ") and len(values):
                found.setdefault(name, {})[what[len("test ") :]] = values
        return found

    def __str__(self) -> str:
        return "\n".join([self.headline, *self.details])

    def _rows(self) -> Tuple[List[str], List[List[str]]]:
        rows = [
            [c.effect, c.into, c.of or "", _number(c.probability), _number(c.error_removed)] for c in self.causes
        ]
        return ["effect", "into", "of", "probability", "error removed"], rows


class Fit(Result):
    """A trained model: a learned part beside the model that was given."""

    @property
    def model(self) -> "Model":
        """The trained model."""
        assert self._model is not None
        return self._model

    @property
    def history(self) -> Dict[str, Any]:
        """``epoch``, ``loss`` and ``rate`` of every epoch, shape ``(epochs + 1,)``."""
        return {key: self._arrays[key] for key in ("epoch", "loss", "rate")}

    @property
    def series(self) -> Dict[str, Dict[str, Any]]:
        """``measured``, ``before`` and ``after`` by output on the record that it is scored on."""
        return Diagnosis.series.fget(self)  # type: ignore[attr-defined, no-any-return]

    @property
    def headline(self) -> str:
        """Baseline and trained model, output by output."""
        ((which, before),), ((_, after),) = self.before.items(), self.after.items()
        each = [
            f"{n}: {which} RMSE {_number(before[n].rmse)} -> {_number(after[n].rmse)}"
            for n in before
            if before[n] and after[n]
        ]
        return "; ".join(each) + f" (epoch {self.best_epoch})"


class Plan(Result):
    """What records can see and tell apart, and the experiment that would tell more."""


class Look(Result):
    """A record before any model, or what a model leaves unexplained on it."""

    def __init__(self, answer: "Answer", records: "List[Record]") -> None:
        super().__init__(answer)
        self._looked_at = records
