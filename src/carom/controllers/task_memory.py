"""Memory of the kernel that controls a point on a link, and its launch."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from math import prod
from typing import TYPE_CHECKING, Any

import numpy as np

from carom.algorithms.mechanism import Mechanism, mechanism_of
from carom.algorithms.sweeps import Sweeps, sweeps_of
from carom.checks import Array
from carom.layouts.codes import BASE_POSITIONS, BASE_VELOCITIES
from carom.layouts.mechanism import BASE_MOTION, TASK_TARGETS, TaskControl
from carom.native.kernels import task_control_kernel
from carom.native.launch import Launch
from carom.native.tables import ArrayTable, numbers_of, writer_of

if TYPE_CHECKING:
    from carom.scene.body import Body

_ROWS = 6
# Where the targets begin in `question`, after gravity and the pose of the base.
_TARGETS = 3 + BASE_POSITIONS
# Numbers of a position, an orientation, a velocity, an acceleration and a force.
_LENGTHS = (3, 4, 6, 6, 6)
_NO_TURN = (0.0, 0.0, 0.0, 1.0)


class TaskMemory:
    """Gains and targets of a task, the state that they are for, and what the kernel computes from them.

    Attributes:
        arrays: The fields of `TaskControl` by name.
        mechanism: The mechanism of the body.
        positions: Positions of the joints, after `take_state`.
        pull: The error of the posture, (n,), to be written before `run`.
        torques: The torques after `run`, (n,).
    """

    def __init__(self, body: Body, link: int, rows: int, *, spring: bool) -> None:
        """Reserve memory for a link's first `rows` coordinates; `spring` chooses impedance control."""
        self._body = body
        self.mechanism: Mechanism = mechanism_of(body)
        self._sweeps = sweeps_of(body)
        dofs = self.mechanism.dofs
        table = ArrayTable(TaskControl)
        sizes = {"question": TASK_TARGETS, "axis": _ROWS * _ROWS, "column": _ROWS * dofs}
        table.reserve({**sizes, "dof": dofs, "entry": dofs * dofs})
        arrays = self.arrays = table.numpy
        question = arrays["question"][:TASK_TARGETS]
        self._write_gravity = writer_of(question[:3])
        self._base = numbers_of(question[3:_TARGETS])
        self._write = writer_of(question[_TARGETS:])
        rates = int(BASE_MOTION) + self.mechanism.coordinates
        given = self.mechanism.arrays["input"]
        self.positions: Array = given[int(BASE_MOTION) : rates]
        self._put_positions = numbers_of(self.positions)
        self._put_rates = numbers_of(given[rates : rates + dofs])
        self.torques: Array = arrays["dof_torque"][:dofs]
        self.pull: Array = arrays["dof_pull"][:dofs]
        structs: list[Any] = [*self._sweeps.structs, table.struct()]
        self.run: Callable[[], None] = Launch(
            task_control_kernel, 1, [*structs, 1 + link, rows, int(spring)]
        ).brief_function

    @property
    def outdated(self) -> bool:
        """Whether masses, inertias or other parameters of the body have changed since."""
        return self._body.derived.get(Sweeps) is not self._sweeps

    @property
    def is_finite(self) -> bool:
        """Whether all torques are finite; the kernel makes the first of them NaN if not."""
        return not len(self.torques) or bool(self.torques[0] == self.torques[0])

    def set_gains(
        self,
        *,
        point: Array,
        posture_frequency: Array,
        frequency: Array | float = 0.0,
        ratio: Array | float = 0.0,
        stiffness: Array | float = 0.0,
    ) -> None:
        """Write the gains; a number counts for all entries."""
        arrays = self.arrays
        arrays["axis_point"][:3] = point
        arrays["dof_frequency"][: len(self.torques)] = posture_frequency
        for name, values in (("frequency", frequency), ("ratio", ratio), ("stiffness", stiffness)):
            each = np.ravel(values)
            arrays[f"axis_{name}"][: len(each) if len(each) > 1 else _ROWS] = each

    def write_targets(
        self,
        position: Sequence[float] | np.ndarray,
        orientation: Sequence[float] | np.ndarray | None,
        velocity: Sequence[float] | np.ndarray,
        acceleration: Sequence[float] | np.ndarray,
        force: Sequence[float] | np.ndarray,
    ) -> None:
        """Write all targets.

        Raises:
            TypeError: An argument has no length.
            ValueError: It has the wrong one.
            struct.error: An item is not a number.
        """
        turn = _NO_TURN if orientation is None else orientation
        lengths = len(position), len(turn), len(velocity), len(acceleration), len(force)
        if lengths != _LENGTHS:
            raise ValueError(f"targets have {lengths} numbers, not {_LENGTHS}")
        self._write(*position, *turn, orientation is not None, *velocity, *acceleration, *force)

    def take_state(self) -> None:
        """Take over the present state of the body, and gravity."""
        body = self._body
        world, first = body.world, body.first_position
        own = first + BASE_POSITIONS
        rates = body.first_velocity + BASE_VELOCITIES
        self._write_gravity(*world.parameters.gravity)
        self._base[:] = world.position_memory[first:own]
        self._put_positions[:] = world.position_memory[own : own + len(self._put_positions)]
        self._put_rates[:] = world.velocity_memory[rates : rates + len(self._put_rates)]

    def of_task(self, name: str, *shape: int) -> Array:
        """A copy of one of the fields that begin with "axis_", of this shape."""
        return self.arrays[f"axis_{name}"][: prod(shape)].reshape(shape).copy()
