"""Armature, damping, springs and friction of joints, in bodies that are as their files say."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_allclose
from tests.physics.robots import let_go, pendulum, put_in_motion, random_tree

from carom import Body, World
from carom.algorithms.inverse_dynamics import inverse_dynamics
from carom.algorithms.mass_matrix import mass_matrix
from carom.description import JointType, Pose
from carom.model.body_spec import BodySpec, LinkSpec

H = 1.0 / 240
INERTIA = 2.0 / 3.0  # of the rod of `pendulum`


def rod(time_step: float = H, **terms: Any) -> Body:
    """A weightless rod on a hinge."""
    world = World(time_step, contact="bullet")
    spec = replace(pendulum(**terms), is_held=False, link_damping=0.0)
    return world.load(spec)


def test_damping_is_stable_however_large() -> None:
    body = rod(damping=1e6)
    body.joints[0].reset(0.0, 1.0)
    body.world.step()
    assert body.joints[0].velocity == pytest.approx(1.0 / (1.0 + H * 1e6 / INERTIA), rel=1e-12)


def test_damping_makes_rates_decay() -> None:
    body = rod(1e-4, damping=0.8, armature=0.1)
    body.joints[0].reset(0.0, 1.0)
    body.world.step(5000)
    assert body.joints[0].velocity == pytest.approx(math.exp(-0.8 * 0.5 / (INERTIA + 0.1)), rel=1e-4)


def test_a_pendulum_in_honey_falls_at_its_limit() -> None:
    body = rod(damping=500.0)
    body.world.gravity = (0.0, 0.0, -9.81)
    body.joints[0].reset(math.pi / 2, 0.0)
    body.world.step(20)
    q, v = body.joints[0].position, body.joints[0].velocity
    assert v == pytest.approx(-2.0 * 9.81 * 0.5 * math.sin(q) / 500.0, rel=1e-3)


def test_period_of_a_spring() -> None:
    body = rod(1e-4, stiffness=30.0, spring_reference=0.2, armature=0.05)
    joint = body.joints[0]
    joint.reset(0.5, 0.0)
    quarter = 0.25 * 2.0 * math.pi * math.sqrt((INERTIA + 0.05) / 30.0)
    body.world.step(round(quarter / 1e-4))
    assert joint.position == pytest.approx(0.2, abs=1e-4)
    assert joint.velocity == pytest.approx(-0.3 * math.sqrt(30.0 / (INERTIA + 0.05)), rel=1e-3)


def test_a_stiff_spring_is_stable() -> None:
    body = rod(stiffness=1e8, spring_reference=0.2)
    body.joints[0].reset(0.5, 0.0)
    body.world.step()
    assert body.joints[0].position == pytest.approx(0.2, abs=2e-4)


def test_a_motor_counts_with_armature() -> None:
    body = rod(armature=0.3)
    body.joints[0].set_velocity_target(100.0, max_force=5.0)
    body.world.step()
    assert body.joints[0].velocity == pytest.approx(H * 5.0 / (INERTIA + 0.3), rel=1e-12)


def with_terms(spec: BodySpec, rng: np.random.Generator) -> BodySpec:
    """A body with joint terms of all kinds; links without a moving joint have none."""
    links = []
    for link in spec.links:
        armature, damping, stiffness, rest = rng.uniform(0.0, (0.5, 20.0, 200.0, 1.0)).tolist()
        if link.joint_type == JointType.FIXED:
            links.append(link)
            continue
        links.append(
            replace(link, armature=armature, damping=damping, stiffness=stiffness, spring_reference=rest)
        )
    return replace(spec, links=links, is_held=False)


def stretch(kind: JointType, q: np.ndarray, rest: float) -> np.ndarray:
    """Stretch of a spring along the dofs of its joint."""
    if kind == JointType.SPHERICAL:
        q = q if q[3] > 0.0 else -q
        return 2.0 * math.acos(q[3]) * q[:3] / np.linalg.norm(q[:3])
    away = q - rest
    if kind == JointType.PLANAR:
        # Its slides are along axes that the angle turns, in the sense from the second to the first.
        c, s = math.cos(q[0]), math.sin(q[0])
        away[1:] = c * away[1] - s * away[2], s * away[1] + c * away[2]
    return away


@pytest.mark.parametrize("fixed_base", [True, False], ids=["fixed", "free"])
@pytest.mark.parametrize("seed", range(4))
def test_one_step_solves_the_implicit_equations(seed: int, fixed_base: bool) -> None:
    rng = np.random.default_rng(seed)
    plain = replace(random_tree(seed, 4 + 3 * seed, fixed_base=fixed_base), is_held=False)
    stiff = with_terms(plain, rng)
    changes = []
    for spec in (plain, stiff):
        world = World(H)
        world.gravity = (0.3, -0.7, -9.81)
        body = world.load(spec)
        let_go(body)
        put_in_motion(body, np.random.default_rng(seed))
        body.set_inertial_pose((0.1, 0.2, 0.3), (0.0, 0.0, 0.0, 1.0))
        first = body.first_velocity + (6 if fixed_base else 0)
        rates = slice(first, body.first_velocity + 6 + sum(body.velocity_count))
        before = world.velocity[rates].copy()
        q = [joint.coordinates for joint in body.joints.movable]
        world.step()
        changes.append(world.velocity[rates] - before)
    base = len(before) - sum(body.velocity_count)
    free = World(H).load(plain)
    inertia = mass_matrix(free, np.concatenate(q))
    terms = np.zeros((3, len(before)))
    away = np.zeros(len(before))
    dof = base
    for coordinates, joint in zip(q, body.joints.movable, strict=True):
        dofs = slice(dof, dof + joint.degrees_of_freedom)
        spec = joint.spec
        terms[:, dofs] = [[spec.armature], [spec.damping], [spec.stiffness]]
        away[dofs] = stretch(joint.type, coordinates, spec.spring_reference)
        dof = dofs.stop
    armature, damping, stiffness = terms
    whole = inertia + np.diag(armature + H * damping + H**2 * stiffness)
    force = inertia @ changes[0] / H - damping * before - stiffness * (away + H * before)
    assert_allclose(changes[1], np.linalg.solve(whole, H * force), rtol=0, atol=1e-9)


def three_joints() -> BodySpec:
    """Two hinges and a ball; the same body in MJCF gave the numbers below."""
    links = [
        LinkSpec(
            "a", mass=2.0, inertia=(0.1, 0.1, 0.1), inertial_frame=Pose((0.0, 0.0, -0.5)),
            joint_name="one", joint_type=JointType.REVOLUTE, joint_axis=(0.0, 1.0, 0.0),
            armature=0.4, damping=3.0, stiffness=20.0, spring_reference=0.3,
        ),
        LinkSpec(
            "b", 0, mass=1.0, inertia=(0.02, 0.03, 0.04), inertial_frame=Pose((0.0, 0.1, -0.3)),
            joint_name="two", joint_type=JointType.REVOLUTE, joint_axis=(1.0, 0.0, 0.0),
            joint_frame=Pose((0.0, 0.0, -1.0)),
            armature=0.01, damping=200.0, stiffness=5000.0, spring_reference=-0.2,
        ),
        LinkSpec(
            "c", 1, mass=0.5, inertia=(0.01, 0.01, 0.005), inertial_frame=Pose((0.0, 0.0, -0.2)),
            joint_name="ball", joint_type=JointType.SPHERICAL, joint_frame=Pose((0.0, 0.0, -0.5)),
            armature=0.02, damping=0.5, stiffness=8.0,
        ),
    ]  # fmt: skip
    return BodySpec("three", LinkSpec("base"), links, fixed_base=True, link_damping=0.0, is_held=False)


def three_in_motion() -> Body:
    world = World(H)
    world.gravity = (0.0, 0.0, -9.81)
    body = world.load(three_joints())
    body.joints[0].reset(0.5, 1.0)
    body.joints[1].reset(0.1, -2.0)
    s, c = math.sin(0.4), math.cos(0.4)
    body.joints[2].reset([0.6 * s, 0.0, 0.8 * s, c], [0.3, -0.2, 0.5])
    return body


# Velocities after 1 and 60 steps of MuJoCo 4.0.0 with `integrator="discrete"`.
MUJOCO_ONE = (
    0.9943020375968454,
    -5.703809220956154,
    4.1042481547186735,
    -3.448802083955468,
    -0.22703333325005,
)
MUJOCO_ALL = (
    -0.393755551264726,
    -0.0123161097015434,
    0.8276336971694592,
    0.0454298966185524,
    0.37900383188287,
)


def test_same_as_mujoco() -> None:
    body = three_in_motion()
    body.world.step()
    assert_allclose(body.joints.velocities, MUJOCO_ONE, rtol=0, atol=1e-12)
    body.world.step(59)
    assert_allclose(body.joints.velocities, MUJOCO_ALL, rtol=0, atol=1e-12)


def test_armature_is_part_of_the_mass_matrix() -> None:
    body = rod(armature=0.3, damping=2.0, stiffness=5.0)
    assert mass_matrix(body, [0.4]) == pytest.approx(np.array([[INERTIA + 0.3]]), rel=1e-12)
    assert inverse_dynamics(body, [0.4], [1.0], [2.0]) == pytest.approx(2.0 * (INERTIA + 0.3), rel=1e-12)
    body.joints[0].armature = 0.1
    assert mass_matrix(body, [0.4]) == pytest.approx(np.array([[INERTIA + 0.1]]), rel=1e-12)


def test_terms_are_settable() -> None:
    body = rod()
    joint = body.joints[0]
    joint.damping, joint.armature, joint.stiffness, joint.spring_reference = 1.5, 0.2, 30.0, 0.1
    joint.friction_loss = 0.4
    terms = (joint.damping, joint.armature, joint.stiffness, joint.spring_reference, joint.friction_loss)
    assert terms == (1.5, 0.2, 30.0, 0.1, 0.4)
    joint.reset(0.3, 2.0)
    body.world.step()
    force = -1.5 * 2.0 - 30.0 * (0.2 + H * 2.0) - 0.4
    inertia = INERTIA + 0.2 + H * 1.5 + H**2 * 30.0
    assert joint.velocity == pytest.approx(2.0 + H * force / inertia, rel=1e-9)


def test_a_ball_has_a_spring_reference_that_is_a_rotation() -> None:
    body = three_in_motion()
    ball = body.joints["ball"]
    assert ball.spring_reference == (0.0, 0.0, 0.0, 1.0)
    ball.spring_reference = 2.0 * np.array([0.6, 0.0, 0.0, 0.8])
    assert ball.spring_reference == pytest.approx((0.6, 0.0, 0.0, 0.8))
    for joint in body.joints.movable:
        joint.damping, joint.stiffness = 1e5, 1e7
    body.world.step(240)
    assert ball.coordinates == pytest.approx([0.6, 0.0, 0.0, 0.8], abs=1e-4)


def test_friction_holds_and_slides() -> None:
    body = rod()
    joint = body.joints[0]
    joint.friction_loss = 0.5
    joint.set_torque(0.4)
    body.world.step()
    assert joint.velocity == pytest.approx(0.0, abs=1e-12)
    joint.set_torque(0.8)
    body.world.step()
    assert joint.velocity == pytest.approx(H * 0.3 / INERTIA, rel=1e-9)
    joint.friction_loss = 0.0
    joint.reset(0.0, 1.0)
    body.world.step()
    assert joint.velocity == pytest.approx(1.0, rel=1e-12)


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("damping", -1.0),
        ("armature", -1.0),
        ("stiffness", -1.0),
        ("friction_loss", -1.0),
        ("stiffness", math.nan),
        ("spring_reference", [1.0, 2.0]),
    ],
)
def test_wrong_terms_are_refused(name: str, value: float | list[float]) -> None:
    joint = rod().joints[0]
    before = getattr(joint, name)
    with pytest.raises(ValueError, match=name):
        setattr(joint, name, value)
    assert getattr(joint, name) == before


def test_joints_without_such_terms_refuse_them() -> None:
    world = World()
    fixed = world.load(pendulum(joint_type=JointType.FIXED)).joints[0]
    for term in ("armature", "friction_loss"):
        with pytest.raises(ValueError, match="is fixed"):
            setattr(fixed, term, 1.0)
    with pytest.raises(ValueError, match="no joint_stiffness"):
        world.load(three_joints()).change_dynamics(-1, joint_stiffness=1.0)


def test_saved_with_worlds_and_restored(tmp_path: Path) -> None:
    body = three_in_motion()
    body.joints["one"].friction_loss = 0.7
    body.joints["ball"].spring_reference = (0.6, 0.0, 0.0, 0.8)
    body.joints["two"].armature = 0.3
    body.world.step(5)
    body.world.save(tmp_path / "three.carom")
    other = World()
    other.load(tmp_path / "three.carom")
    start = body.world.snapshot()
    for world in (body.world, other):
        world.step(20)
    np.testing.assert_array_equal(body.world.position, other.position)
    end = body.world.position.copy()
    body.world.restore(start)
    body.world.step(20)
    np.testing.assert_array_equal(body.world.position, end)


def test_a_file_as_written_has_implicit_damping(tmp_path: Path) -> None:
    file = tmp_path / "rod.urdf"
    file.write_text(
        """<robot name="rod"><link name="base"/><link name="rod"><inertial><mass value="2"/>
        <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
        <joint name="hinge" type="continuous"><parent link="base"/><child link="rod"/>
        <dynamics damping="1000"/></joint></robot>"""
    )
    world = World(H)
    body = world.load(file).bodies[0]
    body.joints[0].reset(0.0, 1.0)
    world.step()
    assert body.joints[0].velocity == pytest.approx(1.0 / (1.0 + H * 1000.0), rel=1e-12)


def test_terms_of_zero_change_no_bit() -> None:
    """One tree computes with its terms, all 0, and the other without."""
    ends = []
    for marked in (0.0, 1.0):
        world = World(H)
        world.gravity = (0.0, 0.0, -9.81)
        body = world.load(random_tree(3, 8, fixed_base=False))
        put_in_motion(body, np.random.default_rng(5))
        world.arrays.model.numpy["tree_joint_terms"][:] = marked
        world.step(100)
        ends.append(world.position.copy())
    np.testing.assert_array_equal(*ends)
