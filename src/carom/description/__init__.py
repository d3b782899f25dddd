"""Descriptions of robots, independent of file formats: frozen data classes without physics."""

from carom.description.geometry import (
    Box,
    Capsule,
    ConvexHull,
    Cylinder,
    Geometry,
    Heightfield,
    Mesh,
    Plane,
    SignedDistanceField,
    Sphere,
    TriangleMesh,
)
from carom.description.joint import Joint, JointLimit, JointType, Mimic, SafetyController
from carom.description.link import Collision, ContactParameters, Inertial, Link, Material, Visual
from carom.description.pose import Pose
from carom.description.robot import Robot

__all__ = [
    "Box",
    "Capsule",
    "Collision",
    "ContactParameters",
    "ConvexHull",
    "Cylinder",
    "Geometry",
    "Heightfield",
    "Inertial",
    "Joint",
    "JointLimit",
    "JointType",
    "Link",
    "Material",
    "Mesh",
    "Mimic",
    "Plane",
    "Pose",
    "Robot",
    "SafetyController",
    "SignedDistanceField",
    "Sphere",
    "TriangleMesh",
    "Visual",
]
