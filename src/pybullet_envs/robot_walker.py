"""Base class of robots that run."""

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
    """A robot that runs to a goal.

    Observation: height relative to the start; sine and cosine of the angle to the goal; velocity of the body
    relative to its heading, times 0.3; roll and pitch; for each joint, the position relative to its limits,
    from -1 to 1, and a tenth of its velocity; for each foot, whether it is on the ground. All clipped to ±5.

    Attributes:
        power: Factor on the `power_coef` of all joints.
        foot_list: Names of the links whose contact with the ground is observed.
        joint_power: `power_coef` of joints for which it is not 100 [N m].
        motors: The joints that an action drives, in order.
        feet: The links in `foot_list`.
        feet_contact: For each foot, 1 if it is on the ground; set by the environment.
        walk_target_x: Position of the goal along x, a kilometre away [m].
        walk_target_y: Position of the goal along y [m].
        walk_target_dist: Horizontal distance from the mean position of all parts to the goal [m].
        walk_target_theta: Direction from there to the goal, as an angle from the x axis [rad].
        body_xyz: Mean x and y of all parts, and height of the body [m].
        body_real_xyz: Position of the body [m].
        body_rpy: Roll, pitch and yaw of the body [rad].
        initial_z: Height of the body at the start [m].
        joint_speeds: A tenth of the joint velocities [rad/s].
        joints_at_limit: Number of joints at a limit.
    """

    foot_list: ClassVar[Any] = ()
    joint_power: ClassVar[Mapping[str, float]] = {}
    motors: list[Joint]

    def __init__(self, fn: str, robot_name: str, action_dim: int, obs_dim: int, power: float) -> None:
        """Sets the file; see `XmlBasedRobot`."""
        super().__init__(fn, robot_name, action_dim, obs_dim)
        self.power = power
        self.walk_target_x, self.walk_target_y = 1e3, 0.0
        self.body_xyz: Any = (0.0, 0.0, 0.0)

    def robot_specific_reset(self, bullet_client: Any) -> None:
        """Randomises the joint angles a little."""
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
        """Applies torques to the joints.

        Raises:
            ValueError: The action does not have one number for each motor, or one is not finite.
        """
        shares, own = checked(a), np.array([joint.power_coef for joint in self.motors])
        if shares.shape != own.shape:
            raise ValueError(f"the action has shape {shares.shape}, not {own.shape}")
        self.set_motor_torques(self.motors, self.power * own * shares)

    def calc_state(self) -> np.ndarray:
        """The present observation."""
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
        """Updates the pose of the body, and distance and direction of the goal."""
        pose = self.robot_body.get_pose()
        self.body_real_xyz = pose[:3]
        self.body_rpy = self._p.getEulerFromQuaternion(pose[3:].tolist())
        x, y, _ = self.middle().tolist()
        self.body_xyz = (x, y, float(self.body_real_xyz[2]))
        dx, dy = self.walk_target_x - x, self.walk_target_y - y
        self.walk_target_theta = atan2(dy, dx)
        self.walk_target_dist = float(np.hypot(dx, dy))

    def calc_potential(self) -> float:
        """Negative distance to the goal [m], divided by the time of a step [s]."""
        return -self.walk_target_dist / self.scene.dt

    def alive_bonus(self, z: float, pitch: float) -> float:
        """The reward for being alive; below 0 the robot has failed.

        Args:
            z: Height of the body [m].
            pitch: Pitch of the body [rad].
        """
        raise NotImplementedError(f"{type(self).__name__} has no alive_bonus")
