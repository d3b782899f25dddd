"""Ready terms for tasks: what is often observed, rewarded, ended by and changed.

Each is a function of the name of a body in `env.worlds`, and makes the function of a term:

    Task(
        observations={"joints": Observation(library.joint_positions("arm"))},
        rewards={"effort": Reward(library.squared_torques("arm"), -1e-4)},
        terminations={"fallen": Termination(library.below("arm", 0.3))},
        events={"push": Event(library.push("arm", 0.5), "interval", seconds=(2.0, 4.0))},
    )
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from carom.checks import Array
from carom.vector.rotations import turned

Value = Callable[[Any], Array]
Change = Callable[[Any, np.ndarray], None]
_BACK = np.array((-1.0, -1.0, -1.0, 1.0))
_DOWN = np.array((0.0, 0.0, -1.0))


# Observations


def joint_positions(body: str, joints: Any = None, *, relative_to: Any = 0.0) -> Value:
    """Positions of joints [rad or m], (num_envs, n), minus `relative_to`; of all if None are named."""
    return lambda env: np.asarray(_joints(env, body, joints).positions) - relative_to


def joint_velocities(body: str, joints: Any = None) -> Value:
    """Velocities of joints [rad/s or m/s], (num_envs, n)."""
    return lambda env: np.array(_joints(env, body, joints).velocities)


def base_height(body: str) -> Value:
    """Height of the base's link frame [m], (num_envs,)."""
    return lambda env: env.worlds[body].pose.position[:, 2]


def base_velocity(body: str) -> Value:
    """Velocity of the base's centre of mass along its own axes [m/s], (num_envs, 3)."""
    return lambda env: _in_base(env, body, env.worlds[body].velocity.linear)


def base_rate(body: str) -> Value:
    """Angular velocity of the base about its own axes [rad/s], as a gyroscope shows it, (num_envs, 3)."""
    return lambda env: _in_base(env, body, env.worlds[body].velocity.angular)


def gravity_direction(body: str) -> Value:
    """Direction of gravity in the axes of the base, (num_envs, 3): (0, 0, -1) while it is upright."""
    return lambda env: _in_base(env, body, np.tile(_DOWN, (env.num_envs, 1)))


def position_of(body: str, link: str | None = None, *, relative_to: str | None = None) -> Value:
    """Position of a link, or of the base [m], (num_envs, 3); minus that of the base of another body."""

    def value(env: Any) -> Array:
        place = env.worlds[body].pose if link is None else env.worlds[body].links[link].pose
        other = 0.0 if relative_to is None else env.worlds[relative_to].pose.position
        return place.position - other

    return value


def last_actions() -> Value:
    """The latest actions, (num_envs, n)."""
    return lambda env: env.actions.copy()


def command(name: str) -> Value:
    """A command of the task, (num_envs, n)."""
    return lambda env: env.commands[name].copy()


def sensors() -> Value:
    """What all sensors show, (num_envs, n)."""
    return lambda env: np.asarray(env.worlds.sensors)


# Rewards


def alive() -> Value:
    """1 in each step."""
    return lambda env: np.ones(env.num_envs)


def near(body: str, link: str | None, target: Any, *, width: float = 0.1) -> Value:
    """exp(-(distance / width)²) of a link, or of the base, from a target: a point, or a function of env."""

    def value(env: Any) -> Array:
        goal: Any = target(env) if callable(target) else np.asarray(target, np.float64)
        apart = position_of(body, link)(env) - goal
        return np.exp(-np.square(apart).sum(axis=1) / width**2)

    return value


def tracking(what: Value, wanted: Value, *, width: float = 0.5) -> Value:
    """exp(-(error / width)²) of one term from another: `tracking(base_velocity("a1"), command("speed"))`.

    The columns that both have in front are compared.
    """

    def value(env: Any) -> Array:
        own, goal = np.asarray(what(env)), np.asarray(wanted(env))
        own, goal = own.reshape(env.num_envs, -1), goal.reshape(env.num_envs, -1)
        columns = min(own.shape[1], goal.shape[1])
        return np.exp(-np.square(own[:, :columns] - goal[:, :columns]).sum(axis=1) / width**2)

    return value


def squared_torques(body: str, joints: Any = None) -> Value:
    """Sum of the squared torques of motors [(N m)²], for a negative weight."""
    return lambda env: np.square(np.asarray(_joints(env, body, joints).motor_torques)).sum(axis=1)


