"""Joints of robots as elements of descriptions."""

from __future__ import annotations

from dataclasses import replace
from math import inf

from carom.description import Joint, JointType, Pose
from carom.description.compliance import Compliance
from carom.description.joint import BALL_TYPES, JOINTS, PLANE_TYPES, STILL, WITHOUT_LIMIT
from carom.description.transform import compose, turn_of_z
from carom.editing.elements import new, words
from carom.editing.losses import Losses
from carom.files.xml_element import Element

TYPES: dict[JointType, str] = {kind: it.mjcf for kind, it in JOINTS.items() if it.mjcf}
"""Joint types that MJCF has, and its names for them."""


def joint_elements(joint: Joint, name: str, losses: Losses) -> list[Element]:
    """The elements of a joint with a name, none for one that is fixed; what MJCF cannot say is noted."""
    if joint.safety is not None:
        losses.add("joint/safety_controller", "none here: no program runs it", "MJCF has none")
    if joint.limit.velocity > 0.0:
        losses.add(
            "joint/limit",
            "none for the dynamics: programs do not learn it",
            "MJCF has no greatest speeds",
            "velocity",
        )
    if joint.type in STILL:
        if joint.type is JointType.FLOATING:
            losses.add("joint", "it is fixed", "only bodies of the world are free", "type")
        return []
    if joint.type in PLANE_TYPES:
        return _planar(joint, name, losses)
    element = new("joint", None, {"name": name, "type": TYPES[joint.type]})
    if joint.type not in BALL_TYPES:
        element.attributes["axis"] = words(joint.axis)
    lower, upper = joint.limit.lower, joint.limit.upper
    if joint.type not in (*WITHOUT_LIMIT, *BALL_TYPES) and lower <= upper:
        element.attributes["range"] = words((lower, upper))
        element.attributes["limited"] = "true"
        _yields(element, "limit", joint.limit_compliance)
        if joint.limit_margin:
            element.attributes["margin"] = words((joint.limit_margin,))
    elif joint.type in BALL_TYPES and lower <= upper:
        losses.add("joint/limit", "it turns freely", "MJCF limits the angle of all of it", "lower", "upper")
    _terms(joint, element)
    return [element]


def _terms(joint: Joint, element: Element) -> None:
    terms = {
        "damping": joint.damping,
        "frictionloss": joint.friction,
        "armature": joint.armature,
        "stiffness": joint.stiffness,
        "springref": joint.spring_reference,
    }
    element.attributes.update({name: words((value,)) for name, value in terms.items() if value})
    if joint.friction:
        _yields(element, "friction", joint.friction_compliance)
    effort = joint.limit.effort
    if 0.0 < effort < inf and joint.type not in BALL_TYPES:
        element.attributes["actuatorfrcrange"] = words((-effort, effort))


def _yields(element: Element, what: str, compliance: Compliance | None) -> None:
    if compliance is not None:
        it = compliance
        element.attributes[f"solref{what}"] = words((it.time_constant, it.damping_ratio))
        element.attributes[f"solimp{what}"] = words((it.least, it.greatest, it.width, it.midpoint, it.power))


def _planar(joint: Joint, name: str, losses: Losses) -> list[Element]:
    """Two sliders in the plane and a hinge about its normal."""
    turn = Pose(orientation=turn_of_z(joint.axis))
    found = []
    for suffix, kind, axis in (("x", "slide", (1.0, 0.0, 0.0)), ("y", "slide", (0.0, 1.0, 0.0))):
        along = compose(turn, Pose(axis)).position
        found.append(new("joint", None, {"name": f"{name}_{suffix}", "type": kind, "axis": words(along)}))
    found.append(new("joint", None, {"name": f"{name}_turn", "type": "hinge", "axis": words(joint.axis)}))
    for element in found:
        _terms(replace(joint, limit=replace(joint.limit, effort=0.0)), element)
    losses.add(
        "joint",
        f"it is three joints, {name}_x, {name}_y and {name}_turn",
        "MJCF has no planar joints",
        "type",
    )
    return found
