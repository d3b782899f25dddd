"""Steps linearised by the places of joints in their parents, beside central differences."""

from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from tests.algorithms.moving_robots import ROBOTS, load
from tests.linearization.scenes import ASSETS, assert_exact, excite, motors_off, new_world

from carom import World, Worlds
from carom.layouts.codes import UserConstraintKind as Kind
from carom.linearization.input_values import InputValues
from carom.linearization.inputs import PARAMETERS, chosen_inputs
from carom.linearization.tangent import TangentSpace


@pytest.mark.parametrize("name", ROBOTS)
def test_offsets_of_robots_are_exact(name):
    world = new_world()
    body = load(world, name)
    excite(body)
    for joint in body.joints.movable[::2]:
        if body.velocity_count[joint.index] == 1:
            joint.set_velocity_target(0.0, max_force=0.0)
    body.change_dynamics(-1, linear_damping=0.3, angular_damping=0.2)
    rng = np.random.default_rng(1)
    world.link_force[body.first_link + 1 :, :] = rng.normal(size=6)
    step = assert_exact(world, parameters=["offsets", "masses"])
    links = [link.name for link in body.spec.links]
    assert step.parameters[2] == f"{body.name}.{links[0]}.offset.z"
    assert np.abs(step.E[:, : 3 * len(links)]).max() > 1e-3


def test_limits_and_several_steps_follow_offsets():
    world = new_world()
    body = world.load_urdf(f"{ASSETS}/kuka_iiwa/model.urdf", fixed_base=True, as_pybullet=False)
    excite(body, share=0.3)
    motors_off(body)
    joint = body.joints.movable[1]
    world.position[body.position_index[joint.index]] = body.spec.links[joint.index].upper + 0.01
    world.velocity[body.velocity_index[joint.index]] = 1.0
    step = assert_exact(world, parameters=["offsets"], steps=2)
    assert any(name.startswith("limit") for name, _ in step.rows)


ARM = """<robot name="arm"><link name="base"/>
<joint name="a" type="continuous"><parent link="base"/><child link="upper"/><axis xyz="0 1 0"/></joint>
<link name="upper"><inertial><origin xyz="0.1 0 -0.2" rpy="0.4 -0.7 1.1"/><mass value="2"/>
<inertia ixx="0.1" iyy="0.2" izz="0.15" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="b" type="continuous"><parent link="upper"/><child link="lower"/><axis xyz="1 0 0"/>
<origin xyz="{} {} {}" rpy="0.3 0.2 0.1"/></joint>
<link name="lower"><inertial><origin xyz="0 0.2 -0.1"/><mass value="1"/>
<inertia ixx="0.05" iyy="0.02" izz="0.05" ixy="0" ixz="0" iyz="0"/></inertial></link></robot>"""


def arm(folder: Path, origin: np.ndarray) -> World:
    """An arm in motion, the second joint of which has an origin in the first link."""
    file = folder / "arm.urdf"
    file.write_text(ARM.format(*(repr(float(number)) for number in origin)))
    world = new_world()
    body = world.load_urdf(file, fixed_base=True, as_pybullet=False)
    excite(body)
    return world


def test_offsets_are_those_of_the_origins_in_files(tmp_path):
    origin, size = np.array([0.2, -0.1, -0.4]), 1e-5
    chosen = [f"arm.lower.offset.{axis}" for axis in "xyz"]
    world = arm(tmp_path, origin)
    many = Worlds(world, 2).linearize(parameters=chosen)
    lone = world.linearize(parameters=chosen)
    assert (many.E[1] == lone.E).all()
    for axis in range(3):
        ends = [arm(tmp_path, origin + sign * size * np.eye(3)[axis]) for sign in (1.0, -1.0)]
        for end in ends:
            end.step()
        (body,) = world.bodies.values()
        change = (ends[0].velocity - ends[1].velocity)[list(body.velocity_index)] / (2.0 * size)
        assert_allclose(lone.E[2:, axis], change, rtol=0, atol=1e-8)
    assert np.abs(lone.E[2:]).max() > 1e-3


FLOATING = """<mujoco><worldbody><body name="arm" gravcomp="0.3"><joint type="hinge" axis="0 1 0"/>
<geom size=".1" pos=".2 0 .1" mass="2"/><body name="fore" pos=".4 .1 0" gravcomp="1.2">
<joint type="hinge" axis="0 1 0.3"/><geom size=".1" pos=".2 .1 0" mass="1"/></body></body></worldbody>
</mujoco>"""


def test_offsets_follow_gravity_that_is_compensated(tmp_path):
    (tmp_path / "arm.xml").write_text(FLOATING)
    world = new_world()
    (body,) = world.load_mjcf(tmp_path / "arm.xml")
    excite(body)
    motors_off(body)
    step = assert_exact(world, parameters=["offsets"])
    assert np.abs(step.E).max() > 1e-3


def test_offsets_of_what_touches_or_is_held_need_differences():
    world = new_world()
    body = load(world, "laikago")
    excite(body)
    motors_off(body)
    chosen = [f"{body.name}.{body.spec.links[3].name}.offset.x"]
    world.constrain_links(Kind.POINT_TO_POINT, body, 3, None, -1)
    with pytest.raises(NotImplementedError, match="where it touches or is held"):
        world.linearize(parameters=chosen, method="exact")
    assert world.linearize(parameters=chosen, method="differences").E.any()
    with pytest.raises(NotImplementedError, match="is geometry"):
        space = TangentSpace(world)
        InputValues(space, chosen_inputs(world, space, PARAMETERS, chosen, "parameter"))
