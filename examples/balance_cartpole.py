"""A cart balances a pole by LQR: `World.linearize` gives the model, a Riccati equation the gains.

The pole starts leaning, and gets a push after four seconds.
"""

import time
from pathlib import Path

import numpy as np
from _window import wants_window

import pybullet_data
from carom import World
from carom.viewer import Viewer

CARTPOLE = Path(pybullet_data.getDataPath()) / "cartpole.urdf"
FORCE = "slider_to_cart.torque"


def lqr(a, b, state_cost, control_cost):
    """Gains k: u = -k x has the least sum of xᵀ Q x + uᵀ R u. Iterates the discrete Riccati equation."""
    value = state_cost
    for _ in range(100000):
        gains = np.linalg.solve(control_cost + b.T @ value @ b, b.T @ value @ a)
        before, value = value, state_cost + a.T @ value @ (a - b @ gains)
        if np.abs(value - before).max() < 1e-10 * np.abs(value).max():
            break
    return gains


def upright():
    world = World(time_step=1 / 240)
    world.gravity = (0, 0, -9.81)
    robot = world.load_urdf(CARTPOLE, fixed_base=True)
    for joint in robot.joints.movable:
        joint.disable_motor()
    return world, robot


def gains_of(world, robot):
    """The feedback of positions and velocities to the force on the cart."""
    step = world.linearize([f"{robot.name}.{FORCE}"])
    print("the state is", ", ".join(step.states))
    print("without control a deviation grows by", np.abs(np.linalg.eigvals(step.A)).max(), "in each step")
    gains = lqr(step.A, step.B, np.diag([1.0, 10.0, 0.1, 0.1]), np.array([[0.001]]))
    print("with control it shrinks, by", np.abs(np.linalg.eigvals(step.A - step.B @ gains)).max())
    return gains


def main(duration=12.0, window=False):
    record = {"time": [], "cart": [], "pole": [], "force": []}
    world, robot = upright()
    gains = gains_of(world, robot)
    cart, pole = robot.joints.movable
    viewer = Viewer(world, title="LQR") if window else None
    if viewer is not None:
        print(f"The simulation is shown at {viewer.address}")
        viewer.open_browser()
    pole.reset(0.1)
    while world.time < duration and (viewer is None or viewer.is_open):
        state = np.concatenate([robot.joints.positions, robot.joints.velocities])
        (force,) = -gains @ state
        cart.set_torque(force)
        if len(record["time"]) == 960:
            pole.reset(pole.position, pole.velocity + 0.1)
        world.step()
        if viewer is not None:
            viewer.plot("pole [rad]", pole.position)
            viewer.plot("cart [m]", cart.position)
            time.sleep(world.parameters.time_step)
        for name, value in zip(record, (world.time, cart.position, pole.position, force), strict=True):
            record[name].append(float(value))
    if viewer is not None:
        viewer.close()
    print(
        f"after {world.time:.1f} s the cart is at {cart.position:.4f} m, the pole at {pole.position:.4f} rad"
    )
    return record


if __name__ == "__main__":
    main(window=wants_window(), duration=float("inf") if wants_window() else 12.0)
