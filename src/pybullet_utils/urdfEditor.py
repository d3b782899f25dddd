"""Robots as data that scripts can change, join and write as URDF files."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Sequence
from xml.sax.saxutils import quoteattr

import pybullet as p
from carom.formats.urdf_writer import roll_pitch_yaw
from carom.writing import write_text
from pybullet_utils._urdf_elements import (
    UrdfCollision,
    UrdfContact,
    UrdfInertial,
    UrdfJoint,
    UrdfLink,
    UrdfVisual,
    joint_element,
    link_element,
)

__all__ = [
    "UrdfCollision",
    "UrdfContact",
    "UrdfEditor",
    "UrdfInertial",
    "UrdfJoint",
    "UrdfLink",
    "UrdfVisual",
]

Numbers = Sequence[float]
_NOWHERE = (0.0, 0.0, 0.0)
# File name that PyBullet reports for a convex hull that it has built itself.
_FORGOTTEN = "unknown_file"


class UrdfEditor:
    """The links and joints of a robot.

    Attributes:
        urdfLinks: The links, the base first.
        urdfJoints: The joints; joint i leads to link i + 1.
        robotName: The name of the robot.
        linkNameToIndex: Index of each link in `urdfLinks`, by name.
    """

    def __init__(self) -> None:
        self.initialize()

    def initialize(self) -> None:
        """Removes all links and joints."""
        self.urdfLinks: list[UrdfLink] = []
        self.urdfJoints: list[UrdfJoint] = []
        self.robotName = ""
        self.linkNameToIndex: dict[str, int] = {}
        self.jointTypeToName = {
            p.JOINT_FIXED: "JOINT_FIXED",
            p.JOINT_REVOLUTE: "JOINT_REVOLUTE",
            p.JOINT_PRISMATIC: "JOINT_PRISMATIC",
        }

    def initializeFromBulletBody(self, bodyUid: int, physicsClientId: int) -> None:
        """Replaces all links and joints by those of a body in a simulation."""
        self.initialize()
        base_name, robot_name = p.getBodyInfo(bodyUid, physicsClientId=physicsClientId)
        self.robotName = robot_name.decode()
        base = UrdfLink()
        base.link_name = base_name.decode()
        self.convertLinkFromMultiBody(bodyUid, -1, base, physicsClientId)
        self._add(base)
        for index in range(p.getNumJoints(bodyUid, physicsClientId=physicsClientId)):
            self._take_link(bodyUid, index, physicsClientId)

    def convertLinkFromMultiBody(
        self, bodyUid: int, linkIndex: int, urdfLink: UrdfLink, physicsClientId: int
    ) -> None:
        """Copies mass, inertia and shapes of a link in a simulation to `urdfLink`; index -1 is the base."""
        dynamics = p.getDynamicsInfo(bodyUid, linkIndex, physicsClientId=physicsClientId)
        inertial = urdfLink.urdf_inertial
        inertial.mass, inertial.inertia_xxyyzz, inertial.origin_xyz = dynamics[0], dynamics[2], dynamics[3]
        inertial.origin_rpy = roll_pitch_yaw(dynamics[4])
        for shape in p.getVisualShapeData(bodyUid, physicsClientId=physicsClientId):
            if shape[1] == linkIndex:
                number = len(urdfLink.urdf_visual_shapes)
                urdfLink.urdf_visual_shapes.append(UrdfVisual.of_seen(shape, f"mat_{linkIndex}_{number}"))
        for shape in p.getCollisionShapeData(bodyUid, linkIndex, physicsClientId=physicsClientId):
            # The pose is given in the inertial frame, and written in the link frame.
            place = p.multiplyTransforms(dynamics[3], dynamics[4], shape[5], shape[6])
            collision = UrdfCollision.of_shape(shape, place)
            number = len(urdfLink.urdf_collision_shapes)
            if collision.geom_meshfilename == _FORGOTTEN and number < len(urdfLink.urdf_visual_shapes):
                # The size of a cylinder that collides as a convex hull is only known from its visual shape.
                collision.copy_geometry(urdfLink.urdf_visual_shapes[number])
            urdfLink.urdf_collision_shapes.append(collision)

    def joinUrdf(
        self,
        childEditor: UrdfEditor,
        parentLinkIndex: int = 0,
        jointPivotXYZInParent: Numbers = (0, 0, 0),
        jointPivotRPYInParent: Numbers = (0, 0, 0),
        jointPivotXYZInChild: Numbers = (0, 0, 0),
        jointPivotRPYInChild: Numbers = (0, 0, 0),
        parentPhysicsClientId: int = 0,
        childPhysicsClientId: int = 0,
    ) -> UrdfJoint:
        """Attaches another robot: adds its links and joints, and a new joint to its base.

        The base of the other robot is moved so that the joint is the origin of its link frame. Links and
        joints whose names are already used get a number.

        Args:
            childEditor: The other robot; do not use the editor afterwards.
            parentLinkIndex: Index of the parent link in `urdfLinks`.
            jointPivotXYZInParent: Position of the joint in the frame of the parent link [m].
            jointPivotRPYInParent: Orientation of the joint there: roll, pitch and yaw [rad].
            jointPivotXYZInChild: Position of the joint in the frame of the other robot's base [m].
            jointPivotRPYInChild: Orientation of the joint there: roll, pitch and yaw [rad].
            parentPhysicsClientId: Not used.
            childPhysicsClientId: Not used.

        Returns:
            The new joint: revolute, about z, without limits. Scripts may change it.
        """
        base = childEditor.urdfLinks[0]
        turn = p.getQuaternionFromEuler(jointPivotRPYInChild)
        shift, back = p.invertTransform(jointPivotXYZInChild, turn)
        for part in (base.urdf_inertial, *base.urdf_visual_shapes, *base.urdf_collision_shapes):
            part.move(shift, back)
        for joint in childEditor.urdfJoints:
            if joint.parent_name == base.link_name:
                joint.move(shift, back)

        links, joints = set(self.linkNameToIndex), {joint.joint_name for joint in self.urdfJoints}
        names = {link.link_name: _unused(link.link_name, links) for link in childEditor.urdfLinks}
        new = UrdfJoint()
        new.joint_name = _unused("joint_dummy1", joints)
        new.joint_type = p.JOINT_REVOLUTE
        new.joint_axis_xyz = (0.0, 0.0, 1.0)
        new.joint_origin_xyz = tuple(jointPivotXYZInParent)
        new.joint_origin_rpy = tuple(jointPivotRPYInParent)
        new.parent_name = self.urdfLinks[parentLinkIndex].link_name
        new.child_name = names[base.link_name]
        new.link = base
        for joint in childEditor.urdfJoints:
            joint.joint_name = _unused(joint.joint_name, joints)
            joint.parent_name, joint.child_name = names[joint.parent_name], names[joint.child_name]
        for link in childEditor.urdfLinks:
            link.link_name = names[link.link_name]
            self._add(link)
        self.urdfJoints += [new, *childEditor.urdfJoints]
        return new

    def createMultiBody(
        self,
        basePosition: Numbers = (0, 0, 0),
        baseOrientation: Numbers = (0, 0, 0, 1),
        physicsClientId: int = 0,
    ) -> int:
        """Loads the robot into a simulation as a body.

        Args:
            basePosition: Position of the base [m].
            baseOrientation: Orientation of the base, a quaternion (x, y, z, w).
            physicsClientId: The connection.

        Returns:
            The id of the body.

        Raises:
            pybullet.error: The robot cannot be loaded, for example because a file is missing.
        """
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "robot.urdf")
            self.saveUrdf(path)
            return p.loadURDF(
                path,
                basePosition,
                baseOrientation,
                flags=p.URDF_USE_INERTIA_FROM_FILE,
                physicsClientId=physicsClientId,
            )

    def saveUrdf(self, fileName: str, saveVisuals: bool = True) -> None:
        """Writes the robot to a URDF file, with or without visual shapes."""
        begin = f'<?xml version="1.0" ?>\n<robot name={quoteattr(self.robotName)}>\n'
        links = [link_element(link, saveVisuals) for link in self.urdfLinks]
        joints = [joint_element(joint) for joint in self.urdfJoints]
        write_text(fileName, "".join([begin, *links, *joints, "</robot>\n"]))

    def _take_link(self, body: int, index: int, client: int) -> None:
        info = p.getJointInfo(body, index, physicsClientId=client)
        link, joint = UrdfLink(), UrdfJoint()
        link.link_name = info[12].decode()
        self.convertLinkFromMultiBody(body, index, link, client)
        joint.link = link
        joint.joint_name, joint.joint_type = info[1].decode(), info[2]
        joint.joint_lower_limit, joint.joint_upper_limit = info[8], info[9]
        joint.joint_max_force, joint.joint_max_velocity = info[10], info[11]
        joint.joint_axis_xyz = info[13]
        joint.parent_name = self.urdfLinks[info[16] + 1].link_name
        joint.child_name = link.link_name
        # info[14]: the joint's position in the parent's inertial frame; info[15]: the orientation of that
        # frame in the child's inertial frame.
        parent = p.getDynamicsInfo(body, info[16], physicsClientId=client)
        to_child = p.invertTransform(_NOWHERE, info[15])[1]
        origin, turn = p.multiplyTransforms(parent[3], parent[4], info[14], to_child)
        own = p.getDynamicsInfo(body, index, physicsClientId=client)[4]
        turn = p.multiplyTransforms(_NOWHERE, turn, *p.invertTransform(_NOWHERE, own))[1]
        joint.joint_origin_xyz = origin
        joint.joint_origin_rpy = roll_pitch_yaw(turn)
        self._add(link)
        self.urdfJoints.append(joint)

    def _add(self, link: UrdfLink) -> None:
        self.linkNameToIndex[link.link_name] = len(self.urdfLinks)
        self.urdfLinks.append(link)


def _unused(name: str, taken: set[str]) -> str:
    """The name, with a number if it is already in `taken`; adds the result to `taken`."""
    number, result = 0, name
    while result in taken:
        number += 1
        result = f"{name}_{number}"
    taken.add(result)
    return result
