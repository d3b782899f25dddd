"""`<sensor>` of links and joints, as sites with sensors of Carom, and cameras."""

from __future__ import annotations

from math import pi

from carom.description import Joint, Pose
from carom.description.pose import IDENTITY
from carom.description.sensor import SensorKind, SensorObject, SensorSpec
from carom.description.transform import compose, inverse
from carom.files.xml_element import Element
from carom.formats.robot.context import shown
from carom.formats.sdf.context import SdfContext
from carom.formats.sdf.frames import Frames
from carom.formats.sdf.options import MAGNETIC_FIELD
from carom.formats.sdf.parts import Parts, Placed
from carom.formats.sdf.scene import Mount, SdfCamera, SdfModel
from carom.formats.sdf.tree import Part
from carom.native.trigonometry import atan2, cos, sin

_CAMERAS = ("camera", "depth", "depth_camera", "rgbd", "rgbd_camera")
_LIDARS = ("ray", "lidar", "gpu_ray", "gpu_lidar")
_POSITIONS = ("altimeter", "navsat", "gps")
_SETTINGS = ("always_on", "visualize", "topic", "enable_metrics", "frame_id")
_FIELD_OF_VIEW = 1.047
_WHOLE_LINK = 1e3
"""Radius [m] of a volume that holds all contacts of a link."""

# Of the axis that a range finder measures along, z, to that of a ray, x.
_ALONG_X = Pose((0.0, 0.0, 0.0), (0.0, 0.7071067811865476, 0.0, 0.7071067811865476))


def read_sensors(parts: Parts, model: SdfModel) -> None:
    """Give a model the sites, sensors and cameras of its links and joints.

    A sensor `imu` becomes `imu/acceleration` and so on, at a site of its own name. Raises
    `DescriptionError` if a number in one cannot be read.
    """
    for part, frames, name in parts.links_of:
        placed = Placed(frames, part, frames.of(part))
        prefix = name[: len(name) - len(part.element.attributes["name"])]
        for element in part.element.all("sensor"):
            _Sensor(part.context, element, model, prefix, name).of_link(placed(element))
    for part, frames, prefix, joint in parts.joints_of:
        for element in part.element.all("sensor"):
            link = parts.links[joint.child].name
            frame = _frame_of_joint(frames, part, prefix, parts, joint)
            _Sensor(part.context, element, model, prefix, link).of_joint(frame)


def _frame_of_joint(frames: Frames, part: Part, prefix: str, parts: Parts, joint: Joint) -> Pose:
    """Where a joint is in the frame of its child link."""
    child = next((frames.of(it) for it, of, name in parts.links_of
                  if of is frames and name == parts.links[joint.child].name), None)  # fmt: skip
    return IDENTITY if child is None else compose(inverse(child), frames.of(part))


