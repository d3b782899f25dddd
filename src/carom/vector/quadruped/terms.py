"""The terms of the quadruped's task."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from carom.checks import Array
from carom.vector.managers import Command, Curriculum, Event, Observation, Reward, Task, Termination
from carom.vector.quadruped.terrain import LEVELS

if TYPE_CHECKING:
    from carom.vector.quadruped.robot import QuadrupedRobot

_FASTEST = np.array([1.0, 0.4, 1.0])
_SLOWEST = np.array([-0.5, -0.4, -1.0])
"""Greatest and least commands: forwards and to the left [m/s], turning to the left [rad/s]."""
_STANDING = 0.1
"""Share of commands to stand."""
_HEIGHT, _CLEARANCE = 0.27, 0.07
"""Wanted heights of the trunk and of feet in the air above the ground [m]."""
_SIGMA = 0.25
"""Square of the error of velocity at which the reward for following it is 1/e of the greatest [m²/s²]."""
_STIFFNESS, _DAMPING = 30.0, 0.8


# Observations


def scan(env: QuadrupedRobot) -> Array:
    """Heights of the ground around the robot, above where a trunk of the wanted height would stand [m]."""
    return env.ground - (env.trunks[:, 2:3] - _HEIGHT)


# Rewards


def follow_velocity(env: QuadrupedRobot) -> Array:
    """How near the horizontal velocity is to the command, 1 for equal."""
    error = np.square(env.velocities[:, :2] - env.commands["velocity"][:, :2]).sum(axis=1)
    return np.exp(-error / _SIGMA)


def lag(env: QuadrupedRobot) -> Array:
    """How far the velocity is off [m/s]; unlike `follow_velocity` it guides from afar."""
    error = np.square(env.velocities[:, :2] - env.commands["velocity"][:, :2]).sum(axis=1)
    return np.sqrt(error)


def follow_turn(env: QuadrupedRobot) -> Array:
    """How near the turning is to the command, 1 for equal."""
    return np.exp(-np.square(env.rates[:, 2] - env.commands["velocity"][:, 2]) / _SIGMA)


def trot(env: QuadrupedRobot) -> Array:
    """Share of the feet that are where the clock wants them: on the ground, or in the air."""
    return (env.touching == env.wanted_touching()).mean(axis=1)


def clearance(env: QuadrupedRobot) -> Array:
    """How high the feet are that the clock wants in the air, 1 for high enough."""
    height = np.clip(env.foot_heights / _CLEARANCE, 0.0, 1.0)
    swinging = ~env.wanted_touching()
    return (height * swinging).sum(axis=1) / np.maximum(swinging.sum(axis=1), 1)


def heave(env: QuadrupedRobot) -> Array:
    """Square of the vertical velocity [m²/s²]."""
    return np.square(env.velocities[:, 2])


def sway(env: QuadrupedRobot) -> Array:
    """Square of the rates of roll and pitch [rad²/s²]."""
    return np.square(env.rates[:, :2]).sum(axis=1)


def tilt(env: QuadrupedRobot) -> Array:
    """Square of the sine of the angle by which the trunk is tilted."""
    return np.square(env.gravity[:, :2]).sum(axis=1)


def height(env: QuadrupedRobot) -> Array:
    """Square of the error of the height of the trunk above the ground [m²]."""
    return np.square(env.trunks[:, 2] - env.ground.mean(axis=1) - _HEIGHT)


def posture(env: QuadrupedRobot) -> Array:
    """Sum of squares of what the joints are away from the stance [rad²]."""
    return np.square(env.robot.joints.positions - env.home).sum(axis=1)


def haste(env: QuadrupedRobot) -> Array:
    """Sum of squares of the changes of actions."""
    return np.square(env.actions - env.last_actions).sum(axis=1)


def effort(env: QuadrupedRobot) -> Array:
    """Sum of squares of the torques [N² m²]."""
    return np.square(env.torques()).sum(axis=1)


def bumps(env: QuadrupedRobot) -> Array:
    """Number of legs that touch the ground with the hip or the thigh."""
    return env.bumping.sum(axis=1).astype(float)


def fall(env: QuadrupedRobot) -> Array:
    """A fall, which is worth one second of its weight."""
    return fallen(env) / env.duration


# Terminations


def fallen(env: QuadrupedRobot) -> np.ndarray:
    """Which trunks touch the ground or are tilted by more than 60°."""
    return env.trunk_touching | np.asarray(env.gravity[:, 2] > -0.5)


def outside(env: QuadrupedRobot) -> np.ndarray:
    """Which robots are at the edge of the ground."""
    return np.any(np.abs(env.trunks[:, :2]) > env.terrain.half - 1.0, axis=1)


# Events, commands, curriculum


def choose_start(env: QuadrupedRobot, worlds: np.ndarray) -> None:
    """A kind of terrain, and one of the easier levels."""
    drawn = env.random.uniform(worlds, 0.0, 1.0, 2)
    env.kinds[worlds] = (drawn[:, 0] * env.kind_count).astype(np.int64)
    env.levels[worlds] = (drawn[:, 1] * 2.0).astype(np.int64)


def randomise_robot(env: QuadrupedRobot, worlds: np.ndarray) -> None:
    """Friction of the feet, mass of the trunk, strength of the motors."""
    drawn = env.random.uniform(worlds, -1.0, 1.0, 4)
    for foot in env.feet:
        env.robot.change_dynamics(foot, lateral_friction=0.85 + 0.35 * drawn[:, 0], where=worlds)
    env.robot.change_dynamics("trunk", mass=env.trunk_mass * (1.0 + 0.2 * drawn[:, 1]), where=worlds)
    env.stiffness[worlds, 0] = _STIFFNESS * (1.0 + 0.1 * drawn[:, 2])
    env.damping[worlds, 0] = _DAMPING * (1.0 + 0.1 * drawn[:, 3])


def place(env: QuadrupedRobot, worlds: np.ndarray) -> None:
    """Put the robot on its tile, turned at random, with bent legs."""
    drawn = env.random.uniform(worlds, -1.0, 1.0, 3 + 12)
    places = env.terrain.centres(env.levels[worlds], env.kinds[worlds]) + 0.4 * drawn[:, :2]
    env.stand(worlds, places, np.pi * drawn[:, 2])
    env.robot.joints.positions[worlds] = env.home + 0.1 * drawn[:, 3:]


def push(env: QuadrupedRobot, worlds: np.ndarray) -> None:
    """Change the horizontal velocity at once."""
    velocities = env.robot.base_velocities[worlds]
    velocities[:, :2] += env.random.uniform(worlds, -0.4, 0.4, 2)
    env.robot.set_base_velocities(velocities, where=worlds)


def choose_velocity(env: QuadrupedRobot, worlds: np.ndarray) -> Array:
    """Velocities forwards and to the left [m/s], and of turning [rad/s]."""
    drawn = env.random.uniform(worlds, 0.0, 1.0, 4)
    chosen = _SLOWEST + (_FASTEST - _SLOWEST) * drawn[:, :3]
    return chosen * (drawn[:, 3:] >= _STANDING)


def climb(env: QuadrupedRobot, worlds: np.ndarray) -> float:
    """Harder ground for those that walked as far as they should have, easier for those that did not."""
    share, asked = env.walked[worlds], env.asked[worlds]
    up = (share > 0.75 * asked) & (asked > 1.0)
    down = share < 0.4 * asked
    levels = env.levels[worlds] + up - down
    # Who has mastered them all goes on anywhere.
    mastered = np.flatnonzero(levels >= LEVELS)
    levels[mastered] = (env.random.uniform(worlds[mastered], 0.0, 1.0) * LEVELS).astype(np.int64)
    env.levels[worlds] = np.maximum(levels, 0)
    return float(env.levels.mean())


TASK = Task(
    observations={
        "velocity": Observation(lambda env: env.velocities, scale=2.0, noise=0.1),
        "rates": Observation(lambda env: env.rates, scale=0.5, noise=0.2),
        "gravity": Observation(lambda env: env.gravity, noise=0.05),
        "command": Observation(lambda env: env.commands["velocity"], scale=(2.0, 2.0, 1.0)),
        "positions": Observation(lambda env: env.robot.joints.positions - env.home, noise=0.01),
        "rotation": Observation(lambda env: env.robot.joints.velocities, scale=0.05, noise=1.0),
        "actions": Observation(lambda env: env.actions),
        "clock": Observation(lambda env: env.clock()),
        "scan": Observation(scan, scale=5.0, noise=0.02, clip=(-1.0, 1.0)),
    },
    rewards={
        "follow velocity": Reward(follow_velocity, 2.0),
        "lag": Reward(lag, -1.0),
        "follow turn": Reward(follow_turn, 1.0),
        "trot": Reward(trot, 0.5),
        "clearance": Reward(clearance, 0.5),
        "heave": Reward(heave, -1.0),
        "sway": Reward(sway, -0.05),
        "tilt": Reward(tilt, -0.5),
        "height": Reward(height, -20.0),
        "posture": Reward(posture, -0.05),
        "haste": Reward(haste, -0.02),
        "effort": Reward(effort, -1e-4),
        "bumps": Reward(bumps, -0.3),
        "fall": Reward(fall, -5.0),
    },
    terminations={"fallen": Termination(fallen), "outside": Termination(outside, time_out=True)},
    events={
        "start": Event(choose_start, "start"),
        "robot": Event(randomise_robot, "start"),
        "place": Event(place, "reset"),
        "push": Event(push, "interval", seconds=(4.0, 8.0)),
    },
    commands={"velocity": Command(choose_velocity, seconds=(5.0, 5.0))},
    curriculum={"level": Curriculum(climb)},
)
"""Follow commands of velocity on random terrain."""
