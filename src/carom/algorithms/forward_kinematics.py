"""Forward kinematics: poses of links at given joint positions."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from carom.algorithms.nodes import joint_motion, vector_of
from carom.description.pose import IDENTITY, Pose, Quaternion
from carom.description.transform import compose, inverse
from carom.layouts.codes import BASE_POSITIONS
from carom.model.body_spec import BASE
from carom.native.gates import alone

if TYPE_CHECKING:
    from carom.scene.body import Body

Numbers = Sequence[float] | np.ndarray


@alone("world.call_lock")
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


@alone("world.call_lock")
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
        joint = Pose(vector_of(model["link_pivot_in_parent"][row]), _turn(model["link_joint_rotation"][row]))
        offset = Pose(vector_of(model["link_com_from_pivot"][row]))
        motion = joint_motion(body, each, numbers)
        pose = found[each] = compose(compose(compose(pose, joint), motion), offset)
    return pose


def _turn(row: np.ndarray) -> Quaternion:
    x, y, z, w = row.tolist()
    return x, y, z, w
