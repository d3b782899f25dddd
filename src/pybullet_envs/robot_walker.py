"""What robots that run have in common."""

from __future__ import annotations

from collections.abc import Mapping
from math import atan2, cos, sin
from typing import Any, ClassVar

import numpy as np

from pybullet_envs.env_bases import checked
from pybullet_envs.robot_bases import MJCFBasedRobot
from pybullet_envs.robot_parts import Joint

LARGEST_START = 0.1
NEAR_LIMIT = 0.99
LARGEST_OBSERVED = 5.0


class WalkerBase(MJCFBasedRobot):
    """A robot that is to run to a goal.

    Observation: height above that at the start; sine and cosine of the angle to the goal; velocity of the
    body in its own heading, times 0.3; roll and pitch; of each joint the position between its limits, from -1
    to 1, and a tenth of its rate; of each foot whether it is on the ground. All within ±5.

    Attributes:
        power: Share of the joints' own power that an action of one has.
        foot_list: The links whose contact with the ground is observed.
        joint_power: Torque of joints [N m] that have not 100.
        motors: The joints that the numbers of an action drive, in order.
        feet: The feet.
        feet_contact: Of each foot 1 where it is on the ground; the environment writes it.
        walk_target_x: The goal: a kilometre away [m].
        walk_target_y: The goal [m].
        walk_target_dist: How far it is from the middle of all parts [m].
        walk_target_theta: Its direction [rad].
        body_xyz: Middle of all parts, but the height of the body [m].
        body_real_xyz: Where the body is [m].
        body_rpy: Roll, pitch and yaw of the body [rad].
        initial_z: Height of the body at the start [m].
        joint_speeds: A tenth of the rates of the joints [rad/s].
        joints_at_limit: How many joints are at a limit.
    """

    foot_list: ClassVar[Any] = ()
    joint_power: ClassVar[Mapping[str, float]] = {}
    motors: list[Joint]

    def __init__(self, fn: str, robot_name: str, action_dim: int, obs_dim: int, power: float) -> None:
        """Names the file; see `XmlBasedRobot`."""
        super().__init__(fn, robot_name, action_dim, obs_dim)
        self.power = power
        self.walk_target_x, self.walk_target_y = 1e3, 0.0
        self.body_xyz: Any = (0.0, 0.0, 0.0)

    def robot_specific_reset(self, bullet_client: Any) -> None:
        """Turns the joints a little."""
        for joint in self.ordered_joints:
            joint.reset_current_position(self.np_random.uniform(-LARGEST_START, LARGEST_START), 0)
        for name, torque in self.joint_power.items():
            self.jdict[name].power_coef = torque
        self.motors = self.ordered_joints
        self.feet = [self.parts[name] for name in self.foot_list]
        self.feet_contact = np.zeros(len(self.feet), np.float32)
        self.scene.actor_introduce(self)
        self.initial_z: Any = None

    def apply_action(self, a: np.ndarray) -> None:
        """Drives the joints.

        Raises:
            ValueError: The action has not one number for each motor, or one is not finite.
        """
        shares, own = checked(a), np.array([joint.power_coef for joint in self.motors])
        if shares.shape != own.shape:
            raise ValueError(f"the action has the shape {shares.shape}, where {own.shape} is asked for")
        self.set_motor_torques(self.motors, self.power * own * shares)

    def calc_state(self) -> np.ndarray:
        """What is observed now."""
        joints = self.relative_joint_states().astype(np.float32)
        self.joint_speeds = joints[:, 1]
        self.joints_at_limit = int(np.count_nonzero(np.abs(joints[:, 0]) > NEAR_LIMIT))
        self._find_body()
        if self.initial_z is None:
            self.initial_z = self.body_xyz[2]
        roll, pitch, yaw = self.body_rpy
        aside = self.walk_target_theta - yaw
        vx, vy, vz = self.robot_body.speed()
        ahead, across = cos(yaw) * vx + sin(yaw) * vy, cos(yaw) * vy - sin(yaw) * vx
        height = self.body_xyz[2] - self.initial_z
        body = [height, sin(aside), cos(aside), 0.3 * ahead, 0.3 * across, 0.3 * vz, roll, pitch]
        whole = np.concatenate([body, joints.ravel(), self.feet_contact])
        return np.clip(whole, -LARGEST_OBSERVED, LARGEST_OBSERVED).astype(np.float32)

    def _find_body(self) -> None:
        """Where the body is, and the goal from there."""
        pose = self.robot_body.get_pose()
        self.body_real_xyz = pose[:3]
        self.body_rpy = self._p.getEulerFromQuaternion(pose[3:].tolist())
        x, y, _ = self.middle().tolist()
        self.body_xyz = (x, y, float(self.body_real_xyz[2]))
        dx, dy = self.walk_target_x - x, self.walk_target_y - y
        self.walk_target_theta = atan2(dy, dx)
        self.walk_target_dist = float(np.hypot(dx, dy))

    def calc_potential(self) -> float:
        """How near the goal is [m], by the time of a step [s]."""
        return -self.walk_target_dist / self.scene.dt

    def alive_bonus(self, z: float, pitch: float) -> float:
        """The reward of being alive; below 0 the robot has failed.

        Args:
            z: Height of the body [m].
            pitch: Its pitch [rad].
        """
        raise NotImplementedError(f"{type(self).__name__} has no alive_bonus")
