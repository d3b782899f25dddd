"""Bodies: from files, and from shapes; and their end."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from tools.differ.assets import FILES, FIXED, PRISMATIC, REVOLUTE, ROBOTS, SCENES, SMALL, SPHERICAL, Joint
from tools.differ.kinds.shapes import BOX, PLANE, collision_shape, heights, visual_shape
from tools.differ.maker import FLAGS, MERGE_FIXED, Body, Maker

_ALL_OF_SELF_COLLISION = 8 | 16 | 32 | 8192


def body(maker: Maker) -> None:
    """A body such as the theme has."""
    theme = maker.theme
    if theme.plain:
        multi_body(maker, links=maker.chance(0.3))
    elif theme.scenes and maker.chance(0.7):
        _scene(maker)
    elif theme.robots:
        if maker.chance(0.7):
            _robot(maker, ROBOTS)
        else:
            multi_body(maker, links=True)
    elif maker.chance(0.5):
        _robot(maker, maker.one((ROBOTS, SMALL)))
    else:
        multi_body(maker, links=maker.chance(0.5))


def remove(maker: Maker) -> None:
    """Remove a body; often another one comes."""
    if len(maker.bodies) > 1:
        gone = maker.bodies.pop(maker.random.randrange(len(maker.bodies)))
        maker.call("removeBody", gone.reference)
        maker.call("getNumBodies")
        maker.call("getNumConstraints")
        maker.call("getBodyUniqueId", maker.random.randrange(4))
        if maker.chance(0.6):
            body(maker)


def floor(maker: Maker) -> None:
    """A floor of any kind, or none."""
    if maker.theme.plain:
        _still(maker, maker.one(("box", "plane")), 5)
    elif maker.theme.floor and maker.chance(0.85):
        kind = maker.one(("plane.urdf", "plane.urdf", "box", "plane", "plane_implicit.urdf", "heights"))
        if kind.endswith(".urdf"):
            maker.bodies.append(Body(maker.call("loadURDF", kind), ()))
        else:
            _still(maker, kind, 20)


def _still(maker: Maker, kind: str, size: float) -> None:
    if kind == "heights":
        made, height = heights(maker), 0.0
    elif kind == "plane":
        made, height = maker.call("createCollisionShape", PLANE), 0.0
    else:
        made, height = maker.call("createCollisionShape", BOX, halfExtents=[size, size, 0.5]), -0.5
    maker.call("createMultiBody", 0, made, -1, [0, 0, height])


def _robot(maker: Maker, names: Sequence[str]) -> None:
    name, place = maker.one(names), maker.place()
    keywords = maker.some(
        basePosition=place,
        baseOrientation=maker.turn(),
        useFixedBase=maker.one((0, 1, 1)),
        globalScaling=maker.one((0.5, 2.0, 1.0, maker.random.uniform(0.3, 3))),
        flags=maker.one(FLAGS) | maker.one((0, 0, maker.one(FLAGS))),
    )
    keywords["basePosition"] = place
    if maker.theme.apart:
        keywords["flags"] = keywords.get("flags", 0) & ~_ALL_OF_SELF_COLLISION
    joints = FILES[name][0]
    if keywords.get("flags", 0) & MERGE_FIXED:
        joints = tuple(joint for joint in joints if joint.type != FIXED)
    maker.bodies.append(Body(maker.call("loadURDF", name, **keywords), joints, place))


def _scene(maker: Maker) -> None:
    name = maker.one(SCENES)
    if name.endswith("sdf"):
        scaling = maker.some(globalScaling=maker.random.uniform(0.5, 2))
        reference = maker.call("loadSDF", name, **scaling)
    else:
        reference = maker.call("loadMJCF", name, **maker.some(flags=maker.one(FLAGS)))
    for place, joints in enumerate(FILES[name]):
        maker.bodies.append(Body({**reference, "i": place}, joints))


def multi_body(maker: Maker, *, links: bool) -> None:
    """A body made of shapes, of one link or of up to seven."""
    made = collision_shape(maker)
    mass = maker.one((0, 1, maker.positive(0.05, 20), maker.positive(0.05, 20)))
    keywords = maker.some(
        baseInertialFramePosition=maker.vector(0.2),
        baseInertialFrameOrientation=maker.turn(),
        baseOrientation=maker.turn(),
        flags=maker.one((*FLAGS[:4], 2048, 0)),
    )
    if maker.theme.plain:
        # What lies flat is left to rounding.
        keywords["baseOrientation"] = maker.any_turn()
    joints: list[Joint] = []
    if links:
        types = (REVOLUTE, REVOLUTE, PRISMATIC, SPHERICAL, FIXED)
        joints = [Joint(maker.one(types)) for _ in range(maker.random.randint(1, 6))]
        keywords |= _links(maker, joints)
    place = maker.place()
    reference = maker.call("createMultiBody", mass, made, visual_shape(maker), place, **keywords)
    maker.bodies.append(Body(reference, joints, place))


def _links(maker: Maker, joints: Sequence[Joint]) -> dict[str, Any]:
    return {
        "linkMasses": [maker.one((1, maker.positive(0.05, 5), 0.1)) for _ in joints],
        "linkCollisionShapeIndices": [collision_shape(maker) for _ in joints],
        "linkVisualShapeIndices": [visual_shape(maker) for _ in joints],
        "linkPositions": [maker.vector(0.6) for _ in joints],
        "linkOrientations": [maker.turn() for _ in joints],
        "linkInertialFramePositions": [maker.one(([0, 0, 0], maker.vector(0.2))) for _ in joints],
        "linkInertialFrameOrientations": [maker.one(([0, 0, 0, 1], maker.turn())) for _ in joints],
        "linkParentIndices": [maker.random.randint(0, number) for number in range(len(joints))],
        "linkJointTypes": [joint.type for joint in joints],
        "linkJointAxis": [maker.axis() for _ in joints],
    }
