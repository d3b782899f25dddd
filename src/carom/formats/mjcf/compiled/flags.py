"""`<flag>`: what it switches off in a file that has been read."""

from __future__ import annotations

from dataclasses import replace
from math import inf

from carom.description import Joint, Link
from carom.description.actuator import ActuatorSpec
from carom.description.collision_groups import MOVING_GROUP
from carom.formats.mjcf.compiled.model import CompiledModel
from carom.formats.placed import PlacedRobot

_OF_CONSTRAINTS = ("contact", "equality", "frictionloss", "limit")
_ALONE = 1 << 30
"""A group that is in no mask of a file whose geoms do not collide."""
_ALL = (*_OF_CONSTRAINTS, "clampctrl", "damper", "spring")


def switch_off(model: CompiledModel) -> None:
    """Take out of a model what the flags of its options disable."""
    off = {name for name in _ALL if not model.options.get(f"flag.{name}", True)}
    if not model.options.get("flag.constraint", True):
        off.update(_OF_CONSTRAINTS)
    if not off:
        return
    model.robots = [_robot(placed, off) for placed in model.robots]
    if "contact" in off:
        model.paired = {}
    if "frictionloss" in off:
        model.frictions = []
    if "equality" in off:
        model.connections = [replace(it, enabled=False) for it in model.connections]
        model.couplings = [replace(it, enabled=False) for it in model.couplings]
        model.tendon_couplings = [replace(it, enabled=False) for it in model.tendon_couplings]
    for name, tendon in model.tendons.items():
        if "limit" in off:
            tendon = replace(tendon, range=(-inf, inf))
        if "frictionloss" in off:
            tendon = replace(tendon, friction=0.0)
        if "spring" in off:
            tendon = replace(tendon, stiffness=0.0, stiffness_terms=(0.0, 0.0))
        if "damper" in off:
            tendon = replace(tendon, damping=0.0)
        model.tendons[name] = tendon


def _robot(placed: PlacedRobot, off: set[str]) -> PlacedRobot:
    robot = placed.robot
    links = tuple(_link(link, off) for link in robot.links)
    joints = tuple(_joint(joint, off) for joint in robot.joints)
    actuators = tuple(_actuator(actuator, off) for actuator in robot.actuators)
    robot = replace(robot, links=links, joints=joints, actuators=actuators)
    if "spring" in off:
        robot = replace(robot, base_stiffness=0.0)
    if "damper" in off:
        robot = replace(robot, base_damping=0.0)
    return replace(placed, robot=robot)


def _link(link: Link, off: set[str]) -> Link:
    if "contact" not in off:
        return link
    # Rays still hit them.
    alone = (replace(it, group=_ALONE, mask=MOVING_GROUP) for it in link.collisions)
    return replace(link, collisions=tuple(alone))


def _joint(joint: Joint, off: set[str]) -> Joint:
    if "limit" in off:
        joint = replace(joint, limit=replace(joint.limit, lower=0.0, upper=-1.0))
    if "frictionloss" in off:
        joint = replace(joint, friction=0.0)
    if "spring" in off:
        joint = replace(joint, stiffness=0.0)
    if "damper" in off:
        joint = replace(joint, damping=0.0)
    return joint


def _actuator(actuator: ActuatorSpec, off: set[str]) -> ActuatorSpec:
    return replace(actuator, control_range=(-inf, inf)) if "clampctrl" in off else actuator
