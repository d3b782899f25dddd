"""Linearised steps of bodies without contacts, beside central differences."""

from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from tests.algorithms.moving_robots import ROBOTS, load
from tests.joints.test_actuators import all_kinds
from tests.linearization.scenes import ASSETS, assert_exact, excite, motors_off, new_world, statuses, tighten

from carom import Motor, PositionActuator
from carom.description.pose import Pose
from carom.examples import robot_file
from carom.layouts.codes import UserConstraintKind as Kind

ARM = Path(__file__).parent / "friction.urdf"
PENDULUM = robot_file("one_joint_arm.urdf")
INERTIAL = ["masses", "inertias", "armature", "stiffness", "damping"]


@pytest.mark.parametrize("name", ROBOTS)
@pytest.mark.parametrize("driven", [False, True])
def test_robots_with_all_kinds_of_joints_are_exact(name, driven):
    world = new_world()
    body = load(world, name)
    excite(body)
    if not driven:
        motors_off(body)
    for link, count in enumerate(body.velocity_count):
        if count:
            terms = {"joint_armature": 0.02, "joint_stiffness": 3.0, "joint_damping": 0.1}
            body.change_dynamics(link, **terms)
    body.change_dynamics(-1, linear_damping=0.1, angular_damping=0.2)
    rng = np.random.default_rng(1)
    world.link_force[body.first_link + 1, :] = rng.normal(size=6)
    assert_exact(world, parameters=INERTIAL)


def test_a_pendulum_with_torque_has_the_textbook_derivatives():
    world = new_world()
    world.gravity = (0.0, 0.0, -9.81)
    body = world.load_urdf(PENDULUM, fixed_base=True)
    motors_off(body)
    body.change_dynamics(-1, linear_damping=0.0, angular_damping=0.0)
    step = assert_exact(world)
    h = world.parameters.time_step
    stiffness, inverse = -step.A[1, 0] / h, step.B[1, 0] / h
    assert stiffness * inverse != 0.0
    assert (
        pytest.approx(np.array([[1.0 - h * h * stiffness, h * step.A[1, 1]], [-h * stiffness, step.A[1, 1]]]))
        == step.A
    )
    assert pytest.approx(np.array([[h * h * inverse], [h * inverse]])) == step.B
    assert step.states == (
        f"{body.name}.{body.joints[0].name}.position",
        f"{body.name}.{body.joints[0].name}.velocity",
    )


@pytest.mark.parametrize("as_pybullet", [True, False])
def test_a_panda_with_motors_within_and_at_their_bounds(as_pybullet):
    world = new_world()
    body = world.load_urdf(f"{ASSETS}/franka_panda/panda.urdf", fixed_base=True, as_pybullet=as_pybullet)
    excite(body, share=0.2)
    movable = body.joints.movable
    for joint in movable[:3]:
        joint.set_position_target(0.3, gain=0.01, velocity_gain=0.7, max_force=1e4)
    movable[3].set_position_target(-1.0, max_force=5.0)
    movable[4].set_position_target(-1.0, max_velocity=0.2, max_force=1e4)
    movable[5].set_velocity_target(0.3, gain=0.8, max_force=1e4)
    gains = ["motor_position_gains", "motor_velocity_gains"]
    chosen = [f"panda.{joint.name}.motor_force" for joint in movable[:6]]
    step = assert_exact(
        world, controls=["torques", "target_positions", "target_velocities"], parameters=[*gains, *chosen]
    )
    found = statuses(step)
    assert found["motor of panda.panda_joint1"] == ["holds"]
    assert found["motor of panda.panda_joint4"][0].startswith("at its")
    assert found["motor of panda.panda_joint5"] == ["at its greatest velocity"]
    # The fingers are coupled in the reading as written.
    assert any(name.startswith("coupling") for name in found) is not as_pybullet


def test_spherical_motors_are_exact():
    world = new_world()
    body = world.load_urdf(f"{ASSETS}/humanoid/humanoid.urdf", (0.0, 0.0, 4.0))
    excite(body)
    motors_off(body)
    body.joints["chest"].set_orientation_target((0.1, 0.2, 0.3, 0.9), gain=0.4, damping=0.8, max_force=1e5)
    found = statuses(assert_exact(world))
    assert found[f"motor of {body.name}.chest"] == ["holds"] * 3


