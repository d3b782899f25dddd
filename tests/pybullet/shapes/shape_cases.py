"""What both engines are asked about shapes. Standard library only: both sides import it."""

from __future__ import annotations

from collections.abc import Callable
from math import cos, sin
from pathlib import Path
from typing import Any

FORMATS = Path(__file__).resolve().parents[2] / "formats" / "data"
MESHES = FORMATS / "meshes"

TURNED = [0.0, 0.0, 0.6, 0.8]
TILTED = [0.1, 0.2, 0.3, 0.9273618495495703]
POINTS = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.2, 0.2, 0.2]]
CORNERS = [0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3]

# Arguments of createCollisionShape; the type by name.
COLLISION_SHAPES: dict[str, dict[str, Any]] = {
    "sphere": {"shapeType": "GEOM_SPHERE", "radius": 0.3},
    "default sphere": {"shapeType": "GEOM_SPHERE"},
    "box": {"shapeType": "GEOM_BOX", "halfExtents": [0.1, 0.2, 0.3]},
    "flat box": {"shapeType": "GEOM_BOX", "halfExtents": [0.1, 0.2, 0.0]},
    "capsule": {"shapeType": "GEOM_CAPSULE", "radius": 0.2, "height": 0.6},
    "ball-like capsule": {"shapeType": "GEOM_CAPSULE", "radius": 0.2, "height": 0.0},
    "cylinder": {"shapeType": "GEOM_CYLINDER", "radius": 0.2, "height": 0.6},
    "default cylinder": {"shapeType": "GEOM_CYLINDER"},
    "plane": {"shapeType": "GEOM_PLANE"},
    "tilted plane": {"shapeType": "GEOM_PLANE", "planeNormal": [0.0, 3.0, 4.0]},
    "box aside": {
        "shapeType": "GEOM_BOX",
        "halfExtents": [0.1, 0.2, 0.3],
        "collisionFramePosition": [0.1, -0.2, 0.3],
        "collisionFrameOrientation": TILTED,
    },
    "box with a frame of its own at the origin": {
        "shapeType": "GEOM_BOX",
        "halfExtents": [0.1, 0.2, 0.3],
        "collisionFramePosition": [0.0, 0.0, 0.0],
    },
    "cylinder on its side": {
        "shapeType": "GEOM_CYLINDER",
        "radius": 0.2,
        "height": 0.6,
        "collisionFrameOrientation": [0.0, 0.7071067811865475, 0.0, 0.7071067811865476],
    },
    "capsule with a long quaternion": {
        "shapeType": "GEOM_CAPSULE",
        "radius": 0.2,
        "height": 0.6,
        "collisionFrameOrientation": [0.0, 0.0, 3.0, -4.0],
    },
    "obj": {"shapeType": "GEOM_MESH", "fileName": "two_boxes.obj", "meshScale": [1.0, 2.0, -3.0]},
    "obj aside": {
        "shapeType": "GEOM_MESH",
        "fileName": "two_boxes.obj",
        "collisionFramePosition": [0.0, 0.0, 1.0],
    },
    "concave obj": {"shapeType": "GEOM_MESH", "fileName": "two_boxes.obj", "flags": 1},
    "stl": {"shapeType": "GEOM_MESH", "fileName": "wedge.stl", "meshScale": [2.0, 2.0, 2.0]},
    "concave stl": {"shapeType": "GEOM_MESH", "fileName": "wedge.stl", "flags": 3},
    "concave stl aside": {
        "shapeType": "GEOM_MESH",
        "fileName": "wedge.stl",
        "flags": 1,
        "collisionFramePosition": [0.0, 0.0, 1.0],
    },
    "points": {"shapeType": "GEOM_MESH", "vertices": POINTS, "meshScale": [1.0, 2.0, 3.0]},
    "two points": {"shapeType": "GEOM_MESH", "vertices": POINTS[:2]},
    "three points": {"shapeType": "GEOM_MESH", "vertices": POINTS[:3]},
    "triangles": {"shapeType": "GEOM_MESH", "vertices": POINTS, "indices": CORNERS},
    "landscape": {
        "shapeType": "GEOM_HEIGHTFIELD",
        "meshScale": [0.5, 2.0, 3.0],
        "heightfieldData": [0.1 * place for place in range(12)],
        "numHeightfieldRows": 4,
        "numHeightfieldColumns": 3,
    },
}

