"""Link frames of many worlds from inertial frames, and back."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from carom.checks import Array
from carom.description.pose import Pose
from carom.description.transform import inverse
from carom.model.body_spec import LinkSpec


def link_frames(inertial: Array, links: Sequence[LinkSpec]) -> Array:
    """World poses of link frames, position and quaternion (x, y, z, w).

    Args:
        inertial: World poses of the inertial frames, (worlds, links, 7), on any device.
        links: The links, whose specifications have the inertial frames in the link frames.
    """
    return _composed(inertial, [inverse(link.inertial_frame) for link in links])


def inertial_frames(frames: Array, links: Sequence[LinkSpec]) -> Array:
    """World poses of inertial frames from those of the link frames; the arguments are as in `link_frames`."""
    return _composed(frames, [link.inertial_frame for link in links])


def _composed(frames: Array, inside: Sequence[Pose]) -> Array:
    """World poses of frames that are inside others: (worlds, links, 7), and one for each link."""
    offset = np.array([pose.position for pose in inside]).reshape(1, len(inside), 3)
    turn = np.array([pose.orientation for pose in inside]).reshape(1, len(inside), 4)
    axis, w = frames[:, :, 3:6], frames[:, :, 6:7]
    # A vector v turned by a unit quaternion (a, w) is v + w t + a x t with t = 2 a x v.
    twice: Any = np.cross(axis, np.broadcast_to(offset, (len(frames), *offset.shape[1:]))) * 2.0
    place = frames[:, :, :3] + offset + twice * w + np.cross(axis, twice)
    return np.concatenate([place, _product(axis, w, turn)], axis=2)


def _product(axis: Array, w: Array, second: Array) -> Array:
    """Products of quaternions, the first as (axis, w), the second (1, links, 4)."""
    x, y, z = (axis[:, :, k : k + 1] for k in range(3))
    a, b, c, d = (second[:, :, k : k + 1] for k in range(4))
    return np.concatenate(
        [
            w * a + x * d + y * c - z * b,
            w * b - x * c + y * d + z * a,
            w * c + x * b - y * a + z * d,
            w * d - x * a - y * b - z * c,
        ],
        axis=2,
    )
