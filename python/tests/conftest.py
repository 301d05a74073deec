"""What the tests share: the program, files of the demonstration, a small machine."""

import json
import os
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

import lacuna

ROOT = Path(__file__).resolve().parents[2]
DEMO = ROOT / "src" / "cli" / "demo"

PENDULUM = """
integrator = { method = "rk4", substeps = 2 }
[model.equations]
inputs  = [{ name = "torque", unit = "N m" }]
states  = [
  { name = "theta", unit = "rad",   derivative = "omega" },
  { name = "omega", unit = "rad/s", derivative = "(torque - m*g*l*sin(theta) - c*omega) / J" },
]
outputs = [{ name = "angle", unit = "rad", value = "theta" }]
parameters = [
  { name = "J", value = 0.02, unit = "kg m^2", min = 0.0 },
  { name = "c", value = 0.05, unit = "N m s/rad", min = 0.0 },
  { name = "m", value = 0.4,  unit = "kg", fixed = true },
  { name = "l", value = 0.2,  unit = "m",  fixed = true },
  { name = "g", value = 9.81, unit = "m/s^2", fixed = true },
]
channels    = [{ name = "torque_on_arm", unit = "N m", into = [{ state = "omega", gain = "1/J" }] }]
coordinates = [{ name = "rate", unit = "rad/s", value = "omega", quantity = "velocity" }]
"""


@pytest.fixture(scope="session")
def program():
    """The built program: runs it and gives exit status, stdout, stderr."""
    path = os.environ.get("LACUNA") or shutil.which("lacuna")
    if not path:
        pytest.skip("the program is not built: set LACUNA to its path")

    def run(*arguments, cwd=None):
        done = subprocess.run([path, *map(str, arguments)], capture_output=True, text=True, cwd=cwd)
        return done.returncode, done.stdout, done.stderr

    return run


@pytest.fixture(scope="session")
def answer_of(program):
    """The program's JSON document."""

    def run(*arguments, cwd=None):
        status, out, err = program(*arguments, "--json", cwd=cwd)
        assert status in (0, 3), err + out
        return json.loads(out)

    return run


@pytest.fixture(scope="session")
def pendulum():
    return lacuna.Model.from_toml(PENDULUM)


@pytest.fixture(scope="session")
def torque():
    """A torque of several frequencies, N m, 1500 samples at 0.02 s."""
    t = 0.02 * np.arange(1500)
    return sum(0.25 * np.sin(2 * np.pi * f * t + f * f) for f in (0.3, 0.7, 1.1, 1.9))


@pytest.fixture(scope="session")
def swing(pendulum, torque):
    """The pendulum with dry friction that the model lacks, measured with noise."""
    true = PENDULUM + """
[[effects]]
into = "torque_on_arm"
of = "rate"
effect.coulomb_friction = { level = -0.08, width = 0.05 }
"""
    record = {"torque [N m]": torque}
    run = lacuna.simulate(lacuna.Model.from_toml(true), lacuna.Record(record, sampling_time=0.02), init=0)
    noise = 0.002 * np.random.default_rng(1).standard_normal(len(torque))
    return lacuna.Record({**record, "angle [rad]": run.outputs["angle"] + noise}, sampling_time=0.02)
