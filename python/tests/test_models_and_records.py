"""Models and records, of everything that they can be made of."""

import subprocess
import sys

import numpy as np
import pandas as pd
import pytest
from conftest import DEMO, PENDULUM

import lacuna


def test_a_model_of_a_file_a_text_and_a_dictionary(tmp_path):
    path = tmp_path / "pendulum.toml"
    path.write_text(PENDULUM)
    duffing = {"mass": 1.0, "damping": np.float64(0.5), "stiffness": np.array(100.0), "hardening": 0}
    of_dict = lacuna.Model.from_dict({"sampling_time": 0.01, "model": {"duffing": duffing}})
    assert of_dict.parameters["stiffness"].value == 100.0 and of_dict.sampling_time == 0.01
    of_file, of_text = lacuna.Model.from_file(path), lacuna.Model.from_toml(PENDULUM)
    assert of_file.to_toml() == of_text.to_toml()
    assert of_text.inputs == {"torque": "N m"} and of_text.outputs == {"angle": "rad"}
    assert of_text.states["omega"].quantity == "velocity"
    assert of_text.parameters["m"].fixed and not of_text.parameters["J"].fixed
    assert of_text.channels == {"torque_on_arm": "N m"} and of_text.coordinates == {"rate": "rad/s"}
    of_text.save(tmp_path / "saved.toml")
    assert lacuna.Model.from_file(tmp_path / "saved.toml").parameters == of_text.parameters
    assert "torque -> angle" in repr(of_text) and "<table>" in of_text._repr_html_()


def test_a_model_is_exported(tmp_path, swing):
    duffing = {"mass": 1.0, "damping": 0.5, "stiffness": 90.0, "hardening": 9.0}
    model = lacuna.Model.from_dict({"sampling_time": 0.01, "model": {"duffing": duffing}})
    for to, expected in [
        ("c", {"spring.c", "spring.h", "main_test.c", "test_vector.h"}),
        ("fmu", {"spring_fmi2.fmu", "spring_fmi3.fmu"}),
        ("matlab", {"spring.m", "test_spring.m", "test_vector.csv"}),
        ("python", {"spring.py", "test_spring.py", "test_vector.csv"}),
    ]:
        written = model.export(tmp_path / to, to, name="spring")
        assert {path.name for path in written} == expected and all(path.is_file() for path in written)
    # what was written is the same simulation
    done = subprocess.run([sys.executable, "test_spring.py"], cwd=tmp_path / "python", capture_output=True, text=True)
    assert done.stdout == "equal to the simulation\n", done.stderr
    with pytest.raises(lacuna.CallError, match="there are c, fmu, matlab, python"):
        model.export(tmp_path, "simulink")
    with pytest.raises(lacuna.Error, match="sampling time"):
        lacuna.Model.from_toml(PENDULUM).export(tmp_path)
    # with the effects that were found
    found = lacuna.diagnose(lacuna.Model.from_toml(PENDULUM), swing, only=["coulomb_friction"])
    assert len(found.extended.export(tmp_path / "found")) == 2


def test_a_wrong_model_says_where():
    with pytest.raises(lacuna.InputError, match="damping") as caught:
        lacuna.Model.from_dict({"model": {"duffing": {"mass": 1.0, "dampening": 0.5}}})
    assert caught.value.kind == "input"
    with pytest.raises(lacuna.CallError, match="int"):
        lacuna.simulate(3, {"u": [1.0]})


