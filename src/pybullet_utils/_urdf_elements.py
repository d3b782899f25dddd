"""The elements of a robot in the URDF editor, and their URDF text."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any
from xml.sax.saxutils import quoteattr

import pybullet as p
from carom.description.pose import Quaternion
from carom.formats.urdf_writer import roll_pitch_yaw

Numbers = Sequence[float]

_JOINT_TYPES = {
    p.JOINT_FIXED: "fixed",
    p.JOINT_REVOLUTE: "revolute",
    p.JOINT_PRISMATIC: "prismatic",
    p.JOINT_SPHERICAL: "spherical",
}


class _Placed:
    """An element with a pose in the frame of a link.

    Attributes:
        origin_xyz: Position [m].
        origin_rpy: Orientation: roll, pitch and yaw [rad].
    """

    def __init__(self) -> None:
        self.origin_xyz: Numbers = (0.0, 0.0, 0.0)
        self.origin_rpy: Numbers = (0.0, 0.0, 0.0)

    def move(self, shift: Numbers, turn: Numbers) -> None:
        """Applies a transform of the link frame to the pose: translation [m] and quaternion (x, y, z, w)."""
        self.origin_xyz, self.origin_rpy = _moved(self.origin_xyz, self.origin_rpy, shift, turn)


class UrdfInertial(_Placed):
    """Mass [kg], principal moments of inertia [kg m²] and inertial frame."""

    def __init__(self) -> None:
        super().__init__()
        self.mass = 1.0
        self.inertia_xxyyzz: Numbers = (1.0, 1.0, 1.0)


class UrdfContact:
    """Friction coefficients of a link."""

    def __init__(self) -> None:
        self.lateral_friction = 1.0
        self.rolling_friction = 0.0
        self.spinning_friction = 0.0


class UrdfCollision(_Placed):
    """A collision shape.

    Attributes:
        geom_type: `GEOM_BOX`, `GEOM_SPHERE`, `GEOM_CYLINDER`, `GEOM_CAPSULE`, `GEOM_MESH` or `GEOM_PLANE`.
        geom_radius: Radius of a sphere, a cylinder or a capsule [m].
        geom_length: Length of a cylinder or a capsule, along z [m].
        geom_extents: Edge lengths of a box [m].
        geom_meshfilename: File of a mesh.
        geom_meshscale: Scale of the mesh along x, y and z.
    """

    def __init__(self) -> None:
        super().__init__()
        self.geom_type = p.GEOM_BOX
        self.geom_radius = 1.0
        self.geom_length = 2.0
        self.geom_extents: Numbers = (1.0, 1.0, 1.0)
        self.geom_meshfilename = "meshfile"
        self.geom_meshscale: Numbers = (1.0, 1.0, 1.0)

    @classmethod
    def of_shape(cls, shape: Sequence[Any], place: tuple[Numbers, Quaternion]) -> UrdfCollision:
        """The shape of an entry of `getCollisionShapeData`, at a pose in the link frame."""
        made = cls()
        made.origin_xyz, made.origin_rpy = place[0], roll_pitch_yaw(place[1])
        made._take(shape[2], shape[3], shape[4])
        return made

    def copy_geometry(self, other: UrdfCollision) -> None:
        """Copies the type and size of another shape, but not its pose."""
        self.geom_type, self.geom_radius, self.geom_length = (
            other.geom_type,
            other.geom_radius,
            other.geom_length,
        )
        self.geom_extents, self.geom_meshfilename, self.geom_meshscale = (
            other.geom_extents,
            other.geom_meshfilename,
            other.geom_meshscale,
        )

    def _take(self, kind: int, size: Numbers, file: bytes) -> None:
        self.geom_type = kind
        if kind == p.GEOM_BOX:
            self.geom_extents = size
        elif kind == p.GEOM_SPHERE:
            self.geom_radius = size[0]
        elif kind in (p.GEOM_CAPSULE, p.GEOM_CYLINDER):
            self.geom_length, self.geom_radius = size[0], size[1]
        elif kind == p.GEOM_MESH:
            self.geom_meshfilename, self.geom_meshscale = file.decode(), size


class UrdfVisual(UrdfCollision):
    """A visual shape.

    Attributes:
        material_rgba: Colour and opacity (red, green, blue, alpha), from 0 to 1.
        material_name: Name of the material.
    """

    def __init__(self) -> None:
        super().__init__()
        self.material_rgba: Numbers = (1.0, 0.0, 0.0, 1.0)
        self.material_name = ""

    @classmethod
    def of_seen(cls, shape: Sequence[Any], material: str) -> UrdfVisual:
        """The shape of an entry of `getVisualShapeData`."""
        made = cls()
        made.origin_xyz, made.origin_rpy = shape[5], roll_pitch_yaw(shape[6])
        made._take(shape[2], shape[3], shape[4])
        made.material_name, made.material_rgba = material, shape[7]
        return made


class UrdfLink:
    """A link: its name, its inertia and its shapes."""

    def __init__(self) -> None:
        self.link_name = "dummy"
        self.urdf_inertial = UrdfInertial()
        self.urdf_visual_shapes: list[UrdfVisual] = []
        self.urdf_collision_shapes: list[UrdfCollision] = []


class UrdfJoint:
    """A joint.

    Attributes:
        link: The child link.
        joint_name: Name of the joint.
        joint_type: `JOINT_REVOLUTE`, `JOINT_PRISMATIC`, `JOINT_FIXED` or `JOINT_SPHERICAL`.
        joint_lower_limit: Lower position limit [rad or m]; if it is above the upper one, there are none.
        joint_upper_limit: Upper position limit [rad or m].
        joint_max_force: Maximum torque or force [N m or N].
        joint_max_velocity: Maximum velocity [rad/s or m/s].
        parent_name: Name of the parent link.
        child_name: Name of the child link.
        joint_origin_xyz: Position in the frame of the parent link [m].
        joint_origin_rpy: Orientation in the frame of the parent link: roll, pitch and yaw [rad].
        joint_axis_xyz: Axis of rotation or translation.
    """

    def __init__(self) -> None:
        self.link = UrdfLink()
        self.joint_name = "joint_dummy"
        self.joint_type = p.JOINT_REVOLUTE
        self.joint_lower_limit = 0.0
        self.joint_upper_limit = -1.0
        self.joint_max_force = 0.0
        self.joint_max_velocity = 0.0
        self.parent_name = "parentName"
        self.child_name = "childName"
        self.joint_origin_xyz: Numbers = (0.0, 0.0, 0.0)
        self.joint_origin_rpy: Numbers = (0.0, 0.0, 0.0)
        self.joint_axis_xyz: Numbers = (0.0, 0.0, 1.0)

    def move(self, shift: Numbers, turn: Numbers) -> None:
        """Applies a transform of the parent link's frame: translation [m] and quaternion (x, y, z, w)."""
        self.joint_origin_xyz, self.joint_origin_rpy = _moved(
            self.joint_origin_xyz, self.joint_origin_rpy, shift, turn
        )