SHAPE_ARRAYS: dict[str, dict[str, Any]] = {
    "ball and box": {
        "shapeTypes": ["GEOM_SPHERE", "GEOM_BOX"],
        "radii": [0.3, 0.0],
        "halfExtents": [[1, 1, 1]] * 2,
    },
    "ball and box apart": {
        "shapeTypes": ["GEOM_SPHERE", "GEOM_BOX"],
        "radii": [0.3, 0.0],
        "halfExtents": [[0, 0, 0], [0.1, 0.2, 0.3]],
        "collisionFramePositions": [[0, 0, 0], [0.5, 0, 0]],
    },
    "one ball": {"shapeTypes": ["GEOM_SPHERE"], "radii": [0.3]},
    "a box without size": {"shapeTypes": ["GEOM_BOX"]},
    "one of two balls": {"shapeTypes": ["GEOM_SPHERE", "GEOM_SPHERE"], "radii": [0.0, 0.7]},
    "ball, and cylinder without a length": {
        "shapeTypes": ["GEOM_SPHERE", "GEOM_CYLINDER"],
        "radii": [0.3, 0.2],
    },
    "two cylinders with one length": {
        "shapeTypes": ["GEOM_CYLINDER", "GEOM_CYLINDER"],
        "radii": [0.3, 0.2],
        "lengths": [0.4],
    },
    "cylinder, capsule and mesh": {
        "shapeTypes": ["GEOM_CYLINDER", "GEOM_CAPSULE", "GEOM_MESH"],
        "radii": [0.1, 0.2, 0.0],
        "lengths": [0.3, 0.4, 0.0],
        "fileNames": ["", "", "two_boxes.obj"],
        "meshScales": [[1, 1, 1], [1, 1, 1], [2, 2, 2]],
        "collisionFramePositions": [[0, 0, 0], [0.5, 0, 0], [0, 0.5, 0]],
        "collisionFrameOrientations": [[0, 0, 0, 1], TURNED, TILTED],
    },
}

VISUAL_SHAPES: dict[str, dict[str, Any]] = {
    "box": {"shapeType": "GEOM_BOX", "halfExtents": [0.1, 0.2, 0.3], "rgbaColor": [1.0, 0.0, 0.0, 0.5]},
    "ball aside": {
        "shapeType": "GEOM_SPHERE",
        "radius": 0.1,
        "visualFramePosition": [0.1, 0.2, 0.3],
        "visualFrameOrientation": [0.0, 0.0, 1.0, 1.0],
    },
    "capsule": {"shapeType": "GEOM_CAPSULE", "radius": 0.1, "length": 0.4},
    "cylinder": {"shapeType": "GEOM_CYLINDER", "radius": 0.1, "length": 0.4},
    "plane": {"shapeType": "GEOM_PLANE"},
    "obj": {"shapeType": "GEOM_MESH", "fileName": "two_boxes.obj", "meshScale": [1.0, 2.0, 3.0]},
    "dae": {"shapeType": "GEOM_MESH", "fileName": "wedge.dae"},
    "triangles": {"shapeType": "GEOM_MESH", "vertices": POINTS, "indices": CORNERS},
    "no file": {"shapeType": "GEOM_MESH", "fileName": "nowhere.obj"},
}

VISUAL_ARRAYS: dict[str, dict[str, Any]] = {
    "coloured": {
        "shapeTypes": ["GEOM_SPHERE", "GEOM_BOX"],
        "radii": [0.3, 0.0],
        "halfExtents": [[0, 0, 0], [0.1, 0.2, 0.3]],
        "rgbaColors": [[1, 1, 0, 1], [0, 1, 0, 1]],
        "visualFramePositions": [[0, 0, 0], [1, 2, 3]],
    },
    "plain": {
        "shapeTypes": ["GEOM_CAPSULE", "GEOM_MESH"],
        "radii": [0.3, 0.0],
        "lengths": [1.0, 0.0],
        "fileNames": ["", "two_boxes.obj"],
    },
}

