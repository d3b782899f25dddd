"""Sensors as data: what is measured, of which object, how well. `carom.description.sensors` has classes."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from math import ceil, inf

from carom.description.pose import Vector3
from carom.errors import DescriptionError


class SensorKind(Enum):
    """What a sensor measures; in MuJoCo's files the names are the same without underscores, if not noted."""

    # Of a site.
    TOUCH = "touch"
    ACCELEROMETER = "accelerometer"
    VELOCIMETER = "velocimeter"
    GYRO = "gyro"
    FORCE = "force"
    TORQUE = "torque"
    MAGNETOMETER = "magnetometer"
    RANGE_FINDER = "rangefinder"
    # Of a joint.
    JOINT_POSITION = "jointpos"
    JOINT_VELOCITY = "jointvel"
    JOINT_ACTUATOR_FORCE = "jointactuatorfrc"
    BALL_QUATERNION = "ballquat"
    BALL_ANGULAR_VELOCITY = "ballangvel"
    JOINT_LIMIT_POSITION = "jointlimitpos"
    JOINT_LIMIT_VELOCITY = "jointlimitvel"
    JOINT_LIMIT_FORCE = "jointlimitfrc"
    # Of an actuator.
    ACTUATOR_POSITION = "actuatorpos"
    ACTUATOR_VELOCITY = "actuatorvel"
    ACTUATOR_FORCE = "actuatorfrc"
    # Of a frame, in another frame.
    FRAME_POSITION = "framepos"
    FRAME_QUATERNION = "framequat"
    FRAME_X_AXIS = "framexaxis"
    FRAME_Y_AXIS = "frameyaxis"
    FRAME_Z_AXIS = "framezaxis"
    FRAME_LINEAR_VELOCITY = "framelinvel"
    FRAME_ANGULAR_VELOCITY = "frameangvel"
    FRAME_LINEAR_ACCELERATION = "framelinacc"
    FRAME_ANGULAR_ACCELERATION = "frameangacc"
    # Of a link and all links after it. MuJoCo has no sensor of linear momentum.
    SUBTREE_CENTER_OF_MASS = "subtreecom"
    SUBTREE_LINEAR_VELOCITY = "subtreelinvel"
    SUBTREE_LINEAR_MOMENTUM = "subtreelinmom"
    SUBTREE_ANGULAR_MOMENTUM = "subtreeangmom"
    # Of the world.
    CLOCK = "clock"
    # Of a tendon.
    TENDON_POSITION = "tendonpos"
    TENDON_VELOCITY = "tendonvel"
    TENDON_ACTUATOR_FORCE = "tendonactuatorfrc"
    # Of contacts of something with something else.
    CONTACT = "contact"
    # Of two sets of shapes: their distance, its direction, and the nearest points.
    DISTANCE = "distance"
    DISTANCE_NORMAL = "normal"
    DISTANCE_POINTS = "fromto"


class SensorObject(Enum):
    """What kind of thing the object or the reference of a sensor is.

    MuJoCo's `xbody` is a link, its `body` the inertial frame of one; of subtrees both mean the link. For
    frames of geoms and cameras, make a site at their place. Contacts and distances are those of a shape, of
    all shapes of a link, or of those of a link and all after it.
    """

    NONE = "none"
    SITE = "site"
    LINK = "link"
    INERTIAL_FRAME = "inertial frame"
    JOINT = "joint"
    ACTUATOR = "actuator"
    TENDON = "tendon"
    SHAPE = "shape"
    SUBTREE = "subtree"


class ContactReduction(Enum):
    """Which contacts a sensor of contacts shows, with the names of MuJoCo's files."""

    NONE = "none"
    NEAREST = "mindist"
    STRONGEST = "maxforce"
    NET_FORCE = "netforce"


