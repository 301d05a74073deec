"""Runs both units of a folder along the test vector and compares."""

import csv
import os
import shutil
import sys

import numpy as np
from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Slave
from fmpy.fmi3 import FMU3Slave
from fmpy.validation import validate_fmu


def outputs(path, u):
    """Outputs along inputs (samples, inputs), read with the inputs of the same sample."""
    problems = validate_fmu(path)
    assert not problems, problems
    description = read_model_description(path)
    by_causality = {}
    for variable in description.modelVariables:
        by_causality.setdefault(variable.causality, []).append(variable.valueReference)
    inputs, wanted = by_causality.get("input", []), by_causality["output"]
    step = float(description.defaultExperiment.stepSize)
    folder = extract(path)
    kind = FMU2Slave if description.fmiVersion == "2.0" else FMU3Slave
    unit = kind(
        guid=description.guid,
        unzipDirectory=folder,
        modelIdentifier=description.coSimulation.modelIdentifier,
    )
    unit.instantiate()
    if kind is FMU2Slave:
        unit.setupExperiment(startTime=0.0)
        put, get = unit.setReal, unit.getReal
        unit.enterInitializationMode()
    else:
        put, get = unit.setFloat64, unit.getFloat64
        unit.enterInitializationMode(startTime=0.0)
    unit.exitInitializationMode()
    rows = []
    count = u.shape[1]
    for k, now in enumerate(u):
        values = list(now)
        # where the hold is of first order, the slopes come after the inputs
        if len(inputs) == 2 * count:
            after = u[min(k + 1, len(u) - 1)]
            values += list((after - now) / step)
        put(inputs, values)
        rows.append(get(wanted))
        unit.doStep(currentCommunicationPoint=k * step, communicationStepSize=step)
    unit.terminate()
    unit.freeInstance()
    shutil.rmtree(folder, ignore_errors=True)
    return np.array(rows)


def main(folder, name):
    with open(os.path.join(folder, "test_vector.csv"), newline="", encoding="utf-8") as file:
        rows = np.array(list(csv.reader(file))[1:], dtype=float)
    for version in (2, 3):
        path = os.path.join(folder, f"{name}_fmi{version}.fmu")
        description = read_model_description(path)
        width = sum(v.causality == "output" for v in description.modelVariables)
        u, expected = rows[:, :-width], rows[:, -width:]
        y = outputs(path, u)
        off = np.abs(y - expected).max() / np.abs(expected).max()
        assert off <= 1e-9, f"{path}: {off}"
        print(f"{name}, FMI {version}: valid, largest difference {off:.1e}")


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2])
