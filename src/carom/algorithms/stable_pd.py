"""Stable proportional-derivative control.

The controller of Tan, Liu and Turk (Stable Proportional-Derivative Controllers, 2011) uses the errors of
position and velocity that are expected after the next step. For the velocity error, the equations of motion
are solved together with the damping of the controller. So high gains are stable with long time steps.
"""

from __future__ import annotations

from array import array
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from carom.algorithms.extended_model import base_motion
from carom.algorithms.extended_nodes import extended_nodes
from carom.algorithms.mechanism import Mechanism
from carom.layouts.codes import BASE_POSITIONS, BASE_VELOCITIES
from carom.layouts.mechanism import BASE_MOTION, Control
from carom.native.kernels import stable_pd_kernel
from carom.native.launch import Launch
from carom.native.tables import NUMPY_REAL, ArrayTable, numbers_of

if TYPE_CHECKING:
    from carom.scene.body import Body

_TYPE_CODE = np.dtype(NUMPY_REAL).char
_UNSTATED_FORCE = 100000.0
_NO_TURN = (0.0, 0.0, 0.0, 1.0)


# Position, velocity, forces, kp and kd of a joint; see `stable_pd_torques`.
_Target = tuple[Sequence[float], Sequence[float], Sequence[float], float, float]


def stable_pd_torques(body: Body, targets: Mapping[int, _Target], time_step: float) -> np.ndarray:
    """Torques that drive joints to their targets.

    With a floating base the equations of motion are those that PyBullet solves, see `extended_nodes`. With a
    fixed base, for which PyBullet mixes up coordinates, they are the body's own.

    Args:
        body: The body.
        targets: By joint index; other joints get no torque. Position: one number [rad or m], or a quaternion
            (x, y, z, w); 0 or no rotation if it has another length. Velocity: one number [rad/s or m/s], or
            three; likewise. Maximum torque of each dof [N m or N]; for dofs beyond its length 100000. Torque
            per position error, and per velocity error.
        time_step: Duration of the next step [s].

    Returns:
        Torque of each velocity coordinate of the body, beginning with zeros for its base.

    Raises:
        ValueError: A joint is planar.
        DescriptionError: The file of a collision mesh cannot be used.
    """
    controller = body.derived.get(_Controller)
    if controller is None:
        controller = body.derived[_Controller] = _Controller(body)
    return controller.torques(targets, time_step)


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
        self._target = numbers_of(arrays["coordinate_target"])
        self._given = [arrays[f"dof_{name}"] for name in ("target_rate", "kp", "kd", "most")]
        self._target_rate, self._kp, self._kd, self._most = map(numbers_of, self._given)
        self._torque = arrays["dof_torque"][: mechanism.dofs]
        self._unaimed = array(_TYPE_CODE)
        for count in body.position_count:
            self._unaimed.extend(_NO_TURN if count == 4 else (0.0,) * count)
        # The dofs of the mechanism begin with those of the base, like the body's.
        shift_q, shift_u = body.first_position + BASE_POSITIONS, body.first_velocity
        self._places = [
            (
                body.position_index[joint] - shift_q,
                body.velocity_index[joint] - shift_u,
                body.position_count[joint],
                body.velocity_count[joint],
            )
            for joint in range(body.joint_count)
        ]
        rates = int(BASE_MOTION) + mechanism.coordinates
        given = numbers_of(mechanism.arrays["input"])
        self._position = given[int(BASE_MOTION) : rates]
        self._rate = given[rates : rates + mechanism.joint_dofs]
        arguments = [*mechanism.structs, control.struct(), int(body.fixed_base), 0.0]
        self._launch = Launch(stable_pd_kernel, 1, arguments)
        self._time_step_at = stable_pd_kernel.indices["time_step"]

    def torques(self, targets: Mapping[int, _Target], time_step: float) -> np.ndarray:
        self._take_state()
        self._take_targets(targets)
        self._launch.replace(self._time_step_at, time_step)
        self._launch()
        return self._torque.copy()

    def _take_state(self) -> None:
        body, world = self._body, self._body.world
        q, u = body.first_position, body.first_velocity
        orientation = world.position_memory[q + 3 : q + BASE_POSITIONS].tolist()
        rates = world.velocity_memory[u : u + BASE_VELOCITIES].tolist()
        gravity = world.parameters.gravity
        self._mechanism.set_base_motion(*base_motion(orientation, rates[3:], rates[:3], gravity))
        self._position[:] = world.position_memory[q + BASE_POSITIONS :][: self._mechanism.coordinates]
        self._rate[:] = world.velocity_memory[u + BASE_VELOCITIES :][: self._mechanism.joint_dofs]

    def _take_targets(self, targets: Mapping[int, _Target]) -> None:
        for numbers in self._given:
            numbers.fill(0.0)
        aims, target_rates, kps, kds, most = self._target, self._target_rate, self._kp, self._kd, self._most
        aims[: len(self._unaimed)] = self._unaimed
        for joint, (position, velocity, force, kp, kd) in targets.items():
            q, u, count, freedoms = self._places[joint]
            if count and len(position) == count:
                for k in range(count):
                    aims[q + k] = position[k]
            if len(velocity) == freedoms:
                for k in range(freedoms):
                    target_rates[u + k] = velocity[k]
            stated = len(force)
            for k in range(freedoms):
                kps[u + k] = kp
                kds[u + k] = kd
                most[u + k] = force[k] if k < stated else _UNSTATED_FORCE
