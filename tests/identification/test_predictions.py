"""Identification by predictions: a cart-pole from positions alone, a servo's gains and delay."""

from __future__ import annotations

import numpy as np
import pytest
from tests.identification.robots import STEP, errors, load, truth

from carom import PositionActuator, identify
from carom.identification.link_inertia import set_link_inertia

_FORCE = "physics.slider_to_cart.torque"
_NOISE = 5e-4


def _cartpole_log(seed, count=240):
    rng = np.random.default_rng(seed)
    world, robot = load("cartpole.urdf")
    set_link_inertia(robot, robot.links["pole"].index, 0.35, (0.0, 0.0, 0.4), np.diag([0.02, 0.02, 0.002]))
    cart, pole = robot.joints.movable
    cart.damping, pole.damping = 0.5, 0.03
    pole.reset(0.5)
    time = STEP * np.arange(count)
    force = 8.0 * np.sin(2 * np.pi * 0.7 * time) + 6.0 * np.sin(2 * np.pi * 1.9 * time)
    positions = np.zeros((count, 2))
    for row in range(count):
        positions[row] = robot.joints.positions
        cart.set_torque(force[row])
        world.step()
    positions += rng.normal(0.0, _NOISE, positions.shape)
    return {"time": time, "positions": positions, "controls": {_FORCE: force}}, truth(robot)


def _model():
    world, robot = load("cartpole.urdf")
    set_link_inertia(robot, robot.links["pole"].index, 0.2, (0.0, 0.0, 0.5), np.diag([0.02, 0.02, 0.002]))
    return world, robot


@pytest.mark.long
@pytest.mark.parametrize("seed", [1])
def test_mass_length_and_damping_of_a_pole_are_recovered_from_positions(seed):
    log, true = _cartpole_log(seed)
    world, robot = _model()
    result = identify(log, world, ["physics.pole.inertial", "damping"], horizon=120)
    off = errors(result, true)
    assert np.abs(off).max() < 1.0
    start = "physics.pole.inertial"
    mass, moment = (result.values[f"{start}.{name}"] for name in ("mass", "moment.z"))
    assert mass == pytest.approx(0.35, abs=0.01)
    assert moment / mass == pytest.approx(0.4, abs=0.01)
    assert result.values["physics.cart_to_pole.damping"] == pytest.approx(0.03, abs=1e-3)
    assert result.bounds["physics.cart_to_pole.damping"] < 2e-3
    for noise in result.noise.values():
        assert noise == pytest.approx(_NOISE, rel=0.15)
    # It turns about one axis only.
    assert f"{start}.inertia.zz" in result.ineffective
    result.apply(world)
    frame = robot.link_inertial_frame(robot.links["pole"].index)
    assert frame.position[2] == pytest.approx(moment / mass, rel=1e-9)
    assert robot.joints["cart_to_pole"].damping == result.values["physics.cart_to_pole.damping"]


def test_one_step_predictions_from_measured_states_need_velocities_only():
    world, robot = load("cartpole.urdf")
    robot.joints.movable[1].damping = 0.2
    robot.joints.movable[1].reset(0.5)
    rows = []
    for _ in range(60):
        rows.append((robot.joints.positions, robot.joints.velocities))
        world.step()
    positions, velocities = (np.array(column) for column in zip(*rows, strict=True))
    log = {"time": STEP, "positions": positions, "velocities": velocities}
    other, _ = load("cartpole.urdf")
    name = "physics.cart_to_pole.damping"
    result = identify(log, other, [name], horizon=2, starts="measured")
    assert result.values[name] == pytest.approx(0.2, rel=1e-6)


def test_gains_and_delay_of_a_servo_are_recovered():
    def servo(kp, kv):
        world, robot = load("cartpole.urdf")
        robot.add_actuator("servo", PositionActuator("slider_to_cart", kp=kp, kv=kv))
        return world, robot

    world, robot = servo(300.0, 20.0)
    rng = np.random.default_rng(1)
    count, delay = 240, 0.0205
    time = STEP * np.arange(count)

    def command(t):
        return 0.3 * np.sin(2 * np.pi * 0.9 * t) + 0.1 * np.sin(2 * np.pi * 2.3 * t)

    positions = np.zeros((count, 2))
    for row in range(count):
        positions[row] = robot.joints.positions
        robot.actuators["servo"].control = float(command(max(time[row] - delay, 0.0)))
        world.step()
    positions += rng.normal(0.0, 2e-4, positions.shape)
    control = "physics.servo.control"
    log = {"time": time, "positions": positions, "controls": {control: command(time)}}
    other, _ = servo(150.0, 10.0)
    names = ["physics.servo.gain.0", "physics.servo.bias.1", "physics.servo.bias.2", "delays"]
    result = identify(log, other, names, horizon=120)
    true = dict(zip(result.values, [300.0, -300.0, -20.0, delay], strict=True))
    for name, value in true.items():
        assert abs(result.values[name] - value) < result.bounds[name]
        assert result.bounds[name] < 0.05 * abs(value) + 1e-3
    assert result.delays == {control: result.values[f"{control}.delay"]}


def test_a_log_of_another_rate_is_refused():
    log, _ = _cartpole_log(1, 30)
    world, _ = _model()
    with pytest.raises(ValueError, match="time step"):
        identify({**log, "time": 2.0 * log["time"]}, world, ["damping"])
    with pytest.raises(ValueError, match="no control"):
        identify(log, world, ["physics.cart.control.delay"])
