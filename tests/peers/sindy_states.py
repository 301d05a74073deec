#!/usr/bin/env python3
"""Takes an exam by PySINDy, with the true states given: sequentially thresholded least squares.

    tests/peers/sindy_states.py EXAM ANSWERS.json [--cases 1-40] [--lacuna PATH]

The states come from the sealed machine, simulated without noise along the recorded inputs. What one
step of the model, from the true states, does not explain of the next ones is, channel by channel, a
sum of library functions of the coordinates (Brunton, Proctor and Kutz, PNAS 113, 2016), at most five.
"""

import copy
import math
import re
import time
import tomllib

import numpy as np
import pysindy

from exam_folder import simulate, take

FUNCTIONS = {name: getattr(np, name) for name in "sin cos tan sinh cosh tanh exp log sqrt abs sign".split()}
FUNCTIONS |= {"min": np.minimum, "max": np.maximum, "pow": np.power, "pi": math.pi}
THRESHOLD = 0.02  # of the missing force
EXACT = 1e-5  # of a state's change over a sample: what the integrators of two programs differ by


def value(expression, names):
    # names of a model may be words of Python
    own = lambda word: word[0] if word[0] in FUNCTIONS else f"v_{word[0]}"
    text = re.sub(r"(?<![\w.])[A-Za-z_]\w*", own, expression.replace("^", "**"))
    known = FUNCTIONS | {f"v_{name}": numbers for name, numbers in names.items()}
    result = eval(text, {"__builtins__": {}}, known)  # an exam that was written here
    return np.broadcast_to(result, names["time"].shape).astype(float)


def answer(case, lacuna):
    began = time.time()
    machine = tomllib.loads((case.truth / "machine.toml").read_text())
    equations = case.equations()
    states = [state["name"] for state in equations["states"]]
    seen = copy.deepcopy(machine)
    seen["model"]["equations"]["outputs"] = [{"name": f"seen_{s}", "value": s} for s in states]
    outputs = {output["name"] for output in machine["model"]["equations"]["outputs"]}
    # what sits in an output's path is no part of the states
    seen["effects"] = [e for e in machine.get("effects", []) if e["into"] not in outputs]
    run = simulate(lacuna, seen, case, False)
    if run is None:
        return None
    step = case.model["sampling_time"]
    x = {state: run[f"seen_{state}_hat"] for state in states}
    parameters = {p["name"]: p["value"] for p in equations["parameters"]}
    inputs = {name: case.record[name][:-1] for name in case.file["inputs"]}
    substeps = case.model.get("integrator", {}).get("substeps", 1)

    def at(now, time_):
        names = parameters | inputs | now | {"time": time_}
        for variable in equations.get("variables", []):
            names[variable["name"]] = value(variable["value"], names)
        return names

    def rates(now, time_):
        names = at(now, time_)
        return {s["name"]: value(s["derivative"], names) for s in equations["states"]}

    # one step of the model from every true state (Runge and Kutta's fourth order; inputs are held)
    now, clock, h = {s: x[s][:-1] for s in states}, case.record["time"][:-1], step / substeps
    start, began_at = dict(now), clock
    for _ in range(substeps):
        k1 = rates(now, clock)
        k2 = rates({s: now[s] + 0.5 * h * k1[s] for s in states}, clock + 0.5 * h)
        k3 = rates({s: now[s] + 0.5 * h * k2[s] for s in states}, clock + 0.5 * h)
        k4 = rates({s: now[s] + h * k3[s] for s in states}, clock + h)
        now = {s: now[s] + h / 6 * (k1[s] + 2 * k2[s] + 2 * k3[s] + k4[s]) for s in states}
        clock = clock + h
    unexplained = {s: (x[s][1:] - now[s]) / step for s in states}
    # the missing force acts over the sample: library functions are those of its middle
    middle = {s: 0.5 * (x[s][1:] + x[s][:-1]) for s in states}
    names = at(middle, began_at + 0.5 * step)
    causes = []
    coordinates = equations.get("coordinates", [])
    z = {c["name"]: value(c["value"], names) for c in coordinates}
    for channel in equations.get("channels", []):
        into = channel["into"][0]
        state = into["state"]
        change = np.sqrt(np.mean(((x[state][1:] - start[state]) / step) ** 2))
        if np.sqrt(np.mean(unexplained[state] ** 2)) < EXACT * change:
            continue
        missing = unexplained[state] / value(str(into.get("gain", 1)), names)
        library, labels = [np.ones_like(missing)], [("bias", None)]
        for c in coordinates:
            own, width = z[c["name"]], 0.05 * (np.std(z[c["name"]]) or 1.0)
            shapes = {"linear": own, "quadratic": own**2, "cubic": own**3}
            if c.get("quantity") == "velocity":
                shapes |= {"drag": own * np.abs(own), "coulomb_friction": np.tanh(own / width)}
            library += list(shapes.values())
            labels += [(effect, c["name"]) for effect in shapes]
        theta = np.stack(library, axis=1)
        scale = np.sqrt(np.mean(theta**2, axis=0))
        size = np.sqrt(np.mean(missing**2))
        if size == 0.0:
            continue
        sparse = pysindy.STLSQ(threshold=THRESHOLD, alpha=1e-6)
        sparse.fit(theta / scale, (missing / size)[:, None])
        share = np.abs(np.asarray(sparse.coef_).ravel())
        for i in np.argsort(-share):
            if share[i] > 0 and labels[i][0] not in case.file["without"]:
                effect, of = labels[i]
                causes.append((share[i] * size, {"effect": effect, "into": channel["name"], "of": of}))
    causes = [cause for _, cause in sorted(causes, key=lambda c: -c[0])[:5]]
    verdict = "causes_found" if causes else "nothing_found"
    return {"case": case.number, "verdict": verdict, "causes": causes, "seconds": time.time() - began}


if __name__ == "__main__":
    take(__doc__, f"PySINDy {pysindy.__version__}, true states", answer)
