"""Sensors for `Body.add_sensor`: one class for each kind, all with the same parameters of quality."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, ClassVar, TypedDict

from carom.description.pose import Vector3
from carom.description.sensor import ContactReduction, RangeImage, SensorKind, SensorObject, SensorSpec

if TYPE_CHECKING:
    from typing_extensions import Unpack


class Quality(TypedDict, total=False):
    """Parameters that all sensors have; see `SensorSpec`."""

    noise: float
    bias: float | tuple[float, ...]
    cutoff: float
    delay: float
    period: float
    samples: int
    seed: int


class Sensor:
    """Base of all sensors: a `SensorSpec` without a name.

    Args:
        object_type: What its object is.
        object: Name of the object.
        **parameters: Other fields of `SensorSpec`; `bias` may be one number.
    """

    __slots__ = ("_spec",)
    kind: ClassVar[SensorKind]

    def __init__(self, object_type: SensorObject, object: str, **parameters: Any) -> None:
        bias = parameters.get("bias", ())
        parameters["bias"] = (float(bias),) if isinstance(bias, (int, float)) else tuple(bias)
        self._spec = SensorSpec("", self.kind, object_type, object, **parameters)

    def __repr__(self) -> str:
        spec = self._spec
        relative = f" from {spec.reference_type.value} {spec.reference!r}" if spec.reference else ""
        return f"<{type(self).__name__} of {spec.object_type.value} {spec.object!r}{relative}>"

    def spec(self, name: str) -> SensorSpec:
        """The sensor as data, with a name."""
        return replace(self._spec, name=name)


class _SiteSensor(Sensor):
    __slots__ = ()

    def __init__(self, site: str, **quality: Unpack[Quality]) -> None:
        super().__init__(SensorObject.SITE, site, **quality)


class Touch(_SiteSensor):
    """Sum of the normal forces [N] of contacts of the site's link that lie in the volume of the site."""

    __slots__ = ()
    kind = SensorKind.TOUCH


class Accelerometer(_SiteSensor):
    """Acceleration of the site less gravity, in its axes [m/s²]: mean over the last step."""

    __slots__ = ()
    kind = SensorKind.ACCELEROMETER


class Velocimeter(_SiteSensor):
    """Velocity of the site in its axes [m/s]."""

    __slots__ = ()
    kind = SensorKind.VELOCIMETER


class Gyro(_SiteSensor):
    """Angular velocity of the site in its axes [rad/s]."""

    __slots__ = ()
    kind = SensorKind.GYRO


class Force(_SiteSensor):
    """Force [N] of the link's parent on the link, at the site, in its axes."""

    __slots__ = ()
    kind = SensorKind.FORCE


class Torque(_SiteSensor):
    """Torque [N m] of the link's parent on the link, about the site, in its axes."""

    __slots__ = ()
    kind = SensorKind.TORQUE


class Magnetometer(Sensor):
    """The magnetic field of the world in the axes of the site."""

    __slots__ = ()
    kind = SensorKind.MAGNETOMETER

    def __init__(
        self, site: str, *, magnetic_field: Vector3 = (0.0, -0.5, 0.0), **quality: Unpack[Quality]
    ) -> None:
        super().__init__(SensorObject.SITE, site, magnetic_field=magnetic_field, **quality)


class RangeFinder(Sensor):
    """Distance [m] along z of the site to the next surface of another link; -1 if none is within reach.

    Args:
        site: The site.
        reach: How far it sees [m].
        shows: What is shown of each ray, some of `dist`, `dir`, `origin`, `point`, `normal` and `depth`, in
            this order: its length, its direction, its start, where it ends and the normal there, in the
            world, and the depth along the optical axis.
        image: Rays through the pixels of an image, row by row from the top left, instead of one; it looks
            along -z of the site, with y up.
        **quality: Noise, delay and so on.
    """

    __slots__ = ()
    kind = SensorKind.RANGE_FINDER

    def __init__(
        self,
        site: str,
        *,
        reach: float = 1000.0,
        shows: Sequence[str] = ("dist",),
        image: RangeImage | None = None,
        **quality: Unpack[Quality],
    ) -> None:
        super().__init__(SensorObject.SITE, site, reach=reach, shows=tuple(shows), image=image, **quality)


class _JointSensor(Sensor):
    __slots__ = ()

    def __init__(self, joint: str, **quality: Unpack[Quality]) -> None:
        super().__init__(SensorObject.JOINT, joint, **quality)


class JointPosition(_JointSensor):
    """Position of a revolute or prismatic joint [rad or m]."""

    __slots__ = ()
    kind = SensorKind.JOINT_POSITION


