"""Turning bodies with the mouse: a torque that brings a link to the orientation that a page asks for."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import hypot, isfinite
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from carom.description.pose import Quaternion, Vector3
from carom.description.transform import conjugate, multiplied, rotate, rotation_matrix
from carom.layouts.flags import ActivationChange
from carom.model.body_spec import BASE
from carom.scene.dynamics.changes import change_dynamics
from carom.scene.joint_constraints import moving_links
from carom.viewer.input.picking import follows_hand

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore
    from carom.scene.core.world_core import WorldCore

# The torque is that of a critically damped spring of this frequency on the turned links [rad/s].
_FREQUENCY = 20.0
_PATIENCE = 0.02


@dataclass(slots=True)
class _Turn:
    """The turn of one page: a link, those that hang on it, and the target of its inertial frame."""

    body: BodyCore
    link: int
    subtree: list[int]
    target: Quaternion


class Turning:
    """The turns of all pages; an observer of the world while there are any.

    Requests are made by one thread, which also calls `apply`; only that changes the world, under its lock.
    While the simulation is `paused`, bodies with a free base are turned at once about the centre of mass of
    the link; their velocity stays. Mocap bodies always are. Otherwise, and with a fixed base, a torque turns
    the link in each step.
    """

    def __init__(self, world: WorldCore, lock: Any, paused: Callable[[], bool]) -> None:
        self._world = world
        self._world_lock = lock
        self._paused = paused
        self._asked: dict[int, tuple[int, int, Quaternion]] = {}
        self._ended: set[int] = set()
        self._turns: dict[int, _Turn] = {}

    def turn(self, page: int, message: dict[str, Any]) -> None:
        """Sets what a page turns, by a message with body, link and the orientation of its inertial frame."""
        orientation = orientation_of(message)
        if orientation is not None:
            self._asked[page] = (int(message["body"]), int(message["link"]), orientation)
            self._ended.discard(page)

    def release(self, page: int) -> None:
        """Ends the turn of a page, after what it has asked for last."""
        if page in self._turns or page in self._asked:
            self._ended.add(page)

    def apply(self, patience: float = _PATIENCE) -> None:
        """Does what pages have asked for; if no step ends in `patience` [s], at the next call."""
        if not (self._asked or self._ended) or not self._world_lock.acquire(timeout=patience):
            return
        try:
            for page, asked in self._asked.items():
                turn = self._turn(self._turns.get(page), *asked)
                by_hand = turn is not None and follows_hand(turn.body, turn.link)
                if turn is None or by_hand:
                    self._turns.pop(page, None)
                else:
                    self._turns[page] = turn
                if turn is not None and (by_hand or self._paused()):
                    _carry(turn)
            for page in self._ended:
                self._turns.pop(page, None)
            self._asked.clear()
            self._ended.clear()
            observers = self._world.observers
            if self._turns and self not in observers:
                observers.append(self)
            elif not self._turns and self in observers:
                observers.remove(self)
        finally:
            self._world_lock.release()

    def before_step(self) -> None:
        """Adds the torques of all turns to the forces of the step."""
        for turn in self._turns.values():
            # The body may have been removed in the meantime.
            if self._world.bodies.get(turn.body.id) is turn.body:
                row = turn.body.first_link - BASE + turn.link
                self._world.link_force[row, 3:] += self._torque(turn, row)

    def after_step(self) -> None:
        """Does nothing: the torque of the next step is not known yet."""

    def _turn(self, turn: _Turn | None, number: int, link: int, target: Quaternion) -> _Turn | None:
        """A turn with its new target; None if there is no such link, or it cannot move."""
        body = self._world.bodies.get(number)
        if body is None or body.spec.soft is not None or not BASE <= link < body.joint_count:
            return None
        if not moving_links(body)[link - BASE] and not follows_hand(body, link):
            return None
        change_dynamics(body, BASE, {"activation_state": ActivationChange.WAKE_UP})
        if turn is not None and turn.body is body and turn.link == link:
            turn.target = target
            return turn
        return _Turn(body, link, subtree_of(body, link), target)

    def _torque(self, turn: _Turn, row: int) -> NDArray[np.float64]:
        """(3,) the torque in the world [N m]."""
        turn.body.update_link_poses()
        turn.body.update_link_velocities()
        rate = self._world.link_velocity[row, 3:]
        return turning_torque(turn.body, turn.subtree, turn.target, self._world.link_pose, rate)


def turning_torque(
    body: BodyCore, subtree: list[int], target: Quaternion, poses: NDArray[Any], rate: NDArray[np.float64]
) -> NDArray[np.float64]:
    """The torque of a critically damped spring that turns a link, with those that hang on it, to a target.

    Args:
        body: The body.
        subtree: The link and those that hang on it, see `subtree_of`.
        target: Orientation that the inertial frame of the link is to have.
        poses: (links, 7) present poses of the inertial frames of all links of the world, by their rows.
        rate: (3,) angular velocity of the link [rad/s].

    Returns:
        (3,) the torque in the world [N m].
    """
    own = poses[body.first_link - BASE + np.array(subtree)].astype(np.float64)
    left = turn_between(tuple(own[0, 3:].tolist()), target)
    return _inertia(body, subtree, own) @ (_FREQUENCY**2 * left - 2.0 * _FREQUENCY * rate)


def turn_between(start: Quaternion, end: Quaternion) -> NDArray[np.float64]:
    """(3,) the rotation vector from an orientation to another, in the world, the shorter way round [rad]."""
    x, y, z, w = multiplied(end, conjugate(start))
    sine = hypot(x, y, z)
    angle = 2.0 * np.arctan2(sine, abs(w)) * (1.0 if w >= 0.0 else -1.0)
    return np.array([x, y, z]) * (angle / max(sine, 1e-12))


def _inertia(body: BodyCore, subtree: list[int], poses: NDArray[np.float64]) -> NDArray[np.float64]:
    """(3, 3) inertia of a link and those that hang on it, about their centre of mass, in world axes."""
    dynamics = [body.dynamics(link) for link in subtree]
    masses = np.array([each.mass for each in dynamics])
    arms = poses[:, :3] - (masses @ poses[:, :3]) / max(masses.sum(), 1e-12)
    total = np.zeros((3, 3))
    for mass, each, arm, pose in zip(masses, dynamics, arms, poses, strict=True):
        axes = np.array(rotation_matrix(tuple(pose[3:].tolist()))).reshape(3, 3)
        total += (axes * np.nan_to_num(each.inertia, posinf=0.0)) @ axes.T
        total += mass * ((arm @ arm) * np.eye(3) - np.outer(arm, arm))
    return total


def subtree_of(body: BodyCore, link: int) -> list[int]:
    """A link, and all those that hang on it, directly or by others."""
    subtree = [link]
    for child in range(max(link, BASE) + 1, body.joint_count):
        if body.link_spec(child).parent in subtree:
            subtree.append(child)
    return subtree


def _carry(turn: _Turn) -> None:
    """Turns a body with a free base, or a mocap body, so that the link has its target; others stay."""
    body = turn.body
    if body.fixed_base and not follows_hand(body, turn.link):
        return
    first = body.first_link
    base, held = (body.world.link_pose[row].tolist() for row in (first, first - BASE + turn.link))
    body.set_inertial_pose(*turned_base(base, held, turn.target))


def turned_base(base: list[float], held: list[float], target: Quaternion) -> tuple[Vector3, Quaternion]:
    """Where the base of a body comes (7,), if it is turned as a whole about a link (7,) that has a target."""
    turned = multiplied(target, conjugate((held[3], held[4], held[5], held[6])))
    dx, dy, dz = rotate(turned, (base[0] - held[0], base[1] - held[1], base[2] - held[2]))
    orientation = multiplied(turned, (base[3], base[4], base[5], base[6]))
    return (held[0] + dx, held[1] + dy, held[2] + dz), orientation


def orientation_of(message: dict[str, Any]) -> Quaternion | None:
    """The unit quaternion of a message; None if there is none."""
    x, y, z, w = map(float, message["orientation"])
    length = hypot(x, y, z, w)
    if not (isfinite(length) and length > 1e-6):
        return None
    return (x / length, y / length, z / length, w / length)