def link_element(link: UrdfLink, visuals: bool) -> str:
    """The URDF text of a link."""
    inertial = link.urdf_inertial
    ixx, iyy, izz = inertial.inertia_xxyyzz
    lines = [
        f"<link name={quoteattr(link.link_name)}>",
        "\t<inertial>",
        f"\t\t{_origin(inertial.origin_xyz, inertial.origin_rpy)}",
        f'\t\t<mass value="{inertial.mass!r}"/>',
        f'\t\t<inertia ixx="{ixx!r}" ixy="0" ixz="0" iyy="{iyy!r}" iyz="0" izz="{izz!r}"/>',
        "\t</inertial>",
    ]
    for shape in link.urdf_visual_shapes if visuals else ():
        material = [
            f"\t\t<material name={quoteattr(shape.material_name)}>",
            f'\t\t\t<color rgba="{_numbers(shape.material_rgba)}"/>',
            "\t\t</material>",
        ]
        lines += ["\t<visual>", *_shape(shape), *material, "\t</visual>"]
    for shape in link.urdf_collision_shapes:
        lines += ["\t<collision>", *_shape(shape), "\t</collision>"]
    return _indented([*lines, "</link>"])


def joint_element(joint: UrdfJoint) -> str:
    """The URDF text of a joint."""
    limited = joint.joint_type in (p.JOINT_REVOLUTE, p.JOINT_PRISMATIC)
    endless = joint.joint_type == p.JOINT_REVOLUTE and joint.joint_lower_limit > joint.joint_upper_limit
    kind = "continuous" if endless else _JOINT_TYPES.get(joint.joint_type, "fixed")
    lines = [
        f'<joint name={quoteattr(joint.joint_name)} type="{kind}">',
        f"\t<parent link={quoteattr(joint.parent_name)}/>",
        f"\t<child link={quoteattr(joint.child_name)}/>",
        f"\t{_origin(joint.joint_origin_xyz, joint.joint_origin_rpy)}",
        f'\t<axis xyz="{_numbers(joint.joint_axis_xyz)}"/>',
    ]
    if limited:
        lower, upper = float(joint.joint_lower_limit), float(joint.joint_upper_limit)
        bounds = "" if endless else f' lower="{lower!r}" upper="{upper!r}"'
        force, velocity = float(joint.joint_max_force), float(joint.joint_max_velocity)
        lines.append(f'\t<limit effort="{force!r}" velocity="{velocity!r}"{bounds}/>')
    return _indented([*lines, "</joint>"])


def _shape(shape: UrdfCollision) -> list[str]:
    kind = shape.geom_type
    if kind == p.GEOM_BOX:
        text = f'<box size="{_numbers(shape.geom_extents)}"/>'
    elif kind == p.GEOM_SPHERE:
        text = f'<sphere radius="{float(shape.geom_radius)!r}"/>'
    elif kind in (p.GEOM_CYLINDER, p.GEOM_CAPSULE):
        tag = "cylinder" if kind == p.GEOM_CYLINDER else "capsule"
        text = f'<{tag} length="{float(shape.geom_length)!r}" radius="{float(shape.geom_radius)!r}"/>'
    elif kind == p.GEOM_PLANE:
        text = '<plane normal="0 0 1"/>'
    else:
        file = quoteattr(shape.geom_meshfilename)
        text = f'<mesh filename={file} scale="{_numbers(shape.geom_meshscale)}"/>'
    return [
        f"\t\t{_origin(shape.origin_xyz, shape.origin_rpy)}",
        "\t\t<geometry>",
        f"\t\t\t{text}",
        "\t\t</geometry>",
    ]


def _origin(xyz: Numbers, rpy: Numbers) -> str:
    return f'<origin rpy="{_numbers(rpy)}" xyz="{_numbers(xyz)}"/>'


def _numbers(values: Numbers) -> str:
    return " ".join(repr(float(value)) for value in values)


def _indented(lines: list[str]) -> str:
    return "".join(f"\t{line}\n" for line in lines)


def _moved(xyz: Numbers, rpy: Numbers, shift: Numbers, turn: Numbers) -> tuple[Numbers, Numbers]:
    position, orientation = p.multiplyTransforms(shift, turn, xyz, p.getQuaternionFromEuler(rpy))
    return position, roll_pitch_yaw(orientation)