class JointVelocity(_JointSensor):
    """Velocity of a revolute or prismatic joint [rad/s or m/s]."""

    __slots__ = ()
    kind = SensorKind.JOINT_VELOCITY


class JointActuatorForce(_JointSensor):
    """Sum of the forces of all actuators on a joint [N m or N].

    Those of actuators of tendons and sites count by their moment arms.
    """

    __slots__ = ()
    kind = SensorKind.JOINT_ACTUATOR_FORCE


class BallQuaternion(_JointSensor):
    """Rotation of a spherical joint, quaternion (x, y, z, w)."""

    __slots__ = ()
    kind = SensorKind.BALL_QUATERNION


class BallAngularVelocity(_JointSensor):
    """Angular velocity of a spherical joint in the axes of its link [rad/s]."""

    __slots__ = ()
    kind = SensorKind.BALL_ANGULAR_VELOCITY


class JointLimitPosition(_JointSensor):
    """Distance of a joint to the limit that it has passed [rad or m], negative; 0 within its limits."""

    __slots__ = ()
    kind = SensorKind.JOINT_LIMIT_POSITION


class JointLimitVelocity(_JointSensor):
    """Rate of the distance of a joint to the limit that it has passed [rad/s or m/s]; 0 within its limits."""

    __slots__ = ()
    kind = SensorKind.JOINT_LIMIT_VELOCITY


class JointLimitForce(_JointSensor):
    """Force of the limit of a joint in the last substep [N m or N]."""

    __slots__ = ()
    kind = SensorKind.JOINT_LIMIT_FORCE


class _ActuatorSensor(Sensor):
    __slots__ = ()

    def __init__(self, actuator: str, **quality: Unpack[Quality]) -> None:
        super().__init__(SensorObject.ACTUATOR, actuator, **quality)


class ActuatorPosition(_ActuatorSensor):
    """Length of an actuator."""

    __slots__ = ()
    kind = SensorKind.ACTUATOR_POSITION


class ActuatorVelocity(_ActuatorSensor):
    """Rate of the length of an actuator."""

    __slots__ = ()
    kind = SensorKind.ACTUATOR_VELOCITY


class ActuatorForce(_ActuatorSensor):
    """Force of an actuator in the last substep."""

    __slots__ = ()
    kind = SensorKind.ACTUATOR_FORCE


class _TendonSensor(Sensor):
    __slots__ = ()

    def __init__(self, tendon: str, **quality: Unpack[Quality]) -> None:
        super().__init__(SensorObject.TENDON, tendon, **quality)


class TendonPosition(_TendonSensor):
    """Length of a tendon [m]; of one over joints their weighted sum."""

    __slots__ = ()
    kind = SensorKind.TENDON_POSITION


class TendonVelocity(_TendonSensor):
    """Rate of the length of a tendon [m/s]."""

    __slots__ = ()
    kind = SensorKind.TENDON_VELOCITY


class TendonActuatorForce(_TendonSensor):
    """Sum of the forces of a tendon's actuators in the last substep, whatever their gears [N]."""

    __slots__ = ()
    kind = SensorKind.TENDON_ACTUATOR_FORCE


class _FrameSensor(Sensor):
    """Base of sensors of a frame: exactly one of `site`, `link`, `inertial_frame` names it.

    Args:
        site: A site.
        link: A link, for its frame.
        inertial_frame: A link, for its centre of mass and principal axes.
        reference_site: The frame that it is seen from, likewise; the world without any.
        reference_link: Likewise.
        reference_inertial_frame: Likewise.
        reference_body: Name of the body of the reference; empty for the body of the sensor.
        **quality: Parameters that all sensors have.

    Raises:
        TypeError: No frame, or more than one, is named.
    """

    __slots__ = ()

    def __init__(
        self,
        *,
        site: str | None = None,
        link: str | None = None,
        inertial_frame: str | None = None,
        reference_site: str | None = None,
        reference_link: str | None = None,
        reference_inertial_frame: str | None = None,
        reference_body: str = "",
        **quality: Unpack[Quality],
    ) -> None:
        what = _one_of("", site, link, inertial_frame)
        if what is None:
            raise TypeError(f"{type(self).__name__} needs a site, a link or an inertial_frame")
        origin = _one_of("reference_", reference_site, reference_link, reference_inertial_frame)
        reference_type, reference = origin or (SensorObject.NONE, "")
        super().__init__(
            *what,
            reference_type=reference_type,
            reference=reference,
            reference_body=reference_body,
            **quality,
        )


