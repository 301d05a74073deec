"""Waiting for work: progress, Ctrl-C, and what was noticed on the way."""

from __future__ import annotations

import sys
import time
import warnings
from typing import Any, Callable, Dict, List, Optional, Tuple, Union

from ._lacuna import Job
from ._lacuna import Model as NativeModel

#: Called with how much is done, from 0 to 1, and what is being done; ``False``: nobody is told.
Progress = Union[None, bool, Callable[[float, str], None]]
#: Document, arrays, texts, model, remarks.
Answer = Tuple[str, Dict[str, Any], Dict[str, str], Optional[NativeModel], List[str]]

#: Seconds between two looks at how far the work is.
_PAUSE = 0.1
#: Work that is over sooner is not told about.
_PATIENCE = 0.5


class Remark(UserWarning):
    """Something that was noticed in a record or a model without being an error."""


class _Line:
    """Progress as one line: rewritten in a terminal, one plain text in a notebook."""

    def __init__(self) -> None:
        self.started = time.monotonic()
        self.shown: Any = None
        self.handle: Any = None
        self.notebook = _in_notebook()
        self.terminal = not self.notebook and sys.stderr is not None and sys.stderr.isatty()

    def __call__(self, done: float, doing: str) -> None:
        if not (self.notebook or self.terminal) or time.monotonic() - self.started < _PATIENCE:
            return
        text = f"{100 * done:3.0f} %  {doing}"
        if text == self.shown:
            return
        self.shown = text
        if self.terminal:
            sys.stderr.write(f"\r\x1b[K{text}")
            sys.stderr.flush()
        else:
            import IPython.display as notebook

            bundle = {"text/plain": text}
            if self.handle is None:
                show: Any = notebook.display
                self.handle = show(bundle, raw=True, display_id=True)
            else:
                self.handle.update(bundle, raw=True)

    def close(self) -> None:
        if self.terminal and self.shown is not None:
            sys.stderr.write("\r\x1b[K")
            sys.stderr.flush()
        if self.handle is not None:
            self.handle.update({"text/plain": ""}, raw=True)


def _in_notebook() -> bool:
    ipython = sys.modules.get("IPython")
    shell = ipython.get_ipython() if ipython is not None else None
    return shell is not None and hasattr(shell, "kernel")


def settle(job: Job, progress: Progress) -> Answer:
    """Waits for a job and takes its result.

    The first Ctrl-C asks the work to end with what is known: the result then says
    ``interrupted``. A second one, or work that knows nothing half done, raises
    ``KeyboardInterrupt``.
    """
    line = _Line() if progress is None or progress is True else None
    own = progress if callable(progress) else None
    tell: Optional[Callable[[float, str], None]] = line if line is not None else own
    asked = False
    try:
        while True:
            try:
                ended = job.wait(_PAUSE)
                if tell is not None:
                    tell(*job.course())
                if ended:
                    break
            except KeyboardInterrupt:
                job.stop()
                if asked:
                    raise
                asked = True
                print("stopping with what is known; Ctrl-C again ends at once", file=sys.stderr)
            except BaseException:
                job.stop()
                raise
    finally:
        if line is not None:
            line.close()
    answer = job.result()
    if asked and '"interrupted":true' not in answer[0].replace(" ", ""):
        raise KeyboardInterrupt
    for remark in answer[4]:
        warnings.warn(remark, Remark, stacklevel=4)
    return answer
