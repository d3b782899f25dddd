"""What joints do and are told to do, for plots."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from carom.model.codes import JointCode

if TYPE_CHECKING:
    from carom.world import World

Sample = tuple[int, int, float, float, float, float | None, float | None, float | None]

_ONE_FREEDOM = (JointCode.REVOLUTE, JointCode.PRISMATIC)
# Columns of `World.motor`.
_TARGET, _TARGET_VELOCITY, _KP, _KD, _MAX_IMPULSE = range(5)


class Probes:
    """What some joints do, and what they are told to; one of `World.observers` while there are any.

    Args:
        world: The world.
    """

    def __init__(self, world: World) -> None:
        self._world = world
        self._joints: set[tuple[int, int]] = set()
        # Steps clear what they have applied.
        self._applied = np.zeros(0)

    def watch(self, joints: set[tuple[int, int]]) -> None:
        """Watches these joints from now on: numbers of their bodies, and their indices."""
        observers = self._world.observers
        if joints and not self._joints:
            observers.append(self)
        elif self._joints and not joints:
            observers.remove(self)
        self._joints = joints

    def before_step(self) -> None:
        """Keeps the torques that scripts have applied for the step."""
        self._applied = self._world.joint_torque.copy()

    def after_step(self) -> None:
        """Nothing: samples are taken when pages have time for them."""

    def samples(self) -> list[Sample]:
        """What the joints do now; those that do not exist, or turn about several axes, are left out.

        Returns:
            Body, joint, position [rad or m], velocity, torque or force of the motor and the script together,
            and the targets of position, velocity and torque where there are such.
        """
        world = self._world
        samples = []
        for number, joint in sorted(self._joints):
            body = world.bodies.get(number)
            if body is None or not 0 <= joint < body.joint_count:
                continue
            if body.joint_types[joint] not in _ONE_FREEDOM:
                continue
            row = body.velocity_index[joint]
            motor = world.motor[row]
            active = motor[_MAX_IMPULSE] > 0.0
            applied = float(self._applied[row]) if row < len(self._applied) else 0.0
            torque = float(world.motor_impulse[row]) / world.parameters.substep_time + applied
            samples.append(
                (
                    number,
                    joint,
                    float(world.position[body.position_index[joint]]),
                    float(world.velocity[row]),
                    torque,
                    float(motor[_TARGET]) if active and motor[_KP] != 0.0 else None,
                    float(motor[_TARGET_VELOCITY]) if active and motor[_KD] != 0.0 else None,
                    applied if applied != 0.0 else None,
                )
            )
        return samples
