#!/usr/bin/env python3
"""Takes an exam by stepwise regression: the residual of the model on responses to small effects.

    tests/peers/stepwise.py EXAM ANSWERS.json [--cases 1-40] [--lacuna PATH]

Each candidate is an effect at a place at one size; its response is what a little of it does to the
outputs. Forward selection by the Bayesian information criterion (Efroymson 1960; Schwarz 1978).
"""

import copy
import time

import numpy as np

from exam_folder import simulate, take

LITTLE = 0.02  # of what a place carries


def candidates(case, scales):
    """(name, extended model, is a parameter) of everything that is tried."""
    equations = case.equations()
    found = []

    def placed(effect, into, of, table):
        model = copy.deepcopy(case.model)
        entry = {"into": into, "effect": {effect: table}}
        if of:
            entry["of"] = of
        model.setdefault("effects", []).append(entry)
        found.append(({"effect": effect, "into": into, "of": of}, model))

    for channel in equations.get("channels", []):
        into = channel["name"]
        placed("bias", into, None, {"value": 1e-3})
        for coordinate in equations.get("coordinates", []):
            of, z = coordinate["name"], scales.get(coordinate["name"], 1.0)
            for effect, power in [("linear", 1), ("quadratic", 2), ("cubic", 3)]:
                placed(effect, into, of, {"coefficient": 1e-3 / z**power})
            if coordinate.get("quantity") == "velocity":
                placed("drag", into, of, {"coefficient": 1e-3 / z**2})
                placed("coulomb_friction", into, of, {"level": 1e-3, "width": 0.05 * z})
    for signal in equations["inputs"] + equations["outputs"]:
        name = signal["name"]
        placed("bias", name, None, {"value": 1e-3})
        placed("gain", name, name, {"gain": LITTLE})
        placed("quadratic", name, name, {"coefficient": LITTLE / max(scales.get(name, 1.0), 1e-12)})
        placed("lag", name, name, {"time_constant": 0.5 * case.model["sampling_time"]})
    for parameter in equations["parameters"]:
        if not parameter.get("fixed"):
            model = copy.deepcopy(case.model)
            for other in model["model"]["equations"]["parameters"]:
                if other["name"] == parameter["name"]:
                    other["value"] *= 1.0 + LITTLE
            found.append(({"effect": "parameter", "into": parameter["name"], "of": None}, model))
    return found


def stacked(columns, names):
    return np.concatenate([columns[name] for name in names])


def answer(case, lacuna):
    began = time.time()
    names = case.file["outputs"]
    base = simulate(lacuna, case.model, case)
    if base is None:
        return None
    hats = [f"{name}_hat" for name in names]
    residual = stacked(case.record, names) - stacked(base, hats)
    coordinates = copy.deepcopy(case.model)
    coordinates["model"]["equations"]["outputs"] = [
        {"name": f"seen_{c['name']}", "value": c["value"]} for c in case.equations().get("coordinates", [])
    ]
    seen = simulate(lacuna, coordinates, case, False) or {}
    scales = {k[5:-4]: float(np.std(v)) or 1.0 for k, v in seen.items() if k.startswith("seen_")}
    scales |= {name: float(np.sqrt(np.mean(case.record[name] ** 2))) for name in names + case.file["inputs"]}
    library = []
    for name, model in candidates(case, scales):
        if name["effect"] in case.file["without"]:
            continue
        moved = simulate(lacuna, model, case)
        if moved is None:
            continue
        response = stacked(moved, hats) - stacked(base, hats)
        size = np.sqrt(np.sum(response**2))
        if np.isfinite(size) and size > 0:
            library.append((name, response / size))
    n, chosen = len(residual), []

    def bic(columns):
        left = residual
        if columns:
            design = np.stack(columns, axis=1)
            left = residual - design @ np.linalg.lstsq(design, residual, rcond=None)[0]
        return n * np.log(np.mean(left**2)) + len(columns) * np.log(n)

    now = bic([])
    while len(chosen) < 5:
        open_ = [i for i in range(len(library)) if i not in chosen]
        scores = [(bic([library[k][1] for k in chosen + [i]]), i) for i in open_]
        # as many candidates as there are may win by chance: each costs its share (EBIC)
        best, i = min(scores)
        if best + 2 * np.log(len(library)) >= now:
            break
        now, chosen = best + 2 * np.log(len(library)), chosen + [i]
    causes = [library[i][0] for i in chosen]
    verdict = "causes_found" if causes else "nothing_found"
    return {"case": case.number, "verdict": verdict, "causes": causes, "seconds": time.time() - began}


if __name__ == "__main__":
    take(__doc__, "stepwise regression", answer)
