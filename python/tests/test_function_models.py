"""Models whose law is a Python function."""

import math

import numpy as np
import pytest

import lacuna

STATES = {"theta": "rad", "omega": {"unit": "rad/s", "quantity": "velocity"}}
PARAMETERS = {
    "J": {"value": 0.02, "unit": "kg m^2", "min": 0.0},
    "c": {"value": 0.05, "unit": "N m s/rad", "min": 0.0},
    "mgl": {"value": 0.4 * 9.81 * 0.2, "unit": "N m", "fixed": True},
}


def made(derivative, **more):
    given = {
        "states": STATES,
        "inputs": {"torque": "N m"},
        "outputs": {"angle": "rad"},
        "parameters": PARAMETERS,
        "channels": {"torque_on_arm": "N m"},
        "coordinates": {"rate": {"unit": "rad/s", "quantity": "velocity"}},
        "coordinate": lambda x, u, theta: [x.omega],
        "integrator": {"method": "rk4", "substeps": 2},
    }
    return lacuna.Model.from_function(derivative, **{**given, **more})


def whole(x, u, theta, w):
    return [x.omega, (u.torque + w.torque_on_arm - theta.mgl * np.sin(x.theta) - theta.c * x.omega) / theta.J]


def single(x, u, theta, w):
    force = w[0] if abs(w[0]) > 0 else 0.0
    return [x[1], (u[0] + force - theta[2] * math.sin(x[0]) - theta[1] * x[1]) / theta[0]]


def test_it_simulates_as_the_equations_do(pendulum, swing):
    theirs = lacuna.simulate(pendulum, swing, init=0)
    for function in (whole, single):
        with pytest.warns(lacuna.Remark, match="slower"):
            ours = lacuna.simulate(made(function), swing, init=0)
        assert np.allclose(ours.outputs["angle"], theirs.outputs["angle"], rtol=0, atol=1e-12)
        assert any("slower" in text for text in ours.noticed)


def test_a_discrete_one_and_one_without_channels(swing):
    model = lacuna.Model.from_function(
        lambda x, u, theta: [0.9 * x[0] + theta.b * u[0]],
        states=["x"], inputs=["u"], outputs=["y"], parameters={"b": 0.5}, discrete=True, sampling_time=0.1,
    )
    u = np.sin(np.arange(50))
    found = lacuna.simulate(model, lacuna.Record({"u": u}, sampling_time=0.1), init=0).outputs["y"]
    x, wanted = 0.0, []
    for value in u:
        wanted.append(x)
        x = 0.9 * x + 0.5 * value
    assert np.allclose(found, wanted, atol=1e-14)
    assert model.channels == {"x": ""} and model.coordinates == {"x": ""}


def test_it_is_diagnosed_and_the_cause_is_the_same(pendulum, swing):
    theirs = lacuna.diagnose(pendulum, swing, only=["coulomb_friction", "quadratic"], max_causes=1)
    ours = lacuna.diagnose(made(whole), swing, only=["coulomb_friction", "quadratic"], max_causes=1)
    assert (ours.verdict, len(ours.causes)) == ("causes_found", 1)
    one, other = ours.causes[0], theirs.causes[0]
    assert (one.effect, one.into, one.of) == (other.effect, other.into, other.of)
    assert one.effect == "coulomb_friction"
    level, wanted = one.parameters[0], other.parameters[0]
    assert level.value == pytest.approx(wanted.value, abs=wanted.std_error)
    assert level.value == pytest.approx(-0.08, abs=0.02)
    # the extended model goes on in this process, and nowhere else
    after = lacuna.simulate(ours.extended, swing)
    assert after.metrics.angle.rmse < 0.5 * lacuna.simulate(pendulum, swing).metrics.angle.rmse
    with pytest.raises(lacuna.CallError, match="written in Python"):
        ours.extended.save("nowhere.toml")


def test_exceptions_of_the_function_come_through(swing):
    def broken(x, u, theta, w):
        raise LookupError("my own mistake")

    def divided(x, u, theta, w):
        return [x[1], 1 / 0]

    with pytest.raises(LookupError, match="my own mistake"):
        lacuna.simulate(made(broken), swing)
    with pytest.raises(ZeroDivisionError):
        lacuna.simulate(made(divided), swing)
    with pytest.raises(lacuna.CallError, match="3 values came back, where 2"):
        lacuna.simulate(made(lambda x, u, theta, w: [1.0, 2.0, 3.0]), swing)


@pytest.mark.parametrize("root", [math.sqrt, np.sqrt])
def test_outside_of_its_domain_a_run_diverges(root, swing):
    model = made(lambda x, u, theta, w: [x[1], 5 * root(1.5 - x[0])])
    found = lacuna.simulate(model, swing, init=0)
    assert found.diverged_at is not None and 0 < found.diverged_at < 200
    assert np.isnan(found.outputs["angle"][-1])


@pytest.mark.parametrize(
    "more, words",
    [
        ({"channels": {"theta": "N m"}}, "`theta` is given twice"),
        ({"coordinate": None}, "go together"),
        ({"parameters": {"J": "kg m^2", "c": None}}, "`c` is declared by None"),
        ({"states": ["theta"], "outputs": ["a", "b"], "channels": ()}, "more outputs than states"),
    ],
)
def test_wrong_declarations_are_refused(more, words):
    with pytest.raises(lacuna.Error, match=words):
        made(whole, **more)


def test_a_function_must_take_x_u_and_theta():
    with pytest.raises(lacuna.CallError, match="x, u, theta"):
        made(lambda x, u: [0.0, 0.0], channels=())
    with pytest.raises(lacuna.CallError, match="no argument `w`"):
        made(lambda x, u, theta: [0.0, 0.0])


def test_one_without_states_is_its_output_alone():
    t = 0.01 * np.arange(2000)
    q, qd, qdd = np.zeros((3, 2000))
    for i in range(1, 5):
        a, w = 1.5 / i**2, 0.8 * i**2
        q += a * np.sin(w * t + i)
        qd += a * w * np.cos(w * t + i)
        qdd -= a * w * w * np.sin(w * t + i)
    noise = np.random.default_rng(3).normal(0, 0.05, 2000)
    tau = 0.5 * qdd + 3.0 * np.sin(q) + 0.4 * np.tanh(qd / 0.02) + noise
    model = lacuna.Model.from_function(
        inputs={"q": "rad", "qd": {"unit": "rad/s", "quantity": "velocity"}, "qdd": "rad/s^2"},
        outputs={"tau": "N m"},
        parameters={"J": 0.5, "G": 3.0},
        output=lambda x, u, theta: [theta.J * u.qdd + theta.G * np.sin(u.q)],
    )
    record = lacuna.Record({"q": q, "qd": qd, "qdd": qdd, "tau": tau}, sampling_time=0.01)
    finding = lacuna.diagnose(model, record)
    cause = finding.causes[0]
    assert (cause.effect, cause.into, cause.of) == ("coulomb_friction", "tau", "qd")
    with pytest.raises(lacuna.CallError, match="no function gives the derivatives"):
        lacuna.Model.from_function(states=["x"], inputs=["u"], outputs=["y"])