CONTACT_FIELDS: dict[str, int] = {
    "found": 1, "force": 3, "torque": 3, "dist": 1, "pos": 3, "normal": 3, "tangent": 3,
}  # fmt: skip
"""What a sensor of contacts can show of each, in this order, and how many numbers that has."""
RANGE_FIELDS: dict[str, int] = {"dist": 1, "dir": 3, "origin": 3, "point": 3, "normal": 3, "depth": 1}
"""What a range finder can show of each ray, in this order, and how many numbers that has.

The distance to what it hits, its direction, where it begins, where it ends, and the normal of the surface
there, in the world, and how far that is along the optical axis. Without a hit, `dist` and `depth` are -1, the
others 0 but `origin`.
"""
MAX_RAYS = 1 << 22
_QUATERNIONS = (SensorKind.FRAME_QUATERNION, SensorKind.BALL_QUATERNION)
_AXES = (SensorKind.FRAME_X_AXIS, SensorKind.FRAME_Y_AXIS, SensorKind.FRAME_Z_AXIS)
POSITIVE: tuple[SensorKind, ...] = (SensorKind.TOUCH,)
DISTANCE_KINDS: tuple[SensorKind, ...] = (
    SensorKind.DISTANCE,
    SensorKind.DISTANCE_NORMAL,
    SensorKind.DISTANCE_POINTS,
)
UNBOUNDED: tuple[SensorKind, ...] = (*_QUATERNIONS, *_AXES, SensorKind.CONTACT, *DISTANCE_KINDS[1:])
"""Kinds with results of unit length, of several units or of points, to which no cutoff applies."""
_NUMBERS = (
    SensorKind.TOUCH,
    SensorKind.JOINT_POSITION,
    SensorKind.JOINT_VELOCITY,
    SensorKind.JOINT_ACTUATOR_FORCE,
    SensorKind.JOINT_LIMIT_POSITION,
    SensorKind.JOINT_LIMIT_VELOCITY,
    SensorKind.JOINT_LIMIT_FORCE,
    SensorKind.ACTUATOR_POSITION,
    SensorKind.ACTUATOR_VELOCITY,
    SensorKind.ACTUATOR_FORCE,
    SensorKind.CLOCK,
    SensorKind.TENDON_POSITION,
    SensorKind.TENDON_VELOCITY,
    SensorKind.TENDON_ACTUATOR_FORCE,
    SensorKind.DISTANCE,
)
OF_STEPS: tuple[SensorKind, ...] = (
    SensorKind.ACCELEROMETER,
    SensorKind.FRAME_LINEAR_ACCELERATION,
    SensorKind.FRAME_ANGULAR_ACCELERATION,
)
"""Kinds that are known only just after a step."""
SHORT_STEP = 1e-3
MAX_SAMPLES = 100_000
_SITE_KINDS = tuple(SensorKind)[:8]
_JOINT_KINDS = tuple(SensorKind)[8:16]
_ACTUATOR_KINDS = tuple(SensorKind)[16:19]
FRAME_KINDS: tuple[SensorKind, ...] = tuple(SensorKind)[19:28]
_TENDON_KINDS = (
    SensorKind.TENDON_POSITION,
    SensorKind.TENDON_VELOCITY,
    SensorKind.TENDON_ACTUATOR_FORCE,
)
SUBTREE_KINDS: tuple[SensorKind, ...] = tuple(SensorKind)[28:32]
_SIDES = (SensorObject.SHAPE, SensorObject.LINK, SensorObject.SUBTREE)


@dataclass(frozen=True, slots=True)
class RangeImage:
    """The rays of a range finder that is a camera: one through the middle of each pixel.

    It looks along -z of the site, with y up.

    Attributes:
        width: Number of columns.
        height: Number of rows.
        focal: Focal lengths, in widths and heights of the image; of parallel rays image sizes per metre.
        middle: Where the optical axis meets the image, from its top left corner, in its sizes.
        is_orthographic: Rays are parallel.
    """

    width: int
    height: int
    focal: tuple[float, float]
    middle: tuple[float, float] = (0.5, 0.5)
    is_orthographic: bool = False


