"""What sensors measure, without noise, in all worlds of a source; see `carom.description.sensors`."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from carom.checks import Array
from carom.description.sensor import DISTANCE_KINDS, SensorKind, SensorSpec
from carom.scene.sensors.contacts import contacts
from carom.scene.sensors.distances import distances
from carom.scene.sensors.frames import motion, object_frame, placement, reference_frame
from carom.scene.sensors.joints import OF_JOINTS
from carom.scene.sensors.loads import OF_LOADS
from carom.scene.sensors.ranges import ranges
from carom.scene.sensors.source import Source
from carom.scene.sensors.subtrees import OF_SUBTREES
from carom.scene.sensors.vectors import conjugate, cross, product, turned, turned_back

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore

Measure = Callable[[Source, "BodyCore", SensorSpec], Array]


def measured(source: Source, body: BodyCore, spec: SensorSpec) -> Array:
    """What a sensor measures at present, (worlds, dim); not for kinds that only steps know.

    Raises:
        DescriptionError: It refers to something that does not exist.
    """
    return _BY_KIND[spec.kind](source, body, spec).reshape(source.count, spec.dim)


def _gyro(source: Source, body: BodyCore, spec: SensorSpec) -> Array:
    frame = object_frame(body, spec)
    return turned_back(placement(source, frame).orientation, motion(source, frame).angular)


def _velocimeter(source: Source, body: BodyCore, spec: SensorSpec) -> Array:
    frame = object_frame(body, spec)
    return turned_back(placement(source, frame).orientation, motion(source, frame).linear)


def _magnetometer(source: Source, body: BodyCore, spec: SensorSpec) -> Array:
    turn = placement(source, object_frame(body, spec)).orientation
    return turned_back(turn, np.array([spec.magnetic_field]))


def _position(source: Source, body: BodyCore, spec: SensorSpec) -> Array:
    place = placement(source, object_frame(body, spec))
    reference = reference_frame(source.bodies, body, spec)
    if reference is None:
        return place.position
    origin = placement(source, reference)
    return turned_back(origin.orientation, place.position - origin.position)


def _quaternion(source: Source, body: BodyCore, spec: SensorSpec) -> Array:
    turn = placement(source, object_frame(body, spec)).orientation
    reference = reference_frame(source.bodies, body, spec)
    return turn if reference is None else product(conjugate(placement(source, reference).orientation), turn)


def _axis(number: int) -> Measure:
    direction = np.eye(3)[number : number + 1]

    def measure(source: Source, body: BodyCore, spec: SensorSpec) -> Array:
        return turned(_quaternion(source, body, spec), direction)

    return measure


def _linear_velocity(source: Source, body: BodyCore, spec: SensorSpec) -> Array:
    frame, reference = object_frame(body, spec), reference_frame(source.bodies, body, spec)
    if reference is None:
        return motion(source, frame).linear
    position, velocity = placement(source, frame).position, motion(source, frame).linear
    origin, moving = placement(source, reference), motion(source, reference)
    carried = moving.linear + cross(moving.angular, position - origin.position)
    return turned_back(origin.orientation, velocity - carried)


def _angular_velocity(source: Source, body: BodyCore, spec: SensorSpec) -> Array:
    frame, reference = object_frame(body, spec), reference_frame(source.bodies, body, spec)
    if reference is None:
        return motion(source, frame).angular
    angular = motion(source, frame).angular
    moving = motion(source, reference).angular
    return turned_back(placement(source, reference).orientation, angular - moving)


def _clock(source: Source, body: BodyCore, spec: SensorSpec) -> Array:
    return source.times.copy()


_BY_KIND: dict[SensorKind, Measure] = {
    SensorKind.GYRO: _gyro,
    SensorKind.VELOCIMETER: _velocimeter,
    SensorKind.MAGNETOMETER: _magnetometer,
    SensorKind.RANGE_FINDER: ranges,
    SensorKind.FRAME_POSITION: _position,
    SensorKind.FRAME_QUATERNION: _quaternion,
    SensorKind.FRAME_X_AXIS: _axis(0),
    SensorKind.FRAME_Y_AXIS: _axis(1),
    SensorKind.FRAME_Z_AXIS: _axis(2),
    SensorKind.FRAME_LINEAR_VELOCITY: _linear_velocity,
    SensorKind.FRAME_ANGULAR_VELOCITY: _angular_velocity,
    SensorKind.CLOCK: _clock,
    SensorKind.CONTACT: contacts,
    **dict.fromkeys(DISTANCE_KINDS, distances),
    **OF_JOINTS,
    **OF_LOADS,
    **OF_SUBTREES,
}
