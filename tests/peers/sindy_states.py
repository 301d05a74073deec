#!/usr/bin/env python3
"""Takes an exam by PySINDy, with the true states given: sequentially thresholded least squares.

    tests/peers/sindy_states.py EXAM ANSWERS.json [--cases 1-40] [--lacuna PATH]

The states come from the sealed machine, simulated without noise along the recorded inputs. What the
model does not explain of their derivatives is, channel by channel, a sum of library functions of the
coordinates (Brunton, Proctor and Kutz, PNAS 113, 2016), at most five.
"""

import argparse
import copy
import math
import re
import time
import tomllib

import numpy as np
import pysindy

from exam_folder import Case, numbers, simulate, write

FUNCTIONS = {name: getattr(np, name) for name in "sin cos tan sinh cosh tanh exp log sqrt abs sign".split()}
FUNCTIONS |= {"min": np.minimum, "max": np.maximum, "pow": np.power, "pi": math.pi}
START = 0.3  # of the record, in which the simulated start fades
THRESHOLD = 0.02  # of the largest share of the missing force


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
    step, n = case.model["sampling_time"], len(case.record["time"])
    x = {state: run[f"seen_{state}_hat"] for state in states}
    names = dict(x) | {name: case.record[name] for name in case.file["inputs"]}
    names["time"] = case.record["time"]
    names |= {p["name"]: p["value"] for p in equations["parameters"]}
    for variable in equations.get("variables", []):
        names[variable["name"]] = value(variable["value"], names)
    keep = slice(int(START * n), n - 2)
    causes = []
    coordinates = equations.get("coordinates", [])
    z = {c["name"]: value(c["value"], names)[keep] for c in coordinates}
    for channel in equations.get("channels", []):
        into = channel["into"][0]
        derivative = next(s["derivative"] for s in equations["states"] if s["name"] == into["state"])
        # the input is held over a sample: the mean derivative over it, at its middle
        mean = np.append(np.diff(x[into["state"]]) / step, 0.0)
        rate = value(derivative, names)
        known = 0.5 * (rate + np.append(rate[1:], rate[-1]))
        missing = ((mean - known) / value(str(into.get("gain", 1)), names))[keep]
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
        # below what the derivative's own error is, nothing is missing
        error = np.sqrt(np.mean((mean - known)[keep] ** 2)) / np.sqrt(np.mean(mean[keep] ** 2))
        if error < 1e-3:
            continue
        for i in np.argsort(-share):
            if share[i] > 0 and labels[i][0] not in case.file["without"]:
                effect, of = labels[i]
                causes.append((share[i] * size, {"effect": effect, "into": channel["name"], "of": of}))
    causes = [cause for _, cause in sorted(causes, key=lambda c: -c[0])[:5]]
    verdict = "causes_found" if causes else "nothing_found"
    return {"case": case.number, "verdict": verdict, "causes": causes, "seconds": time.time() - began}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("exam")
    parser.add_argument("answers")
    parser.add_argument("--cases", default="")
    parser.add_argument("--lacuna", default="lacuna")
    arguments = parser.parse_args()
    answers, left = [], 0
    for number in numbers(arguments.cases, arguments.exam):
        case = Case(arguments.exam, number)
        given = answer(case, arguments.lacuna) if case.equations() else None
        if given is None:
            left += 1
        else:
            answers.append(given)
    write(arguments.answers, f"PySINDy {pysindy.__version__}, true states", answers)
    print(f"{len(answers)} cases answered, {left} left")


if __name__ == "__main__":
    main()
