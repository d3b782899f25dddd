"""Writing a description as a URDF file."""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import fields
from math import copysign, hypot, pi
from pathlib import Path
from xml.sax.saxutils import escape, quoteattr

from carom.description import (
    Collision,
    ContactParameters,
    Geometry,
    Inertial,
    Joint,
    JointLimit,
    Link,
    Material,
    Mesh,
    Pose,
    Robot,
    SignedDistanceField,
    Visual,
)
from carom.description.joint import JOINTS, STILL
from carom.description.pose import IDENTITY, Quaternion, Vector3
from carom.description.transform import quaternion_from_rpy, rotation_matrix
from carom.errors import DescriptionError
from carom.formats.robot.common_joints import with_common_joints
from carom.native.trigonometry import atan2

# Angles are rounded to fewer decimals than this if that is exact; otherwise all their digits are written.
_DIGITS = 16
_GIMBAL_LOCK = 1e-10
"""Cosine of the pitch below which roll and yaw are about the same axis (gimbal lock)."""

_UNNAMED = "material"


def urdf_text(robot: Robot, folder: Path) -> str:
    """The URDF text of a robot; `read_urdf` reads the same robot from it, except for rounding errors.

    Paths of meshes and textures are relative to the folder of the file.

    Raises:
        DescriptionError: It has a shape that URDF does not have, or is a soft body.
    """
    if robot.deformable is not None:
        raise DescriptionError("soft bodies are not written as URDF", file=robot.source)
    return "\n".join(['<?xml version="1.0"?>', *_Writer(with_common_joints(robot), folder).lines(), ""])


class _Writer:
    def __init__(self, robot: Robot, folder: Path) -> None:
        self.robot = robot
        self.folder = folder

    def lines(self) -> Iterator[str]:
        yield f"<robot name={quoteattr(self.robot.name)}>"
        yield from _user_data(self.robot.user_data, 1)
        for link in self.robot.links:
            yield from self._link(link)
        for joint in self.robot.joints:
            yield from self._joint(joint)
        yield "</robot>"

    def _link(self, link: Link) -> Iterator[str]:
        yield f"  <link name={quoteattr(link.name)}>"
        yield from _inertial(link.inertial)
        yield from _contact(link.contact)
        for visual in link.visuals:
            yield from self._visual(link, visual)
        for collision in link.collisions:
            yield from self._collision(link, collision)
        yield from _user_data(link.user_data, 2)
        yield "  </link>"

    def _visual(self, link: Link, visual: Visual) -> Iterator[str]:
        yield f"    <visual{_attribute('name', visual.name or None)}>"
        yield from _origin(visual.frame, 3)
        yield f"      <geometry>{self._geometry(link, visual.geometry)}</geometry>"
        if visual.material is not None:
            yield from self._material(visual.material)
        yield from _user_data(visual.user_data, 3)
        yield "    </visual>"

    def _collision(self, link: Link, collision: Collision) -> Iterator[str]:
        is_concave = isinstance(collision.geometry, Mesh) and collision.geometry.concave
        attributes = (
            ("name", collision.name or None),
            ("group", collision.group),
            ("mask", collision.mask),
            ("concave", "yes" if is_concave else None),
        )
        yield f"    <collision{''.join(_attribute(*pair) for pair in attributes)}>"
        yield from _origin(collision.frame, 3)
        yield f"      <geometry>{self._geometry(link, collision.geometry)}</geometry>"
        yield "    </collision>"

    def _geometry(self, link: Link, geometry: Geometry) -> str:
        match geometry:
            case Mesh(path, scale):
                return f'<mesh filename={self._file(path)} scale="{_numbers(scale)}"/>'
            case SignedDistanceField(path):
                return f"<cdf filename={self._file(path)}/>"
            case _ if geometry.tag:
                stated = "".join(
                    f' {it.stated}="{_numbers(numbers)}"' for it, numbers in geometry.stated().items()
                )
                return f"<{geometry.tag}{stated}/>"
            case _:
                raise DescriptionError(
                    f"link {link.name!r} has a shape that URDF does not have: {type(geometry).__name__}",
                    file=self.robot.source,
                )

    def _material(self, material: Material) -> Iterator[str]:
        yield f"      <material name={quoteattr(material.name or _UNNAMED)}>"
        if material.rgba is not None:
            yield f'        <color rgba="{_numbers(material.rgba)}"/>'
        if material.specular is not None:
            yield f'        <specular rgb="{_numbers(material.specular)}"/>'
        if material.texture is not None:
            yield f"        <texture filename={self._file(material.texture)}/>"
        yield "      </material>"

    def _file(self, path: Path) -> str:
        """Path of a file relative to the folder, quoted."""
        try:
            name = os.path.relpath(path, self.folder)
        except ValueError:  # another drive
            name = os.path.abspath(path)
        return quoteattr(Path(name).as_posix())

    def _joint(self, joint: Joint) -> Iterator[str]:
        limit = joint.limit
        yield f'  <joint name={quoteattr(joint.name)} type="{JOINTS[joint.type].urdf}">'
        yield from _origin(joint.frame, 2)
        yield f"    <parent link={quoteattr(self.robot.links[joint.parent].name)}/>"
        yield f"    <child link={quoteattr(self.robot.links[joint.child].name)}/>"
        moves = joint.type not in STILL
        if moves:
            x, y, z = (component * joint.axis_length for component in joint.axis)
            yield f'    <axis xyz="{_numbers((x, y, z))}"/>'
        if moves or limit != JointLimit():
            yield (
                f'    <limit lower="{limit.lower!r}" upper="{limit.upper!r}" effort="{limit.effort!r}" '
                f'velocity="{limit.velocity!r}" twist="{limit.twist!r}"/>'
            )
        if joint.damping or joint.friction:
            yield f'    <dynamics damping="{joint.damping!r}" friction="{joint.friction!r}"/>'
        if joint.mimic is not None:
            yield (
                f"    <mimic joint={quoteattr(joint.mimic.joint)} "
                f'multiplier="{joint.mimic.multiplier!r}" offset="{joint.mimic.offset!r}"/>'
            )
        if joint.safety is not None:
            safety = joint.safety
            yield (
                f'    <safety_controller soft_lower_limit="{safety.soft_lower!r}" '
                f'soft_upper_limit="{safety.soft_upper!r}" '
                f'k_position="{safety.k_position!r}" k_velocity="{safety.k_velocity!r}"/>'
            )
        yield "  </joint>"


