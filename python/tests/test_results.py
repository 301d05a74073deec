"""Results as objects, in notebooks and as pictures; progress and interrupts."""

import inspect
import os
import signal
import subprocess
import sys
import textwrap
import time

import matplotlib
import numpy as np
import pytest

import lacuna
from lacuna import _lacuna

matplotlib.use("Agg")


@pytest.fixture(scope="module")
def results(pendulum, swing):
    few = {"only": ["coulomb_friction"]}
    return {
        "simulate": lacuna.simulate(pendulum, swing),
        "estimate": lacuna.estimate(pendulum, swing),
        "check": lacuna.check(pendulum, swing),
        "diagnose": lacuna.diagnose(pendulum, swing, **few),
        "plan": lacuna.plan(pendulum, swing, only=["coulomb_friction"]),
        "look": lacuna.look(swing, inputs="torque", outputs="angle"),
    }


def test_attributes_are_the_document(results):
    for name, result in results.items():
        document = result.to_dict()
        for key in document:
            assert key in dir(result), (name, key)
        document.clear()
        assert result.to_dict(), "a dictionary that was taken can be changed"
    found = results["diagnose"]
    assert found.causes[0].parameters[0].name == found.to_dict()["causes"][0]["parameters"][0]["name"]
    assert found.noise_floor.angle.std == found.to_dict()["noise_floor"]["angle"]["std"] > 0
    with pytest.raises(AttributeError, match="there is no `magic` here; there are: schema"):
        found.magic


def test_series_are_arrays(results):
    found = results["diagnose"]
    series = found.series["angle"]
    assert set(series) == {"measured", "before", "after"}
    assert series["after"].shape == found.time.shape
    test = found.test_series["angle"]
    assert set(test) == {"measured", "before", "after"}
    off = test["measured"] - test["after"]
    assert np.sqrt(np.mean(off**2)) == pytest.approx(found.after.test.angle.rmse)
    assert "Dry friction" in str(found) and found.page.startswith("<!")


def test_notebooks_show_a_table_and_escape_what_is_hostile(results):
    for result in results.values():
        page = result._repr_html_()
        assert page.startswith("<p><b>") and "None" not in page
    hostile = lacuna.Record({"<script>": [1.0, 2.0]}, sampling_time=0.1)
    assert "<script>" not in hostile._repr_html_()


def test_every_result_draws_itself(results, swing):
    import matplotlib.pyplot as plt

    for name, result in results.items():
        axes = result.plot()
        assert any(axis.has_data() for axis in axes), name
        axes[0].get_figure().canvas.draw()
        plt.close("all")
    assert len(swing.plot()) == 2
    plt.close("all")


def test_progress_is_told_and_never_goes_back(pendulum, swing):
    told = []
    lacuna.estimate(pendulum, swing, progress=lambda done, doing: told.append((done, doing)))
    assert told[-1][0] == 1.0 and all(a[0] <= b[0] for a, b in zip(told, told[1:]))

    class Enough(Exception):
        pass

    def stop(done, doing):
        raise Enough

    with pytest.raises(Enough):
        lacuna.diagnose(*lacuna.demo(), progress=stop)


def test_same_seed_same_numbers_for_any_number_of_threads(pendulum, swing):
    runs = [lacuna.estimate(pendulum, swing, seed=5, threads=n).to_dict() for n in (1, 2)]
    assert runs[0] == runs[1]


@pytest.mark.skipif(os.name != "posix", reason="signals")
def test_an_interrupt_ends_with_what_is_known(tmp_path):
    text = textwrap.dedent(
        """
        import lacuna, sys
        model, record, test = lacuna.demo()
        def told(done, doing):
            if not told.said:
                told.said = True
                print("begun", flush=True)
        told.said = False
        found = lacuna.diagnose(model, record, test, progress=told)
        print("interrupted", found.to_dict().get("interrupted"), flush=True)
        """
    )
    call = [sys.executable, "-W", "ignore", "-c", text]
    # elsewhere, so that the package is the installed one
    process = subprocess.Popen(call, stdout=subprocess.PIPE, text=True, cwd=tmp_path)
    assert process.stdout.readline() == "begun\n"
    time.sleep(0.2)
    process.send_signal(signal.SIGINT)
    out, _ = process.communicate(timeout=60)
    assert process.returncode == 0 and out == "interrupted True\n"


def test_the_stub_names_what_is_there():
    stub = (lacuna.work.__file__).replace("work.py", "_lacuna.pyi")
    with open(stub) as file:
        text = file.read()
    for name in dir(_lacuna):
        if name.startswith("__") and name != "__version__":
            continue
        assert any(f"{word}{name}" in text for word in ("class ", "def ", "")), name
    for cls in (_lacuna.Model, _lacuna.Table, _lacuna.Job):
        for name, _ in inspect.getmembers(cls):
            if not name.startswith("_"):
                assert name in text, (cls, name)
