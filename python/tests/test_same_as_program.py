"""Every function gives the program's JSON document."""

import json

import numpy as np
import pytest
from conftest import DEMO, PENDULUM

import lacuna

MODEL, DATA, TEST = DEMO / "model.toml", DEMO / "est.csv.gz", DEMO / "test.csv.gz"


def without(document, *keys):
    return {key: value for key, value in document.items() if key not in keys}


@pytest.fixture(scope="module")
def files(tmp_path_factory, pendulum, swing):
    folder = tmp_path_factory.mktemp("files")
    (folder / "pendulum.toml").write_text(PENDULUM)
    t = 0.02 * np.arange(len(swing))
    table = np.column_stack([t, swing["torque"], swing["angle"]])
    head = "time [s],torque [N m],angle [rad]"
    np.savetxt(folder / "swing.csv", table, delimiter=",", header=head, comments="", fmt="%.17g")
    return folder / "pendulum.toml", folder / "swing.csv", folder


def test_diagnose(answer_of, tmp_path):
    theirs = answer_of("diagnose", "--model", MODEL, "--data", DATA, "--test", TEST, "--out", tmp_path)
    found = lacuna.diagnose(MODEL, DATA, TEST)
    ours = found.to_dict()
    assert ours["verdict"] == "causes_found" and ours["causes"][0]["effect"] == "coulomb_friction"
    apart = ("seconds", "provenance")
    assert list(ours) == list(theirs)
    assert without(ours, *apart) == without(theirs, *apart)
    for key in ("program", "files", "seed"):
        assert ours["provenance"][key] == theirs["provenance"][key], key
    # the same of what the package brings along, and the files of the program
    brought = lacuna.diagnose(*lacuna.demo()).to_dict()
    assert without(brought, *apart) == without(ours, *apart)
    found.save(tmp_path / "ours")
    names = {path.name for path in (tmp_path / "ours").iterdir()}
    assert names == {"report.html", "report-data.json", "diagnosis.json", "extended.toml"}
    again = lacuna.simulate(tmp_path / "ours" / "extended.toml", TEST)
    theirs = lacuna.simulate(tmp_path / "extended.toml", TEST)
    assert again.to_dict() == theirs.to_dict()


def test_simulate(answer_of, files):
    model, data, _ = files
    run = lacuna.simulate(model, data)
    assert run.to_dict() == answer_of("simulate", "--model", model, "--data", data)
    assert run.outputs["angle"].shape == run.time.shape == (1500,)
    assert run.metrics.angle.fit_percent == run.metrics["angle"]["fit_percent"]


def test_estimate(answer_of, files):
    model, data, folder = files
    out = folder / "fitted.toml"
    theirs = answer_of("estimate", "--model", model, "--data", data, "--out", out, "--seed", 3)
    found = lacuna.estimate(model, data, seed=3)
    assert without(found.to_dict(), "model") == without(theirs, "model")
    of_file = "\n".join(line for line in out.read_text().splitlines() if not line.startswith("#"))
    assert found.model.to_toml().strip() == of_file.strip()


def test_estimate_a_linear_model(answer_of, files):
    _, data, folder = files
    theirs = answer_of(
        "estimate", "--lti", "2", "--inputs", "torque", "--outputs", "angle", "--data", data, "--out", folder / "l.toml"
    )
    found = lacuna.estimate(None, data, order=2, inputs="torque", outputs=["angle"])
    assert without(found.to_dict(), "model") == without(theirs, "model")


def test_check(answer_of, files):
    model, data, _ = files
    found = lacuna.check(model, data)
    assert found.rejected is True
    assert found.to_dict() == answer_of("check", "--model", model, "--data", data)


def test_plan(answer_of, files):
    model, data, _ = files
    assert lacuna.plan(model, data).to_dict() == answer_of("plan", "--model", model, "--data", data)


def test_look(answer_of, files):
    model, data, folder = files
    named = ("--inputs", "torque", "--outputs", "angle")
    theirs = answer_of("look", "--data", data, *named, "--out", folder / "look")["records"]
    ours = lacuna.look(data, inputs=["torque"], outputs=["angle"])
    assert [without(r, "page") for r in ours.to_dict()["records"]] == [without(r, "page") for r in theirs]
    theirs = answer_of("look", "--model", model, "--data", data, "--out", folder / "look2")
    ours = lacuna.look(data, model)
    assert without(ours.to_dict(), "report") == without(theirs, "report")
    assert [p.name for p in ours.save(folder / "ours")] == ["look.html"]


def test_fit(answer_of, files):
    model, data, folder = files
    recipe = {"training": {"epochs": 2, "batch": 64}, "encoder": {"resnet": {"n_a": 4, "n_b": 4, "hidden": [4]}}}
    (folder / "train.json").write_text(json.dumps(recipe))
    theirs = answer_of(
        "fit", "--model", model, "--data", data, "--config", folder / "train.json", "--out", folder / "fit", "--threads", 1
    )
    found = lacuna.fit(model, data, recipe=recipe, threads=1)
    beside = ("model", "weights", "history", "report")
    assert without(found.to_dict(), *beside) == without(theirs, *beside)
    assert found.history["epoch"].tolist() == [0, 1, 2]
    assert lacuna.simulate(found.model, data, init=0).time.shape == (1500,)


def test_errors_have_the_words_of_the_program(program, tmp_path):
    bad = tmp_path / "bad.toml"
    bad.write_text(PENDULUM.replace("min = 0.0", "minimum = 0.0", 1))
    with pytest.raises(lacuna.InputError) as caught:
        lacuna.Model.from_file(bad)
    status, _, err = program("simulate", "--model", bad, "--data", DATA)
    assert status == 2 and err.strip() == f"error: {caught.value}"
    error = caught.value
    assert (error.kind, error.file, error.line) == ("input", str(bad), 11) and "min" in error.hint
    for wrong in (lambda: lacuna.diagnose(MODEL, DATA, only="magic"), lambda: lacuna.diagnose(MODEL, DATA, DATA)):
        with pytest.raises(lacuna.Error):
            wrong()
    status, out, _ = program("diagnose", "--model", MODEL, "--data", DATA, "--only", "magic", "--out", tmp_path, "--json")
    with pytest.raises(lacuna.CallError) as caught:
        lacuna.diagnose(MODEL, DATA, only="magic")
    theirs = json.loads(out)["error"]
    assert (theirs["message"], theirs["hint"], theirs["kind"]) == (
        caught.value.message,
        caught.value.hint,
        caught.value.kind,
    )
