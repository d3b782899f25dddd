"""A cart balances a pole by LQR, whose model is a step linearised.

The pole starts leaning, and gets a push after four seconds.
"""

import time
from pathlib import Path

import numpy as np

import pybullet_data
from carom import World
from carom.controllers import LQR
from carom.examples.window import wants_window
from carom.viewer import Viewer

CARTPOLE = Path(pybullet_data.getDataPath()) / "cartpole.urdf"
FORCE = "slider_to_cart.torque"


def upright():
    world = World(time_step=1 / 240)
    world.gravity = (0, 0, -9.81)
    robot = world.load_urdf(CARTPOLE, fixed_base=True)
    for joint in robot.joints.movable:
        joint.free()
    return world, robot


def regulator_of(world, robot):
    """The feedback of positions and velocities to the force on the cart."""
    regulator = LQR(world, [f"{robot.name}.{FORCE}"], state_cost=(1.0, 10.0, 0.1, 0.1), control_cost=0.001)
    print("the state is", ", ".join(regulator.step.states))
    print("the gains are", regulator.K.round(1))
    growth = np.abs(np.linalg.eigvals(regulator.step.A)).max()
    print("without control a deviation grows by", growth, "in each step")
    print("with control it shrinks, by", regulator.eigenvalues[0])
    return regulator


def main(duration=12.0, window=False):
    record = {"time": [], "cart": [], "pole": [], "force": []}
    world, robot = upright()
    regulator = regulator_of(world, robot)
    cart, pole = robot.joints.movable
    viewer = Viewer(world, title="LQR") if window else None
    if viewer is not None:
        print(f"The simulation is shown at {viewer.address}")
        viewer.open_browser()
    pole.reset(0.1)
    while world.time < duration and (viewer is None or viewer.is_open):
        if len(record["time"]) == 960:
            pole.reset(pole.position, pole.velocity + 0.1)
        (force,) = regulator.apply()
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
