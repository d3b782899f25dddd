"""Setting the motors of several joints at once."""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Sequence
from functools import partial
from struct import Struct
from typing import TYPE_CHECKING

import numpy as np

from carom.layouts.motor_commands import (
    FORCES,
    KDS,
    KPS,
    POSITION,
    POSITIONS,
    TORQUE,
    VELOCITIES,
    VELOCITY,
    MotorCommands,
)
from carom.layouts.quick_bodies import MotorGroup as Record
from carom.native.kernels import command_motors_kernel
from carom.native.launch import Launch
from carom.native.tables import NUMPY_REAL, ArrayTable

if TYPE_CHECKING:
    from carom.world.world import World

_TYPE_CODE = np.dtype(NUMPY_REAL).char
_NUMBERS = ("position", "velocity", "force", "kp", "kd")
_MODES = (VELOCITY, TORQUE, POSITION)


class MotorGroup:
    """Revolute and prismatic joints of a world, in any order; valid until bodies are added or removed.

    They are given by the rows of their velocities; `bounds` are the minimum and maximum target position of
    each, and `force` [N or N m], `kp` and `kd` the defaults of motors.
    """

    def __init__(
        self,
        world: World,
        dofs: Sequence[int],
        bounds: Sequence[tuple[float, float]],
        force: float,
        kp: float,
        kd: float,
    ) -> None:
        count = len(dofs)
        self._count = count
        commands = ArrayTable(MotorCommands)
        commands.reserve({"joint": count})
        self._commands = commands
        arrays = commands.numpy
        arrays["joint_dof"][:count] = dofs
        arrays["joint_lower"][:count], arrays["joint_upper"][:count] = np.array(bounds).T
        pack = Struct(f"{count}{_TYPE_CODE}").pack_into
        self._put_positions, self._put_velocities, self._put_forces, self._put_kps, self._put_kds = (
            partial(pack, commands.bytes_of(f"joint_{name}"), 0) for name in _NUMBERS
        )
        self._refused: memoryview[int] = arrays["joint_refused"].data
        defaults = (NUMPY_REAL(force), NUMPY_REAL(kp), NUMPY_REAL(kd))
        state = world.arrays.state.struct()
        asked = (VELOCITY, 0, NUMPY_REAL(0.0))
        self._launch = Launch(
            command_motors_kernel,
            1,
            [state, commands.struct(), 0, count, *defaults, *asked],
        )
        self._run: Callable[[], None] = self._launch.brief_function
        indices = command_motors_kernel.indices
        self._places = [indices[name] for name in ("mode", "given", "time_step")]
        self._asked: tuple[float, ...] = ()

    def record(self, indices: Sequence[int]) -> Record:
        """The record of these joints, by index, for quick calls; valid as long as this object exists."""
        commands = self._commands.struct()
        made = Record(
            indices=ctypes.addressof(self._keep(indices)),
            count=len(indices),
            refused=commands.joint_refused.data,
            **{name: getattr(commands, f"joint_{name}").data for name in _NUMBERS},
        )
        command = made.command
        command.function, command.bounds, command.arguments, made.mode, made.given, made.time_step = (
            self._launch.addresses("mode", "given", "time_step")
        )
        return made

    def _keep(self, indices: Sequence[int]) -> ctypes.Array[ctypes.c_int32]:
        self._indices = (ctypes.c_int32 * len(indices))(*indices)
        return self._indices

    def command(
        self,
        mode: int,
        time_step: float,
        positions: Sequence[float] | None = None,
        velocities: Sequence[float] | None = None,
        forces: Sequence[float] | None = None,
        kps: Sequence[float] | None = None,
        kds: Sequence[float] | None = None,
    ) -> None:
        """Set the motors by one number for each joint; None stands for the default numbers.

        Args:
            mode: `VELOCITY`, `TORQUE` or `POSITION` of `carom.layouts.motor_commands`.
            time_step: Duration of a step [s], to convert forces to impulses.
            positions: Targets [rad or m], clipped to the limits; 0 by default.
            velocities: Targets [rad/s or m/s]; 0 by default.
            forces: Maximum forces of the motors, or torques [N m or N].
            kps: Gains.
            kds: Gains.

        Raises:
            ValueError: The mode is unknown, an argument does not have a number for each joint, or a number
                is not finite; nothing is set.
            struct.error: An argument contains something else than numbers; nothing is set.
        """
        if mode not in _MODES:
            raise ValueError("there is no such mode")
        for numbers in (positions, velocities, forces, kps, kds):
            # Before anything is read, because a range may be too long to be read.
            if numbers is not None and len(numbers) != self._count:
                raise ValueError("there has to be a number for each joint")
        given = 0
        if positions is not None:
            self._put_positions(*positions)
            given = POSITIONS
        if velocities is not None:
            self._put_velocities(*velocities)
            given |= VELOCITIES
        if forces is not None:
            self._put_forces(*forces)
            given |= FORCES
        if kps is not None:
            self._put_kps(*kps)
            given |= KPS
        if kds is not None:
            self._put_kds(*kds)
            given |= KDS
        asked = (mode, given, time_step)
        if asked != self._asked:
            for place, value in zip(self._places, asked, strict=True):
                self._launch.replace(place, value)
            self._asked = asked
        self._run()
        if self._refused[0]:
            raise ValueError("a number is not finite")
