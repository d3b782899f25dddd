"""Bodies of every kind of shape that come into contact with every other: runs with PyBullet and with Carom.

What decides how a motion goes on is the first contact: at which gap it is made, with how many points, which
normal and which force. So each case is followed up to its third step with contact.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product
from math import cos, sin
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

MOVING = ("sphere", "box", "capsule", "cylinder", "hull")
SURFACES = ("mesh", "heightfield")
"""What is made of triangles."""
RESTING = (*MOVING, "plane", *SURFACES)
PLACES = ("base", "turned", "offset", "compound", "pair", "link", "link offset")
"""Of the moving shape: in place at the base's centre of mass, turned there, away from there, one of two
shapes of the base, beside a fixed link, on a hinged link, and there away from its centre of mass."""
MOTIONS = ("fall", "fall tilted", "slide", "roll")
BREAKING = (0.02, 0.1)
SUPPORTS = ("base", "offset", "link")
"""Of the shape at rest: in place at the base's origin, away from there, or on a link."""

_STEPS = 160
CONTACTS = 3
"""So many steps with contact are followed."""
_HALF = 0.1
_GAP = 0.03
_TILT = (0.1, 0.2, 0.3)
_OFFSET = (0.03, 0.02, 0.04)


@dataclass(frozen=True)
class Case:
    """One motion of a body towards another.

    Attributes:
        moving: Kind of the shape that moves.
        resting: Kind of the shape that is there.
        place: One of `PLACES`, of the moving one.
        motion: One of `MOTIONS`.
        breaking: `contactBreakingThreshold`.
        support: One of `SUPPORTS`, of the resting one.
    """

    moving: str
    resting: str
    place: str
    motion: str
    breaking: float
    support: str = SUPPORTS[0]

    @property
    def name(self) -> str:
        below = "" if self.support == SUPPORTS[0] else f" {self.support}"
        return f"{self.moving} on {self.resting}{below}, {self.place}, {self.motion}, {self.breaking}"


def cases() -> Iterator[Case]:
    """Each kind on each in each place, motion and breaking distance, some also on other supports."""
    for moving, resting in product(MOVING, RESTING):
        for place, motion, breaking in product(PLACES, MOTIONS, BREAKING):
            yield Case(moving, resting, place, motion, breaking)
        for support, place, motion in product(SUPPORTS[1:], ("base", "link"), ("fall tilted", "slide")):
            yield Case(moving, resting, place, motion, BREAKING[0], support)


def follow(p: Any, case: Case) -> list[dict[str, Any]]:
    """The first three steps with contact, in a connection of their own.

    Returns:
        Of each its number, and of each point of contact the distance, the normal, the point on the moving
        body, and the normal force.
    """
    client = p.connect(p.DIRECT)
    try:
        p.setGravity(0, 0, -10)
        p.setPhysicsEngineParameter(contactBreakingThreshold=case.breaking)
        _resting(p, case)
        moving = _moving(p, case)
        found = []
        for step in range(_STEPS):
            p.stepSimulation()
            points = p.getContactPoints(bodyA=moving, bodyB=0)
            if points:
                found.append({"step": step, "points": [_plain(point) for point in points]})
            if len(found) == CONTACTS:
                break
        return found
    finally:
        # It belongs to the process in PyBullet.
        p.setPhysicsEngineParameter(contactBreakingThreshold=BREAKING[0])
        p.disconnect(client)


def _plain(point: Any) -> list[float]:
    return [point[8], *point[7], *point[5], point[9]]


def _shape(p: Any, kind: str, **frame: Any) -> int:
    match kind:
        case "sphere":
            return p.createCollisionShape(p.GEOM_SPHERE, radius=_HALF, **frame)
        case "box":
            return p.createCollisionShape(p.GEOM_BOX, halfExtents=[_HALF, 0.12, 0.08], **frame)
        case "capsule":
            return p.createCollisionShape(p.GEOM_CAPSULE, radius=0.06, height=0.12, **frame)
        case "cylinder":
            return p.createCollisionShape(p.GEOM_CYLINDER, radius=_HALF, height=0.14, **frame)
        case "hull":
            return p.createCollisionShape(p.GEOM_MESH, vertices=_gem(), **frame)
        case "plane":
            return p.createCollisionShape(p.GEOM_PLANE, **frame)
        case "mesh":
            corners, triangles = _bumpy_grid()
            return p.createCollisionShape(p.GEOM_MESH, vertices=corners, indices=triangles, **frame)
    heights = [0.0] * 81
    return p.createCollisionShape(
        p.GEOM_HEIGHTFIELD,
        meshScale=[0.2, 0.2, 1.0],
        heightfieldData=heights,
        numHeightfieldRows=9,
        numHeightfieldColumns=9,
        **frame,
    )


def _gem() -> list[list[float]]:
    """Twelve corners on two rings and two tips."""
    rings = [(0.06, 0.08), (-0.04, 0.1)]
    corners = [
        [radius * cos(turn + height), radius * sin(turn + height), height]
        for height, radius in rings
        for turn in (0.0, 1.2566, 2.5133, 3.7699, 5.0265)
    ]
    return [*corners, [0.0, 0.0, 0.1], [0.0, 0.0, -0.09]]


def _bumpy_grid() -> tuple[list[list[float]], list[int]]:
    """A flat grid of triangles, 1.6 m wide."""
    corners = [[0.2 * i - 0.8, 0.2 * j - 0.8, 0.0] for i in range(9) for j in range(9)]
    triangles = []
    for i in range(8):
        for j in range(8):
            a = 9 * i + j
            triangles += [a, a + 9, a + 1, a + 1, a + 9, a + 10]
    return corners, triangles


