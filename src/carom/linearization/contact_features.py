"""With which of their features two shapes touch: points of a link, and faces."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from carom.layouts.codes import BOX, CAPSULE, HULL, PLANE, SPHERE
from carom.linearization.turns import matrix_of

if TYPE_CHECKING:
    from carom.linearization.taken_step import TakenStep

# Distance [m], and difference of unit vectors, that count as none.
_NONE = 1e-7


def _frame(taken: TakenStep, shape: int) -> tuple[np.ndarray, np.ndarray]:
    """World position and rotation of a shape."""
    link, pose = taken.link_pose[taken.shapes["shape_link"][shape]], taken.shapes["shape_pose"][shape]
    turn = matrix_of(link[3:])
    return link[:3] + turn @ pose[:3], turn @ matrix_of(pose[3:])


def touching_radius(taken: TakenStep, shape: int, point: np.ndarray, outward: np.ndarray) -> float | None:
    """The radius of the ball around a point of its link with which a shape touches; None for other features.

    Args:
        taken: The step.
        shape: The shape.
        point: The point of contact on it, in world axes.
        outward: The normal, towards the shape.
    """
    shapes = taken.shapes
    kind, size = shapes["shape_kind"][shape], shapes["shape_size"][shape]
    position, turn = _frame(taken, shape)
    if kind == SPHERE:
        return float(size[0])
    margin = float(shapes["shape_margin"][shape])
    radii = (float(size[0]),) if kind == CAPSULE else (0.0, margin)
    for radius in radii:
        local = turn.T @ (point + radius * outward - position)
        if kind == CAPSULE:
            corners = np.array([[0.0, 0.0, size[1]], [0.0, 0.0, -size[1]]])
        elif kind == BOX:
            corners = np.sign(local)[None] * (size - radius)
        elif kind == HULL:
            first = int(shapes["shape_first_vertex"][shape])
            corners = shapes["vertex_position"][first : first + int(shapes["shape_vertex_count"][shape])]
        else:
            return None
        if np.abs(corners - local).max(axis=1).min() < _NONE:
            return radius
    return None


def touches_with_face(taken: TakenStep, shape: int, normal: np.ndarray) -> bool:
    """Whether a normal, away from a shape, is that of a face of the shape."""
    shapes = taken.shapes
    kind = shapes["shape_kind"][shape]
    if kind == PLANE:
        return True
    local = _frame(taken, shape)[1].T @ normal
    if kind == BOX:
        return float(np.abs(local).max()) > 1.0 - _NONE
    if kind == HULL:
        first = int(shapes["shape_first_face"][shape])
        planes = shapes["face_plane"][first : first + int(shapes["shape_face_count"][shape])]
        return bool((np.abs(planes[:, :3] - local).max(axis=1) < _NONE).any())
    return False