def test_a_record_of_arrays_and_of_tables_is_the_same(torque):
    t = 0.02 * np.arange(len(torque))
    of_arrays = lacuna.Record({"torque": torque}, sampling_time=0.02, units={"torque": "N m"})
    of_times = lacuna.Record({"time": t, "torque [N m]": list(torque)})
    frame = pd.DataFrame({"torque [N m]": torque})
    of_frame = lacuna.Record(frame.set_index(pd.Index(t)))
    dates = pd.Timestamp("2024-05-01") + pd.to_timedelta(t, unit="s")
    of_dates = lacuna.Record(frame.set_index(dates))
    of_durations = lacuna.Record(frame.set_index(pd.to_timedelta(t, unit="s")))
    of_rows = lacuna.Record(frame, sampling_time=0.02)
    runs = [
        lacuna.simulate(lacuna.Model.from_toml(PENDULUM), r, init=0).outputs["angle"]
        for r in (of_arrays, of_times, of_frame, of_dates, of_durations, of_rows)
    ]
    for run in runs[1:]:
        assert np.allclose(run, runs[0], atol=1e-9, rtol=0)
    for record in (of_arrays, of_frame, of_dates):
        assert record.sampling_time == pytest.approx(0.02) and record.units["torque"] == "N m"


def test_columns_are_seen_where_they_lie(torque):
    record = lacuna.Record({"torque": torque}, sampling_time=0.02)
    first, second = record["torque"], record["torque"]
    assert first.ctypes.data == second.ctypes.data, "a view is no copy"
    assert not first.flags.writeable and not first.flags.owndata
    with pytest.raises(ValueError):
        first[0] = 1.0
    del record
    assert np.array_equal(second, torque), "a view keeps its record"


def test_units_are_converted_or_refused(pendulum, torque):
    degrees = lacuna.Record({"torque [N m]": torque, "angle [deg]": 0 * torque + 180}, sampling_time=0.02)
    with pytest.warns(lacuna.Remark, match="deg"):
        run = lacuna.simulate(pendulum, degrees)
    assert np.allclose(run.measured["angle"], np.pi)
    assert any("deg" in text for text in run.noticed)
    wrong = lacuna.Record({"torque [V]": torque}, sampling_time=0.02)
    with pytest.raises(lacuna.InputError, match="unit"):
        lacuna.simulate(pendulum, wrong)


def test_missing_values_and_integers(pendulum):
    frame = pd.DataFrame({"torque": pd.array(([1] * 19 + [None]) * 4, dtype="Int64"), "angle": np.arange(80)})
    record = lacuna.Record(frame, sampling_time=0.02)
    assert np.isnan(record["torque"][19]) and record["angle"][5] == 5.0
    assert lacuna.simulate(pendulum, record, init=0).outputs["angle"].shape == (80,)


@pytest.mark.parametrize(
    "data, words",
    [
        ({"u": [[1.0, 2.0]]}, r"\(1, 2\)"),
        ({"u": ["a"]}, "no numbers"),
        ({"u": [1.0], "y": [1.0, 2.0]}, "y"),
        ({}, "no values"),
        (3.0, "float"),
        ({"u": [np.inf]}, "infinite"),
    ],
)
def test_what_is_no_record_is_refused(data, words, pendulum):
    with pytest.raises(lacuna.Error, match=words):
        lacuna.simulate(pendulum, lacuna.Record(data, sampling_time=0.1), inputs=["u"])


def test_files_are_read_as_the_program_reads_them(tmp_path, torque):
    np.savez(tmp_path / "a.npz", torque=torque, Ts=0.02)
    record = lacuna.Record(tmp_path / "a.npz")
    assert record.names == ["torque"] and record.sampling_time == 0.02 and len(record) == len(torque)
    packed = lacuna.Record(DEMO / "est.csv.gz")
    assert len(packed) == 3000 and packed["time"][1] == pytest.approx(0.05)
    with pytest.raises(lacuna.InputError, match="cannot be read"):
        lacuna.Record(tmp_path / "none.csv")
    np.savez(tmp_path / "three.npz", u=np.zeros((3, 50, 1)), y=np.zeros((3, 50, 1)), Ts=0.1)
    assert len(lacuna.Record.all(tmp_path / "three.npz")) == 3
    with pytest.raises(lacuna.CallError, match="3 records"):
        lacuna.Record(tmp_path / "three.npz")
