"""Forward kinematics: poses of links at given joint positions."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from carom.algorithms.questions import asker_of, held_pose
from carom.algorithms.sweeps import Sweeps, link_numbers, sweeps_of
from carom.checks import Array, finite
from carom.description.pose import Pose
from carom.layouts.mechanism import LINK_POSE
from carom.native.gates import gated
from carom.native.kernel_builtins import Asker
from carom.native.kernels import link_frames_kernel

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore

Numbers = Sequence[float] | np.ndarray

_AT_ORIGIN = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)


def forward_kinematics(
    body: BodyCore, positions: Numbers, links: Sequence[int] | None = None, *, in_base_frame: bool = False
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
        ValueError: The number of positions is wrong, or one is not finite.
        IndexError: There is no such link.
    """
    frames = link_frames(body, positions, in_base_frame=in_base_frame)
    chosen = None if links is None else link_numbers(body, links)
    rows = frames[1:].tolist() if chosen is None else [frames[1 + link].tolist() for link in chosen]
    return tuple([Pose((x, y, z), (a, b, c, d)) for x, y, z, a, b, c, d in rows])


def link_frames(body: BodyCore, positions: Numbers, *, in_base_frame: bool = False) -> Array:
    """Those of all links, the base first: position before quaternion, (1 + links, 7)."""
    base = _AT_ORIGIN if in_base_frame else held_pose(body)
    found = asker_of(body, _asker)(base, positions)
    return _checked(body, positions, base) if found is None else found


def many_link_frames(body: BodyCore, positions: Array, bases: Array | None = None) -> Array:
    """The same at N states: (N, 1 + links, 7).

    Args:
        body: The body.
        positions: Joint positions, (N, coordinates).
        bases: Poses of the base's inertial frame, (N, 7); the present one by default.
    """
    sweeps, count = sweeps_of(body), len(positions)
    given = np.tile(np.array(held_pose(body)), (count, 1)) if bases is None else bases
    still = np.zeros((count, 2 * sweeps.dofs))
    questions = np.concatenate([np.zeros((count, 3)), given, positions, still], axis=1)
    found = sweeps.answers(link_frames_kernel, _size(sweeps), sweeps.links, questions=questions)
    return found.reshape(count, sweeps.links, LINK_POSE)


@gated("world.call_lock")
def _checked(body: BodyCore, positions: Numbers, base: Sequence[float] | memoryview[float]) -> Array:
    numbers, count = finite(positions, "positions"), sum(body.position_count)
    if numbers.shape != (count,):
        raise ValueError(f"there are {numbers.size} joint positions; {body.name!r} has {count}")
    return many_link_frames(body, numbers[np.newaxis], np.array([base]))[0]


def _asker(body: BodyCore) -> Asker:
    sweeps = sweeps_of(body)
    return sweeps.pose_asker(link_frames_kernel, _size(sweeps), (sweeps.links, int(LINK_POSE)))


def _size(sweeps: Sweeps) -> int:
    return int(LINK_POSE) * sweeps.links
