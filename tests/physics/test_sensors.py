"""Force-torque sensors against the weight they carry and against Newton's law."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose
from tests.physics.aba_reference import rotation
from tests.physics.contact_scenes import (
    HALF,
    WEIGHT,
    add_ball,
    add_box,
    add_plate_on_a_stand,
    earth,
    impulses,
)
from tests.physics.one_joint import DT, WEIGHT_MOMENT, Motor, hanging_rod, joint_state, place
from tests.physics.robots import ALL_TYPES, coordinates, let_go, put_in_motion, random_tree

from carom import Body, World
from carom.description import JointType, Pose
from carom.layouts.codes import MOTOR_MAX_IMPULSE, MOTOR_VELOCITY, UserConstraintKind
from carom.model.body_spec import BASE, BodySpec

WORLD_AXES, ABOUT_JOINT = 1, 2


def sensing(body: Body, mode: int, *joints: int) -> None:
    for joint in joints:
        body.set_sensor(joint, True)
    body.world.parameters.joint_feedback_mode = mode
    body.world.apply_parameters()


@pytest.mark.parametrize("angle", [0.0, 0.7, math.pi / 2])
@pytest.mark.parametrize("held_by", ["weld", "torque", "motor"])
def test_an_arm_at_rest_weighs_on_its_joint(held_by, angle):
    """The torque of a motor, unlike one that is applied, is not part of what the joint itself carries."""
    turned = Pose((0.0, 0.0, 0.0), (0.0, math.sin(angle / 2), 0.0, math.cos(angle / 2)))
    body = hanging_rod(
        time_step=1e-5,
        joint_type=JointType.FIXED if held_by == "weld" else JointType.REVOLUTE,
        joint_frame=turned,
    )
    if held_by == "torque":
        let_go(body)
    weight, moment = 2.0 * 9.81, WEIGHT_MOMENT * math.sin(angle)
    along, across = weight * math.cos(angle), -weight * math.sin(angle)
    # About its centre of mass a rod at rest needs no moment; about the joint it is that of its weight.
    about_com = -moment if held_by == "motor" else 0.0
    expected = {
        WORLD_AXES | ABOUT_JOINT: [0.0, 0.0, weight, 0.0, moment + about_com, 0.0],
        WORLD_AXES: [0.0, 0.0, weight, 0.0, about_com, 0.0],
        ABOUT_JOINT: [across, 0.0, along, 0.0, moment + about_com, 0.0],
        0: [across, 0.0, along, 0.0, about_com, 0.0],
    }
    for mode, wrench in expected.items():
        sensing(body, mode, 0)
        if held_by == "torque":
            body.world.joint_torque[6] = moment
        body.world.step()
        assert_allclose(body.world.joint_reaction[1], wrench, rtol=0, atol=1e-6)


def test_a_swinging_rod_pulls_outwards():
    """The free rod's joint carries its weight along the rod and the centripetal force."""
    body = hanging_rod()
    let_go(body)
    sensing(body, 0, 0)
    place(body, 0.0, 3.0)
    body.world.step()
    assert_allclose(body.world.joint_reaction[1, :3], [0.0, 0.0, 2.0 * (9.81 + 9.0 * 0.5)], atol=1e-12)
    place(body, math.pi / 2, 0.0)
    body.world.step()
    # Released from the horizontal, a joint carries a quarter of a rod.
    assert_allclose(body.world.joint_reaction[1, :3], [-2.0 * 9.81 / 4, 0.0, 0.0], atol=1e-12)


def test_a_plate_weighs_what_lies_on_it_and_hangs_from_it():
    world = earth()
    plate = add_plate_on_a_stand(world)
    add_box(world, (0.0, -HALF, 1.0 + HALF))
    hanging = add_ball(world, (0.0, 0.0, 0.5))
    frame = Pose((0.0, 0.0, 0.5 - HALF))
    world.constrain_links(UserConstraintKind.POINT_TO_POINT, plate, 0, hanging, BASE, child_frame=frame)
    sensing(plate, WORLD_AXES, 0)
    alone = world.copy()
    alone.bodies[plate.id].set_sensor(0, False)
    world.step(480)
    alone.step(480)
    assert_allclose(world.joint_reaction[1], [0.0, 0.0, 3.0 * WEIGHT, -HALF * WEIGHT, 0.0, 0.0], atol=1e-3)
    np.testing.assert_array_equal(world.position, alone.position)
    np.testing.assert_array_equal(world.velocity, alone.velocity)


@pytest.mark.parametrize("substeps", [1, 4])
def test_forces_are_those_of_the_last_substep(substeps):
    world = earth(substeps=substeps)
    plate = add_plate_on_a_stand(world)
    add_ball(world, (0.0, 0.0, 1.0 + HALF))
    sensing(plate, WORLD_AXES, 0)
    world.step(20)
    (impulse,) = impulses(world)
    assert_allclose(world.joint_reaction[1, 2], WEIGHT + impulse[0] * substeps / DT, rtol=1e-12)
    assert world.joint_reaction[1, 2] > 1.5 * WEIGHT