def _one_of(prefix: str, *names: str | None) -> tuple[SensorObject, str] | None:
    kinds = (SensorObject.SITE, SensorObject.LINK, SensorObject.INERTIAL_FRAME)
    given = [(kind, name) for kind, name in zip(kinds, names, strict=True) if name is not None]
    if len(given) > 1:
        raise TypeError(f"only one of {prefix}site, {prefix}link and {prefix}inertial_frame can be given")
    return given[0] if given else None


class FramePosition(_FrameSensor):
    """Position of a frame [m]."""

    __slots__ = ()
    kind = SensorKind.FRAME_POSITION


class FrameQuaternion(_FrameSensor):
    """Orientation of a frame, quaternion (x, y, z, w)."""

    __slots__ = ()
    kind = SensorKind.FRAME_QUATERNION


class FrameXAxis(_FrameSensor):
    """The x axis of a frame."""

    __slots__ = ()
    kind = SensorKind.FRAME_X_AXIS


class FrameYAxis(_FrameSensor):
    """The y axis of a frame."""

    __slots__ = ()
    kind = SensorKind.FRAME_Y_AXIS


class FrameZAxis(_FrameSensor):
    """The z axis of a frame."""

    __slots__ = ()
    kind = SensorKind.FRAME_Z_AXIS


class FrameLinearVelocity(_FrameSensor):
    """Velocity of the origin of a frame [m/s]; of a reference: as seen by an observer that moves with it."""

    __slots__ = ()
    kind = SensorKind.FRAME_LINEAR_VELOCITY


class FrameAngularVelocity(_FrameSensor):
    """Angular velocity of a frame [rad/s], relative to that of the reference and in its axes."""

    __slots__ = ()
    kind = SensorKind.FRAME_ANGULAR_VELOCITY


class FrameLinearAcceleration(_FrameSensor):
    """Acceleration of the origin of a frame, gravity included [m/s²]: mean over the last step, world axes."""

    __slots__ = ()
    kind = SensorKind.FRAME_LINEAR_ACCELERATION


class FrameAngularAcceleration(_FrameSensor):
    """Angular acceleration of a frame [rad/s²]: mean over the last step, world axes."""

    __slots__ = ()
    kind = SensorKind.FRAME_ANGULAR_ACCELERATION


class _SubtreeSensor(Sensor):
    """Base of sensors of a link and all links after it."""

    __slots__ = ()

    def __init__(self, link: str, **quality: Unpack[Quality]) -> None:
        super().__init__(SensorObject.LINK, link, **quality)


class SubtreeCenterOfMass(_SubtreeSensor):
    """Centre of mass of a link and all links after it, world axes [m]."""

    __slots__ = ()
    kind = SensorKind.SUBTREE_CENTER_OF_MASS


class SubtreeLinearVelocity(_SubtreeSensor):
    """Velocity of this centre of mass, world axes [m/s]."""

    __slots__ = ()
    kind = SensorKind.SUBTREE_LINEAR_VELOCITY


class SubtreeLinearMomentum(_SubtreeSensor):
    """Linear momentum of a link and all links after it, world axes [kg m/s]."""

    __slots__ = ()
    kind = SensorKind.SUBTREE_LINEAR_MOMENTUM


class SubtreeAngularMomentum(_SubtreeSensor):
    """Their angular momentum about their centre of mass, world axes [kg m²/s]."""

    __slots__ = ()
    kind = SensorKind.SUBTREE_ANGULAR_MOMENTUM


class Clock(Sensor):
    """Simulated time [s]."""

    __slots__ = ()
    kind = SensorKind.CLOCK

    def __init__(self, **quality: Unpack[Quality]) -> None:
        super().__init__(SensorObject.NONE, "", **quality)


