"""A Minitaur whose sensors lag and are noisy, as those of the real one."""

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
    "MapToMinusPiToPi",
    "Minitaur",
]

INIT_RACK_POSITION = (0.0, 0.0, 1.0)
SENSOR_NOISE_STDDEV = (0.0, 0.0, 0.0, 0.0, 0.0)
_PD_KD = 0.3
_REMEMBERED_STEPS = 100
_STANDING_STEPS = 100

# Where in what is remembered of a step the sensors' readings are.
_ANGLES, _VELOCITIES, _TORQUES = slice(0, 8), slice(8, 16), slice(16, 24)
_ORIENTATION, _TURNING = slice(24, 28), slice(28, 31)


def MapToMinusPiToPi(angles: Any) -> np.ndarray:
    """Angles between -π and π that stand for the same directions [rad]."""
    within_a_turn = np.fmod(angles, 2 * pi)
    too_far = np.where(within_a_turn >= pi, 1.0, np.where(within_a_turn < -pi, -1.0, 0.0))
    return within_a_turn - 2 * pi * too_far


class Minitaur(MinitaurDynamics):
    """A Minitaur in a world that is there already; see `MinitaurBody`.

    What its sensors tell is what was `control_latency` ago, with noise; its motors' controllers see what was
    `pd_latency` ago. Methods with `True` in their names tell what is.

    Attributes:
        np_random: Where noise comes from.
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
        """Loads it.

        Args:
            pybullet_client: The world.
            urdf_root: The folder of the files; that of `pybullet_data` where not given.
            time_step: Of the simulation [s].
            action_repeat: How many steps of the simulation `Step` makes.
            self_collision_enabled: Whether its links touch each other.
            motor_velocity_limit: How fast commands may lead the motors [rad/s].
            pd_control_enabled: Whether torques of a PD controller drive the motors.
            accurate_motor_model_enabled: Whether torques of a model of the motors do.
            remove_default_joint_damping: Whether its links move through the air without damping.
            motor_kp: Gain for angles, of the model of the motors.
            motor_kd: Gain for velocities.
            pd_latency: How old what the motors' controllers see is [s].
            control_latency: How old what the sensors tell is [s].
            observation_noise_stdev: Standard deviations of angles, velocities and torques of the motors, and
                of the angles and angular velocities of the base.
            torque_control_enabled: Whether commands are duty cycles for the model of the motors.
            motor_overheat_protection: Whether a motor of that model that strains for a second is shut off.
            on_rack: Whether the base is fixed, in the air.
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
        """Takes it to where it begins, and lets it come to stand.

        Args:
            reload_urdf: Whether to load it anew, or to put back the one that is there.
            default_motor_angles: Where the motors go after a hundred steps at a quarter turn [rad], (8,).
            reset_time: How long they do [s]. Where it is not positive, and under torque control, the robot
                does not come to stand at all.
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
        # Delayed readings of the first steps depend on this one, which tells the last again, as in PyBullet.
        self.ReceiveObservation()

    def Step(self, action: Any, before_each: Callable[[int], None] | None = None) -> None:
        """Applies commands for as many steps of the simulation as an action is repeated.

        Args:
            action: As `ApplyAction` takes it.
            before_each: Called before each of the steps, with its number.
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
        """Ends an episode; a real robot would be shut down."""

    def GetTimeSinceReset(self) -> float:
        """How long `Step` has moved it since it was reset [s]."""
        return self._step_counter * self.time_step

    def SetTimeSteps(self, action_repeat: int, simulation_step: float) -> None:
        """Sets how often an action is repeated, and the step of the simulation [s]."""
        self.time_step = simulation_step
        self._action_repeat = action_repeat

    def ApplyAction(self, motor_commands: Any, motor_kps: Any = None, motor_kds: Any = None) -> None:
        """Sets the motors for the next step of the simulation.

        Args:
            motor_commands: Angles [rad] for the motors, or duty cycles under torque control, shape (8,).
            motor_kps: Gains for angles, (8,); the robot's where not given. For torques only.
            motor_kds: Gains for velocities, (8,).
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
        """Whether the sensors tell something; in a simulation they do."""
        return True

    def ReceiveObservation(self) -> None:
        """Reads the sensors; until it is called again they tell the same."""
        self._observation_history.appendleft(self.GetTrueObservation())

    def _delayed(self, latency: float) -> np.ndarray:
        """What the sensors read so long ago, between two readings where it falls there."""
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
        """All that sensors read, as it is now.

        Returns:
            Angles [rad], velocities [rad/s] and torques [N m] of the motors, orientation and angular velocity
            [rad/s] of the base: (31,).
        """
        _, turning = self._pybullet_client.getBaseVelocity(self.quadruped)
        return np.concatenate((*self._motor_states(), self._orientation(), turning))

    def GetTrueMotorAngles(self) -> np.ndarray:
        """Angles of the motors now [rad], (8,)."""
        return self._motor_states()[0]

    def GetMotorAngles(self) -> np.ndarray:
        """Angles of the motors as sensed, between -π and π [rad], (8,)."""
        return MapToMinusPiToPi(self._noisy(self._sensed(_ANGLES), 0))

    def GetTrueMotorVelocities(self) -> np.ndarray:
        """Velocities of the motors now [rad/s], (8,)."""
        return self._motor_states()[1]

    def GetMotorVelocities(self) -> np.ndarray:
        """Velocities of the motors as sensed [rad/s], (8,)."""
        return self._noisy(self._sensed(_VELOCITIES), 1)

    def GetTrueMotorTorques(self) -> np.ndarray:
        """Torques of the motors now [N m], (8,)."""
        return self._motor_states()[2]

    def GetMotorTorques(self) -> np.ndarray:
        """Torques of the motors as sensed [N m], (8,)."""
        return self._noisy(self._sensed(_TORQUES), 2)

    def GetTrueBaseOrientation(self) -> tuple[float, float, float, float]:
        """Orientation of the base now (x, y, z, w)."""
        return self._orientation()

    def GetBaseOrientation(self) -> tuple[float, float, float, float]:
        """Orientation of the base as sensed (x, y, z, w)."""
        return self._pybullet_client.getQuaternionFromEuler(self.GetBaseRollPitchYaw())

    def GetTrueBaseRollPitchYaw(self) -> np.ndarray:
        """Euler angles of the base now [rad], (3,)."""
        return np.array(self._pybullet_client.getEulerFromQuaternion(self._orientation()))

    def GetBaseRollPitchYaw(self) -> np.ndarray:
        """Euler angles of the base as sensed [rad], (3,)."""
        angles = self._pybullet_client.getEulerFromQuaternion(self._sensed(_ORIENTATION))
        return self._noisy(np.array(angles), 3)

    def GetTrueBaseRollPitchYawRate(self) -> np.ndarray:
        """Angular velocity of the base now, in the world's frame [rad/s], (3,)."""
        return np.array(self._pybullet_client.getBaseVelocity(self.quadruped)[1])

    def GetBaseRollPitchYawRate(self) -> np.ndarray:
        """Angular velocity of the base as sensed, in the world's frame [rad/s], (3,)."""
        return self._noisy(self._sensed(_TURNING), 4)

    def SetControlLatency(self, latency: float) -> None:
        """Sets how old what the sensors tell is [s]."""
        self._control_latency = latency

    def GetControlLatency(self) -> float:
        """How old what the sensors tell is [s]."""
        return self._control_latency
