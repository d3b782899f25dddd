"""A number that is none, written straight into the arrays of a world, is found at the next step and named."""

from __future__ import annotations

import numpy as np
import pytest

import pybullet_data
from carom import World
from carom.errors import SimulationError

JOINT = 2


def arm() -> World:
    world = World()
    world.load_urdf(f"{pybullet_data.getDataPath()}/kuka_iiwa/model.urdf", fixed_base=True)
    body = world.bodies[0]
    for joint in range(body.joint_count):
        row = body.velocity_index[joint]
        world.motor[row, :6] = [0.1, 0.0, 0.1, 1.0, 1.0, np.inf]
    return world


@pytest.mark.parametrize(
    ("column", "name"),
    [
        (0, "target position"),
        (1, "target velocity"),
        (2, "position gain"),
        (3, "velocity gain"),
        (4, "greatest impulse"),
        (5, "velocity clamp"),
    ],
)
def test_motors(column: int, name: str) -> None:
    world = arm()
    world.step()
    row = world.bodies[0].velocity_index[JOINT]
    before = world.motor[row, column]
    world.motor[row, column] = np.nan
    position = world.position.copy()
    message = rf"the {name} of the motor of joint {JOINT} \('lbr_iiwa_joint_3'\) is NaN"
    with pytest.raises(SimulationError, match=message):
        world.step()
    assert (world.position == position).all()
    world.motor[row, column] = before
    world.step()


@pytest.mark.parametrize(("column", "name"), [(0, "target position"), (4, "greatest force")])
def test_pd_control(column: int, name: str) -> None:
    world = arm()
    row = world.bodies[0].velocity_index[JOINT]
    world.pd[row, :5] = [0.1, 0.0, 10.0, 1.0, 100.0]
    world.step()
    world.pd[row, column] = np.nan
    with pytest.raises(SimulationError, match=rf"the {name} of the PD control of joint {JOINT}"):
        world.step()


def test_coordinates() -> None:
    world = arm()
    world.step()
    body = world.bodies[0]
    world.position[body.first_position + 8] = np.nan
    with pytest.raises(SimulationError, match="entry 8 of its position coordinates is NaN"):
        world.step()
    world.position[body.first_position + 8] = 0.0
    world.velocity[body.velocity_index[0]] = np.nan
    with pytest.raises(SimulationError, match="velocity coordinates is NaN"):
        world.step()
