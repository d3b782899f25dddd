"""Derivatives of steps of the converged laws with rows of joints and user constraints.

Rigid ones yield there by a hundred thousandth of their own inverse mass, which changes with positions.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.joints.test_actuators import all_kinds
from tests.linearization.scenes import ASSETS, assert_exact, excite, motors_off, new_world, statuses
from tests.linearization.test_joints import ARM
from tests.linearization.test_tendons import LIMITED, arm
from tests.physics.test_spherical_joint import limited_ball

from carom import World
from carom.description.pose import Pose
from carom.layouts.codes import UserConstraintKind as Kind
from carom.linearization import linearized_step


@pytest.fixture(autouse=True)
def _larger_differences(monkeypatch: pytest.MonkeyPatch) -> None:  # pyright: ignore[reportUnusedFunction]
    """The solver ends at a precision that smaller ones would show."""
    monkeypatch.setattr(linearized_step, "_SIZE", 1e-5)


def _rigid(world: World) -> World:
    world.contact = "rigid"
    return world


@pytest.mark.parametrize("kind", [Kind.POINT_TO_POINT, Kind.FIXED, Kind.PRISMATIC])
def test_bodies_tied_together(kind: Kind) -> None:
    world = _rigid(new_world())
    cube = world.load_urdf(f"{ASSETS}/cube.urdf", (3.0, 0.0, 1.5))
    robot = world.load_urdf(f"{ASSETS}/kuka_iiwa/model.urdf", fixed_base=True)
    excite(cube)
    excite(robot, share=0.3)
    frames = Pose((0.0, 0.0, 0.05)), Pose((-2.5, 0.2, 0.2))
    world.constrain_links(
        kind, robot, 6, cube, -1, axis=(0.0, 0.6, 0.8), parent_frame=frames[0], child_frame=frames[1]
    )
    step = assert_exact(world, parameters=["masses"] if kind == Kind.FIXED else [])
    assert {status for name, status in step.rows if "constraint" in name} == {"holds"}


def test_motors_and_coupled_fingers_of_a_panda() -> None:
    world = _rigid(new_world())
    panda = world.load_urdf(f"{ASSETS}/franka_panda/panda.urdf", fixed_base=True, as_pybullet=False)
    excite(panda, share=0.2)
    for joint in panda.joints.movable[:3]:
        joint.set_position_target(0.3, gain=0.01, velocity_gain=0.7, max_force=1e4)
    panda.joints.movable[4].set_position_target(-1.0, max_velocity=0.2, max_force=1e4)
    step = assert_exact(world, controls=["torques", "target_positions", "target_velocities"])
    found = statuses(step)
    assert found["motor of panda.panda_joint1"] == ["holds"]
    assert any(name.startswith("coupling") for name in found)


def test_motors_of_spherical_joints() -> None:
    world = _rigid(new_world())
    body = world.load_urdf(f"{ASSETS}/humanoid/humanoid.urdf", (0.0, 0.0, 4.0))
    excite(body)
    motors_off(body)
    body.joints["chest"].set_orientation_target((0.1, 0.2, 0.3, 0.9), gain=0.4, damping=0.8, max_force=1e5)
    found = statuses(assert_exact(world))
    assert found[f"motor of {body.name}.chest"] == ["holds"] * 3


@pytest.mark.parametrize("seed", range(3))
def test_limits_of_a_spherical_joint(seed: int) -> None:
    body = limited_ball()
    world = _rigid(body.world)
    world.gravity = (0.3, -0.5, -9.81)
    rng = np.random.default_rng(seed)
    turn = np.append(rng.uniform(-0.6, 0.6, 3), 1.0)
    q, dof = body.position_index[0], body.velocity_index[0]
    world.position[q : q + 4] = turn / np.linalg.norm(turn)
    world.velocity[dof : dof + 3] = 6.0 * turn[:3] + rng.uniform(-0.5, 0.5, 3)
    found = statuses(assert_exact(world))
    assert any(name.startswith("limit") for name in found)


def test_friction_of_joints_sticks_or_slides() -> None:
    world = _rigid(new_world())
    body = world.load_urdf(ARM, fixed_base=True, as_pybullet=False)
    body.joints["lower"].reset(0.0, 2.0)
    step = assert_exact(world, parameters=["joint_friction"])
    assert dict(step.rows) == {
        "friction of arm.upper": "holds",
        "friction of arm.lower": "at its lower bound",
    }


def test_actuators_of_all_kinds() -> None:
    body = all_kinds()
    _rigid(body.world)
    body.actuators.controls = [0.3, 0.0, 0.3, 1.5, 1.0, 0.4, 0.4]
    for link, count in enumerate(body.velocity_count):
        if count:
            body.change_dynamics(link, joint_armature=0.3, joint_damping=0.2)
    assert_exact(body.world, controls=["actuators"])


@pytest.mark.parametrize("law", ["rigid", "compliant"])
@pytest.mark.parametrize(
    "tendon",
    [
        'stiffness="40" damping="3" springlength=".1"',
        'stiffness="4" armature=".2" frictionloss=".01"',
        'frictionloss="300"',
        LIMITED,
        f'{LIMITED} margin=".05" solreflimit=".06 .8" solimplimit=".4 .95 .3 .5 2"',
    ],
)
def test_tendons(tmp_path: Path, tendon: str, law: str) -> None:
    world = arm(tmp_path, tendon)
    world.contact = law
    found = statuses(assert_exact(world, parameters=["masses", "inertias", "armature"]))
    assert any("tendon" in name for name in found)
