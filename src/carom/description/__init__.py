"""Descriptions of robots, independent of file formats: frozen data classes without physics."""

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from carom.description.geometry import (
        Box,
        Capsule,
        ConvexHull,
        Cylinder,
        Ellipsoid,
        Geometry,
        Heightfield,
        Mesh,
        Plane,
        RoundedBox,
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
    "Ellipsoid",
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
    "RoundedBox",
    "SafetyController",
    "SignedDistanceField",
    "Sphere",
    "TriangleMesh",
    "Visual",
]

# A module is imported when one of its names is first asked for: data classes take long to make.
_HOME = dict.fromkeys(__all__, "geometry")
_HOME |= dict.fromkeys(("Joint", "JointLimit", "JointType", "Mimic", "SafetyController"), "joint")
_HOME |= dict.fromkeys(("Collision", "ContactParameters", "Inertial", "Link", "Material", "Visual"), "link")
_HOME |= {"Pose": "pose", "Robot": "robot"}


def __getattr__(name: str) -> Any:
    from importlib import import_module

    if name not in _HOME:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = globals()[name] = getattr(import_module(f"{__name__}.{_HOME[name]}"), name)
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