class ContactSensor(Sensor):
    """Contacts of something in the last step: how many, where, and how strong they are.

    Those count that have a force or are not apart. Each is seen from the object: `normal` points away from
    it, and a force is that of the object on what it touches, along the normal, `tangent`, and across both.
    A net force is in world axes, with its moment about the mean of the points, weighted by force.

    Args:
        site: Contacts whose points are in the volume of a site, whatever touches there.
        shape: Contacts of a shape.
        link: Those of all shapes of a link.
        subtree: Those of a link and of all links after it.
        other_shape: What is touched, likewise; anything without any. With a `site` contacts are seen
            towards it.
        other_link: Likewise.
        other_subtree: Likewise.
        other_body: Name of the body of what is touched; empty for the body of the sensor.
        fields: What is shown of each contact, in this order: `found`, how many there are, `force` [N],
            `torque` [N m], 0 but of a net force, `dist`, negative for penetration [m], `pos`, `normal` and
            `tangent`, in world axes.
        slots: How many contacts are shown at most; the numbers of those that are not there are 0.
        reduction: Which are shown: the first (`none`), the deepest (`mindist`), the strongest (`maxforce`),
            or one for all (`netforce`).
        **quality: Parameters that all sensors have; there is no cutoff.

    Raises:
        TypeError: There is no object, or more than one, or more than one other.
        ValueError: There is no such reduction.
    """

    __slots__ = ()
    kind = SensorKind.CONTACT

    def __init__(
        self,
        *,
        site: str | None = None,
        shape: str | None = None,
        link: str | None = None,
        subtree: str | None = None,
        other_shape: str | None = None,
        other_link: str | None = None,
        other_subtree: str | None = None,
        other_body: str = "",
        fields: tuple[str, ...] = ("found",),
        slots: int = 1,
        reduction: ContactReduction | str = ContactReduction.NONE,
        **quality: Unpack[Quality],
    ) -> None:
        own = _only((SensorObject.SITE, site), (SensorObject.SHAPE, shape), *_links(link, subtree))
        if own is None:
            raise TypeError("ContactSensor needs a site, a shape, a link or a subtree")
        other = _only((SensorObject.SHAPE, other_shape), *_links(other_link, other_subtree))
        reference_type, reference = other or (SensorObject.NONE, "")
        super().__init__(
            *own,
            reference_type=reference_type,
            reference=reference,
            reference_body=other_body,
            fields=tuple(fields),
            slots=slots,
            reduction=ContactReduction(reduction),
            **quality,
        )


class _DistanceSensor(Sensor):
    """Base of sensors of two sides, each a shape, all shapes of a link, or those of it and all after it.

    Args:
        shape: A shape.
        link: A link.
        subtree: A link, with all after it.
        other_shape: The other side, likewise.
        other_link: Likewise.
        other_subtree: Likewise.
        other_body: Name of the body of the other side; empty for the body of the sensor.
        reach: How far shapes may be apart, 0 or more [m].
        **quality: Parameters that all sensors have.

    Raises:
        TypeError: A side has nothing, or more than one thing.
    """

    __slots__ = ()

    def __init__(
        self,
        *,
        shape: str | None = None,
        link: str | None = None,
        subtree: str | None = None,
        other_shape: str | None = None,
        other_link: str | None = None,
        other_subtree: str | None = None,
        other_body: str = "",
        reach: float = 1000.0,
        **quality: Unpack[Quality],
    ) -> None:
        own = _only((SensorObject.SHAPE, shape), *_links(link, subtree))
        other = _only((SensorObject.SHAPE, other_shape), *_links(other_link, other_subtree))
        if own is None or other is None:
            name = type(self).__name__
            raise TypeError(f"{name} needs a shape, a link or a subtree, and such an other side")
        reference_type, reference = other
        super().__init__(
            *own,
            reference_type=reference_type,
            reference=reference,
            reference_body=other_body,
            reach=reach,
            **quality,
        )


class Distance(_DistanceSensor):
    """Distance of the nearest collision shapes of two sides [m]; negative if they overlap.

    Where nothing is within `reach` it is that.
    """

    __slots__ = ()
    kind = SensorKind.DISTANCE


class DistanceNormal(_DistanceSensor):
    """Direction in which `Distance` is measured: unit vector between the `DistancePoints`, world axes.

    It is from the first side to the other, but the other way where shapes overlap, since then so are the
    points. Where nothing is within `reach` it is 0.
    """

    __slots__ = ()
    kind = SensorKind.DISTANCE_NORMAL


class DistancePoints(_DistanceSensor):
    """The points between which `Distance` is measured: the first side's, then the other's, world axes [m].

    Where nothing is within `reach` they are 0.
    """

    __slots__ = ()
    kind = SensorKind.DISTANCE_POINTS


def _links(link: str | None, subtree: str | None) -> tuple[tuple[SensorObject, str | None], ...]:
    return (SensorObject.LINK, link), (SensorObject.SUBTREE, subtree)


def _only(*named: tuple[SensorObject, str | None]) -> tuple[SensorObject, str] | None:
    """The only one of some that is named; None if none is."""
    given = [(kind, name) for kind, name in named if name is not None]
    if len(given) > 1:
        names = ", ".join(kind.value for kind, _ in named)
        raise TypeError(f"only one of {names} can be given on each side")
    return given[0] if given else None
