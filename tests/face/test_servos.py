"""Servos of joints: gains in N m/rad that act on positions and velocities at the end of a step."""

from __future__ import annotations

import numpy as np
import pytest
from tests.face.scene import ARM, made

from carom import Body, World, Worlds

LAWS = ("bullet", "compliant", "rigid")
_WITHOUT = ARM[: ARM.index("  <actuator>")] + ARM[ARM.index("  <sensor>") :]


@pytest.mark.parametrize("law", LAWS)
def test_it_is_the_position_actuator_of_a_file(law: str) -> None:
    world, arm, _ = made()
    other, same, _ = made(_WITHOUT)
    world.contact = other.contact = law
    # Actuators count within the step as servos do, not at its start as with Euler.
    world.integrator = other.integrator = "discrete"
    arm.actuators["bend"].control = 0.6
    same.joints["elbow"].servo(0.6, kp=30.0, kd=2.0, max_force=20.0)
    for each in (world, other):
        each.step(100)
    np.testing.assert_allclose(same.joints.positions, arm.joints.positions, atol=1e-6)
    assert same.joints["elbow"].motor_torque == pytest.approx(arm.actuators["bend"].force, abs=1e-4)


def test_no_gain_is_too_large_for_the_step() -> None:
    world, arm, _ = made(_WITHOUT)
    arm.joints.servo((0.5, -0.3), kp=1e7, kd=1e4)
    world.step(200)
    assert arm.joints.positions == pytest.approx([0.5, -0.3], abs=1e-3)


def test_velocities_are_kept_forces_are_bounded_and_free_ends_it() -> None:
    world, arm, _ = made(_WITHOUT)
    world.gravity = (0.0, 0.0, 0.0)
    joint = arm.joints["elbow"]
    joint.velocity_servo(0.5, kd=100.0)
    world.step(50)
    assert joint.velocity == pytest.approx(0.5, abs=1e-2)
    arm.joints["elbow"].servo(3.0, kp=1e4, kd=0.0, max_force=0.25)
    world.step()
    assert joint.motor_torque == pytest.approx(0.25)
    arm.joints.free()
    assert not arm.joints.motors()["max_forces"].any()
    assert not Worlds(world, 1)[arm].joints.motors()["max_forces"].any()
    rate = joint.velocity
    world.step()
    assert joint.velocity == pytest.approx(rate, abs=1e-2)
    before = joint.position
    arm.joints.hold(max_forces=100.0)
    world.step(100)
    assert joint.position == pytest.approx(before, abs=0.01)


def test_without_gains_it_does_nothing() -> None:
    world, arm, _ = made(_WITHOUT)
    other = world.copy()
    arm.joints.servo(1.0, kp=0.0, kd=0.0)
    for each in (world, other):
        each.step(50)
    assert np.array_equal(world.position, other.position)


def test_bad_gains_are_refused_and_change_nothing() -> None:
    world, arm, box = made(_WITHOUT)
    before = world.motor.copy()
    for wrong, words in (
        ({"kp": -1.0, "kd": 0.0}, "kp must be >= 0"),
        ({"kp": 1.0, "kd": np.nan}, "kd must"),
    ):
        with pytest.raises(ValueError, match=words):
            arm.joints.servo(0.0, **wrong)
        with pytest.raises(ValueError, match=words):
            Worlds(world, 2)[arm].joints.servo(0.0, **wrong)
    with pytest.raises(ValueError, match="joints of 'arm' are shoulder, elbow"):
        arm.joints.servo((0.0, 0.0, 0.0), kp=1.0, kd=1.0)
    assert np.array_equal(world.motor, before)
    assert len(box.joints) == 0


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("count", [3, 8])
def test_many_worlds_move_as_one_with_motors_of_both_kinds(law: str, count: int) -> None:
    world, arm, _ = made(_WITHOUT)
    world.contact = law
    worlds = Worlds(world, count)
    lone = [world.copy() for _ in range(count)]
    targets = np.linspace(-1.0, 1.0, 2 * count).reshape(count, 2)
    # Lanes have servos, motors of shares, and none, side by side.
    kinds = np.arange(count) % 3
    joints = worlds[arm].joints
    joints.servo(targets[kinds == 0], kp=(80.0, 20.0), kd=(4.0, 0.5), where=kinds == 0)
    joints.set_position_targets(targets[kinds == 1], max_forces=30.0, where=kinds == 1)
    for number, one in enumerate(lone):
        own = one["arm"].joints
        if kinds[number] == 0:
            own.servo(targets[number], kp=(80.0, 20.0), kd=(4.0, 0.5))
        elif kinds[number] == 1:
            own.set_position_targets(targets[number], max_forces=30.0)
    worlds.step(120)
    for number, one in enumerate(lone):
        one.step(120)
        assert np.array_equal(joints.positions[number], one["arm"].joints.positions)
        assert np.array_equal(joints.velocities[number], one["arm"].joints.velocities)


def test_files_and_states_keep_it(tmp_path) -> None:
    world, arm, _ = made(_WITHOUT)
    arm.joints.servo((0.5, -0.3), kp=50.0, kd=3.0)
    world.step(20)
    state = world.snapshot()
    world.save(tmp_path / "world.carom")
    other = World()
    other.load(tmp_path / "world.carom")
    for each in (world, other):
        each.step(40)
    assert np.array_equal(world.position, other.position)
    world.restore(state)
    world.step(40)
    assert np.array_equal(world.position, other.position)


@pytest.mark.parametrize("bounded", [False, True])
def test_derivatives_are_those_of_the_steps(bounded: bool) -> None:
    world, arm = _alone()
    arm.joints.servo((0.9, -0.3), kp=(80.0, 20.0), kd=(4.0, 0.5), max_forces=(0.5 if bounded else 100.0))
    world.step(5)
    controls, parameters = ("target_positions", "target_velocities"), ("motor_position_gains", "motor_forces")
    exact = world.linearize(controls, parameters=parameters)
    differences = world.linearize(controls, parameters=parameters, method="differences")
    for name in ("A", "B", "E"):
        np.testing.assert_allclose(getattr(exact, name), getattr(differences, name), rtol=1e-4, atol=1e-6)


def _alone() -> tuple[World, Body]:
    world = World()
    world.load(_WITHOUT)
    world.remove("box")
    return world, world["arm"]
