"""Masses, friction and damping of an arm from ten seconds of its motion: `carom.identify`.

A simulated Panda, whose parameters differ from those of its file, moves along sums of sines. Its joint angles
and the torques of its drives are measured, with noise; the rest follows.
"""

import sys
import time
from pathlib import Path

import numpy as np

import pybullet_data
from carom import World, identify
from carom.algorithms import inverse_dynamics
from carom.examples.window import wants_window
from carom.viewer import Viewer

PANDA = Path(pybullet_data.getDataPath()) / "franka_panda" / "panda.urdf"
STEP = 1 / 240
ARM = 7
FINGERS = [0.02, 0.02]
PARAMETERS = [
    *(f"panda.panda_{link}.inertial" for link in ("link5", "link6", "link7", "hand")),
    *(
        f"panda.panda_joint{number}.{what}"
        for what in ("damping", "joint_friction")
        for number in range(1, 8)
    ),
]


def load():
    """The Panda of the file, its fingers held."""
    world = World(time_step=STEP)
    world.gravity = (0, 0, -9.81)
    robot = world.load_urdf(PANDA, fixed_base=True)
    robot.joints.free()
    for finger in robot.joints.movable[ARM:]:
        finger.set_position_target(FINGERS[0])
    return world, robot


def real_robot():
    """What the file does not say: a tool of 0.6 kg, friction, and the damping of the gears."""
    world, robot = load()
    robot.change_dynamics("panda_hand", mass=0.81 + 0.6)
    for number, joint in enumerate(robot.joints.movable[:ARM]):
        joint.damping = 1.0 - 0.1 * number
        joint.friction_loss = 0.8 - 0.08 * number
    return world, robot


def measure(world, robot, duration, window):
    """Excites all joints with frequencies up to 0.8 Hz, and measures angles and torques."""
    rng = np.random.default_rng(1)
    rates, phases = 2 * np.pi * rng.uniform(0.1, 0.8, (ARM, 4)), rng.uniform(0, 2 * np.pi, (ARM, 4))
    sizes = np.array([1.0, 0.6, 1.0, 0.6, 1.0, 0.8, 1.0])[:, None] / 4
    middle = np.array([0.0, 0.2, 0.0, -1.6, 0.0, 1.8, 0.0])
    _, model = load()
    viewer = Viewer(world, title="Excitation") if window else None
    if viewer is not None:
        print(f"The simulation is shown at {viewer.address}")
        viewer.open_browser()
    log = {"time": [], "positions": [], "torques": []}
    while world.time < duration and (viewer is None or viewer.is_open):
        angle = rates * world.time + phases
        wanted = middle + (sizes * np.sin(angle)).sum(axis=1)
        speed = (sizes * rates * np.cos(angle)).sum(axis=1)
        if not log["time"]:
            robot.joints.reset([*wanted, *FINGERS], [*speed, 0, 0])
        q, v = robot.joints.positions, robot.joints.velocities
        pull = 100 * (wanted - q[:ARM]) + 20 * (speed - v[:ARM])
        torque = inverse_dynamics(model, q, v, [*pull, 0, 0])[:ARM]
        log["time"].append(world.time)
        log["positions"].append(q + rng.normal(0, 1e-5, ARM + 2))
        # Torques of the fingers are not measured.
        log["torques"].append([*(torque + rng.normal(0, 0.1, ARM)), np.nan, np.nan])
        robot.joints.set_torques([*torque, 0, 0])
        world.step()
        if viewer is not None:
            viewer.plot("elbow [N m]", torque[3])
            time.sleep(STEP)
    if viewer is not None:
        viewer.close()
    return log


def main(duration=10.0, window=False, plot=None):
    log = measure(*real_robot(), duration, window)
    world, robot = load()
    result = identify(log, world, PARAMETERS)
    print(result.report())
    result.apply(world)
    if plot is not None:
        result.plot(plot)
        print(f"{plot} shows measured and fitted torques")
    hand = robot.links["panda_hand"].index
    return {"result": result, "robot": robot, "hand": robot.dynamics(hand).mass}


if __name__ == "__main__":
    pictures = [argument for argument in sys.argv[1:] if argument.endswith((".svg", ".png"))]
    main(window=wants_window(), plot=pictures[0] if pictures else None)
