"""Carom: a robot simulator that runs PyBullet scripts unmodified.

Scripts written for PyBullet do not need this module: they `import pybullet`. New code can use
`World`, `Body`, `Joint` and `Link` directly, and the controllers in `carom.control`. Names are
imported when first used, so `import carom` itself is quick.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from carom.conflicts import check as _check_conflicts
from carom.suggestions import install as _suggest_names
from carom.version import __version__

if TYPE_CHECKING:
    # Modules that are not in `__all__`: `import *` would load them, and what they need.
    from carom import algorithms as algorithms
    from carom import cluster as cluster
    from carom import control
    from carom import controllers as controllers
    from carom import errors as errors
    from carom import identification as identification
    from carom import jax as jax
    from carom import profiling as profiling
    from carom import torch as torch
    from carom import vector as vector
    from carom import viewer as viewer
    from carom.camera import Camera
    from carom.description.actuator import (
        Adhesion,
        Cylinder,
        Damper,
        GeneralActuator,
        IntegratedVelocityActuator,
        Motor,
        PositionActuator,
        VelocityActuator,
    )
    from carom.description.sensors import (
        Accelerometer,
        ActuatorForce,
        ActuatorPosition,
        ActuatorVelocity,
        BallAngularVelocity,
        BallQuaternion,
        Clock,
        ContactSensor,
        Distance,
        DistanceNormal,
        DistancePoints,
        Force,
        FrameAngularAcceleration,
        FrameAngularVelocity,
        FrameLinearAcceleration,
        FrameLinearVelocity,
        FramePosition,
        FrameQuaternion,
        FrameXAxis,
        FrameYAxis,
        FrameZAxis,
        Gyro,
        JointActuatorForce,
        JointLimitForce,
        JointLimitPosition,
        JointLimitVelocity,
        JointPosition,
        JointVelocity,
        Magnetometer,
        RangeFinder,
        SubtreeAngularMomentum,
        SubtreeCenterOfMass,
        SubtreeLinearMomentum,
        SubtreeLinearVelocity,
        Torque,
        Touch,
        Velocimeter,
    )
    from carom.editing.description import Description
    from carom.editing.files import read
    from carom.identification.identify import identify
    from carom.identification.result import IdentificationResult
    from carom.pose import Pose
    from carom.recording.recorder import Recorder
    from carom.scene.body import Body
    from carom.scene.joint import Joint
    from carom.scene.link import Link
    from carom.scene.named_constraints.joint_coupling import JointCoupling
    from carom.world.face.solving import Solver
    from carom.world.scene import Scene
    from carom.world.world import World
    from carom.worlds.worlds import Worlds

_check_conflicts()
_suggest_names()

__all__ = [
    "Accelerometer",
    "ActuatorForce",
    "ActuatorPosition",
    "ActuatorVelocity",
    "Adhesion",
    "BallAngularVelocity",
    "BallQuaternion",
    "Body",
    "Camera",
    "Clock",
    "ContactSensor",
    "Cylinder",
    "Damper",
    "Description",
    "Distance",
    "DistanceNormal",
    "DistancePoints",
    "Force",
    "FrameAngularAcceleration",
    "FrameAngularVelocity",
    "FrameLinearAcceleration",
    "FrameLinearVelocity",
    "FramePosition",
    "FrameQuaternion",
    "FrameXAxis",
    "FrameYAxis",
    "FrameZAxis",
    "GeneralActuator",
    "Gyro",
    "IdentificationResult",
    "IntegratedVelocityActuator",
    "Joint",
    "JointActuatorForce",
    "JointCoupling",
    "JointLimitForce",
    "JointLimitPosition",
    "JointLimitVelocity",
    "JointPosition",
    "JointVelocity",
    "Link",
    "Magnetometer",
    "Motor",
    "Pose",
    "PositionActuator",
    "RangeFinder",
    "Recorder",
    "Scene",
    "Solver",
    "SubtreeAngularMomentum",
    "SubtreeCenterOfMass",
    "SubtreeLinearMomentum",
    "SubtreeLinearVelocity",
    "Torque",
    "Touch",
    "Velocimeter",
    "VelocityActuator",
    "World",
    "Worlds",
    "__version__",
    "control",
    "identify",
    "read",
]

_HOME = {
    "Body": "carom.scene.body",
    "Camera": "carom.camera",
    "Description": "carom.editing.description",
    "IdentificationResult": "carom.identification.result",
    "Joint": "carom.scene.joint",
    "JointCoupling": "carom.scene.named_constraints.joint_coupling",
    "Link": "carom.scene.link",
    "Pose": "carom.pose",
    "Recorder": "carom.recording.recorder",
    "Scene": "carom.world.scene",
    "Solver": "carom.world.face.solving",
    "World": "carom.world.world",
    "Worlds": "carom.worlds.worlds",
    "identify": "carom.identification.identify",
    "read": "carom.editing.files",
}
_HOME |= dict.fromkeys(
    (
        "Adhesion",
        "Cylinder",
        "Damper",
        "GeneralActuator",
        "IntegratedVelocityActuator",
        "Motor",
        "PositionActuator",
        "VelocityActuator",
    ),
    "carom.description.actuator",
)
_HOME |= dict.fromkeys(
    (
        "Accelerometer",
        "ActuatorForce",
        "ActuatorPosition",
        "ActuatorVelocity",
        "BallAngularVelocity",
        "BallQuaternion",
        "Clock",
        "ContactSensor",
        "Distance",
        "DistanceNormal",
        "DistancePoints",
        "Force",
        "FrameAngularAcceleration",
        "FrameAngularVelocity",
        "FrameLinearAcceleration",
        "FrameLinearVelocity",
        "FramePosition",
        "FrameQuaternion",
        "FrameXAxis",
        "FrameYAxis",
        "FrameZAxis",
        "Gyro",
        "JointActuatorForce",
        "JointLimitForce",
        "JointLimitPosition",
        "JointLimitVelocity",
        "JointPosition",
        "JointVelocity",
        "Magnetometer",
        "RangeFinder",
        "SubtreeAngularMomentum",
        "SubtreeCenterOfMass",
        "SubtreeLinearMomentum",
        "SubtreeLinearVelocity",
        "Torque",
        "Touch",
        "Velocimeter",
    ),
    "carom.description.sensors",
)


# Imported when first asked for; all but these and their names are internal.
_MODULES = (
    *("algorithms", "cluster", "control", "controllers", "errors", "identification", "jax", "torch"),
    *("profiling", "vector", "viewer"),
)


def __getattr__(name: str) -> Any:
    from importlib import import_module

    if name in _MODULES:
        return import_module(f"carom.{name}")
    if name not in _HOME:
        from difflib import get_close_matches

        from carom.foreign_names import MODULES

        near = get_close_matches(name, __dir__(), 1)
        similar = f"; did you mean {near[0]!r}?" if near and name not in MODULES["carom"] else ""
        raise AttributeError(f"module 'carom' has no attribute {name!r}{similar}")
    # Kept, so that Python finds it itself from now on.
    found = globals()[name] = getattr(import_module(_HOME[name]), name)
    return found


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__, *_MODULES})
