"""What sensors of joints, actuators and tendons measure."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from carom.checks import Array
from carom.description.sensor import SensorKind, SensorSpec
from carom.errors import DescriptionError
from carom.layouts.codes import BALLS, DRIVEN, ConstraintKind
from carom.scene.sensors.source import Source
from carom.scene.sensors.vectors import turned
from carom.scene.tendons.making import tendon_of, transmission_of
from carom.scene.tendons.measure import measured, measured_wrench
from carom.scene.tendons.moment_arms import moment_arm, pulling

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore

_OF_BALLS = (SensorKind.BALL_QUATERNION, SensorKind.BALL_ANGULAR_VELOCITY)


def joint_of(body: BodyCore, spec: SensorSpec) -> int:
    """Index of the joint of a sensor.

    Raises:
        DescriptionError: There is no such joint, or the sensor is for another type of joint.
    """
    names = [link.joint_name for link in body.spec.links]
    if spec.object not in names:
        known = ", ".join(map(repr, names)) or "none"
        raise DescriptionError(f"sensor {spec.name!r}: there is no joint {spec.object!r}; there are {known}")
    joint = names.index(spec.object)
    wanted = BALLS if spec.kind in _OF_BALLS else DRIVEN
    if body.joint_types[joint] not in wanted:
        types = "spherical" if spec.kind in _OF_BALLS else "revolute, prismatic and screw"
        raise DescriptionError(
            f"sensor {spec.name!r} of kind {spec.kind.value} is for {types} joints; {spec.object!r} is "
            f"{body.spec.links[joint].joint_type.value}"
        )
    return joint


def actuator_of(body: BodyCore, spec: SensorSpec) -> int:
    """Index of the actuator of a sensor.

    Raises:
        DescriptionError: There is no such actuator.
    """
    names = [actuator.name for actuator in body.spec.actuators]
    if spec.object not in names:
        known = ", ".join(map(repr, names)) or "none"
        raise DescriptionError(
            f"sensor {spec.name!r}: there is no actuator {spec.object!r}; there are {known}"
        )
    return names.index(spec.object)


def _position(source: Source, body: BodyCore, spec: SensorSpec) -> Array:
    return source.state("position")[:, body.position_index[joint_of(body, spec)]].copy()


def _velocity(source: Source, body: BodyCore, spec: SensorSpec) -> Array:
    return source.state("dof_velocity")[:, body.velocity_index[joint_of(body, spec)]].copy()


def _actuators_force(source: Source, body: BodyCore, spec: SensorSpec) -> Array:
    first, total = body.rows.first["actuator"], np.zeros(source.count)
    lower, upper = np.full(source.count, -np.inf), np.full(source.count, np.inf)
    is_first = True
    for row, actuator in enumerate(body.spec.actuators, start=first):
        if actuator.joint == spec.object:
            total = total + source.parameter("actuator_gear", row) * source.state("actuator_force")[:, row]
            if is_first:
                lower, upper = (source.parameter(f"actuator_joint_{end}", row) for end in ("lower", "upper"))
                is_first = False
    total = np.minimum(np.maximum(total, lower), upper)
    joint = joint_of(body, spec)
    for transmission in pulling(body, joint):
        row = first + transmission.actuator
        force = source.parameter("actuator_gear", row) * source.state("actuator_force")[:, row]
        total = total + force * moment_arm(source, body, transmission, joint)
    return total


def _quaternion(source: Source, body: BodyCore, spec: SensorSpec) -> Array:
    first = body.position_index[joint_of(body, spec)]
    return source.state("position")[:, first : first + 4].copy()


def _ball_velocity(source: Source, body: BodyCore, spec: SensorSpec) -> Array:
    joint = joint_of(body, spec)
    first = body.velocity_index[joint]
    to_link = np.array([body.link_inertial_frame(joint).orientation])
    return turned(to_link, source.state("dof_velocity")[:, first : first + 3])


def _limit_distance(source: Source, body: BodyCore, spec: SensorSpec) -> tuple[Array, Array]:
    """Distance to the limit that is passed, else 0, and the sign of the velocity away from it, else 0."""
    joint = joint_of(body, spec)
    kinds, links = source.topology("constraint_kind"), source.topology("constraint_link")
    number = source.engine.arrays.used["constraint"]
    link = body.first_link + 1 + joint
    rows = np.flatnonzero((kinds[:number] == ConstraintKind.LIMIT) & (links[:number] == link))
    if not len(rows):
        return np.zeros(source.count), np.zeros(source.count)
    row = int(rows[0])
    position = source.state("position")[:, body.position_index[joint]]
    above = position - source.parameter("constraint_lower", row)
    below = source.parameter("constraint_upper", row) - position
    distance = np.minimum(np.minimum(above, below), 0.0)
    return distance, np.where(distance < 0.0, np.where(above <= below, 1.0, -1.0), 0.0)


def _limit_position(source: Source, body: BodyCore, spec: SensorSpec) -> Array:
    return _limit_distance(source, body, spec)[0]


def _limit_velocity(source: Source, body: BodyCore, spec: SensorSpec) -> Array:
    return _limit_distance(source, body, spec)[1] * _velocity(source, body, spec)


def _limit_force(source: Source, body: BodyCore, spec: SensorSpec) -> Array:
    impulse = source.state("dof_limit_impulse")[:, body.velocity_index[joint_of(body, spec)]]
    return np.abs(impulse) / source.parameters.substep_time


def _actuator_position(source: Source, body: BodyCore, spec: SensorSpec) -> Array:
    return along_actuator(source, body, actuator_of(body, spec))[0]


def _actuator_velocity(source: Source, body: BodyCore, spec: SensorSpec) -> Array:
    return along_actuator(source, body, actuator_of(body, spec))[1]


def along_actuator(source: Source, body: BodyCore, actuator: int) -> tuple[Array, Array]:
    """Length of an actuator of a body in each world, and its velocity, (count,) each."""
    spec = body.spec.actuators[actuator]
    gear = source.parameter("actuator_gear", body.rows.first["actuator"] + actuator)
    if spec.joint:
        joint = [link.joint_name for link in body.spec.links].index(spec.joint)
        position = source.state("position")[:, body.position_index[joint]]
        return gear * position, gear * source.state("dof_velocity")[:, body.velocity_index[joint]]
    if spec.link:
        return np.zeros(source.count), np.zeros(source.count)
    transmission = transmission_of(body, actuator)
    if transmission.is_wrench:
        origin = transmission.second_path[0] if transmission.second_path else None
        length, velocity = measured_wrench(source, body, transmission.path[0], origin, spec.wrench)
    else:
        length, velocity = measured(source, body, transmission.path)
    return gear * length, gear * velocity


def _actuator_force(source: Source, body: BodyCore, spec: SensorSpec) -> Array:
    return source.state("actuator_force")[:, body.rows.first["actuator"] + actuator_of(body, spec)].copy()


def _tendon_position(source: Source, body: BodyCore, spec: SensorSpec) -> Array:
    return measured(source, body, tendon_of(body, spec.object).path)[0]


def _tendon_velocity(source: Source, body: BodyCore, spec: SensorSpec) -> Array:
    return measured(source, body, tendon_of(body, spec.object).path)[1]


def _tendon_force(source: Source, body: BodyCore, spec: SensorSpec) -> Array:
    first = body.rows.first["actuator"]
    rows = [row for row, it in enumerate(body.spec.actuators, start=first) if it.tendon == spec.object]
    tendon_of(body, spec.object)
    return source.state("actuator_force")[:, rows].sum(axis=1)


OF_JOINTS: dict[SensorKind, Callable[[Source, BodyCore, SensorSpec], Array]] = {
    SensorKind.JOINT_POSITION: _position,
    SensorKind.JOINT_VELOCITY: _velocity,
    SensorKind.JOINT_ACTUATOR_FORCE: _actuators_force,
    SensorKind.BALL_QUATERNION: _quaternion,
    SensorKind.BALL_ANGULAR_VELOCITY: _ball_velocity,
    SensorKind.JOINT_LIMIT_POSITION: _limit_position,
    SensorKind.JOINT_LIMIT_VELOCITY: _limit_velocity,
    SensorKind.JOINT_LIMIT_FORCE: _limit_force,
    SensorKind.ACTUATOR_POSITION: _actuator_position,
    SensorKind.ACTUATOR_VELOCITY: _actuator_velocity,
    SensorKind.ACTUATOR_FORCE: _actuator_force,
    SensorKind.TENDON_POSITION: _tendon_position,
    SensorKind.TENDON_VELOCITY: _tendon_velocity,
    SensorKind.TENDON_ACTUATOR_FORCE: _tendon_force,
}
