"""Derivatives where something is 0: worlds without state, gains, sensors that see no motion."""

from typing import Any

import numpy as np
import pytest
from tests.linearization.scenes import ASSETS, assert_exact, new_world

from carom import Gyro, PositionActuator, VelocityActuator, World


def cartpole(actuator: Any) -> World:
    world = new_world()
    body = world.load_urdf(f"{ASSETS}/cartpole.urdf", (0.0, 0.0, 3.0), fixed_base=True)
    body.joints.free()
    body.joints.movable[0].reset(0.2, 1.0)
    body.joints.movable[1].reset(0.5, -0.7)
    body.add_actuator("pusher", actuator)
    body.actuators.controls = [0.5]
    return world


@pytest.mark.parametrize("method", ["exact", "differences"])
def test_a_world_without_state_has_empty_derivatives(method: str):
    world = World()
    world.load_urdf(f"{ASSETS}/plane.urdf")
    step = world.linearize(method=method, steps=2)
    assert step.A.shape == (0, 0)
    assert step.B.shape == (0, 0)


@pytest.mark.parametrize("kp", [10.0, 0.0])
def test_derivatives_by_a_gain_that_is_0_are_the_mean_of_both_sides(kp: float):
    world = cartpole(PositionActuator("slider_to_cart", kp=kp, kv=0.0))
    exact = assert_exact(world, atol=1e-8, parameters=["actuator_gains", "actuator_biases"])
    assert np.abs(exact.E).max() > 1e-3
    world = cartpole(VelocityActuator("slider_to_cart", kv=0.0))
    assert_exact(world, atol=1e-8, parameters=["actuator_gains", "actuator_biases"])


def test_the_gyroscope_of_the_tutorial_sees_the_pole():
    world = cartpole(PositionActuator("slider_to_cart", kp=10.0))
    body = world.bodies[min(world.bodies.keys())]
    body.add_site("tip", body.links["pole"].index)
    body.add_sensor("imu", Gyro(site="tip"))
    step = world.linearize(outputs=body.sensors)
    assert np.abs(step.C).max() > 0.5
