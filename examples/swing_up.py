"""iLQR swings up a pole on a cart, with a force of at most 8 N; then an LQR balances it.

The plan takes a few seconds to compute. The pole gets a push after six seconds.
"""

import time

import numpy as np

from carom import World
from carom.controllers import ILQR, LQR, state_of
from carom.examples import robot_file
from carom.examples.window import wants_window
from carom.viewer import Viewer

ROBOT = robot_file("swinging_pole.urdf")
FORCE = "swinging_pole.slide.torque"
TIME_STEP, INTERVALS, LIMIT = 1 / 50, 100, 8.0


def make_world():
    world = World(TIME_STEP)
    world.gravity = (0, 0, -9.81)
    robot = world.load_urdf(ROBOT, (0, 0, 1), fixed_base=True)
    robot.joints.free()
    return world, robot


def make_controllers(world, robot):
    """The regulator of the upright pole, and the plan that brings it there."""
    swing = robot.joints["swing"]
    swing.reset(np.pi)
    regulator = LQR(world, [FORCE], state_cost=(1, 10, 0.1, 0.1), control_cost=0.01)
    goal = state_of(world)
    swing.reset(0.0)
    planner = ILQR(
        world,
        [FORCE],
        goal=goal,
        state_cost=(0.01, 0.01, 0.001, 0.001),
        control_cost=1e-3,
        # What is left costs what the regulator would spend on it, and more.
        final_cost=100 * regulator.P,
        limits=(-LIMIT, LIMIT),
    )
    plan = planner.solve(np.zeros((INTERVALS, 1)))
    print(f"the cost fell from {plan.costs[0]:.1f} to {plan.cost:.2f} in {len(plan.costs) - 1} iterations")
    return regulator, planner, plan


def main(duration=10.0, window=False):
    record = {"time": [], "cart": [], "pole": [], "force": []}
    world, robot = make_world()
    regulator, planner, plan = make_controllers(world, robot)
    cart, pole = robot.joints["slide"], robot.joints["swing"]
    viewer = Viewer(world, title="Swing-up") if window else None
    if viewer is not None:
        print(f"The simulation is shown at {viewer.address}")
        viewer.open_browser()
    step = 0
    while world.time < duration and (viewer is None or viewer.is_open):
        if step == 300:
            pole.reset(pole.position, pole.velocity + 0.3)
        (force,) = planner.apply(plan, step) if step < INTERVALS else regulator.apply()
        world.step()
        step += 1
        if viewer is not None:
            viewer.plot("pole [rad]", pole.position)
            viewer.plot("cart [m]", cart.position)
            time.sleep(TIME_STEP)
        for name, value in zip(record, (world.time, cart.position, pole.position, force), strict=True):
            record[name].append(float(value))
    if viewer is not None:
        viewer.close()
    print(f"after {world.time:.1f} s the pole is {np.pi - pole.position:.5f} rad from upright")
    return record


if __name__ == "__main__":
    main(window=wants_window(), duration=float("inf") if wants_window() else 10.0)
