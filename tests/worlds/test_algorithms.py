"""Kinematics and dynamics of all worlds at once are, bit for bit, those of each world alone."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import pybullet_data
from carom import World, Worlds, algorithms
from carom.scene.body import Body
from carom.worlds.body import BodyBatch

ASSETS = pybullet_data.getDataPath()
COUNT = 12
# A fixed arm, a free robot, and a free robot with spherical joints.
ROBOTS = {
    "panda": ("franka_panda/panda.urdf", True),
    "kuka": ("kuka_iiwa/model.urdf", True),
    "laikago": ("laikago/laikago.urdf", False),
    "humanoid": ("humanoid/humanoid.urdf", False),
}
Lone = tuple[int, Body]


def varied(robot: str, threads: int = 2) -> tuple[Worlds, BodyBatch]:
    """Worlds that differ in state, gravity, masses, inertias and armature."""
    path, is_fixed = ROBOTS[robot]
    world = World()
    body = world.load_urdf(f"{ASSETS}/{path}", (0.2, 0.1, 0.5), (0.1, 0.2, 0.3, 0.9), fixed_base=is_fixed)
    worlds = Worlds(world, COUNT, threads=threads)
    batch, random = worlds[body], np.random.default_rng(5)
    worlds.change_parameters(gravity=random.normal(0.0, 5.0, (COUNT, 3)))
    turn(batch, random)
    batch.set_base_inertial_poses(random.normal(size=(COUNT, 3)), random.normal(size=(COUNT, 4)))
    batch.set_base_velocities(random.normal(size=(COUNT, 6)))
    batch.joints.velocities = random.normal(size=batch.joints.velocities.shape)
    moving = next(link for link in range(body.joint_count) if body.velocity_count[link])
    batch.change_dynamics(moving, mass=random.uniform(1.0, 2.0, COUNT))
    batch.change_dynamics(body.joint_count - 1, inertia=random.uniform(0.1, 0.2, (COUNT, 3)))
    batch.change_dynamics(moving, joint_armature=random.uniform(0.0, 0.1, COUNT))
    return worlds, batch


def turn(batch: BodyBatch, random: np.random.Generator) -> None:
    """Random joint positions; quaternions of unit length."""
    body = batch._body
    positions = random.uniform(-0.8, 0.8, batch.joints.positions.shape)
    first = 0
    for count in body.position_count:
        if count == 4:
            quaternions = random.normal(size=(COUNT, 4))
            positions[:, first : first + 4] = quaternions / np.linalg.norm(quaternions, axis=1, keepdims=True)
        first += count
    batch.joints.positions = positions


def lone(worlds: Worlds, number: int) -> Body:
    return worlds.extract(number).bodies[0]


def own_state(body: Body) -> tuple[np.ndarray, np.ndarray]:
    """Positions and velocities of a body of a lone world, as `algorithms.inverse_dynamics` takes them."""
    world = body.world
    joints = world.position[body.first_position + 7 :][: sum(body.position_count)]
    rates = world.velocity[body.first_velocity + 6 :][: sum(body.velocity_count)]
    if body.fixed_base:
        return np.array(joints), np.array(rates)
    base = world.position[body.first_position : body.first_position + 7]
    x, y, z, w = base[3:]
    back = np.array(rotation(-x, -y, -z, w))
    velocity = np.array(world.velocity[body.first_velocity : body.first_velocity + 6])
    return np.concatenate([base, joints]), np.concatenate([back @ velocity[:3], back @ velocity[3:], rates])


def rotation(x: float, y: float, z: float, w: float) -> list[list[float]]:
    from carom.description.transform import rotation_matrix

    return [list(row) for row in rotation_matrix((x, y, z, w))]


def joint_positions(body: Body) -> np.ndarray:
    return own_state(body)[0][0 if body.fixed_base else 7 :]


@pytest.mark.parametrize("robot", ROBOTS)
def test_mass_matrices_and_jacobians_are_those_of_each_world_alone(robot: str):
    worlds, batch = varied(robot)
    link, points = len(batch.links.names[1:]) - 1, np.random.default_rng(1).normal(size=(COUNT, 3))
    matrices, (linear, angular) = batch.mass_matrix(), batch.jacobian(batch.links.names[1:][link], points)
    assert not (matrices[0] == matrices[1]).all()
    for number in range(COUNT):
        body = lone(worlds, number)
        assert (algorithms.mass_matrix(body, joint_positions(body)) == matrices[number]).all()
        alone = algorithms.jacobian(body, link, points[number], joint_positions(body))
        assert (alone[0] == linear[number]).all()
        assert (alone[1] == angular[number]).all()


@pytest.mark.parametrize("robot", ROBOTS)
def test_inverse_dynamics_is_that_of_each_world_alone(robot: str):
    worlds, batch = varied(robot)
    dofs = batch.mass_matrix().shape[1]
    wanted = np.random.default_rng(2).normal(size=(COUNT, dofs))
    states = [own_state(lone(worlds, number)) for number in range(COUNT)]
    positions, velocities = (np.array([state[part] for state in states]) for part in range(2))
    forces = batch.inverse_dynamics(wanted, positions, velocities)
    for number in range(COUNT):
        alone = algorithms.inverse_dynamics(lone(worlds, number), *states[number], wanted[number])
        assert (alone == forces[number]).all()
    # Present positions and velocities are the default; those of a free base are turned to its own axes.
    assert np.allclose(batch.inverse_dynamics(wanted), forces, rtol=1e-12, atol=1e-9)
    bias = batch.inverse_dynamics()
    products = np.einsum("wij,wj->wi", batch.mass_matrix(), wanted)
    if not worlds.extract(0).bodies[0].fixed_base:
        products[:, :6] = products[:, [3, 4, 5, 0, 1, 2]]
    assert np.allclose(bias + products, forces, atol=1e-8)


def reach(batch: BodyBatch, random: np.random.Generator) -> dict[str, Any]:
    """Targets within reach, limits, and a start, each different in each world."""
    link = len(batch.links.names[1:]) - 1
    goal = batch.forward_kinematics(random.uniform(-0.5, 0.5, batch.joints.positions.shape), [link])
    dofs = batch.joints.velocities.shape
    return {
        "links": [link],
        "positions": goal[:, :, :3],
        "orientations": goal[:, :, 3:],
        "lower": random.uniform(-2.5, -1.0, dofs),
        "upper": random.uniform(1.0, 2.5, dofs),
        "start": random.uniform(-0.3, 0.3, dofs),
    }


@pytest.mark.parametrize("robot", ["panda", "kuka"])
@pytest.mark.parametrize("method", ["damped", "selective", "rest"])
def test_inverse_kinematics_is_that_of_each_world_alone(robot: str, method: str):
    worlds, batch = varied(robot)
    random = np.random.default_rng(3)
    asked: dict[str, Any] = reach(batch, random)
    more: dict[str, Any] = {}
    if method == "selective":
        more = {"selective": True}
    elif method == "rest":
        more = {"ranges": 4.0 * np.ones(batch.joints.velocities.shape[1]), "rest": asked["start"]}
    found = batch.algorithms.inverse_kinematics(**asked, **more)
    assert found.success.any()
    for number in range(COUNT):
        own: dict[str, Any] = {
            name: value[number] if name != "links" else value for name, value in asked.items()
        }
        rest: dict[str, Any] = {
            name: value[number] if name == "rest" else value for name, value in more.items()
        }
        alone = algorithms.inverse_kinematics(lone(worlds, number), **own, **rest)
        assert (np.array(alone.positions) == found.positions[number]).all()
        assert np.isclose(alone.residual, found.residuals[number], atol=1e-9)
        assert np.isclose(alone.angle_residual, found.angle_residuals[number], atol=1e-7)
        assert alone.success == found.success[number]


def test_a_warm_start_follows_a_target_that_moves():
    _, batch = varied("kuka")
    asked = reach(batch, np.random.default_rng(4))
    first = batch.algorithms.inverse_kinematics(**asked, further=500)
    assert first.success.sum() > COUNT // 2
    asked["positions"] = asked["positions"] + 1e-3
    # One step from where the last search ended gets near.
    few: dict[str, Any] = {"iterations": 1, "further": 0, "lower": None, "upper": None}
    cold = batch.algorithms.inverse_kinematics(**asked | few)
    asked["start"] = first.positions
    warm = batch.algorithms.inverse_kinematics(**asked | few)
    assert (warm.residuals < 0.1 * cold.residuals)[first.success].all()


def test_link_poses_of_chosen_positions_are_those_of_links_that_are_there():
    worlds, batch = varied("humanoid")
    there = batch.joints.positions.copy()
    poses, base = batch.links.poses.copy(), batch.base_inertial_poses.copy()
    turn(batch, np.random.default_rng(6))
    stepped = batch.links.stepped_poses.copy()
    assert (batch.forward_kinematics(there) == poses).all()
    assert (batch.forward_kinematics(there[3], where=[3])[0] == poses[3]).all()
    named = batch.forward_kinematics(there, [batch.links.names[1:][2], -1])
    assert (named[:, 0] == poses[:, 2]).all()
    assert (batch.base_inertial_poses == base).all()
    assert (batch.links.stepped_poses == stepped).all()
    body = lone(worlds, 7)
    alone = algorithms.forward_kinematics(body, there[7])
    assert np.allclose([pose.position for pose in alone], poses[7, :, :3], atol=1e-12)


def test_results_do_not_depend_on_threads_or_on_the_other_worlds():
    results = []
    for threads in (1, 3):
        _, batch = varied("panda", threads)
        asked = reach(batch, np.random.default_rng(3))
        results.append(
            (batch.mass_matrix(), batch.inverse_dynamics(), batch.algorithms.inverse_kinematics(**asked)[0])
        )
    for one, many in zip(*results, strict=True):
        assert (one == many).all()
    chosen = np.array([7, 2])
    assert (batch.mass_matrix(where=chosen) == results[0][0][chosen]).all()
    assert (batch.inverse_dynamics(where=chosen) == results[0][1][chosen]).all()
    own: dict[str, Any] = {name: value[chosen] if name != "links" else value for name, value in asked.items()}
    assert (batch.algorithms.inverse_kinematics(**own, where=chosen).positions == results[0][2][chosen]).all()


def test_changes_of_parameters_count_at_once():
    worlds, batch = varied("laikago")
    before = batch.mass_matrix()
    batch.change_dynamics(0, mass=9.0, where=[4])
    after = batch.mass_matrix()
    assert not (after[4] == before[4]).all()
    assert (after[5] == before[5]).all()
    body = lone(worlds, 4)
    assert (algorithms.mass_matrix(body, joint_positions(body)) == after[4]).all()


def test_mistakes_are_named():
    _, batch = varied("panda")
    with pytest.raises(ValueError, match=r"accelerations has shape \(3,\)"):
        batch.inverse_dynamics(np.zeros(3))
    with pytest.raises(ValueError, match=r"positions has shape \(2, 3\)"):
        batch.algorithms.inverse_kinematics([0], np.zeros((2, 3)))
    with pytest.raises(KeyError, match="no link is called 'hand of god'"):
        batch.jacobian("hand of god")
    huge = np.zeros(batch.joints.velocities.shape)
    huge[5] = 1e200
    with pytest.raises(ValueError, match="in world 5 the force is not finite"):
        batch.inverse_dynamics(velocities=huge)


def test_nothing_is_asked_of_no_world():
    _, batch = varied("panda")
    assert batch.mass_matrix(where=[]).shape == (0, 9, 9)
    assert batch.inverse_dynamics(where=[]).shape == (0, 9)