# Calls that PyBullet refuses.
REFUSED: dict[str, tuple[str, dict[str, Any]]] = {
    "box without size": ("createCollisionShape", {"shapeType": "GEOM_BOX"}),
    "ball of radius 0": ("createCollisionShape", {"shapeType": "GEOM_SPHERE", "radius": 0}),
    "ball of negative radius": ("createCollisionShape", {"shapeType": "GEOM_SPHERE", "radius": -1}),
    "cylinder of negative height": ("createCollisionShape", {"shapeType": "GEOM_CYLINDER", "height": -1}),
    "mesh of nothing": ("createCollisionShape", {"shapeType": "GEOM_MESH"}),
    "mesh without points": ("createCollisionShape", {"shapeType": "GEOM_MESH", "vertices": []}),
    "missing mesh": ("createCollisionShape", {"shapeType": "GEOM_MESH", "fileName": "nowhere.obj"}),
    "landscape of nothing": ("createCollisionShape", {"shapeType": "GEOM_HEIGHTFIELD"}),
    "landscape with a height missing": (
        "createCollisionShape",
        {
            "shapeType": "GEOM_HEIGHTFIELD",
            "heightfieldData": [1.0, 2.0, 3.0],
            "numHeightfieldRows": 2,
            "numHeightfieldColumns": 2,
        },
    ),
    "replaced landscape that is none": (
        "createCollisionShape",
        {
            "shapeType": "GEOM_HEIGHTFIELD",
            "heightfieldData": [1.0] * 4,
            "numHeightfieldRows": 2,
            "numHeightfieldColumns": 2,
            "replaceHeightfieldIndex": 99,
        },
    ),
    "unknown type": ("createCollisionShape", {"shapeType": 99}),
    "no types": ("createCollisionShapeArray", {"shapeTypes": []}),
    "types that are no list": ("createCollisionShapeArray", {"shapeTypes": 5}),
    "array of nothing usable": ("createCollisionShapeArray", {"shapeTypes": ["GEOM_SPHERE"], "radii": [0.0]}),
    "cylinder of an array without lengths": (
        "createCollisionShapeArray",
        {"shapeTypes": ["GEOM_CYLINDER"], "radii": [0.2]},
    ),
    "visual cylinder of an array without lengths": (
        "createVisualShapeArray",
        {"shapeTypes": ["GEOM_CYLINDER"], "radii": [0.2]},
    ),
    "visual box without size": ("createVisualShape", {"shapeType": "GEOM_BOX"}),
    "visual ball of radius 0": ("createVisualShape", {"shapeType": "GEOM_SPHERE", "radius": 0}),
    "visual points without triangles": ("createVisualShape", {"shapeType": "GEOM_MESH", "vertices": POINTS}),
    "visual landscape": ("createVisualShape", {"shapeType": "GEOM_HEIGHTFIELD"}),
    "no visual types": ("createVisualShapeArray", {"shapeTypes": []}),
    "link lists of different lengths": ("createMultiBody", {"linkMasses": [1.0]}),
    "shapes of no body": ("getCollisionShapeData", {"objectUniqueId": 99, "linkIndex": -1}),
    "bounds of no body": ("getAABB", {"bodyUniqueId": 99}),
    "corners of no body": ("getMeshData", {"bodyUniqueId": 99}),
}


def call(p: Any, function: str, arguments: dict[str, Any]) -> Any:
    """Calls a function of PyBullet; names of types stand for the types."""
    given = dict(arguments)
    if isinstance(given.get("shapeType"), str):
        given["shapeType"] = getattr(p, given["shapeType"])
    if isinstance(given.get("shapeTypes"), list):
        given["shapeTypes"] = [getattr(p, name) for name in given["shapeTypes"]]
    return getattr(p, function)(**given)


def describe(p: Any, body: int, link: int = -1) -> dict[str, Any]:
    """Everything that can be read of a link's shapes, but for what is garbage in PyBullet."""
    return {
        "dynamics": p.getDynamicsInfo(body, link),
        # The ids in front are right in the first entry only.
        "collision": [entry[2:] for entry in p.getCollisionShapeData(body, link)],
        "bounds": p.getAABB(body, link),
    }


def describe_body(p: Any, body: int) -> dict[str, Any]:
    joints = range(p.getNumJoints(body))
    return {
        "names": p.getBodyInfo(body),
        "pose": p.getBasePositionAndOrientation(body),
        "visual": p.getVisualShapeData(body),
        "links": [describe(p, body, link) for link in (-1, *joints)],
        "joints": [p.getJointInfo(body, joint) for joint in joints],
        # PyBullet rounds the fields that follow to single precision.
        "states": [p.getLinkState(body, joint)[:4] for joint in joints],
    }


def corners(p: Any, body: int, link: int = -1, index: int = -1) -> list[Any]:
    """Corners of hulls, in some order."""
    count, vertices = p.getMeshData(body, link, index)
    assert count == len(vertices)
    return [list(vertex) for vertex in vertices]


