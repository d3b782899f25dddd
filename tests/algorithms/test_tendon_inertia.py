"""What the armature of tendons adds: against differences, and against a step of a body that flies."""

from collections.abc import Iterator

import numpy as np
import pytest
from numpy.testing import assert_allclose

from carom import Body, World
from carom.algorithms import bias_forces, mass_matrix, tendon_bias_forces, tendon_inertia

ARMATURE = 0.7
FLYER = f"""<mujoco><option timestep="1e-7" gravity="0 0 -3"/>
<default><geom contype="0" conaffinity="0"/></default><worldbody><site name="hook" pos=".1 .7 .9"/>
<body name="a" pos="0 0 .4"><freejoint/><geom size=".1 .05 .07" type="box"/>
<site name="own" pos=".1 .02 -.05"/><body pos=".2 0 .1"><joint name="j" axis=".2 1 .3"/>
<geom size=".06" pos=".1 .03 0"/><site name="mid" pos=".1 .05 0"/><body pos=".2 0 0">
<joint name="k" type="ball"/><geom size=".04" pos=".05 0 .1"/><site name="tip" pos=".1 0 .2"/></body></body>
</body></worldbody><tendon><spatial name="t" armature="{ARMATURE}">
<site site="hook"/><site site="own"/><site site="tip"/>
<pulley divisor="2"/><site site="mid"/><site site="hook"/></spatial>
<fixed name="f" armature=".2"><joint joint="j" coef=".4"/></fixed></tendon></mujoco>"""


@pytest.fixture
def flyer(tmp_path) -> Iterator[Body]:
    """A free body with two joints, one of them spherical, whose tendons lead to the world."""
    (tmp_path / "flyer.xml").write_text(FLYER)
    with World() as world:
        scene = world.load(tmp_path / "flyer.xml")
        scene.apply_options()
        world.parameters.solver_residual_threshold = 0.0
        world.apply_parameters()
        body = scene["a"]
        body.pose = ((0.1, -0.2, 0.3), np.array([0.1, 0.5, -0.3, 0.8]) / np.sqrt(0.99))
        body.set_base_velocity((0.4, -0.7, 0.2), (1.1, -0.6, 0.9))
        body.joints[0].reset(0.3, -1.2)
        turn = np.array([0.2, -0.3, 0.4, 0.8])
        body.set_joint_state(1, (turn / np.linalg.norm(turn)).tolist(), [0.8, -1.5, 0.7])
        yield body


def motion(body: Body) -> tuple[np.ndarray, np.ndarray]:
    """Positions and velocities as the algorithms take them."""
    pose, twist = body.links[-1].inertial_pose, body.links[-1].velocity
    lever = np.array(pose.position) - np.array(body.links[-1].pose.position)
    x, y, z, w = pose.orientation
    turn = np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )
    omega = np.array(twist.angular)
    velocity = np.array(twist.linear) + np.cross(omega, lever)
    rates = np.concatenate([np.ravel(each.rates) for each in body.joints])
    positions = [*pose.position, *pose.orientation, *body.joints.positions]
    return np.array(positions), np.concatenate([turn.T @ omega, turn.T @ velocity, rates])


def test_moment_arms_are_how_fast_tendons_get_longer(flyer: Body) -> None:
    q, v = motion(flyer)
    rates = {name: flyer.tendons[name].velocity for name in "tf"}
    matrix = tendon_inertia(flyer, q)
    assert_allclose(v @ matrix @ v, ARMATURE * rates["t"] ** 2 + 0.2 * rates["f"] ** 2, rtol=1e-9)
    assert np.linalg.matrix_rank(matrix) == 2


def test_a_step_moves_by_what_armature_adds(flyer: Body) -> None:
    q, v = motion(flyer)
    h = flyer.world.parameters.time_step
    flyer.world.step()
    change = (motion(flyer)[1] - v) / h
    bias, added = bias_forces(flyer, q, v), tendon_bias_forces(flyer, q, v)
    total = mass_matrix(flyer, flyer.joints.positions) + tendon_inertia(flyer, q)
    found = np.linalg.solve(total, -bias - added)
    assert_allclose(change, found, atol=1e-6 * np.abs(found).max())
    without = np.linalg.solve(total, -bias)
    assert np.abs(without - found).max() > 1e-2 * np.abs(found).max()


def test_the_energy_of_a_free_motion_stays(flyer: Body) -> None:
    flyer.world.parameters.gravity = (0.0, 0.0, 0.0)
    flyer.world.parameters.time_step = 1e-5
    flyer.world.apply_parameters()

    def energy() -> float:
        q, v = motion(flyer)
        return float(v @ (mass_matrix(flyer, flyer.joints.positions) + tendon_inertia(flyer, q)) @ v) / 2.0

    before = energy()
    flyer.world.step(20_000)
    assert energy() == pytest.approx(before, rel=1e-3)