def action_rate() -> Value:
    """Sum of the squared changes of the actions, for a negative weight."""
    return lambda env: np.square(env.actions - env.last_actions).sum(axis=1)


def tilt(body: str) -> Value:
    """Square of the sine of the angle by which the base leans, for a negative weight."""
    return lambda env: np.square(gravity_direction(body)(env)[:, :2]).sum(axis=1)


def beyond_limits(body: str, joints: Any = None) -> Value:
    """By how much joints are beyond their limits, in total [rad or m], for a negative weight."""

    def value(env: Any) -> Array:
        group = _joints(env, body, joints)
        lower, upper = (np.asarray(bound) for bound in group.limits)
        at = np.asarray(group.positions)
        return (np.maximum(lower - at, 0.0) + np.maximum(at - upper, 0.0)).sum(axis=1)

    return value


# Terminations


def below(body: str, height: float) -> Callable[[Any], np.ndarray]:
    """Where the base is lower than this [m]."""
    return lambda env: base_height(body)(env) < height


def leaning(body: str, angle: float) -> Callable[[Any], np.ndarray]:
    """Where the base leans by more than this angle [rad]."""
    return lambda env: gravity_direction(body)(env)[:, 2] > -np.cos(angle)


def touching(body: str, other: str | None = None, *, links: Sequence[str] | None = None) -> Any:
    """Where a body, or one of its links, touches another one, or anything."""

    def value(env: Any) -> np.ndarray:
        places = [None] if links is None else links
        found = [env.worlds.contacts(body, other, link=link).touching for link in places]
        return np.logical_or.reduce(found)

    return value


def longer_than(seconds: float) -> Callable[[Any], np.ndarray]:
    """Where the episode has lasted so long; with `time_out=True`."""
    return lambda env: env.episode_steps * env.duration >= seconds - 1e-9


# Events


def scatter_joints(body: str, spread: Any, joints: Any = None, *, about: Any = 0.0) -> Change:
    """Put joints at random positions, uniform within `spread` of `about`, at rest."""

    def change(env: Any, worlds: np.ndarray) -> None:
        group = _joints(env, body, joints)
        size = np.asarray(group.positions).shape[1]
        drawn = env.random.uniform(worlds, -1.0, 1.0, size) * spread
        group.reset(drawn + about, 0.0, where=worlds)

    return change


def scatter_base(body: str, lower: Any, upper: Any) -> Change:
    """Put the base at a random position in a box [m], upright and at rest."""

    def change(env: Any, worlds: np.ndarray) -> None:
        places = env.random.uniform(worlds, np.asarray(lower, float), np.asarray(upper, float), 3)
        env.worlds[body].set_pose((places, np.array((0.0, 0.0, 0.0, 1.0))), where=worlds)
        env.worlds[body].set_velocity(where=worlds)

    return change


def push(body: str, speed: float) -> Change:
    """Change the horizontal velocity of the base by up to this along each axis [m/s]."""

    def change(env: Any, worlds: np.ndarray) -> None:
        present = env.worlds[body].velocity
        kick = np.zeros((len(worlds), 3))
        kick[:, :2] = env.random.uniform(worlds, -speed, speed, 2)
        env.worlds[body].set_velocity(present.linear[worlds] + kick, present.angular[worlds], where=worlds)

    return change


def random_friction(body: str, lower: float, upper: float) -> Change:
    """Give all shapes of a body the same friction, drawn for each world; with `when="start"`."""

    def change(env: Any, worlds: np.ndarray) -> None:
        friction = env.random.uniform(worlds, lower, upper)
        for shape in env.worlds[body].shapes:
            shape.change(friction=friction, where=worlds)

    return change


def random_masses(body: str, lower: float, upper: float) -> Change:
    """Multiply the masses of all links by one factor for each world; with `when="start"`."""

    def change(env: Any, worlds: np.ndarray) -> None:
        factor = env.random.uniform(worlds, lower, upper)
        batch = env.worlds[body]
        for link in batch.links:
            if (mass := link.spec.mass) > 0.0 and not (link.index < 0 and batch.fixed_base):
                batch.change_dynamics(link.index, mass=factor * mass, where=worlds)

    return change


def _joints(env: Any, body: str, joints: Any) -> Any:
    found = env.worlds[body].joints
    return found if joints is None else found[joints]


def _in_base(env: Any, body: str, vectors: Array) -> Array:
    return turned(env.worlds[body].pose.quaternion * _BACK, vectors)
