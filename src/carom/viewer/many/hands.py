"""What users do to bodies of many worlds: they pull and turn them with the mouse, and drive joints."""

from __future__ import annotations

from dataclasses import dataclass
from math import isfinite
from threading import Lock
from typing import TYPE_CHECKING, Any

import numpy as np

from carom.description import Pose
from carom.description.pose import Quaternion, Vector3
from carom.description.transform import compose
from carom.model.body_spec import BASE
from carom.native.uninterrupted import uninterrupted
from carom.scene.joint_constraints import moving_links
from carom.viewer.input.handles import Handles
from carom.viewer.input.picking import FORCE_BY_MASS, MIN_FORCE, follows_hand
from carom.viewer.input.scene_hands import Answer, vector
from carom.viewer.input.turning import orientation_of, subtree_of, turn_between, turned_base, turning_torque
from carom.viewer.many.joints import ManyJoints
from carom.viewer.protocol import from_page
from carom.viewer.protocol.message import Message

if TYPE_CHECKING:
    from carom.checks import Array
    from carom.scene.core.body_core import BodyCore
    from carom.viewer.latest_messages import LatestMessages
    from carom.viewer.many.feed import ManyFeed
    from carom.viewer.many.shown import ShownWorlds
    from carom.viewer.steps.pause_control import PauseControl
    from carom.viewer.steps.step_queue import StepQueue

_NO_TURN = (0.0, 0.0, 0.0, 1.0)
# How fast a body of the pulled mass alone would follow the mouse [rad/s]. The damping is that of the link, so
# that a light link of a heavy robot does not become unstable.
_RATE = 12.0
# How long a frame waits for a step to end [s].
_PATIENCE = 0.02


@dataclass(slots=True)
class _Hand:
    """The pull of one page.

    Attributes:
        world: The world.
        body: The body, in the lone world.
        link: Index of the link; -1 is the base.
        point: The pulled point in the link's inertial frame [m].
        target: Where the mouse is, in that world [m].
        shift: Where that world is drawn [m].
        last: Where the point was before the last step [m]; None before the first one.
        moved: Whether the target has changed since the body was last carried.
    """

    world: int
    body: BodyCore
    link: int
    point: Vector3
    target: Array
    shift: Array
    last: Array | None = None
    moved: bool = False


@dataclass(slots=True)
class _Turn:
    """The turn of one page.

    Attributes:
        world: The world.
        body: The body, in the lone world.
        link: Index of the link; -1 is the base.
        target: Orientation that its inertial frame is to have.
        last: Its orientation before the last step; None before the first one.
        moved: Whether the target has changed since the body was last carried.
    """

    world: int
    body: BodyCore
    link: int
    target: Quaternion
    last: Quaternion | None = None
    moved: bool = True


