"""Written by `lacuna export`: compares with the test vector: to 1e-9 of each output's largest value."""

import csv
import os

import numpy as np

from model import Model


def test_model_is_the_simulation():
    folder = os.path.dirname(os.path.abspath(__file__))
    with open(os.path.join(folder, "test_vector.csv"), newline="", encoding="utf-8") as file:
        rows = np.array(list(csv.reader(file))[1:], dtype=float)
    count = len(Model.INPUTS)
    y = Model().simulate(rows[:, :count])
    expected = rows[:, count:]
    largest = np.maximum(np.abs(expected).max(axis=0), np.finfo(float).tiny)
    assert (np.abs(y - expected).max(axis=0) <= 1e-9 * largest).all()


if __name__ == "__main__":
    test_model_is_the_simulation()
    print("equal to the simulation")
