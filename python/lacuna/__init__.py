"""lacuna: what a model's simulation gets wrong, by name.

>>> import lacuna
>>> model, record, test = lacuna.demo()
>>> found = lacuna.diagnose(model, record, test)
>>> print(found.headline)          # doctest: +SKIP
Dry friction on force_1, 1.505 +- 0.011 N (> 99 % sure); without it more than 99.9 % of the removable error comes back.
>>> found.plot()                   # doctest: +SKIP
>>> found.save("lacuna-out")       # doctest: +SKIP

A :class:`Model` comes from a model file, its text, a dictionary or a Python function; a
:class:`Record` from a file, arrays or a pandas table. :func:`simulate`, :func:`estimate`,
:func:`check`, :func:`diagnose`, :func:`fit`, :func:`plan` and :func:`look` do what the program of
the same name does, and give the same numbers: ``to_dict()`` is the program's JSON document.
"""

from ._lacuna import CallError, Error, InputError, WorkError, __version__
from .model import Model, demo
from .record import Record
from .result import Check, Diagnosis, Estimate, Fit, Look, Plan, Result, Simulation
from .verbs import check, diagnose, estimate, fit, look, plan, simulate
from .work import Remark

__all__ = [
    "CallError",
    "Check",
    "Diagnosis",
    "Error",
    "Estimate",
    "Fit",
    "InputError",
    "Look",
    "Model",
    "Plan",
    "Record",
    "Remark",
    "Result",
    "Simulation",
    "WorkError",
    "__version__",
    "check",
    "demo",
    "diagnose",
    "estimate",
    "fit",
    "look",
    "plan",
    "simulate",
]
