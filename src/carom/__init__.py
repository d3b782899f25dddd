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
    from carom import control
    from carom.camera import Camera
    from carom.description.actuator import (
        Cylinder,
        Damper,
        GeneralActuator,
        IntegratedVelocityActuator,
        Motor,
        PositionActuator,
        VelocityActuator,
    )
    from carom.recording.recorder import Recorder
    from carom.scene.body import Body
    from carom.scene.joint import Joint
    from carom.scene.link import Link
    from carom.scene.named_constraints.joint_coupling import JointCoupling
    from carom.world.scene import Scene
    from carom.world.world import World
    from carom.worlds.worlds import Worlds

_check_conflicts()
_suggest_names()

__all__ = [
    "Body",
    "Camera",
    "Cylinder",
    "Damper",
    "GeneralActuator",
    "IntegratedVelocityActuator",
    "Joint",
    "JointCoupling",
    "Link",
    "Motor",
    "PositionActuator",
    "Recorder",
    "Scene",
    "VelocityActuator",
    "World",
    "Worlds",
    "__version__",
    "control",
]

_HOME = {
    "Body": "carom.scene.body",
    "Camera": "carom.camera",
    "Joint": "carom.scene.joint",
    "JointCoupling": "carom.scene.named_constraints.joint_coupling",
    "Link": "carom.scene.link",
    "Recorder": "carom.recording.recorder",
    "Scene": "carom.world.scene",
    "World": "carom.world.world",
    "Worlds": "carom.worlds.worlds",
}
_HOME |= dict.fromkeys(
    (
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


def __getattr__(name: str) -> Any:
    from importlib import import_module

    if name == "control":
        return import_module("carom.control")
    if name not in _HOME:
        raise AttributeError(f"module 'carom' has no attribute {name!r}")
    return getattr(import_module(_HOME[name]), name)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
