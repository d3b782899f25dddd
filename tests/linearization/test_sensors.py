"""Derivatives of what sensors show, beside central differences of their readings."""

from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose
from tests.algorithms.moving_robots import ROBOTS, load
from tests.linearization.scenes import ASSETS, excite, motors_off, new_world
from tests.rings import few

import carom
from carom import Body, PositionActuator, World
from carom.description import Pose
from carom.layouts.codes import JointCode
from carom.linearization import outputs
from carom.linearization.sensor_motion import has_jacobian

OF_FRAMES = ("FramePosition", "FrameQuaternion", "FrameXAxis", "FrameYAxis", "FrameZAxis")
OF_MOTIONS = ("FrameLinearVelocity", "FrameAngularVelocity")
OF_ACCELERATIONS = ("FrameLinearAcceleration", "FrameAngularAcceleration")
OF_SITES = ("Gyro", "Velocimeter", "Accelerometer", "Magnetometer")
OF_SUBTREES = (
    *("SubtreeCenterOfMass", "SubtreeLinearVelocity", "SubtreeLinearMomentum", "SubtreeAngularMomentum"),
)


def add(body: Body, kind: str, name: str = "", **arguments: Any) -> None:
    """Add a sensor, called by its kind if not otherwise."""
    body.add_sensor(name or kind, getattr(carom, kind)(**arguments))


def add_all(body: Body) -> None:
    """Add sensors of all kinds with exact derivatives, at the last link and seen from the first one."""
    names = [link.name for link in body.spec.links]
    body.add_site("tip", len(names) - 1, Pose((0.1, -0.2, 0.3), (0.5, -0.5, 0.5, 0.5)))
    body.add_site("seat", -1, Pose((0.0, 0.1, 0.05), (0.0, 0.6, 0.0, 0.8)))
    for kind in OF_SITES:
        for site in ("tip", "seat"):
            add(body, kind, f"{kind} of {site}", site=site)
    for kind in (*OF_FRAMES, *OF_MOTIONS):
        add(body, kind, site="tip")
        add(body, kind, f"{kind} from", inertial_frame=names[-1], reference_site="seat")
        add(body, kind, f"{kind} of link", link=names[0], reference_link=names[-1])
    for kind in OF_ACCELERATIONS:
        add(body, kind, link=names[-1])
    for kind in OF_SUBTREES:
        add(body, kind, link=names[0])
    add(body, "Clock")
    for code, joint in zip(body.joint_types, body.joints, strict=True):
        if code in (JointCode.REVOLUTE, JointCode.PRISMATIC):
            for kind in ("JointPosition", "JointVelocity", "JointLimitPosition", "JointLimitVelocity"):
                add(body, kind, f"{kind} of {joint.name}", joint=joint.name)
        if code == JointCode.SPHERICAL:
            for kind in ("BallQuaternion", "BallAngularVelocity"):
                add(body, kind, f"{kind} of {joint.name}", joint=joint.name)


def assert_outputs_exact(world: World, body: Body, **arguments: Any) -> Any:
    """Compare C and D of all sensors with central differences of their readings; returns the exact ones."""

    def readings(after: World) -> np.ndarray:
        return np.concatenate([sensor.read() for sensor in after.bodies[body.id].sensors])

    assert all(has_jacobian(body, spec) for spec in body.spec.sensors)
    exact = world.linearize(outputs=body.sensors, **arguments)
    # Of accelerations, which are divided by the time step, smaller changes leave rounding.
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(outputs, "_SIZE", 1e-5)
        near = world.linearize(outputs=readings, **arguments)
    assert exact.C.shape == near.C.shape == (len(exact.outputs), len(exact.states))
    for name in ("C", "D"):
        found, wanted = getattr(exact, name), getattr(near, name)
        bounds = 1e-6 * np.maximum(1.0, np.abs(wanted).max(axis=1, initial=0.0))
        off = np.abs(found - wanted).max(axis=1, initial=0.0) > bounds
        assert not off.any(), (name, [exact.outputs[row] for row in np.flatnonzero(off)])
    return exact