class _Sensor:
    """Reads one `<sensor>`."""

    def __init__(
        self, context: SdfContext, element: Element, model: SdfModel, prefix: str, link: str
    ) -> None:
        self._context = context
        self._element = element
        self._model = model
        self._link = link
        taken = {it.name for it in (*model.mounts, *model.cameras)}
        name = prefix + context.required(element, "name")
        # Sensors of two links may have the same name.
        self._name = name if name not in taken else f"{link}::{name[len(prefix) :]}"
        self._specs: list[SensorSpec] = []

    def of_link(self, frame: Pose) -> None:
        """Read a sensor of a link, at a pose in its frame."""
        kind = self._context.required(self._element, "type")
        reach = 0.005
        if kind in _CAMERAS:
            self._camera(frame, kind)
            return
        if kind == "imu":
            self._imu()
        elif kind == "magnetometer":
            self._add("field", SensorKind.MAGNETOMETER, *self._noise(self._element.first("magnetometer")))
        elif kind == "contact":
            reach = self._contact()
        elif kind in _POSITIONS:
            self._position(kind)
        elif kind in _LIDARS:
            turned = self._ray(kind)
            if turned is None:
                return
            frame = compose(compose(frame, turned), _ALONG_X)
        else:
            self._missing(f"Carom has no sensor {shown(kind)}")
            return
        self._mount(frame, reach)

    def of_joint(self, frame: Pose) -> None:
        """Read a sensor of a joint, which is at a pose in the frame of its child link."""
        context = self._context
        kind = context.required(self._element, "type")
        if kind != "force_torque":
            self._missing(f"Carom has no sensor {shown(kind)} of joints")
            return
        stated = self._element.first("force_torque")
        at = None if stated is None else context.text(stated, "frame")
        way = None if stated is None else context.text(stated, "measure_direction")
        if (at or "child") == "sensor":
            frame = compose(frame, context.pose(self._element))
        elif at == "parent":
            context.leave_out(
                self._element, "it is in the axes of the child link", "sensors are on the link that they load"
            )
        if (way or "child_to_parent") != "parent_to_child":
            context.leave_out(
                self._element,
                "none: it shows the force of the parent on the child, with the opposite sign",
                "sensors have one direction",
            )
        for name, label in (("force", SensorKind.FORCE), ("torque", SensorKind.TORQUE)):
            self._add(name, label, *self._noise(None if stated is None else stated.first(name)))
        self._mount(frame, 0.005)

    def _missing(self, reason: str) -> None:
        self._context.leave_out_all(self._element, "the sensor is missing", reason)

    def _mount(self, frame: Pose, reach: float) -> None:
        for tag in _SETTINGS:
            self._element.first(tag)
        self._model.mounts.append(Mount(self._name, self._link, frame, reach, tuple(self._specs)))

    def _add(
        self,
        label: str,
        kind: SensorKind,
        noise: float = 0.0,
        bias: tuple[float, ...] = (),
        *,
        reach: float = 1000.0,
    ) -> None:
        rate = self._context.value(self._element, "update_rate", 0.0)
        period = 1.0 / rate if rate > 0.0 else 0.0
        self._specs.append(
            SensorSpec(
                f"{self._name}/{label}",
                kind,
                SensorObject.SITE,
                self._name,
                noise=noise,
                bias=bias if any(bias) else (),
                period=period,
                reach=reach,
                magnetic_field=MAGNETIC_FIELD,
            )
        )

    def _noise(self, owner: Element | None) -> tuple[float, tuple[float, ...]]:
        """Standard deviation and bias in the `<noise>` of three axes."""
        axes = [None if owner is None else owner.first(tag) for tag in ("x", "y", "z")]
        found = [self._one_noise(axis) for axis in axes]
        deviations = [deviation for deviation, _ in found]
        if len(set(deviations)) > 1 and owner is not None:
            self._context.leave_out(owner, "all axes have the noise of the first", "noise has no directions")
        return deviations[0], tuple(mean for _, mean in found)

    def _one_noise(self, owner: Element | None) -> tuple[float, float]:
        noise = None if owner is None else owner.first("noise")
        if noise is None or noise.attributes.get("type", "none") == "none":
            return 0.0, 0.0
        return abs(self._context.value(noise, "stddev", 0.0)), self._context.value(noise, "mean", 0.0)

    def _imu(self) -> None:
        imu = self._element.first("imu")
        turn, push = (
            self._noise(None if imu is None else imu.first(tag))
            for tag in ("angular_velocity", "linear_acceleration")
        )
        self._add("acceleration", SensorKind.ACCELEROMETER, *push)
        self._add("angular_velocity", SensorKind.GYRO, *turn)
        if imu is None or self._context.says(imu, "enable_orientation", default=True):
            self._add("orientation", SensorKind.FRAME_QUATERNION)

    def _contact(self) -> float:
        stated = self._element.first("contact")
        if stated is not None and stated.first("collision") is not None:
            self._context.leave_out(
                stated.first("collision") or stated,
                "none, or contacts of other shapes of the link count as well",
                "contacts are those of a link",
            )
        self._add("force", SensorKind.TOUCH)
        return _WHOLE_LINK

    def _position(self, kind: str) -> None:
        if kind != "altimeter":
            self._context.leave_out(
                self._element, "it shows metres in the world", "there are no coordinates of the earth"
            )
        self._add("position", SensorKind.FRAME_POSITION)
        self._add("velocity", SensorKind.FRAME_LINEAR_VELOCITY)

    def _ray(self, kind: str) -> Pose | None:
        """How the ray of a range finder is turned; None, which is reported, for a sensor of many rays."""
        context = self._context
        stated = self._element.first("lidar") or self._element.first("ray")
        if stated is None:
            self._missing(f"<{kind}> is not described")
            return None
        scan, reach = stated.first("scan"), stated.first("range")
        angles = []
        for tag in ("horizontal", "vertical"):
            lines = None if scan is None else scan.first(tag)
            if lines is not None and context.value(lines, "samples", 1.0) > 1.0:
                self._missing("sensors with many rays are not made from files; see World.rays")
                return None
            angles.append(0.0 if lines is None else context.value(lines, "min_angle", 0.0))
        far = 0.0 if reach is None else context.value(reach, "max", 0.0)
        noise = stated.first("noise")
        deviation = 0.0 if noise is None else abs(context.value(noise, "stddev", 0.0))
        mean = 0.0 if noise is None else context.value(noise, "mean", 0.0)
        self._add(
            "distance",
            SensorKind.RANGE_FINDER,
            deviation,
            (mean,),
            reach=far * context.scale if far > 0.0 else 1000.0,
        )
        yaw, pitch = (0.5 * angle for angle in angles)
        about_z = Pose((0.0, 0.0, 0.0), (0.0, 0.0, sin(yaw), cos(yaw)))
        return compose(about_z, Pose((0.0, 0.0, 0.0), (0.0, -sin(pitch), 0.0, cos(pitch))))

    def _camera(self, frame: Pose, kind: str) -> None:
        context = self._context
        camera = self._element.first("camera")
        for tag in _SETTINGS:
            self._element.first(tag)
        if self._element.first("update_rate") is not None:
            context.leave_out(
                self._element.first("update_rate") or self._element, "none: it sees when it is asked", kind
            )
        wide, width, height = _FIELD_OF_VIEW, 320, 240
        if camera is not None:
            wide = context.value(camera, "horizontal_fov", _FIELD_OF_VIEW)
            image = camera.first("image")
            if image is not None:
                width, height = (
                    int(context.value(image, tag, size)) for tag, size in (("width", 320), ("height", 240))
                )
            if camera.first("pose") is not None:
                frame = compose(frame, context.pose(camera))
        if not 0.0 < wide < pi or min(width, height) < 1:
            self._missing("its field of view or its resolution is none of a pinhole camera")
            return
        half = 0.5 * wide
        tall = 2.0 * atan2(sin(half) * height, cos(half) * width)
        self._model.cameras.append(
            SdfCamera(self._name, self._link, frame, tall * 180.0 / pi, (width, height))
        )
