"""Tendons with armature: what their inertia changes in springs, damping ratios and softness of joints."""

from __future__ import annotations

from carom.formats.mjcf.compiled.actuation.length_range import moment_arms
from carom.formats.mjcf.compiled.inverse_masses import TendonInertia
from carom.formats.mjcf.compiled.model import CompiledBody, CompiledModel
from carom.formats.mjcf.compiled.names import Names
from carom.formats.mjcf.compiled.robots import robot_of_body
from carom.formats.mjcf.compiled.softness import weigh_tree


def weigh_with_tendons(model: CompiledModel, world: CompiledBody, names: Names) -> None:
    """Find inverse masses of trees again whose tendons have armature, and make robots of these anew.

    As in MuJoCo, the inertia of a tendon counts for `springdamper`, `dampratio` and how constraints yield. Of
    one between two trees, each tree has what its own joints do.
    """
    above = {child.name: body.name for body in names.bodies.values() for child in body.children}
    found: dict[str, list[TendonInertia]] = {}
    for tendon in model.tendons.values():
        if not tendon.armature:
            continue
        arms: dict[str, dict[str, float]] = {}
        for joint, arm in moment_arms(tendon.parts, names.bodies, above, names.joints).items():
            root = names.joints[joint][0].name
            while root in above:
                root = above[root]
            arms.setdefault(root, {})[joint] = arm
        for root, own in arms.items():
            found.setdefault(root, []).append(TendonInertia(tendon.armature, own))
    roots = {child.name: child for child in world.children}
    for root, tendons in found.items():
        weigh_tree(model, roots[root], tendons)
    model.robots = [
        robot_of_body(roots[it.robot.name]) if it.robot.name in found else it for it in model.robots
    ]
