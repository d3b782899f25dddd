"""iLQR with bounds: swing-ups, and the quadratic programs of its backward pass."""

import numpy as np
import pytest
from tests.controllers.robots import swinging_pole

from carom.controllers import ILQR, LQR, solve_box_qp, state_of


@pytest.mark.parametrize("seed", range(20))
def test_solutions_of_box_qps_are_optimal(seed):
    rng = np.random.default_rng(seed)
    root = rng.normal(size=(6, 6))
    h, g = root @ root.T + 0.01 * np.eye(6), 3 * rng.normal(size=6)
    lower, upper = -rng.uniform(0.0, 1.0, 6), rng.uniform(0.0, 1.0, 6)
    x, free = solve_box_qp(h, g, lower, upper)
    gradient = h @ x + g
    assert np.abs(gradient[free]).max(initial=0.0) < 1e-8
    low, high = ~free & (x == lower), ~free & (x == upper)
    assert (low | high | free).all()
    assert (gradient[low] > 0).all()
    assert (gradient[high] < 0).all()


def test_long_steps_of_box_qps_that_leave_the_box_are_shortened():
    rng = np.random.default_rng(267)
    root = rng.normal(size=(4, 4))
    h, g = root @ root.T + 0.01 * np.eye(4), 3 * rng.normal(size=4)
    lower, upper = -rng.uniform(0.0, 1.0, 4), rng.uniform(0.0, 1.0, 4)
    x, _ = solve_box_qp(h, g, lower, upper)
    # Projected gradients, which converge slowly but surely.
    reached, size = np.zeros(4), 1.0 / np.linalg.eigvalsh(h)[-1]
    for _ in range(3000):
        reached = np.clip(reached - size * (h @ reached + g), lower, upper)
    assert x == pytest.approx(reached, abs=1e-6)


def test_with_small_errors_the_plan_is_that_of_lqr():
    world, robot = swinging_pole(1 / 50, np.pi)
    goal, costs = state_of(world), {"state_cost": (1.0, 10.0, 0.1, 0.1), "control_cost": 0.01}
    names = ["swinging_pole.slide.torque"]
    regulator = LQR(world, names, **costs)
    robot.joints["swing"].reset(np.pi + 1e-3)
    planner = ILQR(world, names, goal=goal, final_cost=regulator.P, **costs)
    plan = planner.solve(np.zeros((60, 1)), tolerance=1e-12)
    assert plan.converged
    assert plan.controls[0] == pytest.approx(regulator.compute(), rel=1e-3)
    assert -plan.gains[0] == pytest.approx(regulator.K, rel=1e-3)


def swing_up(controls: str, limit: float, intervals: int) -> tuple[ILQR, np.ndarray, np.ndarray]:
    world, robot = swinging_pole(1 / 50, np.pi)
    goal = state_of(world)
    robot.joints["swing"].reset(0.0)
    planner = ILQR(
        world,
        [controls],
        goal=goal,
        state_cost=(0.01, 0.01, 0.001, 0.001),
        control_cost=1e-3,
        final_cost=(1000.0, 1000.0, 100.0, 100.0),
        limits=(-limit, limit),
    )
    plan = planner.solve(np.zeros((intervals, 1)))
    # The plan, played in the world, with a little feedback against rounding.
    for interval in range(intervals):
        planner.apply(plan, interval)
        world.step()
    assert plan.costs == sorted(plan.costs, reverse=True)
    return planner, plan.controls, np.concatenate([robot.joints.positions, robot.joints.velocities])


@pytest.mark.long
def test_a_cart_swings_up_a_pole():
    _, controls, reached = swing_up("swinging_pole.slide.torque", 8.0, 100)
    assert np.abs(controls).max() == 8.0
    assert reached == pytest.approx([0.0, np.pi, 0.0, 0.0], abs=0.05)


@pytest.mark.long
def test_a_weak_motor_swings_up_a_pendulum():
    # To hold the pole level takes 0.59 N m, so it has to swing several times.
    _, controls, reached = swing_up("swinging_pole.swing.torque", 0.3, 150)
    assert np.abs(controls).max() == 0.3
    assert reached[[1, 3]] == pytest.approx([np.pi, 0.0], abs=0.1)


def test_arguments_are_checked():
    world, _ = swinging_pole(1 / 50)
    costs = {"state_cost": 1.0, "control_cost": 1.0, "final_cost": 1.0, "goal": state_of(world)}
    with pytest.raises(ValueError, match="lower limits"):
        ILQR(world, limits=(1.0, -1.0), **costs)
    with pytest.raises(ValueError, match="steps"):
        ILQR(world, steps=0, **costs)
    with pytest.raises(ValueError, match="shape"):
        ILQR(world, **costs).solve(np.zeros(10))


def test_a_whole_step_that_gains_little_is_the_last_one_and_a_short_step_is_not():
    world, robot = swinging_pole(1 / 50, np.pi)
    goal, costs = state_of(world), {"state_cost": (1.0, 10.0, 0.1, 0.1), "control_cost": 0.01}
    robot.joints["swing"].reset(np.pi - 1.0)
    names = ["swinging_pole.slide.torque"]
    planner = ILQR(world, names, goal=goal, final_cost=(100.0, 100.0, 10.0, 10.0), **costs)
    plan = planner.solve(np.zeros((40, 1)), tolerance=0.3)
    found = np.array(plan.costs)
    gains = (found[:-1] - found[1:]) / found[1:]
    assert plan.converged
    # The first step is shortened: it gains less than the model promises, and says nothing of the optimum.
    assert gains[0] < 0.3 < gains[1]
    assert len(gains) > 2
    assert gains[-1] < 0.3
    assert len(gains) < len(planner.solve(np.zeros((40, 1)), tolerance=0.01).costs)


def test_steps_that_gain_nothing_are_tried_again_nearer_to_the_plan():
    world, robot = swinging_pole(1 / 20, np.pi, contact="bullet")
    goal = state_of(world)
    # In half a second without control it turns round once or more: the model is far off.
    robot.joints["swing"].reset(1.0, 15.0)
    costs = {"state_cost": 0.0, "control_cost": 1e-6, "final_cost": 1e3}
    names = ["swinging_pole.slide.torque"]
    planner = ILQR(world, names, goal=goal, limits=(-100.0, 100.0), steps=10, **costs)
    plan = planner.solve(np.random.default_rng(0).normal(size=(10, 1)), iterations=20)
    assert plan.costs == sorted(plan.costs, reverse=True)
    assert plan.cost < 0.02 * plan.costs[0]
