"""How much of a body an actuator moves where the body is now: moment arms, and inverse masses along them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from carom.algorithms.mass_matrix import mass_matrix
from carom.checks import Array
from carom.description.transform import inverse, rotate
from carom.layouts.codes import BASE_VELOCITIES
from carom.native.products import dots, length
from carom.scene.handles import world_of
from carom.scene.sensors.joints import along_actuator
from carom.scene.sensors.lone_source import LoneSource
from carom.scene.tendons.making import tendons_of
from carom.scene.tendons.measure import measured

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore

_ZERO = (0.0, 0.0, 0.0)


@dataclass(frozen=True, eq=False, slots=True)
class Effect:
    """What a unit force of an actuator does to a body.

    Attributes:
        arms: Its moment arms along all dofs: those of a free base first, about and along its own axes.
        accelerations: Those that it causes.
    """

    arms: Array
    accelerations: Array

    @property
    def inverse_mass(self) -> float:
        """The acceleration that it causes along the actuator."""
        return float(dots(self.arms, self.accelerations))


class ReferenceMasses:
    """The mass matrix of a body at rest where it is now, armature of joints and tendons included."""

    def __init__(self, body: BodyCore) -> None:
        self.body = body
        joints = [joint for joint in range(body.joint_count) if body.velocity_count[joint]]
        self._places = [
            body.velocity_index[joint] + each
            for joint in joints
            for each in range(body.velocity_count[joint])
        ]
        state = world_of(body).arrays.state.numpy
        positions = [
            state["position"][0, body.position_index[joint] + each]
            for joint in joints
            for each in range(body.position_count[joint])
        ]
        self._matrix = mass_matrix(body, np.array(positions))
        for tendon in tendons_of(body):
            if tendon.armature:
                path = tendon.path
                arms = self._arms(lambda path=path: float(measured(self._source(), body, path)[1][0]))
                self._matrix += tendon.armature * arms[:, None] * arms

    def of(self, actuator: int) -> Effect:
        """What a unit force of an actuator of the body does."""
        arms = self._arms(lambda: float(along_actuator(self._source(), self.body, actuator)[1][0]))
        return Effect(arms, _solved(self._matrix, arms))

    def norm(self, effect: Effect) -> float:
        """Length of the vector of accelerations as MuJoCo's coordinates have it.

        For them a free body moves with the origin of its link frame.
        """
        values = effect.accelerations.copy()
        if not self.body.fixed_base:
            origin = inverse(self.body.spec.base.inertial_frame).position
            values[3:6] += np.cross(values[:3], origin)
        return length(values)

    def _source(self) -> LoneSource:
        return LoneSource(world_of(self.body))

    def _arms(self, rate: Callable[[], float]) -> Array:
        """What a length changes by per unit velocity of each dof."""
        body = self.body
        arms = [] if body.fixed_base else self._base_arms(rate)
        rates = world_of(body).arrays.state.numpy["dof_velocity"][0]
        for place in self._places:
            before, rates[place] = rates[place], 1.0
            arms.append(rate())
            rates[place] = before
        return np.array(arms)

    def _base_arms(self, rate: Callable[[], float]) -> list[float]:
        body, arms = self.body, []
        *_, x, y, z, w = self._source().poses(body)[0, body.first_link].tolist()
        for dof in range(BASE_VELOCITIES):
            axis = rotate((x, y, z, w), tuple(float(dof % 3 == each) for each in range(3)))  # pyright: ignore
            body.set_base_velocity(*((_ZERO, axis) if dof < 3 else (axis, _ZERO)))
            arms.append(rate())
        body.set_base_velocity(_ZERO, _ZERO)
        return arms


def _solved(matrix: Array, right: Array) -> Array:
    """The solution of a system of equations with a symmetric positive definite matrix, by elimination."""
    rows, values = matrix.copy(), right.copy()
    for pivot in range(len(rows)):
        for below in range(pivot + 1, len(rows)):
            share = rows[below][pivot] / rows[pivot][pivot]
            rows[below] = rows[below] - share * rows[pivot]
            values[below] -= share * values[pivot]
    for pivot in reversed(range(len(rows))):
        for other in range(pivot + 1, len(rows)):
            values[pivot] -= rows[pivot][other] * values[other]
        values[pivot] /= rows[pivot][pivot]
    return values
