"""Equations of motion in extended coordinates against those of the engine."""

from pathlib import Path

import numpy as np
import pytest

from carom import World
from carom.algorithms import inverse_dynamics, mass_matrix
from carom.algorithms.extended_model import ExtendedModel, extended_bias_forces, extended_mass_matrix
from carom.algorithms.extended_nodes import extended_nodes
from carom.algorithms.stable_pd import stable_pd_torques
from carom.model.joint_columns import NO_ENTRIES, column_of
from carom.scene.body import Body

ROBOTS = Path(__file__).parents[1] / "pybullet" / "robots"
INERTIA_FROM_FILE = 2
BASE = 7


def load(name: str, *, fixed_base: bool) -> Body:
    world = World()
    world.gravity = (0.3, -0.2, -9.8)
    return world.load_urdf(ROBOTS / name, fixed_base=fixed_base, flags=INERTIA_FROM_FILE)


def extended_and_plain(body: Body, seed: int) -> list[np.ndarray]:
    """Positions; velocities with a fourth coordinate of ball joints, and without; which are not that."""
    generator = np.random.default_rng(seed)
    positions, rates, plain_rates, moving = [], [], [], []
    for count in body.position_count:
        values = generator.uniform(-1.0, 1.0, count)
        rate = generator.uniform(-1.0, 1.0, count)
        if count == 4:
            values /= np.linalg.norm(values)
            rate[3] = 0.0
        positions.append(values)
        rates.append(rate)
        plain_rates.append(rate[:3])
        moving.append(np.arange(count) < 3)
    return [np.concatenate(parts) for parts in (positions, rates, plain_rates, moving)]


@pytest.mark.parametrize("name", ["arm.urdf", "zoo.urdf"])
@pytest.mark.parametrize("seed", range(3))
def test_joint_space_is_that_of_the_engine(name: str, seed: int) -> None:
    body = load(name, fixed_base=True)
    for joint in body.joints.movable:
        joint.armature = 0.1 * (1 + joint.index)
    positions, rates, plain_rates, moving = extended_and_plain(body, seed)
    base = body.world.position[:BASE]
    model = ExtendedModel(extended_nodes(body, as_pybullet=False))
    position = np.array([*base, *positions])
    matrix = model.mass_matrix(position)[BASE:, BASE:]
    assert matrix[np.ix_(moving, moving)] == pytest.approx(mass_matrix(body, positions), abs=1e-12)
    forces = model.bias_forces(position, np.array([*[0.0] * BASE, *rates]), (0.3, -0.2, -9.8))
    still = np.zeros_like(plain_rates)
    assert forces[BASE:][moving] == pytest.approx(
        inverse_dynamics(body, positions, plain_rates, still), abs=1e-12
    )


def test_a_base_counts_even_when_it_is_fixed() -> None:
    body = load("arm.urdf", fixed_base=True)
    matrix = extended_mass_matrix(body, [0.1, 0.2, 0.05])
    assert matrix.shape == (10, 10)
    # The base's own mass is 0 when it is fixed; the fourth of its angular coordinates moves nothing.
    assert matrix[0, 0] == pytest.approx(1.9)
    assert matrix[6, 6] == 1.0
    assert matrix == pytest.approx(matrix.T)


def test_weight_at_rest() -> None:
    body = load("arm.urdf", fixed_base=False)
    forces = extended_bias_forces(body, [0, 0, 0, 0, 0, 0, 1, 0.1, 0.2, 0.05], [0.0] * 10)
    assert forces[:3] == pytest.approx(3.9 * np.array([-0.3, 0.2, 9.8]))


def test_torques_solve_the_equations_of_motion_together_with_the_controller() -> None:
    body = load("zoo.urdf", fixed_base=True)
    positions, _, rates, _ = extended_and_plain(body, 5)
    q, u = 0, 0
    for joint, (count, freedoms) in enumerate(zip(body.position_count, body.velocity_count, strict=True)):
        body.set_joint_state(joint, positions[q : q + count].tolist(), rates[u : u + freedoms].tolist())
        q, u = q + count, u + freedoms
    kp, kd, step = 30.0, 4.0, 0.01
    joints = tuple(joint for joint, count in enumerate(body.position_count) if count)
    aims = [[0.2] if body.position_count[joint] == 1 else [0.0, 0.0, 0.6, 0.8] for joint in joints]
    kps, kds = [kp] * len(joints), [kd] * len(joints)
    targets = column_of(aims), NO_ENTRIES, NO_ENTRIES
    torques = stable_pd_torques(body, joints, *targets, kps, kds, step)[6:]
    still = np.zeros_like(rates)
    bias = inverse_dynamics(body, positions, rates, still)
    acceleration = np.linalg.solve(mass_matrix(body, positions), torques - bias)
    hinge = positions[0] + step * rates[0]
    assert torques[0] == pytest.approx(kp * (0.2 - hinge) - kd * (rates[0] + step * acceleration[0]))


def test_torques_are_bounded_and_other_joints_are_left_alone() -> None:
    body = load("arm.urdf", fixed_base=True)
    columns = column_of([[1.0]]), column_of([[0.0]]), column_of([[0.5]])
    torques = stable_pd_torques(body, (1,), *columns, [1000.0], [1.0], 0.01)
    assert torques.tolist() == [0.0] * 7 + [0.5, 0.0]


def test_planar_joints_have_no_extended_coordinates(tmp_path: Path) -> None:
    file = tmp_path / "planar.urdf"
    file.write_text(
        '<robot name="r"><link name="a"/><link name="b"/><joint name="j" type="planar">'
        '<parent link="a"/><child link="b"/><axis xyz="0 0 1"/></joint></robot>'
    )
    body = World().load_urdf(file)
    with pytest.raises(ValueError, match="planar"):
        extended_mass_matrix(body, [0.0] * 10)
