"""Joints of one format as those that others have: a screw as a hinge, and a slider that follows it."""

from __future__ import annotations

from dataclasses import replace
from math import pi

from carom.description import Inertial, Joint, JointLimit, JointType, Link, Mimic, Robot
from carom.description.joint import HINGE, SLIDER


def with_common_joints(robot: Robot) -> Robot:
    """The same robot with a hinge, a link without mass and a coupled slider in place of each screw.

    The link of a screw `j` with the child `c` is `c@j`, the slider `j@slide`.
    """
    links, joints = list(robot.links), list[Joint]()
    for joint in robot.joints:
        if joint.type is not JointType.SCREW:
            joints.append(joint)
            continue
        between = len(links)
        links.append(Link(f"{robot.links[joint.child].name}@{joint.name}", Inertial(mass=0.0)))
        joints.append(replace(joint, type=HINGE, child=between, pitch=0.0))
        follows = Mimic(joint.name, joint.pitch / (2.0 * pi))
        slide = Joint(f"{joint.name}@slide", SLIDER, between, joint.child, axis=joint.axis, mimic=follows)
        joints.append(replace(slide, limit=JointLimit(float("-inf"), float("inf"))))
    return replace(robot, links=tuple(links), joints=tuple(joints))
