"""Records: inputs and outputs of a machine, sampled at one regular step."""

from __future__ import annotations

import html
import os
from typing import Any, Dict, Iterable, List, Mapping, Optional, Tuple, Union

import numpy as np

from ._lacuna import Table
from ._lacuna import CallError

#: What every function takes for a record.
RecordLike = Union["Record", str, "os.PathLike[str]", Mapping[str, Any], Any]


class Record:
    """Named columns of one record.

    Parameters
    ----------
    data
        A path (CSV, ``.npy``, ``.npz``, ``.mat``; packed by gzip or not), a mapping of names to
        arrays of shape ``(n,)``, or a pandas ``DataFrame``. A name may carry its unit in brackets,
        ``"force [N]"``; a column ``time`` (s) says the step. A ``DataFrame`` without that column
        whose index is a time (of dates, of durations, of numbers) gives its index as the time, in
        seconds after its first row if it is of dates.
    sampling_time
        The step in s, where no column ``time`` says it.
    units
        Units by name, where the names do not carry them.

    Missing values are NaN. An output that is missing carries no weight; an input that is missing
    ends a stretch. Files and arrays are matched with a model when they are used: by name, else
    ``u1, u2..`` and ``y1, y2..`` by position; units are converted or refused.
    """

    def __init__(
        self,
        data: Any,
        *,
        sampling_time: Optional[float] = None,
        units: Optional[Mapping[str, str]] = None,
    ) -> None:
        if isinstance(data, (str, os.PathLike)):
            if sampling_time is not None or units:
                raise CallError("a file says its own step and units; sampling_time= and units= are for arrays")
            tables = Table.open(data)
            if len(tables) != 1:
                raise CallError(f"{os.fspath(data)}: holds {len(tables)} records; Record.all reads them")
            self._table = tables[0]
            self._path: Optional[str] = os.fspath(data)
            return
        columns = _columns(data)
        named = [(_header(str(name), units), _numbers(str(name), values)) for name, values in columns]
        self._table = Table.of_columns("arrays", named, sampling_time)
        self._path = None

    @classmethod
    def all(cls, path: Union[str, "os.PathLike[str]"]) -> List["Record"]:
        """All records of a file that holds several."""
        return [cls._of(table, os.fspath(path)) for table in Table.open(path)]

    @classmethod
    def _of(cls, table: Table, path: Optional[str] = None) -> "Record":
        record = cls.__new__(cls)
        record._table, record._path = table, path
        return record

    @property
    def source(self) -> str:
        """The file that it is from, or ``"arrays"``."""
        return self._table.source

    @property
    def names(self) -> List[str]:
        """Names of the columns."""
        return [name for name, _ in self._table.names()]

    @property
    def units(self) -> Dict[str, str]:
        """Unit of every column, empty where there is none."""
        return dict(self._table.names())

    @property
    def sampling_time(self) -> Optional[float]:
        """The step in s: of the column ``time``, else as stated; ``None`` where neither says it."""
        if "time" in self.names and len(self) > 1:
            time = self["time"]
            return float((time[-1] - time[0]) / (len(self) - 1))
        return self._table.step

    def __len__(self) -> int:
        return self._table.rows

    def __getitem__(self, name: str) -> "np.ndarray[Any, np.dtype[np.float64]]":
        """The values of a column, shape ``(n,)``, in the column's unit: a view that cannot be written to."""
        return self._table.column(name)

    def __contains__(self, name: object) -> bool:
        return name in self.names

    def plot(self, names: Optional[Iterable[str]] = None, ax: Any = None) -> Any:
        """Draws columns over time; needs matplotlib. Gives the axes."""
        from .plots import record

        return record(self, names, ax)

    def __repr__(self) -> str:
        columns = ", ".join(f"{n} [{u}]" if u else n for n, u in self._table.names())
        return f"Record({self.source}: {len(self)} samples of {columns})"

    def _repr_html_(self) -> str:
        rows = "".join(
            f"<tr><td>{html.escape(name)}</td><td>{html.escape(unit)}</td></tr>"
            for name, unit in self._table.names()
        )
        return (
            f"<b>{html.escape(self.source)}</b>, {len(self)} samples"
            f"<table><tr><th>column</th><th>unit</th></tr>{rows}</table>"
        )


def _header(name: str, units: Optional[Mapping[str, str]]) -> str:
    unit = (units or {}).get(name)
    return f"{name} [{unit}]" if unit else name


def _numbers(name: str, values: Any) -> "np.ndarray[Any, np.dtype[np.float64]]":
    array = np.asarray(values)
    if array.ndim != 1:
        raise CallError(f"`{name}`: an array of shape {array.shape}, where (n,) is wanted")
    try:
        return np.ascontiguousarray(array, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise CallError(f"`{name}`: found values that are no numbers ({error})") from None


def _columns(data: Any) -> List[Tuple[Any, Any]]:
    if hasattr(data, "columns") and hasattr(data, "index"):
        columns = [(name, _plain(data[name])) for name in data.columns]
        if "time" not in data.columns and (time := _time_of(data.index)) is not None:
            columns.insert(0, ("time", time))
        return columns
    if isinstance(data, Mapping):
        return list(data.items())
    raise CallError(
        f"a record cannot be made of {type(data).__name__}\n  try: a path, a dictionary of arrays, a pandas DataFrame"
    )


def _plain(series: Any) -> Any:
    """The values of a pandas column; what is missing is NaN."""
    if series.dtype.kind in "fiub":
        return series.to_numpy()
    return series.to_numpy(dtype=np.float64, na_value=np.nan)


def _time_of(index: Any) -> Any:
    kind = index.dtype.kind
    if kind == "M":
        return (index - index[0]).total_seconds().to_numpy()
    if kind == "m":
        return index.total_seconds().to_numpy()
    # an index of whole numbers counts rows
    return index.to_numpy() if kind == "f" else None


def records(data: Any) -> List[Record]:
    """One record or several, of whatever can be one."""
    many = data if isinstance(data, (list, tuple)) else [data]
    found: List[Record] = []
    for one in many:
        if isinstance(one, Record):
            found.append(one)
        elif isinstance(one, (str, os.PathLike)):
            found.extend(Record.all(one))
        else:
            found.append(Record(one))
    if not found:
        raise CallError("no record was given")
    return found