def links(count: int, **lists: Any) -> dict[str, Any]:
    """Link lists of createMultiBody, with something in those that are not given."""
    defaults: dict[str, Callable[[int], Any]] = {
        "linkMasses": lambda j: 0.5 + 0.25 * j,
        "linkCollisionShapeIndices": lambda j: -1,
        "linkVisualShapeIndices": lambda j: -1,
        "linkPositions": lambda j: [0.1 * j, 0.2, 0.5],
        "linkOrientations": lambda j: [0.0, 0.0, sin(0.1 * j), cos(0.1 * j)],
        "linkInertialFramePositions": lambda j: [0.0, 0.05 * j, 0.1],
        "linkInertialFrameOrientations": lambda j: [sin(0.2 * j), 0.0, 0.0, cos(0.2 * j)],
        "linkParentIndices": lambda j: j,
        "linkJointTypes": lambda j: 0,
        "linkJointAxis": lambda j: [0.0, 1.0, 0.0],
    }
    return {name: lists.get(name, [make(j) for j in range(count)]) for name, make in defaults.items()}


def tree(p: Any, flags: int = -1, parents: list[int] | None = None) -> int:
    """A body of six links and all joints that can be made."""
    box = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1, 0.2, 0.3])
    rod = p.createCollisionShape(p.GEOM_CAPSULE, radius=0.05, height=0.4, collisionFramePosition=[0, 0, 0.2])
    red = p.createVisualShape(p.GEOM_SPHERE, radius=0.2, rgbaColor=[1, 0, 0, 1])
    return p.createMultiBody(
        2.0,
        box,
        -1,
        [1.0, 2.0, 3.0],
        TURNED,
        [0.0, 0.1, 0.0],
        [0.0, 0.0, 0.0, 1.0],
        flags=flags,
        **links(
            6,
            linkCollisionShapeIndices=[rod, box, -1, rod, rod, box],
            linkVisualShapeIndices=[-1, red, red, -1, -1, -1],
            linkParentIndices=parents or [0, 1, 1, 3, 0, 2],
            linkJointTypes=[0, 1, 2, 4, 0, 0],
            linkJointAxis=[[0, 1, 0], [0, 0, 2], [0, 0, 0], [0, 0, 0], [1, 1, 0], [0, 0, -1]],
        ),
    )


def shape_ids(p: Any) -> list[int]:
    ids = [p.createCollisionShape(p.GEOM_SPHERE) for _ in range(4)]
    p.removeCollisionShape(1)
    p.removeCollisionShape(2)
    ids += [p.createCollisionShape(p.GEOM_SPHERE) for _ in range(3)]
    body = p.createMultiBody(1.0, 0)
    p.removeCollisionShape(0)
    ids.append(p.createCollisionShape(p.GEOM_SPHERE))
    p.removeBody(body)
    p.removeCollisionShape(0)
    ids.append(p.createCollisionShape(p.GEOM_SPHERE))
    p.removeCollisionShape(-1)
    p.removeCollisionShape(500)
    ids += [p.createVisualShape(p.GEOM_SPHERE) for _ in range(2)]
    p.resetSimulation()
    ids += [p.createCollisionShape(p.GEOM_SPHERE), p.createVisualShape(p.GEOM_SPHERE)]
    return ids


def batch(p: Any) -> Any:
    box = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1, 0.2, 0.3])
    places = [[0, 0, 0], [1, 0, 0], [2, 0, 3]]
    ids = p.createMultiBody(
        1.0, box, basePosition=[9, 9, 9], baseInertialFramePosition=[0.1, 0, 0], batchPositions=places
    )
    return ids, [p.getBasePositionAndOrientation(body) for body in ids]


def masses_of_an_implicit_cylinder(p: Any) -> Any:
    body = p.createMultiBody(1.0, p.createCollisionShape(p.GEOM_CYLINDER, radius=0.2, height=0.6))
    p.changeDynamics(body, -1, mass=3.0)
    return p.getDynamicsInfo(body, -1)[:3]


def masses_of_a_compound(p: Any) -> Any:
    body = p.createMultiBody(
        1.0, p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1, 0.2, 0.3], collisionFramePosition=[0, 0, 1])
    )
    p.changeDynamics(body, -1, mass=3.0)
    return p.getDynamicsInfo(body, -1)[:3]


