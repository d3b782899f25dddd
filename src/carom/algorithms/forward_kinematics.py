"""Forward kinematics: poses of links at given joint positions."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from carom.description.pose import IDENTITY, Pose, Quaternion, Vector3
from carom.description.transform import compose, inverse
from carom.layouts.codes import BASE_POSITIONS, JointCode
from carom.model.body_spec import BASE
from carom.native.trigonometry import cos, sin

if TYPE_CHECKING:
    from carom.scene.body import Body

Numbers = Sequence[float] | np.ndarray


def forward_kinematics(
    body: Body, positions: Numbers, links: Sequence[int] | None = None, *, in_base_frame: bool = False
) -> tuple[Pose, ...]:
    """Poses of link frames at joint positions of your choice; the body itself does not move.

    Args:
        body: The body, whose base stays where it is.
        positions: Joint positions in order, a quaternion (x, y, z, w) for each spherical joint.
        links: Indices of the links; -1 is the base. All links but the base by default.
        in_base_frame: Poses are in the inertial frame of the base instead of the world's.

    Returns:
        The pose of each link: its origin [m], and its unit quaternion (x, y, z, w).

    Raises:
        ValueError: The number of positions is wrong.
        IndexError: There is no such link.
    """
    asked = range(body.joint_count) if links is None else links
    inertial = inertial_poses(body, positions, asked, in_base_frame=in_base_frame)
    return tuple(
        compose(pose, inverse(body.link_inertial_frame(link)))
        for link, pose in zip(asked, inertial, strict=True)
    )


def inertial_poses(
    body: Body, positions: Numbers, links: Iterable[int], *, in_base_frame: bool = False
) -> list[Pose]:
    """Poses of inertial frames; arguments and errors are those of `forward_kinematics`."""
    numbers = [float(number) for number in positions]
    count = sum(body.position_count)
    if len(numbers) != count:
        raise ValueError(f"there are {len(numbers)} joint positions; {body.name!r} has {count}")
    found = {BASE: IDENTITY if in_base_frame else _base_pose(body)}
    return [_pose(body, link, numbers, found) for link in links]


def _base_pose(body: Body) -> Pose:
    first = body.first_position
    px, py, pz, qx, qy, qz, qw = body.world.position_memory[first : first + BASE_POSITIONS].tolist()
    return Pose((px, py, pz), (qx, qy, qz, qw))


def _pose(body: Body, link: int, numbers: list[float], found: dict[int, Pose]) -> Pose:
    """The pose of an inertial frame; it and those it depends on are added to `found`."""
    if not BASE <= link < body.joint_count:
        raise IndexError(f"there is no link {link}: {body.name!r} has links {BASE} to {body.joint_count - 1}")
    path = []
    while link not in found:
        path.append(link)
        link = body.spec.links[link].parent
    model = body.world.arrays.model.numpy
    pose = found[link]
    for each in reversed(path):
        row = body.first_link + 1 + each
        joint = Pose(_vector(model["link_pivot_in_parent"][row]), _turn(model["link_joint_rotation"][row]))
        offset = Pose(_vector(model["link_com_from_pivot"][row]))
        motion = _motion(body, each, numbers)
        pose = found[each] = compose(compose(compose(pose, joint), motion), offset)
    return pose


def _motion(body: Body, link: int, numbers: list[float]) -> Pose:
    """The motion of a joint, in its frame with the axes of the link's inertial frame."""
    first = sum(body.position_count[:link])
    q = numbers[first : first + body.position_count[link]]
    model, row = body.world.arrays.model.numpy, body.first_link + 1 + link
    match body.joint_types[link]:
        case JointCode.REVOLUTE:
            return Pose(orientation=_rotation(_vector(model["link_unit_axis"][row]), q[0]))
        case JointCode.PRISMATIC:
            x, y, z = _vector(model["link_axis"][row])
            return Pose((x * q[0], y * q[0], z * q[0]))
        case JointCode.SPHERICAL:
            x, y, z, w = q
            return Pose(orientation=(x, y, z, w))
        case JointCode.PLANAR:
            a = _vector(model["link_planar_axis1"][row])
            b = _vector(model["link_planar_axis2"][row])
            x, y, z = (a[k] * q[1] + b[k] * q[2] for k in range(3))
            return Pose((x, y, z), _rotation(_vector(model["link_unit_axis"][row]), q[0]))
    return IDENTITY


def _rotation(axis: Vector3, angle: float) -> Quaternion:
    s = sin(0.5 * angle)
    return axis[0] * s, axis[1] * s, axis[2] * s, cos(0.5 * angle)


def _vector(row: np.ndarray) -> Vector3:
    x, y, z = row.tolist()
    return x, y, z


def _turn(row: np.ndarray) -> Quaternion:
    x, y, z, w = row.tolist()
    return x, y, z, w