def _resting(p: Any, case: Case) -> None:
    """Body 0, its highest point in the middle at height 0."""
    heights = {"sphere": _HALF, "box": 0.08, "capsule": 0.12, "cylinder": 0.07, "hull": 0.1}
    place = [0.0, 0.0, -heights.get(case.resting, 0.0)]
    match case.support:
        case "base":
            p.createMultiBody(0, _shape(p, case.resting), -1, place)
        case "offset":
            shape = _shape(p, case.resting, collisionFramePosition=[0.05, 0.0, -0.03])
            p.createMultiBody(0, shape, -1, [-0.05, 0.0, place[2] + 0.03])
        case _:
            link = _link(p, _shape(p, case.resting), 0.0, p.JOINT_FIXED)
            p.createMultiBody(0, -1, -1, place, **link)


def _moving(p: Any, case: Case) -> int:
    radius = {"sphere": _HALF, "box": 0.18, "capsule": 0.12, "cylinder": 0.125, "hull": 0.105}[case.moving]
    turn = [0.0, 0.0, 0.0, 1.0] if case.motion == "fall" else p.getQuaternionFromEuler(_TILT)
    height = radius + _GAP + (0.06 if case.place not in ("base", "turned") else 0.0)
    start = [0.013, 0.021, height]
    body = _body(p, case, start, turn)
    linear, angular = [0.0, 0.0, -0.5], [0.0, 0.0, 0.0]
    if case.motion == "slide":
        linear = [0.4, 0.1, -0.4]
    if case.motion == "roll":
        angular = [0.0, 4.0, 1.0]
    p.resetBaseVelocity(body, linear, angular)
    return body


def _body(p: Any, case: Case, start: list[float], turn: Any) -> int:
    match case.place:
        case "base":
            return p.createMultiBody(1.0, _shape(p, case.moving), -1, start, turn)
        case "turned":
            frame = {"collisionFrameOrientation": p.getQuaternionFromEuler((0.4, -0.3, 0.2))}
            return p.createMultiBody(1.0, _shape(p, case.moving, **frame), -1, start, turn)
        case "offset":
            shape = _shape(p, case.moving, collisionFramePosition=_OFFSET)
            return p.createMultiBody(1.0, shape, -1, start, turn)
        case "compound":
            return p.createMultiBody(1.0, _compound(p, case.moving), -1, start, turn)
        case "pair":
            shape = _shape(p, case.moving)
            other = p.createCollisionShape(p.GEOM_SPHERE, radius=0.02, collisionFramePosition=[0, 0, 0.1])
            return p.createMultiBody(1.0, shape, -1, start, turn, **_link(p, other, 0.2, p.JOINT_FIXED))
    frame = {"collisionFramePosition": _OFFSET} if case.place == "link offset" else {}
    bare = p.createCollisionShape(p.GEOM_SPHERE, radius=0.01)
    high = [start[0], start[1], start[2] + 0.1]
    link = _link(p, _shape(p, case.moving, **frame), 0.5, p.JOINT_REVOLUTE)
    body = p.createMultiBody(0.5, bare, -1, high, turn, **link)
    p.setJointMotorControl2(body, 0, p.VELOCITY_CONTROL, force=0)
    return body


def _compound(p: Any, kind: str) -> int:
    """A shape away from the centre of mass, and a small ball on the other side."""
    types = {
        "sphere": p.GEOM_SPHERE,
        "box": p.GEOM_BOX,
        "capsule": p.GEOM_CAPSULE,
        "cylinder": p.GEOM_CYLINDER,
        "hull": p.GEOM_MESH,
    }
    with TemporaryDirectory() as folder:
        file = Path(folder) / "gem.obj"
        corners = [f"v {x!r} {y!r} {z!r}" for x, y, z in _gem()]
        # PyBullet takes the corners of faces only.
        faces = [f"f {k + 1} {k + 2} {k + 3}" for k in range(len(corners) - 2)]
        file.write_text("\n".join([*corners, *faces, ""]), encoding="utf-8")
        return p.createCollisionShapeArray(
            shapeTypes=[types[kind], p.GEOM_SPHERE],
            radii=[0.06 if kind == "capsule" else _HALF, 0.02],
            halfExtents=[[_HALF, 0.12, 0.08], [0, 0, 0]],
            lengths=[0.12 if kind == "capsule" else 0.14, 0],
            fileNames=[str(file) if kind == "hull" else "", ""],
            meshScales=[[1, 1, 1], [1, 1, 1]],
            planeNormals=[[0, 0, 1], [0, 0, 1]],
            flags=[0, 0],
            collisionFramePositions=[[-it for it in _OFFSET], _OFFSET],
            collisionFrameOrientations=[[0, 0, 0, 1], [0, 0, 0, 1]],
        )


def _link(p: Any, shape: int, mass: float, joint: int) -> dict[str, Any]:
    """One link below the base, on a joint about x."""
    return {
        "linkMasses": [mass],
        "linkCollisionShapeIndices": [shape],
        "linkVisualShapeIndices": [-1],
        "linkPositions": [[0, 0, -0.1 if joint == p.JOINT_REVOLUTE else 0.0]],
        "linkOrientations": [[0, 0, 0, 1]],
        "linkInertialFramePositions": [[0, 0, 0]],
        "linkInertialFrameOrientations": [[0, 0, 0, 1]],
        "linkParentIndices": [0],
        "linkJointTypes": [joint],
        "linkJointAxis": [[1, 0, 0]],
    }
