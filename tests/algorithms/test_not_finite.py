"""Answers that are not finite: the error names the joint."""

from pathlib import Path

import numpy as np
import pytest

from carom import Body, World, Worlds, algorithms
from carom.controllers import OperationalSpaceControl

LIGHT = """
<robot name="r"><link name="base"/>
<link name="a"><inertial><mass value="1"/>
<inertia ixx=".01" iyy=".01" izz=".01" ixy="0" ixz="0" iyz="0"/></inertial></link>
<link name="b"/>
<joint name="shoulder" type="continuous"><parent link="base"/><child link="a"/><axis xyz="1 0 0"/></joint>
<joint name="wrist" type="continuous"><parent link="a"/><child link="b"/><axis xyz="0 1 0"/></joint>
</robot>"""


@pytest.fixture
def light(tmp_path: Path) -> Body:
    path = tmp_path / "light.urdf"
    path.write_text(LIGHT)
    return World().load_urdf(str(path), fixed_base=True)


def test_a_joint_that_moves_no_inertia_is_named(light: Body):
    for ask in (algorithms.forward_dynamics, algorithms.forward_dynamics_derivatives):
        with pytest.raises(ValueError, match="joint 'wrist' of 'r' moves nothing with inertia"):
            ask(light, [0.0, 0.0], [0.0, 0.0], [0.0, 1.0])


def test_control_in_task_space_names_the_joint(light: Body):
    control = OperationalSpaceControl(light, "b")
    with pytest.raises(ValueError, match="joint 'wrist' of 'r' moves nothing with inertia"):
        control.compute((0.0, 0.0, 0.0))


def test_a_joint_that_is_too_fast_is_named(light: Body):
    with pytest.raises(ValueError, match="velocity 1e\\+200 of joint 'shoulder' of 'r' is too large"):
        algorithms.inverse_dynamics(light, [0.0, 0.0], [1e200, 0.0], [0.0, 0.0])


def test_the_joint_is_named_in_many_worlds(light: Body):
    worlds = Worlds(light.world, 3)
    forces = np.zeros((3, 2))
    forces[:, 1] = 1.0
    with pytest.raises(
        ValueError, match=r"in world 0 the .* joint 'wrist' of 'r' moves nothing with inertia"
    ):
        worlds[0].forward_dynamics(forces)
