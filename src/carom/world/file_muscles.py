"""Muscles of MJCF files whose force follows from the acceleration that they cause."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from carom.algorithms.mass_matrix import mass_matrix
from carom.lazy_dataclasses import replace
from carom.model.actuator_rows import write_actuator
from carom.native.products import length
from carom.scene.handles import world_of
from carom.scene.sensors.joints import along_actuator
from carom.scene.sensors.lone_source import LoneSource

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore


def find_forces(bodies: Sequence[BodyCore]) -> None:
    """Find the forces of muscles that are stated as accelerations, where the bodies are now.

    MuJoCo's rule: the force is the acceleration over the length of the vector of accelerations that a force
    of 1 causes, of all coordinates.
    """
    for body in bodies:
        for number, spec in enumerate(body.spec.actuators):
            if spec.muscle is not None and spec.muscle.force < 0.0:
                force = -spec.muscle.force / max(_acceleration(body, number), 1e-15)
                found = replace(spec, muscle=replace(spec.muscle, force=force))
                others = [found if it is spec else it for it in body.spec.actuators]
                body.spec = replace(body.spec, actuators=tuple(others))
                row = body.rows.first["actuator"] + number
                write_actuator(world_of(body).arrays.model.numpy, row, found)


def _acceleration(body: BodyCore, actuator: int) -> float:
    """Length of the vector of accelerations of a fixed body that a unit force of an actuator causes."""
    world = world_of(body)
    state, first = world.arrays.state.numpy, body.rows.first
    joints = [joint for joint in range(body.joint_count) if body.velocity_count[joint]]
    places = [
        body.velocity_index[joint] + each for joint in joints for each in range(body.velocity_count[joint])
    ]
    positions = [
        state["position"][0, body.position_index[joint] + each]
        for joint in joints
        for each in range(body.position_count[joint])
    ]
    rates = state["dof_velocity"][0, first["dof"] : first["dof"] + body.rows.count["dof"]]
    before, arms = rates.copy(), []
    for place in places:
        rates[:] = 0.0
        state["dof_velocity"][0, place] = 1.0
        arms.append(float(along_actuator(LoneSource(world), body, actuator)[1][0]))
    rates[:] = before
    return length(_solved(mass_matrix(body, np.array(positions)), np.array(arms)))


def _solved(matrix: np.ndarray, right: np.ndarray) -> np.ndarray:
    """The solution of a system of equations with a symmetric positive definite matrix, by elimination."""
    rows, values = [row.copy() for row in matrix], right.copy()
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