@dataclass(frozen=True, slots=True)
class SensorSpec:
    """A sensor of a body.

    Attributes:
        name: Its name among the sensors of the body.
        kind: What it measures.
        object_type: What its object is.
        object: Name of the site, link, joint, actuator, tendon or shape of the body; empty for a clock.
        reference_type: Of sensors of frames: what they are seen from; NONE for the world. Of sensors of
            contacts: what the object touches; NONE for anything. Of distances: the other side.
        reference: Its name.
        reference_body: Name of the body that has it; empty for the same body.
        noise: Standard deviation of Gaussian noise that is added to each number of a sample.
        bias: Added to the numbers: one for each, one for all, or empty for none.
        cutoff: Bound of the absolute values, after bias and noise; 0 for none.
        delay: Time from a measurement until it is read [s].
        period: Time between measurements, held in between [s]; 0 for one at every step.
        samples: How many measurements are kept for the delay; 0 for as many as steps of 1 ms or longer need.
        seed: Of the noise; sensors with the same name and seed have the same noise.
        magnetic_field: Of magnetometers: in world axes.
        reach: Of range finders: how far they see [m]. Of distances: how far shapes may be apart, 0 or more;
            the distance of those that are further is this.
        fields: Of contacts: what is shown of each, names of `CONTACT_FIELDS` in their order.
        slots: Of contacts: how many are shown at most; the numbers of those that are not there are 0.
        reduction: Of contacts: which are shown.
        is_reversed: Of contacts: they are seen from what the object touches, and not from the object.
        shows: Of range finders: what is shown of each ray, names of `RANGE_FIELDS` in their order.
        image: Of range finders: their rays; None for one along z of the site.
    """

    name: str
    kind: SensorKind
    object_type: SensorObject = SensorObject.NONE
    object: str = ""
    reference_type: SensorObject = SensorObject.NONE
    reference: str = ""
    reference_body: str = ""
    noise: float = 0.0
    bias: tuple[float, ...] = ()
    cutoff: float = 0.0
    delay: float = 0.0
    period: float = 0.0
    samples: int = 0
    seed: int = 0
    magnetic_field: Vector3 = (0.0, -0.5, 0.0)
    reach: float = 1000.0
    fields: tuple[str, ...] = ("found",)
    slots: int = 1
    reduction: ContactReduction = ContactReduction.NONE
    is_reversed: bool = False
    shows: tuple[str, ...] = ("dist",)
    image: RangeImage | None = None

    @property
    def dim(self) -> int:
        """How many numbers it gives."""
        if self.kind is SensorKind.CONTACT:
            return self.slots * sum(CONTACT_FIELDS[name] for name in self.fields)
        if self.kind is SensorKind.RANGE_FINDER:
            rays = 1 if self.image is None else self.image.width * self.image.height
            return rays * sum(RANGE_FIELDS[name] for name in self.shows)
        if self.kind is SensorKind.DISTANCE_POINTS:
            return 6
        return 1 if self.kind in _NUMBERS else 4 if self.kind in _QUATERNIONS else 3

    @property
    def is_clocked(self) -> bool:
        """Whether it is measured at each step, and not when it is read."""
        return self.delay > 0.0 or self.period > 0.0

    @property
    def is_remembered(self) -> bool:
        """Whether it has a memory; without a clock it is not used, except by files of earlier versions."""
        return self.kind in OF_STEPS or self.is_clocked

    @property
    def kept(self) -> int:
        """Number of measurements in its memory."""
        if not self.is_remembered:
            return 0
        return self.samples or 1 if self.delay == 0.0 else self.samples or self._needed

    @property
    def _needed(self) -> int:
        return ceil(self.delay / max(self.period, SHORT_STEP)) + 2

    @property
    def memory(self) -> int:
        """Numbers in its memory: how many measurements it has, and of each its time and its numbers."""
        return 1 + self.kept * (1 + self.dim) if self.is_remembered else 0

    def check(self) -> None:
        """Raise `DescriptionError` unless object and parameters fit the kind."""
        allowed = objects_of(self.kind)
        if self.object_type not in allowed:
            raise self._error(f"measures a {' or '.join(it.value for it in allowed)}")
        if self.kind is SensorKind.CONTACT:
            if (
                list(self.fields) != [name for name in CONTACT_FIELDS if name in self.fields]
                or not self.fields
            ):
                raise self._error(f"shows some of {', '.join(CONTACT_FIELDS)}, in this order")
            if not 1 <= self.slots <= MAX_SAMPLES:
                raise self._error(f"shows from 1 to {MAX_SAMPLES} contacts, not {self.slots}")
        if self.kind is SensorKind.RANGE_FINDER:
            self._check_rays()
        others = _SIDES if self.kind is SensorKind.CONTACT else allowed
        relative = (*FRAME_KINDS, SensorKind.CONTACT, *DISTANCE_KINDS)
        if self.reference_type != SensorObject.NONE and (
            self.kind not in relative or self.reference_type not in others
        ):
            raise self._error(f"cannot be relative to a {self.reference_type.value}")
        if self.kind in DISTANCE_KINDS and self.reference_type is SensorObject.NONE:
            raise self._error(f"needs another {' or '.join(it.value for it in allowed)}")
        for name in ("noise", "cutoff", "delay", "period"):
            if not 0.0 <= getattr(self, name) < inf:
                raise self._error(f"needs a {name} of 0 or more, not {getattr(self, name):g}")
        if not 0.0 <= self.reach < inf or (self.reach == 0.0 and self.kind not in DISTANCE_KINDS):
            least = "of 0 or more" if self.kind in DISTANCE_KINDS else "greater than 0"
            raise self._error(f"needs a reach {least}, not {self.reach:g}")
        if not 0 <= self.samples <= MAX_SAMPLES or self.kept > MAX_SAMPLES:
            raise self._error(
                f"would keep {max(self.samples, self.kept)} measurements; {MAX_SAMPLES} are most"
            )
        if len(self.bias) not in (0, 1, self.dim):
            raise self._error(f"has {self.dim} numbers, but its bias has {len(self.bias)}")
        if not all(-inf < number < inf for number in (*self.bias, *self.magnetic_field)):
            raise self._error("needs a finite bias and magnetic field")

    def _check_rays(self) -> None:
        if list(self.shows) != [name for name in RANGE_FIELDS if name in self.shows] or not self.shows:
            raise self._error(f"shows some of {', '.join(RANGE_FIELDS)}, in this order")
        image = self.image
        if image is None:
            return
        if min(image.width, image.height) < 1 or image.width * image.height > MAX_RAYS:
            raise self._error(f"has an image of 1 to {MAX_RAYS} pixels, not {image.width} x {image.height}")
        if not all(0.0 < it < inf for it in image.focal) or not all(-inf < it < inf for it in image.middle):
            raise self._error("needs positive focal lengths and a finite middle of its image")

    def _error(self, problem: str) -> DescriptionError:
        return DescriptionError(f"sensor {self.name!r} of kind {self.kind.value} {problem}")


def objects_of(kind: SensorKind) -> tuple[SensorObject, ...]:
    """What the object of a sensor can be."""
    if kind in _SITE_KINDS:
        return (SensorObject.SITE,)
    if kind is SensorKind.CONTACT:
        return (SensorObject.SITE, *_SIDES)
    if kind in DISTANCE_KINDS:
        return _SIDES
    if kind in _JOINT_KINDS:
        return (SensorObject.JOINT,)
    if kind in _ACTUATOR_KINDS:
        return (SensorObject.ACTUATOR,)
    if kind in _TENDON_KINDS:
        return (SensorObject.TENDON,)
    if kind in FRAME_KINDS:
        return SensorObject.SITE, SensorObject.LINK, SensorObject.INERTIAL_FRAME
    return (SensorObject.LINK,) if kind in SUBTREE_KINDS else (SensorObject.NONE,)
