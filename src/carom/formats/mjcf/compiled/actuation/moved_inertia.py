"""The inertia that a joint moves where all joints are at their references."""

from __future__ import annotations

import numpy as np

from carom.description import JointType
from carom.description.pose import IDENTITY
from carom.description.transform import compose, rotation_matrix
from carom.formats.mjcf.compiled.model import CompiledBody, CompiledJoint
from carom.native.products import dots


def moved_inertia(body: CompiledBody, joint: CompiledJoint) -> float:
    """Diagonal entry of the mass matrix for a hinge or slide of a body, with its armature [kg m² or kg]."""
    axis, anchor = np.array(joint.joint.axis), np.array(joint.anchor)
    total = joint.joint.armature
    pending = [(body, IDENTITY)]
    while pending:
        part, frame = pending.pop()
        pending += [(child, compose(frame, child.pose)) for child in part.children]
        if joint.joint.type is JointType.PRISMATIC:
            total += part.inertia.mass
            continue
        turn = np.array(rotation_matrix(frame.orientation))
        arm = np.cross(axis, np.array(frame.position) + dots(turn, part.inertia.centre) - anchor)
        along = dots(turn.T, axis)
        total += float(dots(along, dots(part.inertia.tensor, along)) + part.inertia.mass * dots(arm, arm))
    return float(total)