@pytest.mark.parametrize("name", few(ROBOTS, 2))
@pytest.mark.parametrize("steps", [1, 3])
def test_sensors_of_motion_are_exact(name, steps):
    world = new_world()
    body = load(world, name)
    excite(body)
    motors_off(body)
    add_all(body)
    controls = ["torques"]
    step = assert_outputs_exact(world, body, controls=controls, steps=steps)
    assert step.outputs[0] == f"{body.name}.Gyro of tip.0"
    assert f"{body.name}.Clock" in step.outputs
    row = step.outputs.index(f"{body.name}.Accelerometer of tip.0")
    assert np.abs(step.D[row]).max() > 1e-6


def test_a_sensor_that_is_seen_from_another_body_follows_both():
    world = new_world()
    arm, other = load(world, "panda"), load(world, "laikago")
    for body in (arm, other):
        excite(body)
        motors_off(body)
    world.position[other.first_position] += 9.0
    base = other.spec.base.name
    for kind in (*OF_FRAMES, *OF_MOTIONS):
        add(arm, kind, link="panda_link4", reference_link=base, reference_body=other.name)
    step = assert_outputs_exact(world, arm)
    moved = [name.startswith(f"{other.name}.base") for name in step.states]
    assert np.abs(step.C[:, moved]).max() > 0.1


def test_actuators_are_measured_and_cutoffs_hold():
    world = new_world()
    body = world.load_urdf(f"{ASSETS}/cartpole.urdf", fixed_base=True)
    motors_off(body)
    excite(body)
    body.add_actuator("servo", PositionActuator("slider_to_cart", kp=10.0))
    add(body, "ActuatorPosition", actuator="servo", bias=0.3)
    add(body, "ActuatorVelocity", actuator="servo", noise=0.1)
    add(body, "JointVelocity", "cut", joint="slider_to_cart", cutoff=1e-3)
    step = assert_outputs_exact(world, body, controls=["actuators"])
    assert step.C[:2].any(axis=1).all()
    assert not step.C[2].any()


def test_other_sensors_have_differences():
    world = new_world()
    body = world.load_urdf(f"{ASSETS}/cartpole.urdf", fixed_base=True)
    motors_off(body)
    excite(body)
    body.add_site("tip", "pole", Pose((0.0, 0.0, 0.1)))
    add(body, "Force", site="tip")
    add(body, "JointPosition", joint="slider_to_cart")
    add(body, "JointPosition", "held", joint="slider_to_cart", period=0.1)
    assert [has_jacobian(body, spec) for spec in body.spec.sensors] == [False, True, False]
    step = world.linearize(outputs=[body.sensors[1], body.sensors[0]])
    near = world.linearize(outputs=lambda after: after.bodies[body.id].sensors["Force"].read())
    assert step.outputs == (f"{body.name}.JointPosition", *(f"{body.name}.Force.{k}" for k in range(3)))
    assert_allclose(step.C[0], step.A[0], rtol=0, atol=1e-14)
    assert_allclose(step.C[1:], near.C, rtol=0, atol=1e-9)
    assert np.abs(near.C).max() > 0.1
    assert world.linearize(outputs=()).C.shape == (0, 4)


def test_differences_have_outputs_as_well():
    world = new_world()
    body = load(world, "panda")
    excite(body)
    motors_off(body)
    body.add_site("tip", "panda_hand")
    add(body, "Accelerometer", site="tip")
    exact = world.linearize(outputs=body.sensors, steps=3)
    near = world.linearize(outputs=body.sensors, steps=3, method="differences")
    assert np.abs(near.C - exact.C).max() < 1e-6 * np.abs(exact.C).max()


def test_outputs_of_another_world_are_refused():
    world, other = new_world(), new_world()
    body = load(other, "panda")
    load(world, "panda")
    add(body, "Clock")
    with pytest.raises(ValueError, match="is of another world"):
        world.linearize(outputs=body.sensors)
    with pytest.raises(TypeError, match="no sensor"):
        world.linearize(outputs=["Clock"])  # pyright: ignore[reportArgumentType]
