"""Predictions of robots with a free base, and of what their sensors show."""

from __future__ import annotations

import numpy as np
import pytest
from tests.identification.flying import disturb, flight, flyer, with_noise
from tests.identification.robots import errors, load, truth

from carom import Accelerometer, Gyro, identify
from carom.description.pose import Pose

_FORCE = "physics.slider_to_cart.torque"
_NAMES = ["damping", "physics.pole.inertial"]


def _cartpole(*, sensors: bool):
    world, robot = load("cartpole.urdf")
    robot.joints.movable[1].reset(0.5)
    if sensors:
        robot.add_site("tip", "pole", Pose((0.0, 0.02, 0.6)))
        robot.add_sensor("pull", Accelerometer("tip"))
        robot.add_sensor("turn", Gyro("tip"))
    return world, robot


def _log(count: int = 120):
    rng = np.random.default_rng(0)
    world, robot = _cartpole(sensors=True)
    cart, pole = robot.joints.movable
    cart.damping, pole.damping = 0.6, 0.05
    true = truth(robot)
    force = 8.0 * np.sin(0.03 * np.arange(count)) + 5.0 * np.sin(0.11 * np.arange(count))
    positions, seen = np.zeros((count, 2)), {"pull": np.zeros((count, 3)), "turn": np.zeros((count, 3))}
    for row in range(count):
        positions[row] = robot.joints.positions
        for name, values in seen.items():
            values[row] = robot.sensors[name].read()
        cart.set_torque(force[row])
        world.step()
    noise = {"pull": 0.02, "turn": 2e-3}
    seen = {name: it + rng.normal(0.0, noise[name], it.shape) for name, it in seen.items()}
    positions += rng.normal(0.0, 2e-3, positions.shape)
    return {"time": 1 / 240, "positions": positions, "controls": {_FORCE: force}}, seen, true


def test_an_accelerometer_and_a_gyro_beside_encoders_narrow_the_bounds():
    log, seen, true = _log()
    given, alone = (identify({**log, "sensors": it}, _cartpole(sensors=True)[0], _NAMES) for it in (seen, {}))
    for result in (given, alone):
        assert np.abs(errors(result, true)).max() < 1.0
    for joint in ("slider_to_cart", "cart_to_pole"):
        name = f"physics.{joint}.damping"
        assert given.bounds[name] < 0.5 * alone.bounds[name]
    assert given.noise["turn.0"] == pytest.approx(2e-3, rel=0.25)
    assert given.noise["pull.2"] == pytest.approx(0.02, rel=0.25)


def test_rows_without_a_reading_are_left_out():
    log, seen, true = _log(60)
    seen["turn"][::2] = np.nan
    seen.pop("pull")
    result = identify({**log, "sensors": seen}, _cartpole(sensors=True)[0], _NAMES)
    assert np.abs(errors(result, true)).max() < 1.0


def test_predictions_of_a_falling_robot_tell_damping_and_the_inertia_of_its_links(tmp_path):
    world, robot = flyer(tmp_path)
    rng = np.random.default_rng(2)
    for joint in robot.joints:
        joint.damping = rng.uniform(0.05, 0.2)
    lower = robot.links["lower"].index
    robot.change_dynamics(lower, mass=0.55, inertia=robot.dynamics(lower).inertia)
    true = truth(robot)
    log = with_noise(flight(world, robot, rng, 120, pushed=False), rng, 1e-4, 0.0)
    for name in ("velocities", "base_velocities"):
        log[name] = log[name] + rng.normal(0.0, 1e-3, log[name].shape)
    model, _ = flyer(tmp_path)
    names = ["flyer.lower.mass", "damping"]
    result = identify(log, model, names, residuals="prediction", horizon=30)
    for name, value in result.values.items():
        wanted = 0.55 if name.endswith("mass") else true[name]
        assert value == pytest.approx(wanted, abs=result.bounds[name])
        assert result.bounds[name] < 0.02 * wanted
    assert result.noise["base shift.x position"] == pytest.approx(1e-4, rel=0.3)
    assert result.noise["base turn.z velocity"] == pytest.approx(1e-3, rel=0.3)


def test_what_predictions_cannot_do_is_named(tmp_path):
    world, robot = flyer(tmp_path, sensors=True)
    rng = np.random.default_rng(3)
    disturb(robot, rng)
    log = flight(world, robot, rng, 30)
    with pytest.raises(NotImplementedError, match=r"do not apply forces on links: use residuals=\"torque\""):
        identify(log, world, ["damping"], residuals="prediction")
    log["forces"] = {}
    with pytest.raises(NotImplementedError, match=r"'push' shows \(force\) has no exact derivatives"):
        identify(log, world, ["damping"], residuals="prediction")
    log["sensors"] = {}
    with pytest.raises(NotImplementedError, match=r"centre of a base: .* \"masses\""):
        identify(log, world, ["inertial_parameters"], residuals="prediction")
    log |= {"base_positions": None, "base_orientations": None}
    with pytest.raises(ValueError, match="free base: the log needs base_positions"):
        identify(log, world, ["damping"], residuals="prediction")
