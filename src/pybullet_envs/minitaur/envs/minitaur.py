"""A Minitaur with sensor latency and noise, as on the real robot."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Sequence
from math import inf, pi
from typing import Any

import numpy as np

from pybullet_envs.dc_motor import Torques
from pybullet_envs.minitaur.envs.minitaur_dynamics import MinitaurDynamics
from pybullet_envs.minitaur.envs.motor import MotorModel
from pybullet_envs.minitaur_bases import (
    INIT_ORIENTATION,
    INIT_POSITION,
    KNEE_CONSTRAINT_POINT_LEFT,
    KNEE_CONSTRAINT_POINT_RIGHT,
    LEG_POSITION,
    MOTOR_NAMES,
    OVERHEAT_SHUTDOWN_TIME,
    OVERHEAT_SHUTDOWN_TORQUE,
)

__all__ = [
    "INIT_ORIENTATION",
    "INIT_POSITION",
    "INIT_RACK_POSITION",
    "KNEE_CONSTRAINT_POINT_LEFT",
    "KNEE_CONSTRAINT_POINT_RIGHT",
    "LEG_POSITION",
    "MOTOR_NAMES",
    "OVERHEAT_SHUTDOWN_TIME",
    "OVERHEAT_SHUTDOWN_TORQUE",
    "SENSOR_NOISE_STDDEV",
    "TWO_PI",
    "MapToMinusPiToPi",
    "Minitaur",
]

TWO_PI = 2.0 * pi
INIT_RACK_POSITION = (0.0, 0.0, 1.0)
SENSOR_NOISE_STDDEV = (0.0, 0.0, 0.0, 0.0, 0.0)
_PD_KD = 0.3
_REMEMBERED_STEPS = 100
_STANDING_STEPS = 100

# Slices of the recorded sensor readings of a step.
_ANGLES, _VELOCITIES, _TORQUES = slice(0, 8), slice(8, 16), slice(16, 24)
_ORIENTATION, _TURNING = slice(24, 28), slice(28, 31)


def MapToMinusPiToPi(angles: Any) -> np.ndarray:
    """Angles wrapped to the interval from -π to π [rad]."""
    within_a_turn = np.fmod(angles, 2 * pi)
    too_far = np.where(within_a_turn >= pi, 1.0, np.where(within_a_turn < -pi, -1.0, 0.0))
    return within_a_turn - 2 * pi * too_far


class Minitaur(MinitaurDynamics):
    """A Minitaur in an existing world; see `MinitaurBody`.

    Observed sensor readings are `control_latency` old, with noise; the motors' controllers use readings that
    are `pd_latency` old. Methods with `True` in their names return present values without noise.

    Attributes:
        np_random: Random number generator of the noise.
    """

    def __init__(
        self,
        pybullet_client: Any,
        urdf_root: str | None = None,
        time_step: float = 0.01,
        action_repeat: int = 1,
        self_collision_enabled: bool = False,
        motor_velocity_limit: float = inf,
        pd_control_enabled: bool = False,
        accurate_motor_model_enabled: bool = False,
        remove_default_joint_damping: bool = False,
        motor_kp: float = 1.0,
        motor_kd: float = 0.02,
        pd_latency: float = 0.0,
        control_latency: float = 0.0,
        observation_noise_stdev: Sequence[float] = SENSOR_NOISE_STDDEV,
        torque_control_enabled: bool = False,
        motor_overheat_protection: bool = False,
        on_rack: bool = False,
    ) -> None:
        """Loads the robot.

        Args:
            pybullet_client: The world.
            urdf_root: Folder of the files; by default that of `pybullet_data`.
            time_step: Time step of the simulation [s].
            action_repeat: Number of simulation steps of `Step`.
            self_collision_enabled: Whether the links collide with each other.
            motor_velocity_limit: Velocity limit [rad/s]: commands are clipped to the range of one time step.
            pd_control_enabled: Whether torques of a PD controller drive the motors.
            accurate_motor_model_enabled: Whether torques of a motor model drive the motors.
            remove_default_joint_damping: Whether linear and angular damping of the robot are 0.
            motor_kp: Position gain of the motor model.
            motor_kd: Velocity gain of the motor model.
            pd_latency: Age of the readings that the motors' controllers use [s].
            control_latency: Age of the observed sensor readings [s].
            observation_noise_stdev: Standard deviations of the noise of motor angles, velocities and
                torques, and of angles and angular velocities of the base.
            torque_control_enabled: Whether commands are duty cycles for the motor model.
            motor_overheat_protection: Whether the motor model shuts a motor off after 1 s of high torque.
            on_rack: Whether the base is fixed in the air.
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
            pd_gain=_PD_KD if pd_control_enabled else None,
            overheats=motor_overheat_protection,
            on_rack=on_rack,
        )
        if model is not None:
            self._kp, self._kd = motor_kp, motor_kd
        self.np_random: Any = np.random.default_rng()
        self._action_repeat = action_repeat
        self._undamped = remove_default_joint_damping
        self._pd_latency = pd_latency
        self._control_latency = control_latency
        self._observation_noise_stdev = observation_noise_stdev
        self._torque_control_enabled = torque_control_enabled
        self._observation_history: deque[np.ndarray] = deque(maxlen=_REMEMBERED_STEPS)
        self._step_counter = 0
        self.Reset(reset_time=-1.0)

    def Reset(
        self, reload_urdf: bool = True, default_motor_angles: Any = None, reset_time: float = 3.0
    ) -> None:
        """Resets the robot to its start, and lets it settle on its legs.

        Args:
            reload_urdf: Whether to load it again; otherwise, it is moved to the start.
            default_motor_angles: Motor angles to hold, after 100 steps at a quarter turn [rad], (8,).
            reset_time: Time for which they are held [s]. If it is not positive, or with torque control, the
                robot does not settle at all.
        """
        position = INIT_RACK_POSITION if self._on_rack else INIT_POSITION
        if reload_urdf:
            self._load(position, fixed=self._on_rack)
            if self._undamped:
                self._pybullet_client.changeDynamics(self.quadruped, -1, linearDamping=0, angularDamping=0)
            self._record_dynamics()
        else:
            self._put_back(position)
        self._cool_motors()
        self._step_counter = 0
        self._observation_history.clear()
        self.ReceiveObservation()
        if not self._torque_control_enabled and reset_time > 0.0:
            self._advance(np.full(self.num_motors, pi / 2), _STANDING_STEPS)
            if default_motor_angles is not None:
                self._advance(default_motor_angles, int(reset_time / self.time_step))
        # As in PyBullet the last reading is recorded twice; delayed readings of the first steps depend on it.
        self.ReceiveObservation()

    def Step(self, action: Any, before_each: Callable[[int], None] | None = None) -> None:
        """Applies commands for one environment step, that is for `action_repeat` simulation steps.

        Args:
            action: Commands, see `ApplyAction`.
            before_each: Called before each simulation step, with its index.
        """
        self._advance(action, self._action_repeat, before_each)
        self._step_counter += self._action_repeat

    def _advance(self, commands: Any, steps: int, before_each: Callable[[int], None] | None = None) -> None:
        for number in range(steps):
            self.ApplyAction(commands)
            if before_each is not None:
                before_each(number)
            self._pybullet_client.stepSimulation()
            self.ReceiveObservation()

    def Terminate(self) -> None:
        """Called at the end of an episode; does nothing (a real robot would be shut down)."""

    def GetTimeSinceReset(self) -> float:
        """Simulated time of all calls of `Step` since the reset [s]."""
        return self._step_counter * self.time_step

    def SetTimeSteps(self, action_repeat: int, simulation_step: float) -> None:
        """Sets the number of simulation steps of `Step`, and the time step of the simulation [s]."""
        self.time_step = simulation_step
        self._action_repeat = action_repeat

    def ApplyAction(self, motor_commands: Any, motor_kps: Any = None, motor_kds: Any = None) -> None:
        """Sets the motors for the next step of the simulation.

        Args:
            motor_commands: Angles [rad] for the motors, or duty cycles with torque control, shape (8,).
            motor_kps: Position gains, (8,); by default the robot's. Only for motors driven by torques.
            motor_kds: Velocity gains, (8,), likewise.
        """
        self._drive(motor_commands, motor_kps, motor_kds)

    def _torques_for(self, commands: np.ndarray, kp: Any, kd: Any) -> Torques:
        seen = self._delayed(self._pd_latency)
        angles, velocities = seen[_ANGLES], seen[_VELOCITIES]
        if self._motor_model is not None:
            now = self.GetTrueMotorVelocities()
            return self._motor_model.convert_to_torque(commands, angles, velocities, now, kp, kd)
        torques = kp * (commands - angles) - kd * velocities
        return torques, torques

    def IsObservationValid(self) -> bool:
        """Whether the sensor readings are valid; in a simulation they always are."""
        return True

    def ReceiveObservation(self) -> None:
        """Reads the sensors; observed readings stay the same until the next call."""
        self._observation_history.appendleft(self.GetTrueObservation())

    def _delayed(self, latency: float) -> np.ndarray:
        """Sensor readings that are `latency` old, interpolated between two recorded ones."""
        history = self._observation_history
        ago = max(0.0, latency / self.time_step)
        before = int(ago)
        if before + 1 >= len(history):
            return history[-1]
        share = ago - before
        return (1.0 - share) * history[before] + share * history[before + 1]

    def _sensed(self, part: slice) -> np.ndarray:
        return self._delayed(self._control_latency)[part]

    def _noisy(self, values: np.ndarray, sensor: int) -> np.ndarray:
        deviation = self._observation_noise_stdev[sensor]
        return values + self.np_random.normal(scale=deviation, size=values.shape) if deviation > 0 else values

    def GetTrueObservation(self) -> np.ndarray:
        """Present values of all sensors.

        Returns:
            Angles [rad], velocities [rad/s] and torques [N m] of the motors, orientation and angular velocity
            [rad/s] of the base: (31,).
        """
        _, turning = self._pybullet_client.getBaseVelocity(self.quadruped)
        return np.concatenate((*self._motor_states(), self._orientation(), turning))

    def GetTrueMotorAngles(self) -> np.ndarray:
        """Present angles of the motors [rad], (8,)."""
        return self._motor_states()[0]

    def GetMotorAngles(self) -> np.ndarray:
        """Observed angles of the motors, between -π and π [rad], (8,)."""
        return MapToMinusPiToPi(self._noisy(self._sensed(_ANGLES), 0))

    def GetTrueMotorVelocities(self) -> np.ndarray:
        """Present velocities of the motors [rad/s], (8,)."""
        return self._motor_states()[1]

    def GetMotorVelocities(self) -> np.ndarray:
        """Observed velocities of the motors [rad/s], (8,)."""
        return self._noisy(self._sensed(_VELOCITIES), 1)

    def GetTrueMotorTorques(self) -> np.ndarray:
        """Present torques of the motors [N m], (8,)."""
        return self._motor_states()[2]

    def GetMotorTorques(self) -> np.ndarray:
        """Observed torques of the motors [N m], (8,)."""
        return self._noisy(self._sensed(_TORQUES), 2)

    def GetTrueBaseOrientation(self) -> tuple[float, float, float, float]:
        """Present orientation of the base (x, y, z, w)."""
        return self._orientation()

    def GetBaseOrientation(self) -> tuple[float, float, float, float]:
        """Observed orientation of the base (x, y, z, w)."""
        return self._pybullet_client.getQuaternionFromEuler(self.GetBaseRollPitchYaw())

    def GetTrueBaseRollPitchYaw(self) -> np.ndarray:
        """Present Euler angles of the base [rad], (3,)."""
        return np.array(self._pybullet_client.getEulerFromQuaternion(self._orientation()))

    def GetBaseRollPitchYaw(self) -> np.ndarray:
        """Observed Euler angles of the base [rad], (3,)."""
        angles = self._pybullet_client.getEulerFromQuaternion(self._sensed(_ORIENTATION))
        return self._noisy(np.array(angles), 3)

    def GetTrueBaseRollPitchYawRate(self) -> np.ndarray:
        """Present angular velocity of the base, in world axes [rad/s], (3,)."""
        return np.array(self._pybullet_client.getBaseVelocity(self.quadruped)[1])

    def GetBaseRollPitchYawRate(self) -> np.ndarray:
        """Observed angular velocity of the base, in world axes [rad/s], (3,)."""
        return self._noisy(self._sensed(_TURNING), 4)

    def SetControlLatency(self, latency: float) -> None:
        """Sets the age of the observed sensor readings [s]."""
        self._control_latency = latency

    def GetControlLatency(self) -> float:
        """Age of the observed sensor readings [s]."""
        return self._control_latency
