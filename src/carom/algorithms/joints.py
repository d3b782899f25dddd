"""The motion of joints on the host; in kernels it is in `carom.kernels.joints`."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from carom.description.pose import Vector3
from carom.layouts.codes import JointCode
from carom.native.products import dots, length

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore

# Axes whose length differs from 1 by less are rounded ones of length 1.
_UNIT = 1e-12


def _row(body: BodyCore, link: int) -> int:
    return body.first_link + 1 + link


def joint_axes(kind: JointCode, lead: float = 0.0) -> np.ndarray:
    """Velocities, angular and linear, per unit rate of a joint whose axis has length 1 and is along z.

    Args:
        kind: Its type; a planar joint has no such axes.
        lead: How far a screw goes along its axis per radian [m].

    Returns:
        (dofs, 2, 3); a fixed joint has none.
    """
    axes = np.zeros((3 if kind == JointCode.SPHERICAL else 1, 2, 3))
    match kind:
        case JointCode.REVOLUTE:
            axes[0, 0, 2] = 1.0
        case JointCode.PRISMATIC:
            axes[0, 1, 2] = 1.0
        case JointCode.SPHERICAL:
            axes[:, 0, :] = np.eye(3)
        case JointCode.SCREW:
            axes[0, :, 2] = 1.0, lead
        case _:
            return axes[:0]
    return axes


def node_axes(body: BodyCore, link: int, *, unit_axes: bool = False) -> np.ndarray:
    """The same of a joint of a body in the frame of its node, whose z axis is that of a single dof.

    With `unit_axes`, a hinge or slider whose axis has another length than 1 is taken as if it had that.
    """
    kind = JointCode(body.joint_types[link])
    model, row = body.world.arrays.model.numpy, _row(body, link)
    match kind:
        case JointCode.SPHERICAL:
            return joint_axes(kind)
        case JointCode.PLANAR:
            return link_axes(body, link)
        case JointCode.SCREW:
            return joint_axes(kind, screw_lead(body, link))
        case _:
            if unit_axes and has_long_axis(body, link):
                return joint_axes(kind)
            return joint_axes(kind) * length(model["link_axis"][row])


def link_axes(body: BodyCore, link: int) -> np.ndarray:
    """The same of a joint of a body along the axes of its link's inertial frame, (dofs, 2, 3)."""
    kind = JointCode(body.joint_types[link])
    model, row, none = body.world.arrays.model.numpy, _row(body, link), np.zeros(3)
    axis, slide = model["link_axis"][row], model["link_planar_axis1"][row]
    match kind:
        case JointCode.REVOLUTE:
            return np.array([(axis, none)])
        case JointCode.PRISMATIC:
            return np.array([(none, axis)])
        case JointCode.PLANAR:
            return np.array([(axis, none), (none, slide), (none, model["link_planar_axis2"][row])])
        case JointCode.SCREW:
            return np.array([(axis, slide)])
        case _:
            return joint_axes(kind)


def screw_lead(body: BodyCore, link: int) -> float:
    """How far a link goes along the axis of its joint per radian, if that is a screw [m]; otherwise 0."""
    if body.joint_types[link] != JointCode.SCREW:
        return 0.0
    model, row = body.world.arrays.model.numpy, _row(body, link)
    return float(dots(model["link_planar_axis1"][row], model["link_unit_axis"][row]))


def slide_along_z(body: BodyCore, link: int) -> float:
    """How far a link goes along z of its node per unit of the position of a slider or screw."""
    if body.joint_types[link] == JointCode.SCREW:
        return screw_lead(body, link)
    return length(body.world.arrays.model.numpy["link_axis"][_row(body, link)])


def has_long_axis(body: BodyCore, link: int) -> bool:
    """Whether a joint is a hinge or slider whose axis is longer or shorter than 1."""
    if body.joint_types[link] not in (JointCode.REVOLUTE, JointCode.PRISMATIC):
        return False
    return abs(length(body.world.arrays.model.numpy["link_axis"][_row(body, link)]) - 1.0) > _UNIT


def vector_of(row: np.ndarray) -> Vector3:
    """A row of three numbers as a tuple."""
    x, y, z = row.tolist()
    return x, y, z
