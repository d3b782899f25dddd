"""Arms that reach, push, strike and throw, and the objects that they move."""

from __future__ import annotations

from math import cos, sin
from typing import Any

import numpy as np

from pybullet_envs.env_bases import checked
from pybullet_envs.robot_bases import MJCFBasedRobot
from pybullet_envs.robot_parts import BodyPart

TURN = 3.14
TORQUE = 0.05
"""Torque of a joint for an action of 1 [N m]."""


class Reacher(MJCFBasedRobot):
    """An arm of two links in a plane, and a target for its tip.

    Observation: the target (x, y), the vector from there to the tip (x, y), cosine, sine and velocity of the
    first joint, position and velocity of the second, as relative values of `Joint`.

    Attributes:
        TARG_LIMIT: Largest distance of targets from the origin, along each axis [m].
        to_target_vec: Vector from the target to the tip [m].
        theta_dot: A tenth of the first joint's velocity [rad/s].
        gamma: Position of the second joint relative to its limits, from -1 to 1.
        gamma_dot: A tenth of the second joint's velocity [rad/s].
    """

    TARG_LIMIT = 0.27

    def __init__(self) -> None:
        super().__init__("reacher.xml", "body0", action_dim=2, obs_dim=9)

    def robot_specific_reset(self, bullet_client: Any) -> None:
        """Randomises the positions of target and links."""
        self.fingertip, self.target = self.parts["fingertip"], self.parts["target"]
        self.central_joint, self.elbow_joint = self.jdict["joint0"], self.jdict["joint1"]
        for name in ("target_x", "target_y", "joint0", "joint1"):
            reach = TURN if name.startswith("joint") else self.TARG_LIMIT
            self.jdict[name].reset_current_position(self.np_random.uniform(-reach, reach), 0)

    def apply_action(self, a: np.ndarray) -> None:
        """Applies torques to both joints."""
        for joint, share in zip((self.central_joint, self.elbow_joint), checked(a), strict=True):
            joint.set_motor_torque(TORQUE * float(share))

    def calc_state(self) -> np.ndarray:
        """The present observation."""
        turn, self.theta_dot = self.central_joint.current_relative_position()
        self.gamma, self.gamma_dot = self.elbow_joint.current_relative_position()
        target = [self.jdict[name].get_position() for name in ("target_x", "target_y")]
        self.to_target_vec = self.fingertip.pose().xyz() - self.target.pose().xyz()
        bend = (self.theta_dot, self.gamma, self.gamma_dot)
        return np.array([*target, *self.to_target_vec[:2], cos(turn), sin(turn), *bend], np.float32)

    def calc_potential(self) -> float:
        """-100 times the distance between tip and target [m]."""
        return -100.0 * float(np.linalg.norm(self.to_target_vec))


