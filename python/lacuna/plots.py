"""Pictures of results; matplotlib is loaded when the first one is drawn."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Iterable, Optional

if TYPE_CHECKING:
    from . import result
    from .record import Record

#: Colours that those tell apart who do not see red and green (Okabe and Ito 2008).
MEASURED, BEFORE, AFTER = "#000000", "#D55E00", "#0072B2"


def _axes(rows: int, ax: Any) -> Any:
    """So many axes below each other, or those that were given."""
    if ax is not None:
        return [ax] * rows
    try:
        import matplotlib.pyplot as plt  # type: ignore[import-not-found, unused-ignore]
    except ImportError as error:
        raise ImportError("pictures need matplotlib\n  try: pip install matplotlib") from error
    _, axes = plt.subplots(rows, 1, sharex=True, squeeze=False, layout="constrained")
    return list(axes[:, 0])


def record(given: "Record", names: Optional[Iterable[str]] = None, ax: Any = None) -> Any:
    chosen = list(names) if names is not None else [name for name in given.names if name != "time"]
    axes = _axes(len(chosen), ax)
    if "time" in given:
        time: Any = given["time"]
        label = "time"
    else:
        step = given.sampling_time or 1.0
        time = [k * step for k in range(len(given))]
        label = "time in s" if given.sampling_time else "sample"
    for axis, name in zip(axes, chosen):
        axis.plot(time, given[name], color=MEASURED, linewidth=0.8)
        axis.set_ylabel(_label(name, given.units[name]))
    axes[-1].set_xlabel(label)
    return axes


def simulation(given: "result.Simulation", ax: Any = None) -> Any:
    outputs = given.outputs
    axes = _axes(len(outputs), ax)
    for axis, (name, values) in zip(axes, outputs.items()):
        if name in given.measured:
            axis.plot(given.time, given.measured[name], color=MEASURED, linewidth=0.8, label="measured")
        axis.plot(given.time, values, color=AFTER, linewidth=0.8, label="simulated")
        axis.set_ylabel(name)
        axis.legend(loc="upper right")
    axes[-1].set_xlabel("time in s")
    return axes


def _before_and_after(given: Any, series: Any, ax: Any, after: str) -> Any:
    axes = _axes(len(series), ax)
    looks = (("measured", "measured", MEASURED), ("before", "model", BEFORE), ("after", after, AFTER))
    for axis, (name, values) in zip(axes, series.items()):
        for what, label, colour in looks:
            if what in values:
                axis.plot(given._arrays["time"], values[what], color=colour, linewidth=0.8, label=label)
        axis.set_ylabel(name)
        axis.legend(loc="upper right")
    axes[-1].set_xlabel("time in s")
    return axes


def diagnosis(given: "result.Diagnosis", ax: Any = None) -> Any:
    """Measured, before and after; beside it the law of the first cause, where it has a curve."""
    if ax is not None or "law z:0" not in given._arrays or not len(given._arrays["law z:0"]):
        return _before_and_after(given, given.series, ax, "extended model")
    rows = len(given.series)
    axes = _axes(rows + 1, None)
    _before_and_after_on(given, axes[:rows])
    law, arrays = axes[rows], given._arrays
    # the law has an axis of its own, not time
    figure = law.get_figure()
    law.remove()
    law = figure.add_subplot(rows + 1, 1, rows + 1)
    z, w, error = arrays["free z:0"], arrays["free w:0"], arrays["free std:0"]
    if len(z):
        law.errorbar(z, w, yerr=1.96 * error, color=MEASURED, fmt="o", markersize=3, label="from the data")
    if len(arrays["band low:0"]):
        law.fill_between(arrays["law z:0"], arrays["band low:0"], arrays["band high:0"], color=AFTER, alpha=0.2)
    law.plot(arrays["law z:0"], arrays["law w:0"], color=AFTER, label=given.causes[0].effect)
    law.set_xlabel(given.causes[0].of or "")
    law.set_ylabel(given.causes[0].into)
    law.legend()
    return [*axes[:rows], law]


def _before_and_after_on(given: Any, axes: Any) -> None:
    for axis, (name, values) in zip(axes, given.series.items()):
        _before_and_after(given, {name: values}, axis, "extended model")


def fit(given: "result.Fit", ax: Any = None) -> Any:
    """The loss of every epoch, and the trained model on the record that it is scored on."""
    if ax is not None:
        ax.semilogy(given.history["epoch"], given.history["loss"], color=AFTER)
        ax.set_xlabel("epoch")
        ax.set_ylabel("loss")
        return [ax]
    return _before_and_after(given, given.series, None, "trained model")


def estimate(given: "result.Estimate", ax: Any = None) -> Any:
    """Every parameter with its 95 % interval, over its value."""
    axis = _axes(1, ax)[0]
    known = [p for p in given.parameters if p.std_error is not None and p.value]
    for k, parameter in enumerate(known):
        axis.errorbar(1.0, k, xerr=1.96 * abs(parameter.std_error / parameter.value), color=AFTER, fmt="o")
        if parameter.get("from") is not None:
            axis.plot(parameter["from"] / parameter.value, k, "x", color=BEFORE)
    axis.set_yticks(range(len(known)), [p.name for p in known])
    axis.set_xlabel("over the estimate (x: before)")
    return [axis]


def check(given: "result.Check", ax: Any = None) -> Any:
    """The probability of data as far from the model, beside the level."""
    axis = _axes(1, ax)[0]
    axis.barh([0], [max(given.p_value or 0.0, 1e-16)], color=BEFORE if given.rejected else AFTER)
    axis.axvline(given.level, color=MEASURED, linestyle="--")
    axis.set_xscale("log")
    axis.set_yticks([])
    axis.set_xlabel("probability of data as far from the model, if it were right")
    return [axis]


def plan(given: "result.Plan", ax: Any = None) -> Any:
    """How much of each cause's trace nothing else imitates."""
    axis = _axes(1, ax)[0]
    seen = [c for c in given.causes if c.kappa is not None][:30]
    axis.barh(range(len(seen)), [c.kappa for c in seen], color=AFTER)
    axis.set_yticks(range(len(seen)), [f"{c.effect} into {c.into}" for c in seen], fontsize=7)
    axis.set_xlabel("share of its trace that nothing else imitates")
    return [axis]


def look(given: "result.Look", ax: Any = None) -> Any:
    """The first record over time."""
    return record(given._looked_at[0], None, ax)


def _label(name: str, unit: str) -> str:
    return f"{name} in {unit}" if unit else name