def subtree(spec: BodySpec, joint: int) -> list[int]:
    links = [joint]
    for j, link in enumerate(spec.links):
        if link.parent in links:
            links.append(j)
    return links


def force_on_subtree(body: Body, joint: int, placed: np.ndarray, time_step: float) -> np.ndarray:
    """Force and moment about the link's centre of mass that a body set off from rest by one step took."""
    moved = coordinates(body)[0]
    moved[:] = placed
    body.update_link_poses()
    body.update_link_velocities()
    world, spec = body.world, body.spec
    centre = world.link_pose[body.first_link + 1 + joint, :3]
    total = np.zeros(6)
    for link in subtree(spec, joint):
        row = body.first_link + 1 + link
        pose, twist = world.link_pose[row], world.link_velocity[row]
        axes = rotation(pose[3:])
        force = spec.links[link].mass * (twist[:3] / time_step - world.gravity)
        total[:3] += force
        total[3:] += axes @ (spec.links[link].inertia * (axes.T @ twist[3:])) / time_step
        total[3:] += np.cross(pose[:3] - centre, force)
    return total


@pytest.mark.parametrize("fixed_base", [True, False], ids=["fixed", "free"])
@pytest.mark.parametrize("has_motors", [False, True], ids=["loose", "driven"])
def test_sensors_obey_newton(has_motors, fixed_base):
    """In the limit of short steps: the pass for motor forces sees the rates of the pass before."""
    time_step = 1e-6
    world = World(time_step)
    world.gravity = (0.5, -1.0, -9.81)
    # As in Bullet the force of a prismatic motor counts at the centres of mass of both links, which is a
    # moment too many for the joints that carry them.
    types = (JointType.REVOLUTE, JointType.FIXED) if has_motors else ALL_TYPES
    body = world.load(random_tree(32, 10, fixed_base=fixed_base, joint_types=types))
    let_go(body)
    put_in_motion(body, np.random.default_rng(32), speed=0.0)
    sensing(body, WORLD_AXES, *range(10))
    rng = np.random.default_rng(1)
    joints = slice(6, 6 + sum(body.velocity_count))
    world.joint_torque[joints] = rng.normal(size=joints.stop - 6)
    if has_motors:
        world.motor[joints, MOTOR_VELOCITY] = rng.normal(size=joints.stop - 6)
        world.motor[joints, MOTOR_MAX_IMPULSE] = 5.0 * time_step
    placed = coordinates(body)[0].copy()
    world.step()
    motors = np.array([motor_wrench(body, joint, time_step) for joint in range(10)])
    assert motors.any() == has_motors
    measured = world.joint_reaction[1:11].copy()
    for joint in range(10):
        carried = force_on_subtree(body, joint, placed, time_step) - motors[joint]
        assert_allclose(measured[joint], carried, rtol=0, atol=1e-5 * np.abs(carried).max())


def test_a_slide_held_by_its_motor_carries_nothing_along_its_axis():
    body = hanging_rod(1e-5, joint_type=JointType.PRISMATIC, joint_axis=(0.0, 0.6, 0.8))
    sensing(body, WORLD_AXES, 0)
    body.world.step()
    # The weight but for what the motor takes of it.
    expected = 2.0 * 9.81 * (np.array([0.0, 0.0, 1.0]) - 0.8 * np.array([0.0, 0.6, 0.8]))
    assert_allclose(body.world.joint_reaction[1, :3], expected, rtol=0, atol=1e-4)
    assert_allclose(body.world.joint_reaction[1, 3:], 0.0, atol=1e-4)


def motor_wrench(body: Body, joint: int, time_step: float) -> np.ndarray:
    """Force and torque, world axes, that the motor of a revolute joint gave its link in the last step."""
    wrench, row = np.zeros(6), body.velocity_index[joint]
    if row >= 0:
        link = body.spec.links[joint]
        to_world = rotation(body.world.link_pose[body.first_link + 1 + joint, 3:])
        to_inertial = rotation(np.array(link.inertial_frame.orientation)).T
        axis = to_world @ to_inertial @ np.array(link.joint_axis)
        wrench[3:] = axis * body.world.motor_impulse[row] / time_step
    return wrench


def test_a_sensor_that_is_off_reads_zero_and_changes_nothing():
    runs = []
    for enabled in (True, False):
        body = hanging_rod()
        Motor(velocity=1.0, max_impulse=0.05).set_on(body)
        body.set_sensor(0, True)
        body.world.step(5)
        body.set_sensor(0, enabled)
        body.world.step(5)
        assert body.world.joint_reaction[1].any() == enabled
        runs.append(joint_state(body))
    assert runs[0] == runs[1]


def test_sensors_of_one_joint_leave_others_alone():
    world = World(contact="bullet")
    world.gravity = (0.0, 0.0, -9.81)
    body = world.load(random_tree(33, 5, fixed_base=True))
    body.change_dynamics(BASE, linear_damping=0.0)
    body.set_sensor(2, True)
    world.step()
    assert world.joint_reaction[3].any()
    assert not np.delete(world.joint_reaction, 3, axis=0).any()
