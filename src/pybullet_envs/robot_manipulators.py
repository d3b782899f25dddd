"""Arms that reach, push, strike and throw, and what they act on."""

from __future__ import annotations

from math import cos, sin
from typing import Any

import numpy as np

from pybullet_envs.env_bases import checked
from pybullet_envs.robot_bases import MJCFBasedRobot
from pybullet_envs.robot_parts import BodyPart

TURN = 3.14
TORQUE = 0.05
"""Of an action of one [N m]."""


class Reacher(MJCFBasedRobot):
    """Two links in a plane, and a target for their tip.

    Observation: the target (x, y), the way from it to the tip (x, y), cosine, sine and rate of the first
    joint, position and rate of the second.

    Attributes:
        TARG_LIMIT: How far from the middle targets are along each axis [m].
        to_target_vec: The way from the target to the tip [m].
        theta_dot: A tenth of the rate of the first joint [rad/s].
        gamma: Position of the second joint between its limits, from -1 to 1.
        gamma_dot: A tenth of its rate [rad/s].
    """

    TARG_LIMIT = 0.27

    def __init__(self) -> None:
        super().__init__("reacher.xml", "body0", action_dim=2, obs_dim=9)

    def robot_specific_reset(self, bullet_client: Any) -> None:
        """Puts target and links anywhere."""
        self.fingertip, self.target = self.parts["fingertip"], self.parts["target"]
        self.central_joint, self.elbow_joint = self.jdict["joint0"], self.jdict["joint1"]
        for name in ("target_x", "target_y", "joint0", "joint1"):
            reach = TURN if name.startswith("joint") else self.TARG_LIMIT
            self.jdict[name].reset_current_position(self.np_random.uniform(-reach, reach), 0)

    def apply_action(self, a: np.ndarray) -> None:
        """Turns both joints."""
        for joint, share in zip((self.central_joint, self.elbow_joint), checked(a), strict=True):
            joint.set_motor_torque(TORQUE * float(share))

    def calc_state(self) -> np.ndarray:
        """What is observed now."""
        turn, self.theta_dot = self.central_joint.current_relative_position()
        self.gamma, self.gamma_dot = self.elbow_joint.current_relative_position()
        target = [self.jdict[name].get_position() for name in ("target_x", "target_y")]
        self.to_target_vec = self.fingertip.pose().xyz() - self.target.pose().xyz()
        bend = (self.theta_dot, self.gamma, self.gamma_dot)
        return np.array([*target, *self.to_target_vec[:2], cos(turn), sin(turn), *bend], np.float32)

    def calc_potential(self) -> float:
        """100 times how near the tip is."""
        return -100.0 * float(np.linalg.norm(self.to_target_vec))


class SevenJointArm(MJCFBasedRobot):
    """An arm of seven joints with an object and a target for it.

    Observation: of each joint (the arm's, then those that things slide along) position and rate; of each
    joint again the position between its limits, from -1 to 1, and a tenth of its rate; the way from the
    object to the target where they were put; positions of fingertip, object and target.

    Attributes:
        arm: The joints of the arm.
        object_pos: Where the object was put, from the point that both are drawn around [m].
        target_pos: Where the target was put, likewise.
        to_target_vec: From the one to the other.
        zero_offset: The point around which they are drawn, from where they are in the file [m].
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
        """Finds what environments ask for by name."""
        self.fingertip, self.object, self.target = (self.parts[n] for n in ("fingertip", "object", "target"))
        self.arm = [self.jdict[name] for name in self.ARM]

    def _turn_arm(self) -> None:
        for joint in self.arm:
            joint.reset_current_position(self.np_random.uniform(-TURN, TURN), 0)

    def _anywhere(self, axes: int) -> np.ndarray:
        """A point within a square or a cube."""
        return self.np_random.uniform(-1.0, 1.0, size=axes)

    def _around(self, axes: int, nearest: float, farthest: float) -> np.ndarray:
        """A point at a distance from the middle that lies between two."""
        way = self._anywhere(axes)
        return way / np.linalg.norm(way) * self.np_random.uniform(nearest, farthest)

    def _slide(self, thing: str, place: np.ndarray) -> None:
        """Puts a thing on its slides, from the middle."""
        for axis, value in zip("xy", place - self.zero_offset[:2], strict=True):
            self.jdict[f"{thing}_{axis}"].reset_current_position(float(value), 0)

    def _put(self, thing: BodyPart, place: np.ndarray) -> None:
        """Puts the base of a thing somewhere, from the middle."""
        thing.reset_pose(place - self.zero_offset, (0.0, 0.0, 0.0, 1.0))

    def apply_action(self, a: np.ndarray) -> None:
        """Turns the joints."""
        for joint, share in zip(self.arm, checked(a), strict=True):
            joint.set_motor_torque(TORQUE * float(share))

    def calc_state(self) -> np.ndarray:
        """What is observed now."""
        self.to_target_vec = self.target_pos - self.object_pos
        states = [joint.current_position() for joint in self.ordered_joints]
        relative = [joint.current_relative_position() for joint in self.ordered_joints]
        places = [part.pose().xyz() for part in (self.fingertip, self.object, self.target)]
        whole = [np.ravel(states), np.ravel(relative), self.to_target_vec, *places]
        return np.concatenate(whole).astype(np.float32)


class Pusher(SevenJointArm):
    """A fork, a cylinder and a disc, which slide over a table."""

    def __init__(self) -> None:
        super().__init__("pusher.xml", obs_dim=55)

    def robot_specific_reset(self, bullet_client: Any) -> None:
        """Puts all anywhere."""
        super().robot_specific_reset(bullet_client)
        self.target_pos = self._around(2, 0.5, 0.8)
        way = self._anywhere(2)
        apart = float(np.linalg.norm(way - self.target_pos))
        self.object_pos = way / apart * self.np_random.uniform(0.1, 0.4)
        self._slide("target", self.target_pos)
        self._slide("object", self.object_pos)
        self._turn_arm()


class Striker(SevenJointArm):
    """A paddle, a ball that slides over a table, and a goal."""

    def __init__(self) -> None:
        super().__init__("striker.xml", obs_dim=48)

    def robot_specific_reset(self, bullet_client: Any) -> None:
        """Puts all anywhere. The goal is the base of its body, which PyBullet does not find."""
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
    """A claw, a ball and a basket."""

    def __init__(self) -> None:
        super().__init__("thrower.xml", obs_dim=48)

    def robot_specific_reset(self, bullet_client: Any) -> None:
        """Puts all anywhere."""
        super().robot_specific_reset(bullet_client)
        self._turn_arm()
        self.object_pos = self._around(3, 0.1, 0.8)
        self._put(self.object, self.object_pos)
        self.target_pos = self._around(3, 0.1, 0.8)
        self._put(self.target, self.target_pos)