class ManyHands:
    """Hands of users in many worlds: they pull and turn bodies, drive joints, and move handles.

    Safe to use from all threads. While the simulation is paused, bodies with a free base are moved at once;
    mocap bodies always are.

    Attributes:
        handles: Frames of scripts that users move.
    """

    def __init__(
        self,
        shown: ShownWorlds,
        feed: ManyFeed,
        latest: LatestMessages,
        pause: PauseControl,
        steps: StepQueue,
    ) -> None:
        self.handles: Handles = Handles(latest)
        self._shown = shown
        self._feed = feed
        self._pause = pause
        self._lock = Lock()
        self._joints = ManyJoints(shown, feed, pause, steps)
        self._hands: dict[int, _Hand | _Turn] = {}

    @property
    def busy(self) -> bool:
        """Whether something is pulled or turned."""
        return bool(self._hands)

    def answers(self) -> dict[Message, Answer]:
        """What is done for each message about bodies. Sleep is not theirs: pages say so, and do not ask."""
        return {
            **self._joints.answers(),
            from_page.SLEEP: _ignore,
            from_page.TURN: self._turn,
            from_page.HANDLE: self.handles.take,
            from_page.GRASP: self._grasp,
            from_page.PULL: self._pull,
            from_page.LET_GO: lambda page, message: self.gone(page),
        }

    def gone(self, page: int) -> None:
        """A page has closed: what it holds is let go."""
        with uninterrupted, self._lock:
            self._hands.pop(page, None)

    def apply(self) -> None:
        """Carries what no force moves; if no step ends soon, at the next call."""
        for hand in self._held():
            if not hand.moved or not self._is_carried(hand):
                continue
            if self._shown.worlds.lock.acquire(timeout=_PATIENCE):
                try:
                    self._carry(hand)
                finally:
                    self._shown.worlds.lock.release()

    def push(self) -> None:
        """Applies the forces of the hands in the next step; called between two steps."""
        for hand in self._held():
            if self._is_carried(hand):
                continue
            if isinstance(hand, _Hand):
                self._push(hand)
            else:
                self._twist(hand)

    def _held(self) -> list[_Hand | _Turn]:
        with uninterrupted, self._lock:
            return list(self._hands.values())

    def _grasp(self, page: int, message: dict[str, Any]) -> None:
        number, link = int(message["body"]), int(message["link"])
        found = self._movable(number, link)
        shift = self._feed.offset_of(number).astype(float)
        point, target = vector(message["point"]), np.array(vector(message["target"])) - shift
        if found is not None and all(map(isfinite, (*point, *target.tolist()))):
            with uninterrupted, self._lock:
                self._hands[page] = _Hand(*found, link, point, target, shift)

    def _turn(self, page: int, message: dict[str, Any]) -> None:
        link, target = int(message["link"]), orientation_of(message)
        found = self._movable(int(message["body"]), link)
        if found is None or target is None:
            return
        with uninterrupted, self._lock:
            held = self._hands.get(page)
            if isinstance(held, _Turn) and (held.world, held.body, held.link) == (*found, link):
                held.target, held.moved = target, True
            else:
                self._hands[page] = _Turn(*found, link, target)

    def _movable(self, number: int, link: int) -> tuple[int, BodyCore] | None:
        """World and body of a link on the pages; None if there is no such link, or it cannot move."""
        found = self._feed.body_of(number)
        body = None if found is None else self._shown.lone.bodies.get(found[1])
        if found is None or body is None or not BASE <= link < body.joint_count:
            return None
        if not (moving_links(body)[link - BASE] or follows_hand(body, link)) or body.spec.soft is not None:
            return None
        return found[0], body

    def _pull(self, page: int, message: dict[str, Any]) -> None:
        with uninterrupted, self._lock:
            hand = self._hands.get(page)
            if isinstance(hand, _Hand):
                hand.target = np.array(vector(message["target"])) - hand.shift
                hand.moved = True

    def _is_carried(self, hand: _Hand | _Turn) -> bool:
        free = not hand.body.fixed_base and (hand.link == BASE or isinstance(hand, _Turn))
        return follows_hand(hand.body, hand.link) or (free and self._pause.closed)

    def _poses(self, hand: _Hand | _Turn) -> Array:
        """Poses of the inertial frames of all links of its world (links, 7)."""
        return self._shown.worlds.glimpses.poses(np.array([hand.world]))[0].astype(float)

    def _point(self, hand: _Hand) -> tuple[Array, Array]:
        """Pose of the link (7,), and where the pulled point is (3,) [m]."""
        row = hand.body.first_link + 1 + hand.link
        pose = self._poses(hand)[row]
        x, y, z, *turn = pose.tolist()
        i, j, k, w = turn
        point = compose(Pose((x, y, z), (i, j, k, w)), Pose(hand.point, _NO_TURN)).position
        return pose, np.array(point)

    def _carry(self, hand: _Hand | _Turn) -> None:
        batch = self._shown.worlds[hand.body.id]
        if isinstance(hand, _Turn):
            poses, first = self._poses(hand), hand.body.first_link
            held = poses[first - BASE + hand.link].tolist()
            position, orientation = turned_base(poses[first].tolist(), held, hand.target)
            batch.set_base_inertial_poses(position, orientation, where=[hand.world])
            hand.moved, hand.last = False, None
            return
        pose, point = self._point(hand)
        batch.set_base_inertial_poses(pose[:3] + hand.target - point, pose[3:], where=[hand.world])
        hand.moved, hand.last = False, None

    def _push(self, hand: _Hand) -> None:
        pose, point = self._point(hand)
        worlds, body = self._shown.worlds, hand.body
        mass = sum(body.dynamics(link).mass for link in range(BASE, body.joint_count))
        own = body.dynamics(hand.link).mass
        velocity = np.zeros(3) if hand.last is None else (point - hand.last) / worlds.time_step
        hand.last = point
        force = mass * _RATE**2 * (hand.target - point) - 2.0 * own * _RATE * velocity
        most, size = max(MIN_FORCE, FORCE_BY_MASS * mass), float(np.linalg.norm(force))
        if size > most:
            force *= most / size
        torque = np.cross(point - pose[:3], force)
        worlds.glimpses.push(hand.world, body.first_link + 1 + hand.link, force, torque)

    def _twist(self, hand: _Turn) -> None:
        worlds, body = self._shown.worlds, hand.body
        row = body.first_link - BASE + hand.link
        poses = self._poses(hand)
        x, y, z, w = poses[row, 3:].tolist()
        last, hand.last = hand.last, (x, y, z, w)
        rate = np.zeros(3) if last is None else turn_between(last, hand.last) / worlds.time_step
        torque = turning_torque(body, subtree_of(body, hand.link), hand.target, poses, rate)
        worlds.glimpses.push(hand.world, row, np.zeros(3), torque)


def _ignore(_page: int, _message: dict[str, Any]) -> None:
    pass
