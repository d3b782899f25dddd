"""LQR: the Riccati equation, a cart-pole, a body that floats, a robot that stands."""

from pathlib import Path

import numpy as np
import pytest
from tests.controllers.robots import swinging_pole

from carom import World
from carom.controllers import LQR, lqr_gains, solve_discrete_are
from carom.description.pose import Pose
from carom.layouts.codes import UserConstraintKind


def test_the_riccati_equation_holds():
    rng = np.random.default_rng(3)
    a, b = rng.normal(size=(7, 7)), rng.normal(size=(7, 2))
    root = rng.normal(size=(7, 7))
    q, r = root @ root.T, np.array([[2.0, 0.3], [0.3, 1.0]])
    p = solve_discrete_are(a, b, q, r)
    reduced = a.T @ p @ b
    rest = a.T @ p @ a - reduced @ np.linalg.solve(r + b.T @ p @ b, reduced.T) + q
    assert p == pytest.approx(rest, rel=1e-8)
    gains, _ = lqr_gains(a, b, q, r)
    assert np.abs(np.linalg.eigvals(a)).max() > 1.0
    assert np.abs(np.linalg.eigvals(a - b @ gains)).max() < 1.0


def test_without_a_stabilising_solution_there_is_an_error():
    with pytest.raises(ValueError, match="no stabilising solution"):
        solve_discrete_are(np.diag([1.1, 0.5]), np.array([[0.0], [1.0]]), np.eye(2), np.eye(1))


def fall(world, robot, regulator: LQR | None) -> float:
    """The largest angle of the pole in the last second of four, from 0.1 rad."""
    robot.joints["swing"].reset(np.pi + 0.1)
    angles = []
    for _ in range(960):
        if regulator is not None:
            regulator.apply()
        world.step()
        angles.append(abs(robot.joints["swing"].position - np.pi))
    return max(angles[-240:])


def test_a_pole_is_balanced_that_falls_without_control():
    world, robot = swinging_pole(1 / 240, np.pi)
    regulator = LQR(
        world, ["swinging_pole.slide.torque"], state_cost=(1.0, 10.0, 0.1, 0.1), control_cost=0.01
    )
    assert np.abs(np.linalg.eigvals(regulator.step.A)).max() > 1.01
    assert regulator.eigenvalues[0] < 1.0
    other = world.copy()
    assert fall(other, other.bodies[robot.id], None) > 1.0
    assert fall(world, robot, regulator) < 5e-3
    # The present state costs what the value function says.
    robot.joints.reset((0.01, np.pi - 0.01), 0.0)
    expected = regulator.difference() @ regulator.P @ regulator.difference()
    spent = 0.0
    for _ in range(2400):
        state = regulator.difference()
        force = regulator.apply()
        spent += state @ np.diag([1.0, 10.0, 0.1, 0.1]) @ state + 0.01 * float(force @ force)
        world.step()
    assert spent == pytest.approx(expected, rel=1e-3)


@pytest.mark.parametrize("argument", [{"discount": 0.0}, {"control_cost": 0.0}, {"state_cost": [1.0, 2.0]}])
def test_arguments_are_checked(argument):
    world, _ = swinging_pole(1 / 240, np.pi)
    with pytest.raises(ValueError, match=r"must|shape"):
        LQR(world, **{"state_cost": 1.0, "control_cost": 1.0, **argument})


def test_a_free_body_stands_on_its_foot_by_reaction_wheels():
    world = World(1 / 240)
    world.gravity = (0.0, 0.0, -9.81)
    post = world.load_urdf(Path(__file__).with_name("wheels.urdf"), (0.0, 0.0, 0.3))
    post.joints.free()
    foot = Pose((0.0, 0.0, -0.3))
    world.constrain_links(UserConstraintKind.POINT_TO_POINT, post, -1, None, -1, parent_frame=foot)
    # Turns of the base, and all velocities: where wheels are does not matter.
    costs = np.concatenate([[100.0, 100.0, 1.0], np.zeros(6), [10.0, 10.0, 10.0], np.zeros(3), [0.01] * 3])
    regulator = LQR(world, ["torques"], state_cost=costs, control_cost=1.0, discount=0.9999)
    assert "post.base.turn.x.position" in regulator.step.states

    def tilt(scene: World, wants_control: bool) -> float:
        body = scene.bodies[post.id]
        body.set_base_velocity((0.03, -0.015, 0.0), (0.05, 0.1, 0.02))
        for _ in range(1920):
            if wants_control:
                regulator.apply(scene)
            scene.step()
        return float(np.abs(body.links.base.pose.orientation[:2]).max())

    assert tilt(world.copy(), False) > 0.5
    assert tilt(world.copy(), True) < 1e-3
