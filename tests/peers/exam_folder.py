"""What the adapters share: an exam's folder, records, a library of effects at places, answers."""

import argparse
import csv
import json
import pathlib
import subprocess
import tempfile
import tomllib

import numpy as np


class Case:
    """One case: its file, its model as a table, its first record as columns."""

    def __init__(self, folder, number):
        self.number = number
        self.folder = pathlib.Path(folder) / "cases" / f"case{number}"
        self.truth = pathlib.Path(folder) / "truth" / f"case{number}"
        self.file = json.loads((self.folder / "case.json").read_text())
        self.model = tomllib.loads((self.folder / self.file["model"]).read_text())
        self.path = self.folder / self.file["records"][0]
        self.record = columns(self.path)

    def equations(self):
        """The model's equations, or None where it has none that can be read here."""
        return None if "controller" in self.model else self.model["model"].get("equations")


def columns(path):
    """Columns of a CSV file by their names without units."""
    with open(path, newline="") as file:
        rows = list(csv.reader(line for line in file if not line.startswith("#")))
    table = np.array([[float(cell or "nan") for cell in row] for row in rows[1:]])
    return {name.split(" [")[0]: table[:, i] for i, name in enumerate(rows[0])}


def numbers(text, exam):
    """Numbers of the cases: `3-7,12`, or all."""
    if not text:
        whole = json.loads((pathlib.Path(exam) / "exam.json").read_text())["cases"]
        return list(range(1, whole + 1))
    found = []
    for part in text.split(","):
        first, _, last = part.partition("-")
        found += range(int(first), int(last or first) + 1)
    return found


def simulate(lacuna, model, case, measured=True):
    """Columns that a model (a table) gives along a case's record, or None where it cannot.

    Started from what was measured, or, where the model has other outputs, from its own start.
    """
    with tempfile.TemporaryDirectory() as folder:
        path, out, data = (pathlib.Path(folder) / name for name in ["model.json", "out.csv", "data.csv"])
        path.write_text(json.dumps(model))
        names = ["time"] + case.file["inputs"] + (case.file["outputs"] if measured else [])
        with open(data, "w", newline="") as file:
            rows = csv.writer(file)
            rows.writerow(names)
            rows.writerows(zip(*(map(repr, case.record[name].tolist()) for name in names)))
        call = [lacuna, "simulate", "--model", str(path), "--data", str(data), "--out", str(out), "--quiet"]
        call += ["--threads", "1"] + ([] if measured else ["--init", "0"])
        if subprocess.run(call, capture_output=True).returncode:
            return None
        return columns(out)


def take(about, tool, answer):
    """An adapter as a program: `answer` gives the answer to a case, or None where it has none."""
    parser = argparse.ArgumentParser(description=about.splitlines()[0])
    parser.add_argument("exam")
    parser.add_argument("answers")
    parser.add_argument("--cases", default="")
    parser.add_argument("--lacuna", default="lacuna")
    arguments = parser.parse_args()
    cases = [Case(arguments.exam, number) for number in numbers(arguments.cases, arguments.exam)]
    given = [answer(case, arguments.lacuna) if case.equations() else None for case in cases]
    answers = [one for one in given if one is not None]
    document = {"schema": 1, "tool": tool, "answers": answers}
    pathlib.Path(arguments.answers).write_text(json.dumps(document, indent=2) + "\n")
    print(f"{len(answers)} cases answered, {len(given) - len(answers)} left")