class SevenJointArm(MJCFBasedRobot):
    """An arm of seven joints with an object and a target for it.

    Observation: position and velocity of each joint (the arm's, then the slides of object and target); again
    for each joint, the position relative to its limits, from -1 to 1, and a tenth of the velocity; the
    initial vector from object to target; positions of fingertip, object and target.

    Attributes:
        arm: The joints of the arm.
        object_pos: Initial position of the object, relative to the point around which it is drawn [m].
        target_pos: Initial position of the target, likewise.
        to_target_vec: Vector from `object_pos` to `target_pos`.
        zero_offset: Subtracted from these positions to get slide positions or world positions [m].
    """

    ARM = (
        *("shoulder_pan_joint", "shoulder_lift_joint", "upper_arm_roll_joint", "elbow_flex_joint"),
        *("forearm_roll_joint", "wrist_flex_joint", "wrist_roll_joint"),
    )
    zero_offset = np.array([0.45, 0.55, 0.0])
    object_pos: np.ndarray
    target_pos: np.ndarray

    def __init__(self, model_xml: str, obs_dim: int) -> None:
        super().__init__(model_xml, "body0", action_dim=len(self.ARM), obs_dim=obs_dim)

    def robot_specific_reset(self, bullet_client: Any) -> None:
        """Finds the parts and joints that environments use, by name."""
        self.fingertip, self.object, self.target = (self.parts[n] for n in ("fingertip", "object", "target"))
        self.arm = [self.jdict[name] for name in self.ARM]

    def _turn_arm(self) -> None:
        for joint in self.arm:
            joint.reset_current_position(self.np_random.uniform(-TURN, TURN), 0)

    def _anywhere(self, axes: int) -> np.ndarray:
        """A random point in a square or a cube, with coordinates from -1 to 1."""
        return self.np_random.uniform(-1.0, 1.0, size=axes)

    def _around(self, axes: int, nearest: float, farthest: float) -> np.ndarray:
        """A random point whose distance from the origin is between two values."""
        way = self._anywhere(axes)
        return way / np.linalg.norm(way) * self.np_random.uniform(nearest, farthest)

    def _slide(self, thing: str, place: np.ndarray) -> None:
        """Moves an object along its slides to a position, before `zero_offset` is subtracted."""
        for axis, value in zip("xy", place - self.zero_offset[:2], strict=True):
            self.jdict[f"{thing}_{axis}"].reset_current_position(float(value), 0)

    def _put(self, thing: BodyPart, place: np.ndarray) -> None:
        """Moves the base of an object to a position, before `zero_offset` is subtracted."""
        thing.reset_pose(place - self.zero_offset, (0.0, 0.0, 0.0, 1.0))

    def apply_action(self, a: np.ndarray) -> None:
        """Applies torques to the joints."""
        for joint, share in zip(self.arm, checked(a), strict=True):
            joint.set_motor_torque(TORQUE * float(share))

    def calc_state(self) -> np.ndarray:
        """The present observation."""
        self.to_target_vec = self.target_pos - self.object_pos
        states = [joint.current_position() for joint in self.ordered_joints]
        relative = [joint.current_relative_position() for joint in self.ordered_joints]
        places = [part.pose().xyz() for part in (self.fingertip, self.object, self.target)]
        whole = [np.ravel(states), np.ravel(relative), self.to_target_vec, *places]
        return np.concatenate(whole).astype(np.float32)


class Pusher(SevenJointArm):
    """An arm with a fork; a cylinder (the object) and a disc (the target) that slide over a table."""

    def __init__(self) -> None:
        super().__init__("pusher.xml", obs_dim=55)

    def robot_specific_reset(self, bullet_client: Any) -> None:
        """Randomises the positions of arm, object and target."""
        super().robot_specific_reset(bullet_client)
        self.target_pos = self._around(2, 0.5, 0.8)
        way = self._anywhere(2)
        apart = float(np.linalg.norm(way - self.target_pos))
        self.object_pos = way / apart * self.np_random.uniform(0.1, 0.4)
        self._slide("target", self.target_pos)
        self._slide("object", self.object_pos)
        self._turn_arm()


class Striker(SevenJointArm):
    """An arm with a paddle, a ball that slides over a table, and a goal."""

    def __init__(self) -> None:
        super().__init__("striker.xml", obs_dim=48)

    def robot_specific_reset(self, bullet_client: Any) -> None:
        """Randomises all positions. The goal is the base of its body, which PyBullet does not find."""
        (goal,) = (body for body in self.objects if bullet_client.getBodyInfo(body)[0] == b"target")
        self.parts["target"] = BodyPart(bullet_client, "target", [goal], 0, -1)
        super().robot_specific_reset(bullet_client)
        self._turn_arm()
        on_table = self._around(2, 0.1, 0.8)
        self.object_pos = np.append(on_table, 0.0)
        self._slide("object", on_table)
        self.target_pos = self._around(3, 0.1, 0.8)
        self._put(self.target, self.target_pos)


class Thrower(SevenJointArm):
    """An arm with a claw, a ball and a basket."""

    def __init__(self) -> None:
        super().__init__("thrower.xml", obs_dim=48)

    def robot_specific_reset(self, bullet_client: Any) -> None:
        """Randomises the positions of arm, object and target."""
        super().robot_specific_reset(bullet_client)
        self._turn_arm()
        self.object_pos = self._around(3, 0.1, 0.8)
        self._put(self.object, self.object_pos)
        self.target_pos = self._around(3, 0.1, 0.8)
        self._put(self.target, self.target_pos)
