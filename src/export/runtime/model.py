"""One sample of @TS@ s per step. Written by `lacuna export`; needs numpy."""

import numpy as np


class Model:
    """@NAME@: `Model().simulate(u)` gives the outputs along inputs of shape (samples, inputs)."""

    SAMPLING_TIME = @TS@
    INPUTS = @INPUTS@
    OUTPUTS = @OUTPUTS@
    PARAMETERS = {
        @PARAMETERS@
    }
    INITIAL = @STATES@
    _DEPTHS = @DEPTHS@

    def __init__(self, parameters=None):
        """`parameters`: names and values of those that are not as in PARAMETERS."""
        values = dict(self.PARAMETERS)
        for name, value in (parameters or {}).items():
            if name not in values:
                raise KeyError(f"{name} is no parameter; there are: {', '.join(values)}")
            values[name] = value
        self._p = np.array(list(values.values()), dtype=float)
        self._c = np.zeros(@PREPARED@)
        with np.errstate(all="ignore"):
            self._prepare()
        self.reset()

    def reset(self):
        """States at their start."""
        self.x = np.array(self.INITIAL, dtype=float)
        self._lines = [[] for _ in self._DEPTHS]
        self._started = 0.0
        self.sample = 0

    def output(self, u):
        """Outputs at this sample, shape (outputs,), for inputs of shape (inputs,)."""
        u = np.asarray(u, dtype=float)
        with np.errstate(all="ignore"):
            return self._outputs(u, u, 0)

    def step(self, u, u_next=None):
        """Outputs at this sample; then on to the next one.

        `u_next` are the inputs there; they count where the model's hold is of first order.
        """
        u = np.asarray(u, dtype=float)
        u_next = u if u_next is None else np.asarray(u_next, dtype=float)
        with np.errstate(all="ignore"):
            y = self._outputs(u, u_next, 0)
            for j in range(@SUBSTEPS@):
                self._advance(u, u_next, j)
        self.sample += 1
        return y

    def simulate(self, u):
        """Outputs, shape (samples, outputs), from the start along inputs (samples, inputs)."""
        u = np.asarray(u, dtype=float)
        if u.ndim == 1:
            u = u[:, np.newaxis]
        if u.ndim != 2 or u.shape[1] != len(self.INPUTS):
            raise ValueError(f"inputs of shape (samples, {len(self.INPUTS)}) are needed, not {u.shape}")
        self.reset()
        last = len(u) - 1
        rows = [self.step(row, u[min(k + 1, last)]) for k, row in enumerate(u)]
        return np.array(rows).reshape(len(u), len(self.OUTPUTS))

    def _past(self, line, steps, now):
        values = self._lines[line]
        if not steps > 0:
            return now
        known = min(len(values), self._DEPTHS[line] - 1)
        back = int(min(steps, known))
        return values[-back] if back > 0 else now

    def _past_held(self, line, back, now):
        whole = np.floor(back)
        part = back - whole
        newer, older = self._past(line, whole, now), self._past(line, whole + 1, now)
        return newer if part == 0 else (1 - part) * newer + part * older

    def _past_line(self, line, at, now, end):
        if at >= 0:
            return now + at * (end - now)
        whole = np.floor(-at)
        newer, older = self._past(line, whole, now), self._past(line, whole + 1, now)
        return newer + (-at - whole) * (older - newer)

    def _prepare(self):
        p, c = self._p, self._c
        @PREPARE@

    def _outputs(self, u, u_next, j):
        p, c, x = self._p, self._c, self.x
        t = self.sample * @TS@ + j * @H@
        y = np.zeros(@NY@)
        @OUTPUT@
        return y

    def _advance(self, u, u_next, j):
        p, c, x = self._p, self._c, self.x
        t = self.sample * @TS@ + j * @H@
        next = np.zeros(@NN@)
        @ADVANCE@
        self.x = next[:@NX@]
        for line, depth, value in zip(self._lines, self._DEPTHS, next[@NX@:]):
            line.append(value)
            del line[:-depth]
        self._started = 1.0
