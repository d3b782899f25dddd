"""Base class of Minitaurs, quadrupeds with direct drive: each leg is a loop driven by two motors."""

from __future__ import annotations

import os
from abc import ABC, abstractmethod
from collections.abc import Sequence
from math import inf, pi
from typing import Any

import numpy as np

import pybullet
import pybullet_data
from pybullet_envs.dc_motor import Torques

INIT_POSITION = (0.0, 0.0, 0.2)
INIT_ORIENTATION = (0.0, 0.0, 0.0, 1.0)
KNEE_CONSTRAINT_POINT_RIGHT = (0.0, 0.005, 0.2)
KNEE_CONSTRAINT_POINT_LEFT = (0.0, 0.01, 0.2)
OVERHEAT_SHUTDOWN_TORQUE = 2.45
OVERHEAT_SHUTDOWN_TIME = 1.0
LEG_POSITION = ("front_left", "back_left", "front_right", "back_right")
MOTOR_NAMES = tuple(f"motor_{leg}{side}_joint" for leg in LEG_POSITION for side in "LR")

# Signs of the motors: on the left, reported angles are opposite to joint angles.
_DIRECTIONS = np.array((-1.0, -1.0, -1.0, -1.0, 1.0, 1.0, 1.0, 1.0))
_HIP_ANGLE, _KNEE_ANGLE = pi / 2, -2.1834
_MAX_TORQUE = 3.5
_PD_KP = 8.0

_QUARTER = pi / 4
# Signs for swings: the two motors of a leg get opposite commands.
_SWING = np.array((1.0, -1.0, 1.0, -1.0, -1.0, 1.0, -1.0, 1.0))
_UNSTRETCHED = 1.5

Point = tuple[float, float, float]


