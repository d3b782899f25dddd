"""Steps of random robots linearised, beside central differences: rows of joints, and of ties."""

import numpy as np
import pytest
from numpy.testing import assert_array_equal
from tests.linearization.scenes import assert_exact, excite, motors_off, new_world
from tests.physics.robots import MOVING_TYPES, random_tree

from carom import PositionActuator, World, Worlds
from carom.description import JointType, Pose
from carom.layouts.codes import UserConstraintKind as Kind

CONTROLS = ["torques", "target_positions", "target_velocities", "actuators"]
GAINS = ["motor_position_gains", "motor_velocity_gains", "armature"]


def random_world(seed: int) -> World:
    """A tree in motion whose joints have motors within or at their bounds, servos, limits, or nothing."""
    rng = np.random.default_rng(seed)
    world = new_world()
    kinds = MOVING_TYPES if seed % 3 == 0 else (JointType.REVOLUTE, JointType.PRISMATIC)
    body = world.load(random_tree(seed, 7, fixed_base=bool(seed % 2), joint_types=kinds))
    excite(body, seed)
    for joint in body.joints:
        if body.velocity_count[joint.index] != 1:
            continue
        body.change_dynamics(joint.index, joint_armature=0.05, joint_damping=float(rng.uniform(0.0, 0.3)))
        choice = rng.integers(5)
        if choice == 0:
            joint.set_position_target(0.3, gain=0.05, velocity_gain=0.7, max_force=1e4)
        elif choice == 1:
            joint.set_velocity_target(20.0, gain=0.6, max_force=0.5)
        elif choice == 2:
            joint.set_velocity_target(0.0, max_force=0.0)
            body.change_dynamics(joint.index, joint_lower_limit=-2.0, joint_upper_limit=0.2)
            world.position[body.position_index[joint.index]] = 0.2 + 1e-3
            world.velocity[body.velocity_index[joint.index]] = 2.0
        elif choice == 3:
            joint.set_velocity_target(0.0, max_force=0.0)
            body.add_actuator(f"servo{joint.index}", PositionActuator(joint.name, kp=3.0))
        else:
            joint.set_velocity_target(0.0, max_force=0.0)
    return world


@pytest.mark.parametrize("seed", range(8))
def test_steps_of_random_robots_are_exact(seed: int):
    assert_exact(random_world(seed), controls=CONTROLS, parameters=GAINS)


def test_all_kinds_of_rows_of_joints_occur():
    found: set[tuple[str, str]] = set()
    for seed in range(8):
        rows = random_world(seed).linearize().rows
        found |= {(name.partition(" of ")[0], status) for name, status in rows}
    assert found >= {
        ("motor", "holds"),
        ("motor", "at its upper bound"),
        ("limit", "holds"),
        ("actuator", "holds"),
    }


@pytest.mark.parametrize("bound", [1e9, 1e-3])
def test_gears_with_a_third_joint_and_curved_couplings_are_exact(bound: float):
    world = new_world()
    body = world.load(random_tree(2, 6, fixed_base=False, joint_types=[JointType.REVOLUTE]))
    excite(body, 2)
    motors_off(body)
    # Each gets the next number when it is made.
    ends = (0.0, 0.0, 0.0), Pose(), Pose()
    gear = world.user_constraints.new(Kind.GEAR, body, 0, body, 2, *ends)
    gear.gear_ratio, gear.gear_auxiliary_link, gear.erp = -0.7, 4, 0.3
    gear.max_impulse = bound
    world.add_constraint(gear)
    curve = world.user_constraints.new(Kind.COUPLING, body, 1, body, 3, *ends)
    curve.polynomial, curve.erp, curve.max_impulse = (0.5, 0.8, -0.4, 0.3), 1.0, 1e9
    world.add_constraint(curve)
    step = assert_exact(world, parameters=["armature"])
    rows = {name.partition(" ")[0]: status for name, status in step.rows}
    assert rows["coupling"] == "holds"
    assert (rows["gear"] == "holds") == (bound > 1.0)


def test_many_worlds_in_different_states_are_exact():
    world = random_world(1)
    worlds = Worlds(world, 4)
    rng = np.random.default_rng(5)
    velocity = worlds._engine.arrays.state.numpy["dof_velocity"]
    velocity += rng.uniform(-0.1, 0.1, velocity.shape) * (velocity != 0.0)
    found = worlds.linearize(CONTROLS, parameters=GAINS)
    assert np.abs(found.A[1:] - found.A[0]).max() > 1e-3
    for number in range(worlds.count):
        exact = assert_exact(worlds.extract(number), controls=CONTROLS, parameters=GAINS)
        for name in ("A", "B", "E"):
            assert_array_equal(getattr(found, name)[number], getattr(exact, name))


def test_a_world_in_which_nothing_can_move_has_no_state():
    world = World()
    world.load(random_tree(1, 3, fixed_base=True, joint_types=[JointType.FIXED]))
    step = world.linearize()
    assert (step.A.shape, step.B.shape, step.states, step.rows) == ((0, 0), (0, 0), (), ())