def test_limits_are_exact_and_friction_of_joints_sticks_or_slides():
    world = new_world()
    body = world.load_urdf(f"{ASSETS}/kuka_iiwa/model.urdf", fixed_base=True, as_pybullet=False)
    excite(body, share=0.3)
    motors_off(body)
    joint = body.joints.movable[1]
    world.position[body.position_index[joint.index]] = body.spec.links[joint.index].upper + 0.01
    world.velocity[body.velocity_index[joint.index]] = 1.0
    found = statuses(assert_exact(world, parameters=["masses"]))
    assert found[f"limit of {body.name}.{joint.name}"] == ["holds"]


def test_friction_of_joints_is_exact_where_it_sticks_and_where_it_slides():
    world = new_world()
    body = world.load_urdf(ARM, fixed_base=True, as_pybullet=False)
    body.joints["lower"].reset(0.0, 2.0)
    step = assert_exact(world, parameters=["joint_friction"])
    assert dict(step.rows) == {
        "friction of arm.upper": "holds",
        "friction of arm.lower": "at its lower bound",
    }


@pytest.mark.parametrize("control", [0.0, 0.3])
def test_actuators_of_all_kinds_are_exact_with_their_activations(control):
    body = all_kinds()
    world = body.world
    tighten(world)
    body.actuators.controls = [control, 0.0, 0.3, 1.5, 1.0, 0.4, 0.4]
    for link, count in enumerate(body.velocity_count):
        if count:
            body.change_dynamics(link, joint_armature=0.3, joint_damping=0.2)
    # Terms that are 0 are at a switch: stiffness and damping are implicit, their opposites are not.
    chosen = [
        f"{body.name}.{actuator.name}.{kind}.{term}"
        for actuator in body.actuators
        for kind in ("gain", "bias")
        for term in range(3)
        if term == 0 or actuator.spec.bias[term] != 0.0
    ]
    step = assert_exact(world, controls=["actuators"], parameters=[*chosen, "armature", "damping"])
    assert sum(name.endswith(".activation") for name in step.states) == 3
    acting = np.abs(step.B).max(axis=0) > 0.0
    assert acting.tolist() == [True, False, True, True, True, True, True]
    assert ("actuator of three.two", "at its upper bound") in step.rows


def test_a_saturated_actuator_does_not_depend_on_its_control():
    world = new_world()
    body = world.load_urdf(ARM, fixed_base=True, as_pybullet=False)
    body.add_actuator("servo", PositionActuator("lower", kp=30.0, kv=2.0, force_range=(-1.0, 1.0)))
    body.actuators.controls = [5.0]
    step = assert_exact(world, controls=["actuators"])
    assert ("actuator of arm.lower", "at its upper bound") in step.rows
    assert not step.B.any()


@pytest.mark.parametrize("control", [0.5, 3.0])
def test_a_control_out_of_its_range_has_no_effect(control):
    world = new_world()
    body = world.load_urdf(ARM, fixed_base=True, as_pybullet=False)
    body.add_actuator("direct", Motor("lower", control_range=(-1.0, 1.0)))
    body.add_actuator("slow", PositionActuator("lower", kp=5.0, time_constant=0.1, control_range=(-1.0, 1.0)))
    body.actuators.controls = [control, control]
    step = assert_exact(world, controls=["actuators"])
    # The slow one acts on its activation only.
    assert step.B[:-1].any() == step.B[-1].any() == (control < 1.0)


def test_several_steps_hold_controls_and_torques():
    world = new_world()
    body = world.load_urdf(f"{ASSETS}/cartpole.urdf", fixed_base=True)
    motors_off(body)
    excite(body)
    body.joints.set_torques([3.0, 0.5])
    one = world.linearize()
    step = assert_exact(world, steps=5, parameters=["masses"])
    assert np.abs(step.B[-2:]).max() > 4.0 * np.abs(one.B[-2:]).max()


