"""Reading a stage: robots, colliders that do not move, cameras, gravity."""

from __future__ import annotations

from math import atan, degrees
from pathlib import Path
from typing import Any

import numpy as np

from carom.description import Robot
from carom.description.transform import compose, inverse
from carom.formats.mjcf.compiled.model import FileCamera
from carom.formats.placed import PlacedRobot
from carom.formats.reading.ignored import IgnoredList
from carom.formats.usd.actuators import add_actuators
from carom.formats.usd.bodies import Parts
from carom.formats.usd.exact import numbers
from carom.formats.usd.filters import set_pairs
from carom.formats.usd.joints import read_joints
from carom.formats.usd.loops import read_loops
from carom.formats.usd.rules import ignored_of
from carom.formats.usd.scene import UsdRobot, UsdScene
from carom.formats.usd.stage import Solids, Stage, rigid
from carom.formats.usd.tree import Tree, make_trees

_GRAVITY = 9.81
"""On Earth [m/s²], which holds where a scene states none."""
_STEPS = ("physxScene:timeStepsPerSecond", "newton:timeStepsPerSecond")


def read_usd(file: Path, solids: Solids) -> tuple[UsdScene, IgnoredList]:
    """All of a stage, in metres and kilograms with z up, and what of it is left out.

    Raises:
        DescriptionError: It cannot be opened, something in it has no meaning, or `usd-core` is not installed.
    """
    stage = Stage(file, solids)
    parts = Parts(stage)
    joints = read_joints(stage, parts)
    trees = make_trees(stage, parts, joints)
    for tree in trees:
        tree.robot.loops = read_loops(stage, tree)
    add_actuators(stage, trees)
    robots = [tree.robot for tree in trees]
    for part in parts.still:
        robot = Robot(part.link.name, (part.link,), (), source=file)
        robots.append(UsdRobot(PlacedRobot(robot, part.pose, True)))
    scene = UsdScene(robots, options=_options(stage))
    set_pairs(stage, parts, trees, joints, scene)
    _read_cameras(stage, parts, trees, scene)
    return scene, ignored_of(stage)


def _options(stage: Stage) -> dict[str, Any]:
    """Gravity and time step of the first scene."""
    scenes = [prim for prim in stage.prims() if prim.IsA(stage.pxr.UsdPhysics.Scene)]
    for prim in scenes[1:]:
        stage.leave_out(prim, "the first scene of the stage counts", "a world has one gravity")
    if not scenes:
        return {}
    first, options = scenes[0], dict[str, Any]()
    direction = np.array(numbers(stage.value(first, "physics:gravityDirection", (0.0,) * 3)))
    strength = stage.number(first, "physics:gravityMagnitude", -np.inf)
    length = float(np.linalg.norm(direction))
    down = stage.turn @ (direction / length) if length > 0.0 else np.array([0.0, 0.0, -1.0])
    x, y, z = (down * (strength * stage.unit if 0.0 <= strength < np.inf else _GRAVITY)).tolist()
    options["gravity"] = (x, y, z)
    for name in _STEPS:
        rate = stage.number(first, name, 0.0)
        if rate > 0.0:
            options["timestep"] = 1.0 / rate
    step = stage.number(first, "mjc:option:timestep", 0.0)
    if step > 0.0:
        options["timestep"] = step
    return options


def _read_cameras(stage: Stage, parts: Parts, trees: list[Tree], scene: UsdScene) -> None:
    links = {part.path: tree.names[part.path] for tree in trees for part in tree.parts}
    for prim in stage.prims():
        if not prim.IsA(stage.pxr.UsdGeom.Camera):
            continue
        owner = parts.of(prim)
        pose, _ = rigid(stage.matrix(prim))
        if str(stage.value(prim, "projection", "perspective")) != "perspective":
            stage.leave_out(prim, "it sees in perspective", "cameras of files do", "projection")
        aperture, focus = (
            stage.number(prim, "verticalAperture", 15.2908),
            stage.number(prim, "focalLength", 50.0),
        )
        if not (aperture > 0.0 and focus > 0.0):
            raise stage.error(prim, "verticalAperture and focalLength must be positive")
        name = str(prim.GetName())
        if name in scene.cameras:
            name = str(prim.GetPath())
        frame = pose if owner is None else compose(inverse(owner.pose), pose)
        body = "world" if owner is None else links[owner.path]
        angle = degrees(2.0 * atan(0.5 * aperture / focus))
        scene.cameras[name] = FileCamera(name, body, frame, angle, (1, 1), "fixed")
