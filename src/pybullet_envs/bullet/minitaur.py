"""A Minitaur with exact sensors, without latency."""

from __future__ import annotations

from math import inf, pi
from typing import Any

import numpy as np

import pybullet
from pybullet_envs.bullet.motor import MOTOR_SPEED_LIMIT, OBSERVED_TORQUE_LIMIT, MotorModel
from pybullet_envs.dc_motor import Torques
from pybullet_envs.minitaur_bases import (
    INIT_ORIENTATION,
    INIT_POSITION,
    KNEE_CONSTRAINT_POINT_LEFT,
    KNEE_CONSTRAINT_POINT_RIGHT,
    LEG_POSITION,
    MOTOR_NAMES,
    OVERHEAT_SHUTDOWN_TIME,
    OVERHEAT_SHUTDOWN_TORQUE,
    MinitaurBody,
)

# Links of the robot in `minitaur.urdf`.
BASE_LINK_ID = -1
MOTOR_LINK_ID = [1, 4, 7, 10, 14, 17, 20, 23]
LEG_LINK_ID = [2, 3, 5, 6, 8, 9, 11, 12, 15, 16, 18, 19, 21, 22, 24, 25]
FOOT_LINK_ID = LEG_LINK_ID[1::2]

__all__ = [
    "INIT_ORIENTATION",
    "INIT_POSITION",
    "KNEE_CONSTRAINT_POINT_LEFT",
    "KNEE_CONSTRAINT_POINT_RIGHT",
    "LEG_POSITION",
    "MOTOR_NAMES",
    "OVERHEAT_SHUTDOWN_TIME",
    "OVERHEAT_SHUTDOWN_TORQUE",
    "Minitaur",
]


class Minitaur(MinitaurBody):
    """A Minitaur in an existing world; see `MinitaurBody`."""

    def __init__(
        self,
        pybullet_client: Any,
        urdf_root: str | None = None,
        time_step: float = 0.01,
        self_collision_enabled: bool = False,
        motor_velocity_limit: float = inf,
        pd_control_enabled: bool = False,
        accurate_motor_model_enabled: bool = False,
        motor_kp: float = 1.0,
        motor_kd: float = 0.02,
        torque_control_enabled: bool = False,
        motor_overheat_protection: bool = False,
        on_rack: bool = False,
        kd_for_pd_controllers: float = 0.3,
    ) -> None:
        """Loads the robot.

        Args:
            pybullet_client: The world.
            urdf_root: Folder of the files; by default that of `pybullet_data`.
            time_step: Time step of the simulation [s].
            self_collision_enabled: Whether the links collide with each other.
            motor_velocity_limit: Velocity limit [rad/s]: commands are clipped to the range of one time step.
            pd_control_enabled: Whether torques of a PD controller drive the motors.
            accurate_motor_model_enabled: Whether torques of a motor model drive the motors.
            motor_kp: Position gain of the motor model.
            motor_kd: Velocity gain of the motor model.
            torque_control_enabled: Whether commands are duty cycles for the motor model.
            motor_overheat_protection: Whether the motor model shuts a motor off after 1 s of high torque.
            on_rack: Whether the base is fixed in the air.
            kd_for_pd_controllers: Velocity gain of the PD controller.
        """
        model = (
            MotorModel(torque_control_enabled, motor_kp, motor_kd) if accurate_motor_model_enabled else None
        )
        super().__init__(
            pybullet_client,
            urdf_root,
            time_step,
            self_collides=self_collision_enabled,
            velocity_limit=motor_velocity_limit,
            motor_model=model,
            pd_gain=kd_for_pd_controllers if pd_control_enabled else None,
            overheats=motor_overheat_protection,
            on_rack=on_rack,
        )
        self.Reset()

    def Reset(self, reload_urdf: bool = True) -> None:
        """Resets the robot to its start.

        Args:
            reload_urdf: Whether to load it again; otherwise, it is moved to the start.
        """
        if reload_urdf:
            self._load(INIT_POSITION)
            if self._on_rack:
                self._pybullet_client.createConstraint(
                    self.quadruped, -1, -1, -1, pybullet.JOINT_FIXED, [0, 0, 0], [0, 0, 0], [0, 0, 1]
                )
            self._base_mass_urdf = self._mass(-1)
            self._leg_masses_urdf = [self._mass(self._leg_link_ids[0]), self._mass(self._motor_link_ids[0])]
        else:
            self._put_back(INIT_POSITION)
        self._cool_motors()

    def ApplyAction(self, motor_commands: Any) -> None:
        """Sets the motors for the next step of the simulation.

        Args:
            motor_commands: Angles [rad] for the motors, or duty cycles with torque control, shape (8,).
        """
        self._drive(motor_commands)

    def _torques_for(self, commands: np.ndarray, kp: Any, kd: Any) -> Torques:
        angles, velocities, _ = self._motor_states()
        if self._motor_model is not None:
            return self._motor_model.convert_to_torque(commands, angles, velocities)
        torques = kp * (commands - angles) - kd * velocities
        return torques, torques

    def GetBaseOrientation(self) -> tuple[float, float, float, float]:
        """Orientation of the base (x, y, z, w)."""
        return self._orientation()

    def GetMotorAngles(self) -> np.ndarray:
        """Angles of the motors [rad], (8,)."""
        return self._motor_states()[0]

    def GetMotorVelocities(self) -> np.ndarray:
        """Velocities of the motors [rad/s], (8,)."""
        return self._motor_states()[1]

    def GetMotorTorques(self) -> np.ndarray:
        """Torques of the motors [N m], (8,): commanded torques, or those of the engine's motors."""
        return self._motor_states()[2]

    def GetObservation(self) -> list[float]:
        """Angles, velocities and torques of the motors, and the orientation of the base: 28 numbers."""
        return [*np.concatenate(self._motor_states()).tolist(), *self._orientation()]

    def GetObservationDimension(self) -> int:
        """Size of the result of `GetObservation`."""
        return len(self.GetObservation())

    def GetObservationUpperBound(self) -> np.ndarray:
        """Upper bounds of `GetObservation`, (28,)."""
        return observation_bound()

    def GetObservationLowerBound(self) -> np.ndarray:
        """Lower bounds of `GetObservation`, (28,)."""
        return -observation_bound()

    def GetBaseMassFromURDF(self) -> float:
        """Mass of the base in the file [kg]."""
        return self._base_mass_urdf

    def GetLegMassesFromURDF(self) -> list[float]:
        """Masses of a leg link and of a motor link in the file [kg]."""
        return self._leg_masses_urdf

    def SetBaseMass(self, base_mass: float) -> None:
        """Sets the mass of the base [kg]."""
        self._set_dynamics([-1], [base_mass], "mass")

    def SetLegMasses(self, leg_masses: Any) -> None:
        """Sets the mass of each leg link and the mass of each motor link [kg]."""
        of_links, of_motors = leg_masses
        self._set_dynamics(self._leg_link_ids, [of_links] * len(self._leg_link_ids), "mass")
        self._set_dynamics(self._motor_link_ids, [of_motors] * len(self._motor_link_ids), "mass")


def observation_bound() -> np.ndarray:
    """Upper bounds of motor angles, velocities and torques, and of the orientation, (28,)."""
    return np.repeat((pi, MOTOR_SPEED_LIMIT, OBSERVED_TORQUE_LIMIT, 1.0), (8, 8, 8, 4))
