"""The arrays of a body's state that a keyframe sets."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from carom.checks import Array
from carom.description.keyframe import BodyKeyframe
from carom.description.pose import Pose
from carom.description.transform import compose, inverse
from carom.layouts.codes import BASE_POSITIONS, BASE_VELOCITIES

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore

_QUATERNION = 4
# What a keyframe sets to zero: axes of rows, and fields.
_CLEARED = (
    *(("dof", "dof_torque"), ("link", "link_wrench"), ("sensor", "sensor_memory")),
    *(("late", "late_velocity"), ("late", "late_joint")),
)


class Change(NamedTuple):
    """New values of some rows of a field of `State`.

    Attributes:
        field: The field.
        rows: The rows.
        values: Their values, the same in all worlds.
    """

    field: str
    rows: slice
    values: Array


def keyframe_of(body: BodyCore, name: str) -> BodyKeyframe:
    """A keyframe of a body by name.

    Raises:
        KeyError: There is none.
    """
    for keyframe in body.spec.keyframes:
        if keyframe.name == name:
            return keyframe
    known = ", ".join(repr(keyframe.name) for keyframe in body.spec.keyframes) or "none"
    raise KeyError(f"body {body.name!r} has no keyframe {name!r}; it has {known}")


def changes(body: BodyCore, keyframe: BodyKeyframe) -> list[Change]:
    """What a reset of a body to a keyframe writes."""
    found: list[Change] = []
    first = body.first_position
    inertial = body.spec.base.inertial_frame
    if keyframe.pose is not None:
        pose = compose(keyframe.pose, inertial)
        values = np.array([*pose.position, *pose.orientation])
        values[3:] /= np.sqrt(np.square(values[3:]).sum())
        found.append(Change("position", slice(first, first + BASE_POSITIONS), values))
    start, count = first + BASE_POSITIONS, sum(body.position_count)
    if keyframe.positions is not None:
        positions = np.array(keyframe.positions, dtype=float)
        for row, number in zip(body.position_index, body.position_count, strict=True):
            if number == _QUATERNION:
                turn = positions[row - start : row - start + _QUATERNION]
                turn /= np.sqrt(np.square(turn).sum())
        found.append(Change("position", slice(start, start + count), positions))
    found.append(_velocities(body, keyframe))
    actuators = _following(body.rows.first["actuator"], body.rows.count["actuator"])
    for field, values in (("control", keyframe.controls), ("activation", keyframe.activations)):
        filled = np.zeros(body.rows.count["actuator"]) if values is None else np.array(values, dtype=float)
        found.append(Change(f"actuator_{field}", actuators, filled))
    found.append(Change("actuator_force", actuators, np.zeros(body.rows.count["actuator"])))
    for axis, field in _CLEARED:
        rows = _following(body.rows.first[axis], body.rows.count[axis])
        found.append(Change(field, rows, np.zeros(1)))
    found.append(Change("tree_last_step", slice(body.rows.tree, body.rows.tree + 1), np.zeros(1)))
    return found


def _velocities(body: BodyCore, keyframe: BodyKeyframe) -> Change:
    """Velocities of the base's centre of mass and of the joints."""
    angular = np.array(keyframe.angular_velocity or (0.0, 0.0, 0.0))
    linear = np.array(keyframe.linear_velocity or (0.0, 0.0, 0.0))
    if keyframe.pose is not None and keyframe.linear_velocity is not None:
        center = compose(keyframe.pose, body.spec.base.inertial_frame).position
        lever = np.array(center) - np.array(keyframe.pose.position)
        linear = linear + np.cross(angular, lever)
    joints = keyframe.velocities or (0.0,) * sum(body.velocity_count)
    rows = _following(body.first_velocity, BASE_VELOCITIES + sum(body.velocity_count))
    return Change("dof_velocity", rows, np.array([*angular, *linear, *joints]))


def captured(body: BodyCore, name: str, time: float) -> BodyKeyframe:
    """The present state of a body as a keyframe."""
    state = {field: array[0] for field, array in body.world.arrays.state.numpy.items()}
    first = body.first_position
    x, y, z, qx, qy, qz, qw = state["position"][first : first + BASE_POSITIONS].tolist()
    pose = compose(Pose((x, y, z), (qx, qy, qz, qw)), inverse(body.spec.base.inertial_frame))
    velocity = state["dof_velocity"][body.first_velocity :][: BASE_VELOCITIES + sum(body.velocity_count)]
    angular, linear = velocity[:3], velocity[3:BASE_VELOCITIES]
    origin = linear + np.cross(angular, np.array(pose.position) - np.array((x, y, z)))
    positions = state["position"][first + BASE_POSITIONS :][: sum(body.position_count)]
    actuators = _following(body.rows.first["actuator"], body.rows.count["actuator"])
    return BodyKeyframe(
        name,
        time,
        pose,
        tuple(origin.tolist()),
        tuple(angular.tolist()),
        tuple(positions.tolist()),
        tuple(velocity[BASE_VELOCITIES:].tolist()),
        tuple(state["actuator_control"][actuators].tolist()),
        tuple(state["actuator_activation"][actuators].tolist()),
    )


def check_keyframe(body: BodyCore, keyframe: BodyKeyframe) -> None:
    """Raise `DescriptionError` unless a keyframe fits a body."""
    actuators = len(body.spec.actuators)
    keyframe.check(sum(body.position_count), sum(body.velocity_count), actuators)


def _following(first: int, count: int) -> slice:
    return slice(first, first + count)