def robot_from_file(p: Any) -> Any:
    body = p.loadURDF(str(FORMATS / "shapes.urdf"))
    found = describe_body(p, body)
    del found["joints"], found["states"]
    return found


def _of_shape(arguments: dict[str, Any], function: str = "createCollisionShape") -> Callable[[Any], Any]:
    def ask(p: Any) -> Any:
        shape = call(p, function, arguments)
        plain = p.createMultiBody(1.5, shape)
        moved = p.createMultiBody(
            1.5,
            shape,
            basePosition=[1.0, -2.0, 3.0],
            baseOrientation=TILTED,
            baseInertialFramePosition=[0.1, 0.2, 0.3],
            baseInertialFrameOrientation=TURNED,
        )
        return shape, describe_body(p, plain), describe_body(p, moved)

    return ask


def _of_visual(arguments: dict[str, Any], function: str = "createVisualShape") -> Callable[[Any], Any]:
    def ask(p: Any) -> Any:
        box = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1, 0.2, 0.3])
        shape = call(p, function, arguments)
        return shape, p.getVisualShapeData(p.createMultiBody(1.0, box, shape))

    return ask


CASES: dict[str, Callable[[Any], Any]] = {
    **{f"collision shape: {name}": _of_shape(arguments) for name, arguments in COLLISION_SHAPES.items()},
    **{
        f"collision shapes: {name}": _of_shape(arguments, "createCollisionShapeArray")
        for name, arguments in SHAPE_ARRAYS.items()
    },
    **{f"visual shape: {name}": _of_visual(arguments) for name, arguments in VISUAL_SHAPES.items()},
    **{
        f"visual shapes: {name}": _of_visual(arguments, "createVisualShapeArray")
        for name, arguments in VISUAL_ARRAYS.items()
    },
    "no shape": lambda p: describe_body(p, p.createMultiBody(1.0)),
    "no mass": lambda p: describe_body(p, p.createMultiBody(0, p.createCollisionShape(p.GEOM_SPHERE))),
    "unknown shapes": lambda p: describe_body(p, p.createMultiBody(1.0, 77, 88)),
    "tree": lambda p: describe_body(p, tree(p)),
    "tree in the order of the lists": lambda p: describe_body(p, tree(p, flags=131072)),
    "tree with branches": lambda p: describe_body(p, tree(p, parents=[0, 0, 0, 1, 2, 1])),
    "tree whose children come first": lambda p: describe_body(p, tree(p, parents=[2, 3, 0, 3, 4, 1])),
    "inertia from the arguments": lambda p: describe_body(p, tree(p, flags=2)),
    "ids of shapes": shape_ids,
    "batch": batch,
    "long quaternion": lambda p: p.getBasePositionAndOrientation(
        p.createMultiBody(1.0, baseOrientation=[0, 0, 0, 2])
    ),
    "changed mass of an implicit cylinder": masses_of_an_implicit_cylinder,
    "changed mass of a compound": masses_of_a_compound,
    "robot from a file": robot_from_file,
    "visual shapes of no body": lambda p: p.getVisualShapeData(99),
    "filters of no body": lambda p: (
        p.setCollisionFilterPair(99, 98, -1, -1, 0),
        p.setCollisionFilterGroupMask(99, -1, 0, 0),
    ),
}


def hull_of(name: str, index: int = -1) -> Callable[[Any], list[Any]]:
    def ask(p: Any) -> list[Any]:
        body = p.createMultiBody(
            1.0,
            call(p, "createCollisionShape", COLLISION_SHAPES[name]),
            baseInertialFramePosition=[0.1, 0, 0],
        )
        return corners(p, body, index=index)

    return ask


def hulls_of_file(p: Any) -> list[Any]:
    body = p.loadURDF(str(FORMATS / "shapes.urdf"))
    return [corner for link in range(p.getNumJoints(body)) for corner in corners(p, body, link)]


# Corners come in another order.
CORNER_CASES: dict[str, Callable[[Any], list[Any]]] = {
    **{
        f"corners: {name}": hull_of(name)
        for name in ("sphere", "box", "obj", "stl", "points", "three points")
    },
    **{f"corners: {name}": hull_of(name) for name in ("two points", "concave obj", "obj aside")},
    "corners: second group": hull_of("obj", 1),
    "corners: no such group": hull_of("obj", 5),
    "corners: robot from a file": hulls_of_file,
}