def _inertial(inertial: Inertial) -> Iterator[str]:
    names = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
    moments = " ".join(f'{name}="{value!r}"' for name, value in zip(names, inertial.tensor, strict=True))
    yield "    <inertial>"
    yield from _origin(inertial.frame, 3)
    yield f'      <mass value="{inertial.mass!r}"/>'
    yield f"      <inertia {moments}/>"
    yield "    </inertial>"


def _contact(contact: ContactParameters) -> Iterator[str]:
    contact = contact.without_rank()
    values = {field.name: getattr(contact, field.name) for field in fields(contact)}
    values.pop("friction_anchor")
    values.pop("friction_rank")
    values.pop("friction_dimensions")
    values.pop("compliance")
    values.pop("surface_motion")
    stated = {name: value for name, value in values.items() if value is not None}
    if not stated and not contact.friction_anchor:
        return
    yield "    <contact>"
    for name, value in stated.items():
        yield f'      <{name} value="{value!r}"/>'
    if contact.friction_anchor:
        yield "      <friction_anchor/>"
    yield "    </contact>"


def _user_data(pairs: dict[str, str], depth: int) -> Iterator[str]:
    indent = "  " * depth
    if pairs:
        yield f"{indent}<bullet>"
        for key, value in pairs.items():
            yield f"{indent}  <user-data key={quoteattr(key)}>{escape(value)}</user-data>"
        yield f"{indent}</bullet>"


def _origin(pose: Pose, depth: int) -> Iterator[str]:
    if pose != IDENTITY:
        angles = roll_pitch_yaw(pose.orientation)
        yield f'{"  " * depth}<origin xyz="{_numbers(pose.position)}" rpy="{_numbers(angles)}"/>'


def roll_pitch_yaw(quaternion: Quaternion) -> Vector3:
    """Angles about the fixed axes x, y and z [rad]; yaw is 0 in gimbal lock.

    They are rounded to the fewest decimals that give exactly the same quaternion, if any do. The last digit
    matters: inertias depend on whether a shape lies exactly in the inertial frame.
    """
    angles = _angles(quaternion)
    for digits in range(_DIGITS):
        rounded = (round(angles[0], digits), round(angles[1], digits), round(angles[2], digits))
        if quaternion_from_rpy(*rounded) == quaternion:
            return rounded
    return angles


def _angles(quaternion: Quaternion) -> Vector3:
    m = rotation_matrix(quaternion)
    level = hypot(m[0][0], m[1][0])
    if level < _GIMBAL_LOCK:
        return (atan2(-m[1][2], m[1][1]), copysign(0.5 * pi, -m[2][0]), 0.0)
    return (atan2(m[2][1], m[2][2]), atan2(-m[2][0], level), atan2(m[1][0], m[0][0]))


def _attribute(name: str, value: object) -> str:
    return "" if value is None else f" {name}={quoteattr(str(value))}"


def _numbers(values: tuple[float, ...]) -> str:
    return " ".join(repr(float(value)) for value in values)
