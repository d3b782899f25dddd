"""Mass matrices, accelerations and forces of actuators are those of MuJoCo."""

import json
from pathlib import Path

import numpy as np
import pytest
from dynamics_cases import DYNAMICS
from numpy.testing import assert_allclose, assert_array_equal
from test_fluids_of_files import STEP, load, moving, velocities  # noqa: F401  (a fixture)

from carom import World, Worlds, algorithms
from carom.description.transform import rotation_matrix
from carom.errors import DescriptionError

ANSWERS = json.loads(Path(__file__).with_name("dynamics_answers.json").read_text())


def to_mujoco(body):
    """The matrix that makes velocities of Carom, base first, angular before linear, of those of MuJoCo."""
    dofs = len(velocities(body))
    change = np.eye(dofs)
    if body.fixed_base:
        return change
    base = body.links[-1]
    pose = base.inertial_pose
    turn, inertial = (np.array(rotation_matrix(tuple(it.orientation))) for it in (base.pose, pose))
    x, y, z = np.array(pose.position) - np.array(base.pose.position)
    cross = np.array([[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]])
    change[:6, :6] = 0.0
    change[:3, 3:6], change[3:6, :3], change[3:6, 3:6] = (
        inertial.T @ turn,
        inertial.T,
        inertial.T @ cross @ turn,
    )
    return change


@pytest.mark.parametrize("name", DYNAMICS)
def test_mass_matrices_are_those_of_mujoco(load, name):  # noqa: F811
    scene = load(DYNAMICS[name])
    scene.reset("0")
    body = moving(scene)
    change = to_mujoco(body)
    matrix = change.T @ algorithms.mass_matrix(body, body.joints.positions) @ change
    wanted = np.array(ANSWERS[name]["matrix"])
    assert_allclose(matrix, wanted, rtol=0.0, atol=1e-9 * np.abs(wanted).max())


@pytest.mark.parametrize("name", DYNAMICS)
def test_accelerations_and_forces_are_those_of_mujoco(load, name):  # noqa: F811
    scene = load(DYNAMICS[name])
    scene.world.parameters.solver_residual_threshold = 0.0
    body, rates, forces = moving(scene), [], []
    for step in (STEP, 0.5 * STEP):
        scene.reset("0")
        before = velocities(body)
        scene.world.parameters.time_step = step
        scene.world.apply_parameters()
        scene.world.step()
        rates.append((velocities(body) - before) / step)
        forces.append(np.array([it.force for it in scene.actuators.values()]))
    wanted, driven = np.array(ANSWERS[name]["acceleration"]), np.array(ANSWERS[name]["forces"])
    assert_allclose(2.0 * rates[1] - rates[0], wanted, rtol=0.0, atol=1e-6 * np.abs(wanted).max())
    assert_allclose(2.0 * forces[1] - forces[0], driven, rtol=1e-6, atol=1e-6)


def test_armature_of_a_free_base_is_in_all_of_its_dynamics(load):  # noqa: F811
    scene = load(DYNAMICS["free body with armature"])
    scene.reset("0")
    body = moving(scene)
    dofs = len(velocities(body))
    rng = np.random.default_rng(3)
    pose = body.links[-1].inertial_pose
    positions = [*pose.position, *pose.orientation, *body.joints.positions]
    rates, changes = rng.normal(size=(2, dofs))
    matrix = algorithms.mass_matrix(body, body.joints.positions)
    order = [3, 4, 5, 0, 1, 2, *range(6, dofs)]
    forces, still = (
        algorithms.inverse_dynamics(body, positions, rates, it)[order] for it in (changes, np.zeros(dofs))
    )
    assert_allclose(forces - still, matrix @ changes, atol=1e-12)
    found = algorithms.inverse_dynamics_derivatives(body, positions, rates, changes)
    assert_allclose(found.dtau_da, matrix, atol=1e-12)
    worlds = Worlds(scene.world, 2)
    copies = worlds.bodies[body.name]
    copies.change_dynamics(1, joint_armature=[0.05, 0.3])
    assert_allclose(copies.mass_matrix()[0], matrix, atol=1e-12)
    assert_allclose(copies.mass_matrix()[1] - matrix, np.diag([*[0.0] * 6, 0.25]), atol=1e-12)


def test_steps_of_a_free_base_with_armature_have_exact_derivatives(load):  # noqa: F811
    scene = load(DYNAMICS["free body with armature"])
    scene.reset("0")
    exact, near = (scene.world.linearize(method=method) for method in ("exact", "differences"))
    assert_allclose(exact.A, near.A, atol=1e-5)


def test_saved_worlds_keep_the_bounds_of_tendons(load, tmp_path):  # noqa: F811
    scene = load(DYNAMICS["bounded sum on a fixed tendon"])
    scene.reset("0")
    scene.world.save(tmp_path / "saved")
    with World() as other:
        other.load(tmp_path / "saved")
        worlds = Worlds(scene.world, 2)
        for each in (scene.world, other, worlds):
            each.step(20)
        body = moving(scene)
        saved = next(each for each in other.bodies.values() if each.name == body.name)
        assert_array_equal(saved.joints.positions, body.joints.positions)
        assert_array_equal(worlds.bodies[body.name].joints.positions, [body.joints.positions] * 2)
    assert scene.bodies[0].actuators[0].spec.joint_range == (-1.0, 2.0)


def test_bounds_of_a_tendon_have_to_be_a_range(load):  # noqa: F811
    with pytest.raises(DescriptionError, match="the first number must be less"):
        load(DYNAMICS["bounded sum on a fixed tendon"].replace('"-1 2"', '"2 2" actuatorfrclimited="true"'))