class MinitaurBody(ABC):
    """A Minitaur in an existing world.

    Its motors are driven in one of three ways: by the engine's position control, by torques of a PD
    controller, or by torques of a motor model.

    Attributes:
        quadruped: Id of the body.
        num_motors: Number of motors.
        num_legs: Number of legs.
        time_step: Time step of the simulation [s].
    """

    num_motors = 8
    num_legs = 4
    _file = "quadruped/minitaur.urdf"
    _knee_joint = "knee_{}{}_link"
    _self_collision = pybullet.URDF_USE_SELF_COLLISION

    def __init__(
        self,
        pybullet_client: Any,
        urdf_root: str | None,
        time_step: float,
        *,
        self_collides: bool,
        velocity_limit: float,
        motor_model: Any,
        pd_gain: float | None,
        overheats: bool,
        on_rack: bool,
    ) -> None:
        """Stores the settings; subclasses load the robot.

        Args:
            pybullet_client: The world.
            urdf_root: Folder of the robot's files; by default that of `pybullet_data`.
            time_step: Time step of the simulation [s].
            self_collides: Whether the links collide with each other.
            velocity_limit: Velocity limit [rad/s]: commands are clipped to the range of one time step.
            motor_model: Model of the motors, or None.
            pd_gain: Velocity gain of the PD controller without a motor model; None for position control.
            overheats: Whether a motor is shut off after a high torque for one second.
            on_rack: Whether the base is fixed in the air.
        """
        self._pybullet_client = pybullet_client
        self._urdf_root = pybullet_data.getDataPath() if urdf_root is None else urdf_root
        self.time_step = time_step
        self.quadruped = -1
        self._self_collides = self_collides
        self._motor_velocity_limit = velocity_limit
        self._motor_model = motor_model
        self._overheats = overheats
        self._on_rack = on_rack
        self._by_torques = motor_model is not None or pd_gain is not None
        self._kp, self._kd = (1.0, 1.0) if pd_gain is None else (_PD_KP, pd_gain)
        self._observed_motor_torques = np.zeros(self.num_motors)
        self._cool_motors()

    def _load(self, position: Sequence[float], fixed: bool = False) -> None:
        """Loads the robot in its standing pose, and closes the loops of its legs."""
        self.quadruped = self._pybullet_client.loadURDF(
            os.path.join(self._urdf_root, self._file),
            position,
            useFixedBase=fixed,
            flags=self._self_collision if self._self_collides else 0,
        )
        self._find_links()
        self.ResetPose(add_constraint=True)

    def _find_links(self) -> None:
        count = self._pybullet_client.getNumJoints(self.quadruped)
        names = [
            self._pybullet_client.getJointInfo(self.quadruped, joint)[1].decode() for joint in range(count)
        ]
        self._joints = {name: joint for joint, name in enumerate(names)}
        self._motor_id_list = [self._joints[name] for name in MOTOR_NAMES]
        self._chassis_link_ids = [-1]
        self._leg_link_ids: list[int] = []
        self._motor_link_ids: list[int] = []
        self._foot_link_ids: list[int] = []
        for joint, name in enumerate(names):
            if name.startswith("chassis"):
                self._chassis_link_ids.append(joint)
            elif name in MOTOR_NAMES:
                self._motor_link_ids.append(joint)
            else:
                self._leg_link_ids.append(joint)
                if name.startswith("knee"):
                    self._foot_link_ids.append(joint)

    @abstractmethod
    def Reset(self, reload_urdf: bool = True) -> None:
        """Resets the robot to its start: loads it again, or moves it there."""

    def _put_back(self, position: Sequence[float]) -> None:
        """Moves the robot to its standing pose at a base position [m], at rest."""
        self._pybullet_client.resetBasePositionAndOrientation(self.quadruped, position, INIT_ORIENTATION)
        self._pybullet_client.resetBaseVelocity(self.quadruped, [0, 0, 0], [0, 0, 0])
        self.ResetPose(add_constraint=False)

    def _cool_motors(self) -> None:
        self._strained_steps = np.zeros(self.num_motors)
        self._running = np.ones(self.num_motors, bool)

    def ResetPose(self, add_constraint: bool) -> None:
        """Moves all legs to the standing pose.

        Args:
            add_constraint: Whether to add the constraints that close the loops of the legs, as needed once.
        """
        for leg in range(self.num_legs):
            self._reset_leg(leg, add_constraint)

    def _reset_leg(self, leg: int, add_constraint: bool) -> None:
        bullet, place = self._pybullet_client, LEG_POSITION[leg]
        motors = self._motor_id_list[2 * leg : 2 * leg + 2]
        left, right = (self._joints[self._knee_joint.format(place, side)] for side in "LR")
        direction = _DIRECTIONS[2 * leg]
        for hip, knee in zip(motors, (left, right), strict=True):
            bullet.resetJointState(self.quadruped, hip, direction * _HIP_ANGLE, 0)
            bullet.resetJointState(self.quadruped, knee, direction * _KNEE_ANGLE, 0)
        if add_constraint:
            of_right, of_left = self._knee_points(leg)
            bullet.createConstraint(
                *(self.quadruped, right, self.quadruped, left),
                *(pybullet.JOINT_POINT2POINT, [0, 0, 0], of_right, of_left),
            )
        if not self._by_torques:
            self._hold(motors, [direction * _HIP_ANGLE] * 2)
        for joint in (left, right, *(motors if self._by_torques else ())):
            bullet.setJointMotorControl2(
                self.quadruped, joint, pybullet.VELOCITY_CONTROL, targetVelocity=0, force=0
            )

    def _knee_points(self, leg: int) -> tuple[Point, Point]:
        """The joint of the two lower links of a leg, in the frame of the right and of the left one [m]."""
        return KNEE_CONSTRAINT_POINT_RIGHT, KNEE_CONSTRAINT_POINT_LEFT

    def GetBasePosition(self) -> tuple[float, float, float]:
        """Position of the base [m]."""
        return self._pybullet_client.getBasePositionAndOrientation(self.quadruped)[0]

    def _orientation(self) -> tuple[float, float, float, float]:
        return self._pybullet_client.getBasePositionAndOrientation(self.quadruped)[1]

    def _motor_states(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Present angles [rad], velocities [rad/s] and torques [N m] of the motors.

        If the motors are driven by torques, the torques are the sensors' values for the latest command.
        """
        states = self._pybullet_client.getJointStates(self.quadruped, self._motor_id_list)
        angles, velocities, torques = (
            _DIRECTIONS * [state[number] for state in states] for number in (0, 1, 3)
        )
        return angles, velocities, self._observed_motor_torques if self._by_torques else torques

    @abstractmethod
    def GetBaseOrientation(self) -> tuple[float, float, float, float]:
        """Observed orientation of the base (x, y, z, w)."""

    @abstractmethod
    def GetMotorAngles(self) -> np.ndarray:
        """Observed angles of the motors [rad], (8,)."""

    @abstractmethod
    def GetMotorVelocities(self) -> np.ndarray:
        """Observed velocities of the motors [rad/s], (8,)."""

    @abstractmethod
    def GetMotorTorques(self) -> np.ndarray:
        """Observed torques of the motors [N m], (8,)."""

    def GetActionDimension(self) -> int:
        """Number of commands that `ApplyAction` takes."""
        return self.num_motors

    def _drive(self, motor_commands: Any, kp: Any = None, kd: Any = None) -> None:
        """Sets the motors for the next step of the simulation.

        Args:
            motor_commands: Angles [rad] for the motors, or duty cycles with torque control, shape (8,).
            kp: Position gains, (8,); by default the robot's. Only for motors driven by torques.
            kd: Velocity gains, likewise.
        """
        commands = np.asarray(motor_commands, float)
        if self._motor_velocity_limit < inf:
            reach = self.time_step * self._motor_velocity_limit
            angles = self._motor_states()[0]
            commands = np.clip(commands, angles - reach, angles + reach)
        if not self._by_torques:
            self._hold(self._motor_id_list, commands * _DIRECTIONS)
            return
        gains = (self._kp if kp is None else kp, self._kd if kd is None else kd)
        acting, self._observed_motor_torques = self._torques_for(commands, *gains)
        if self._motor_model is not None and self._overheats:
            strained = np.abs(acting) > OVERHEAT_SHUTDOWN_TORQUE
            self._strained_steps = np.where(strained, self._strained_steps + 1, 0)
            self._running &= self._strained_steps <= OVERHEAT_SHUTDOWN_TIME / self.time_step
            acting = np.where(self._running, acting, 0.0)
        self._pybullet_client.setJointMotorControlArray(
            self.quadruped,
            self._motor_id_list,
            pybullet.TORQUE_CONTROL,
            forces=(acting * _DIRECTIONS).tolist(),
        )

    @abstractmethod
    def _torques_for(self, commands: np.ndarray, kp: Any, kd: Any) -> Torques:
        """Torques [N m] to apply, and those that the sensors report."""

    def _hold(self, joints: Sequence[int], targets: Any) -> None:
        count = len(joints)
        self._pybullet_client.setJointMotorControlArray(
            self.quadruped,
            joints,
            pybullet.POSITION_CONTROL,
            targetPositions=[float(target) for target in targets],
            forces=[_MAX_TORQUE] * count,
            positionGains=[self._kp] * count,
            velocityGains=[self._kd] * count,
        )

    def ConvertFromLegModel(self, actions: Any) -> np.ndarray:
        """Motor angles for a swing and an extension of each leg.

        Args:
            actions: Swing of each leg, then extension of each leg; 1 is an eighth of a turn.

        Returns:
            Angles for `ApplyAction` [rad], (8,).
        """
        swing, stretch = np.reshape(np.asarray(actions, float), (2, self.num_legs)).repeat(2, axis=1)
        return pi + _QUARTER * (_SWING * swing - stretch - _UNSTRETCHED)

    def _mass(self, link: int) -> float:
        return self._pybullet_client.getDynamicsInfo(self.quadruped, link)[0]

    def _set_dynamics(self, links: Sequence[int], values: Any, what: str) -> None:
        """Sets one dynamics parameter of several links, to a value for each link."""
        for link, value in zip(links, values, strict=True):
            self._pybullet_client.changeDynamics(self.quadruped, link, **{what: value})

    def SetFootFriction(self, foot_friction: float) -> None:
        """Sets the lateral friction of all feet."""
        count = len(self._foot_link_ids)
        self._set_dynamics(self._foot_link_ids, [foot_friction] * count, "lateralFriction")

    def SetBatteryVoltage(self, voltage: float) -> None:
        """Sets the voltage of the battery [V], if there is a motor model."""
        if self._motor_model is not None:
            self._motor_model.set_voltage(voltage)

    def SetMotorViscousDamping(self, viscous_damping: float) -> None:
        """Sets the viscous damping of the motors [V s/rad], if there is a motor model."""
        if self._motor_model is not None:
            self._motor_model.set_viscous_damping(viscous_damping)