@pytest.mark.parametrize("kind", [Kind.POINT_TO_POINT, Kind.FIXED, Kind.PRISMATIC])
def test_bodies_tied_together_are_exact(kind):
    world = new_world()
    cube = world.load_urdf(f"{ASSETS}/cube.urdf", (3.0, 0.0, 1.5))
    arm = world.load_urdf(f"{ASSETS}/kuka_iiwa/model.urdf", fixed_base=True)
    excite(cube)
    excite(arm, share=0.3)
    frames = Pose((0.0, 0.0, 0.05)), Pose((-2.5, 0.2, 0.2))
    world.constrain_links(
        kind, arm, 6, cube, -1, axis=(0.0, 0.6, 0.8), parent_frame=frames[0], child_frame=frames[1]
    )
    step = assert_exact(world, parameters=["masses"])
    assert {status for name, status in step.rows if "constraint" in name} == {"holds"}
    # A copy that is kept for the next call has all constraints.
    world.constrain_links(kind, cube, -1, None, -1, child_frame=Pose((3.1, 0.2, 1.4)))
    assert len(world.linearize().rows) > len(step.rows)


def test_what_a_world_was_changed_to_counts_in_the_next_call():
    world = new_world()
    body = world.load_urdf(f"{ASSETS}/cartpole.urdf", fixed_base=True)
    motors_off(body)
    before = world.linearize().A
    body.change_dynamics(1, mass=5.0)
    world.gravity = (0.0, 0.0, -2.0)
    assert np.abs(assert_exact(world).A - before).max() > 1e-3


def test_outputs_have_derivatives():
    world = new_world()
    body = world.load_urdf(f"{ASSETS}/cartpole.urdf", fixed_base=True)
    motors_off(body)
    step = world.linearize(outputs=lambda after: after.bodies[body.id].joints.positions)
    assert_allclose(step.C, step.A[:2], rtol=0, atol=1e-8)
    assert_allclose(step.D, step.B[:2], rtol=0, atol=1e-8)


def test_mistakes_are_named():
    world = new_world()
    body = world.load_urdf(f"{ASSETS}/cartpole.urdf", fixed_base=True)
    with pytest.raises(ValueError, match="did you mean 'torques'"):
        world.linearize(["torque"])
    with pytest.raises(ValueError, match="there is no parameter 'length'"):
        world.linearize(parameters=["length"])
    name = f"{body.name}.slider_to_cart.torque"
    with pytest.raises(ValueError, match="chosen twice"):
        world.linearize([name, "torques"])
    with pytest.raises(ValueError, match="steps must be at least 1"):
        world.linearize(steps=0)
    with pytest.raises(ValueError, match="method must be"):
        world.linearize(method="exactly")
    world.parameters.substeps = 2
    world.apply_parameters()
    with pytest.raises(NotImplementedError, match="substeps"):
        world.linearize(method="exact")
    assert world.linearize(method="differences").A.shape == (4, 4)
    assert world.linearize([name], method="differences").controls == (name,)


def test_smoothing_lets_rows_yield():
    world = new_world()
    body = world.load_urdf(f"{ASSETS}/cartpole.urdf", fixed_base=True)
    body.joints["slider_to_cart"].set_velocity_target(0.0, max_force=1e4)
    firm, soft = world.linearize(), world.linearize(smoothing=0.1)
    free_body = world.copy()
    motors_off(free_body.bodies[body.id])
    free = free_body.linearize()
    assert abs(firm.B[2, 0]) < 1e-12
    assert_allclose(soft.B[2, 0], 0.1 / 1.1 * free.B[2, 0], rtol=1e-9)


def test_differences_take_the_place_of_what_is_not_exact_and_say_so(caplog):
    world = new_world()
    load(world, "panda")
    assert world.linearize().method == "exact"
    world.substeps = 2
    with caplog.at_level("WARNING"):
        found = world.linearize()
        world.linearize()
    assert (found.method, found.rows) == ("differences", ())
    assert np.array_equal(found.A, world.linearize(method="differences").A)
    (message,) = (record.message for record in caplog.records)
    assert message.startswith(
        "derivatives are central differences of steps, not exact ones: steps of several"
    )
    with pytest.raises(NotImplementedError, match="substeps"):
        world.linearize(smoothing=0.1)
