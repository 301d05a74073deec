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
    """As `whole`, but it branches on a value and cannot be read."""
    force = w[0] if abs(w[0]) > 0 else 0.0
    return [x[1], (u[0] + force - theta[2] * math.sin(x[0]) - theta[1] * x[1]) / theta[0]]


def test_it_simulates_as_the_equations_do(pendulum, swing):
    theirs = lacuna.simulate(pendulum, swing, init=0)
    assert not lacuna.simulate(made(whole), swing, init=0).noticed
    for model, why in ((made(whole, trace=False), "trace=False"), (made(single), "within `abs`")):
        with pytest.warns(lacuna.Remark, match=f"{why}.*slower"):
            ours = lacuna.simulate(model, swing, init=0)
        assert np.allclose(ours.outputs["angle"], theirs.outputs["angle"], rtol=0, atol=1e-12)
        assert any("slower" in text for text in ours.noticed)


@pytest.mark.parametrize("trace", [True, False])
def test_a_discrete_one_and_one_without_channels(swing, trace):
    model = lacuna.Model.from_function(
        lambda x, u, theta: [0.9 * x[0] + theta.b * u[0]],
        states=["x"], inputs=["u"], outputs=["y"], parameters={"b": 0.5}, discrete=True, sampling_time=0.1, trace=trace,
    )
    u = np.sin(np.arange(50))
    found = lacuna.simulate(model, lacuna.Record({"u": u}, sampling_time=0.1), init=0).outputs["y"]
    x, wanted = 0.0, []
    for value in u:
        wanted.append(x)
        x = 0.9 * x + 0.5 * value
    assert np.allclose(found, wanted, atol=1e-14)
    assert model.channels == {"x": ""} and model.coordinates == {"x": ""}


def test_it_is_diagnosed_and_the_cause_is_the_same(pendulum, swing, tmp_path):
    theirs = lacuna.diagnose(pendulum, swing, only=["coulomb_friction", "quadratic"], max_causes=1)
    ours = lacuna.diagnose(made(whole), swing, only=["coulomb_friction", "quadratic"], max_causes=1)
    assert (ours.verdict, len(ours.causes)) == ("causes_found", 1)
    one, other = ours.causes[0], theirs.causes[0]
    assert (one.effect, one.into, one.of) == (other.effect, other.into, other.of) == ("coulomb_friction", "torque_on_arm", "rate")
    assert one.parameters[0].value == pytest.approx(other.parameters[0].value, rel=1e-6)
    assert one.parameters[0].value == pytest.approx(-0.08, abs=0.02)
    # the extended model goes into a file and into other programs
    ours.extended.save(tmp_path / "extended.toml")
    after = lacuna.simulate(tmp_path / "extended.toml", swing)
    assert after.metrics.angle.rmse < 0.5 * lacuna.simulate(pendulum, swing).metrics.angle.rmse
    assert {".c", ".h"} <= {path.suffix for path in ours.extended.export(tmp_path, to="c")}


def test_one_that_is_called_at_every_step_is_diagnosed(pendulum, swing):
    short = lacuna.Record({name: swing[name][:300] for name in ("torque", "angle")}, sampling_time=0.02)
    found = lacuna.diagnose(made(whole, trace=False), short, only=["coulomb_friction"], max_causes=1)
    assert (found.verdict, len(found.causes)) == ("causes_found", 1)
    cause = found.causes[0]
    assert (cause.effect, cause.into, cause.of) == ("coulomb_friction", "torque_on_arm", "rate")
    assert cause.parameters[0].value == pytest.approx(-0.08, abs=0.02)
    # the extended model goes on in this process, and nowhere else
    after = lacuna.simulate(found.extended, swing)
    assert after.metrics.angle.rmse < 0.5 * lacuna.simulate(pendulum, swing).metrics.angle.rmse
    with pytest.raises(lacuna.CallError, match="written in Python"):
        found.extended.save("nowhere.toml")


def damping(v):
    """Called by a function of this module: `math` and `max` take symbols here, too."""
    return max(0.1, 0.02 * math.exp(-abs(v)) + 0.05) * v


READ = [
    (lambda x, u, theta, w: [x[1], (u[0] + w[0] - damping(x[1])) / theta.J], "(torque - max(0.1, 0.02*exp(-abs(omega)) + 0.05)*omega)/J"),
    (lambda x, u, theta, w: [x[1], np.clip(x[0], -1, 1) ** 3 - np.hypot(x[0], 2) + w[0]], "min(max(theta, -1), 1)^3 - sqrt(theta*theta + 2*2)"),
    (lambda x, u, theta, w, t: [x[1], np.cos(2 * np.pi * t) - x[0] * -0.5 + 2 * w[0]], "cos(6.283185307179586*time) - theta*-0.5"),
    (lambda x, u, theta, w: np.array([[0, 1], [-theta.c, 0]]) @ np.array(x) + np.array([0, 3]) * (u[0] + w[0]), "-c*theta + 3*torque"),
]  # fmt: skip


@pytest.mark.parametrize("derivative, law", READ)
def test_equations_are_read_from_it(derivative, law):
    text = made(derivative).to_toml()
    assert f'derivative = "{law}"' in text and '"omega"' in text, text


def test_what_stands_in_several_places_is_a_variable():
    def law(x, u, theta, w):
        s = np.sin(x.theta)
        return [x.omega + s, (w[0] - s * s) / theta.J]

    text = made(law).to_toml()
    assert 'variables = [{ name = "part_1", value = "sin(theta)" }]' in text, text
    assert "omega + part_1" in text and "-(part_1*part_1)/J" in text, text


@pytest.mark.parametrize(
    "derivative, why",
    [
        (lambda x, u, theta, w: [x[1], w[0] if x[0] > 0 else 0.0], "compares"),
        (lambda x, u, theta, w: [x[1], math.floor(x[0]) + w[0]], "as a number"),
        (lambda x, u, theta, w: [x[1], w[0] * w[0]], "multiplied by itself"),
        (lambda x, u, theta, w: [x[1], 1 / (2 + w[0])], "divided by"),
        (lambda x, u, theta, w: [x[1], w[0] + (1.0 if isinstance(x[0], (float, np.ndarray)) else 2.0)], "other values"),
    ],
)
def test_what_cannot_be_read_is_called_and_says_why(derivative, why, swing):
    with pytest.warns(lacuna.Remark, match=why):
        lacuna.simulate(made(derivative), swing, init=0)


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
    assert 'value = "J*qdd + G*sin(q)"' in model.to_toml()
    cause = lacuna.diagnose(model, record).causes[0]
    assert (cause.effect, cause.into, cause.of) == ("coulomb_friction", "tau", "qd")
    with pytest.raises(lacuna.CallError, match="no function gives the derivatives"):
        lacuna.Model.from_function(states=["x"], inputs=["u"], outputs=["y"])
