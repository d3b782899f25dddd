"""Stable proportional-derivative control.

The controller of Tan, Liu and Turk (Stable Proportional-Derivative Controllers, 2011) uses the errors of
position and velocity that are expected after the next step. For the velocity error, the equations of motion
are solved together with the damping of the controller. So high gains are stable with long time steps.
"""

from __future__ import annotations

from collections.abc import Sequence
from struct import Struct
from struct import error as StructError
from typing import TYPE_CHECKING

import numpy as np

from carom.algorithms.extended_model import base_motion
from carom.algorithms.extended_nodes import extended_nodes
from carom.algorithms.mechanism import Mechanism
from carom.layouts.codes import BASE_POSITIONS, BASE_VELOCITIES
from carom.layouts.mechanism import BASE_MOTION, Control
from carom.model.joint_columns import Column, JointColumns
from carom.native.gates import gated
from carom.native.kernels import stable_pd_kernel
from carom.native.launch import Launch
from carom.native.tables import NUMPY_REAL, ArrayTable, numbers_of, writer_of

if TYPE_CHECKING:
    from carom.scene.body import Body

_NUMBER = np.dtype(NUMPY_REAL)
_read_orientation = Struct(f"4{_NUMBER.char}").unpack_from
_read_velocity = Struct(f"{BASE_VELOCITIES}{_NUMBER.char}").unpack_from


@gated("world.call_lock")
def stable_pd_torques(
    body: Body,
    joints: tuple[int, ...],
    positions: Column,
    velocities: Column,
    forces: Column,
    kps: Sequence[float],
    kds: Sequence[float],
    time_step: float,
) -> np.ndarray:
    """Torques that drive joints to their targets.

    With a floating base the equations of motion are those that PyBullet solves, see `extended_nodes`. With a
    fixed base, for which PyBullet mixes up coordinates, they are the body's own.

    The columns `positions` to `kds` have an entry for each of the joints, in their order. The first three may
    have no entries at all: then each joint's counts as empty.

    Args:
        body: The body.
        joints: The joints by their indices; others get no torque. Of one that is repeated, the last counts.
        positions: One number [rad or m], or a quaternion (x, y, z, w); 0 or no rotation if an entry has
            another length.
        velocities: One number [rad/s or m/s], or three; likewise.
        forces: Maximum torque of each dof [N m or N]; for dofs beyond the length of an entry 100000.
        kps: Torque per position error.
        kds: Torque per velocity error.
        time_step: Duration of the next step [s].

    Returns:
        Torque of each velocity coordinate of the body, beginning with zeros for its base.

    Raises:
        ValueError: The body has a planar joint.
        TypeError: An item is not a number.
        DescriptionError: The file of a collision mesh cannot be used.
    """
    controller = body.derived.get(_Controller)
    if controller is None:
        controller = body.derived[_Controller] = _Controller(body)
    controller.take_state()
    controller.take_targets(joints, positions, velocities, forces, kps, kds)
    return controller.torques(time_step)


class _Controller:
    """The controller of one body: arrays, and the kernel that works on them."""

    def __init__(self, body: Body) -> None:
        self._body = body
        mechanism = Mechanism(extended_nodes(body, as_pybullet=not body.fixed_base), free=True)
        self._mechanism = mechanism
        control = ArrayTable(Control)
        control.reserve(
            {"coordinate": mechanism.coordinates, "dof": mechanism.dofs, "entry": mechanism.dofs**2}
        )
        arrays = control.numpy
        # The dofs of the mechanism begin with those of the base, like the body's; these have no targets.
        dofs = slice(BASE_VELOCITIES, mechanism.dofs)
        self._write_positions = writer_of(arrays["coordinate_target"][: mechanism.coordinates])
        self._write_velocities = writer_of(arrays["dof_target_rate"][dofs])
        self._write_forces = writer_of(arrays["dof_most"][dofs])
        self._write_kps = writer_of(arrays["dof_kp"][dofs])
        self._write_kds = writer_of(arrays["dof_kd"][dofs])
        self._columns = JointColumns(body, ())
        rates = int(BASE_MOTION) + mechanism.coordinates
        given = numbers_of(mechanism.arrays["input"])
        self._position = given[int(BASE_MOTION) : rates]
        self._rate = given[rates : rates + mechanism.joint_dofs]
        self._torque = arrays["dof_torque"][: mechanism.dofs]
        self._time_step = 0.0
        arguments = [*mechanism.structs, control.struct(), int(body.fixed_base), self._time_step]
        self._launch = Launch(stable_pd_kernel, 1, arguments)
        self._run = self._launch.function

    def take_state(self) -> None:
        """Take over the present state of the body."""
        body, world = self._body, self._body.world
        q, u = body.first_position, body.first_velocity
        orientation = _read_orientation(world.position_memory, (q + 3) * _NUMBER.itemsize)
        rates = _read_velocity(world.velocity_memory, u * _NUMBER.itemsize)
        gravity = world.parameters.gravity
        self._mechanism.set_base_motion(*base_motion(orientation, rates[3:], rates[:3], gravity))
        q, u = q + BASE_POSITIONS, u + BASE_VELOCITIES
        self._position[:] = world.position_memory[q : q + self._mechanism.coordinates]
        self._rate[:] = world.velocity_memory[u : u + self._mechanism.joint_dofs]

    def take_targets(
        self,
        joints: tuple[int, ...],
        positions: Column,
        velocities: Column,
        forces: Column,
        kps: Sequence[float],
        kds: Sequence[float],
    ) -> None:
        """Take over the targets of some joints; all others have none."""
        columns = self._columns
        if columns.joints != joints:
            columns = self._columns = JointColumns(self._body, joints)
        try:
            self._write_positions(*columns.positions(positions))
            self._write_velocities(*columns.velocities(velocities))
            self._write_forces(*columns.forces(forces))
            self._write_kps(*columns.gains(kps))
            self._write_kds(*columns.gains(kds))
        except StructError as problem:
            raise TypeError(f"targets of joints: {problem}") from None

    def torques(self, time_step: float) -> np.ndarray:
        """The torques for a step of this duration [s]."""
        if time_step != self._time_step:
            self._launch.replace(stable_pd_kernel.indices["time_step"], time_step)
            self._time_step = time_step
        self._run()
        return self._torque.copy()
