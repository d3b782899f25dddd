"""Joints of a stage: what they connect, how they move, their limits and drives."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from math import inf, radians
from typing import Any

import numpy as np

from carom.description import JointLimit, JointType, Mimic, Pose
from carom.description.joint import BALL, HINGE, HINGES, SLIDER, SLIDES
from carom.description.pose import IDENTITY, Quaternion, Vector3
from carom.description.transform import compose, inverse, quaternion_from_matrix
from carom.formats.usd.bodies import Part, Parts
from carom.formats.usd.drives import read_drive
from carom.formats.usd.exact import numbers
from carom.formats.usd.scene import Drive
from carom.formats.usd.stage import Stage, as_matrix, homogeneous, rigid

_AXES: dict[str, Vector3] = {"X": (1.0, 0.0, 0.0), "Y": (0.0, 1.0, 0.0), "Z": (0.0, 0.0, 1.0)}
_TYPES = {
    "PhysicsFixedJoint": "fixed",
    "PhysicsRevoluteJoint": "revolute",
    "PhysicsPrismaticJoint": "prismatic",
    "PhysicsSphericalJoint": "spherical",
    "PhysicsJoint": "general",
}
# What stands for the axes of a joint in three directions, in the order in which a chain moves.
_DIRECTIONS = ("transX", "transY", "transZ", "rotX", "rotY", "rotZ")
Range = tuple[float, float]


@dataclass(frozen=True, eq=False, slots=True)
class End:
    """An end of a joint: a body, or None for the world; the frame of the joint there; the prim it names."""

    part: Part | None
    frame: Pose
    target: Any = None


@dataclass(eq=False, slots=True)
class Motion:
    """One way in which a joint moves.

    Attributes:
        name: Its name among the joints.
        type: How it moves.
        shift: Pose of its frame in that of the motion before it.
        axis: In the frame of the joint.
        limit: Its bounds.
        damping: [N m s/rad or N s/m].
        friction: [N m or N].
        armature: [kg m² or kg].
        stiffness: [N m/rad or N/m].
        reference: Where that spring is at rest [rad or m].
        mimic: What it follows.
        drive: What drives it.
    """

    name: str
    type: JointType
    shift: Pose = IDENTITY
    axis: Vector3 = (1.0, 0.0, 0.0)
    limit: JointLimit = field(default_factory=JointLimit)
    damping: float = 0.0
    friction: float = 0.0
    armature: float = 0.0
    stiffness: float = 0.0
    reference: float = 0.0
    mimic: Mimic | None = None
    drive: Drive | None = None


@dataclass(eq=False, slots=True)
class UsdJoint:
    """A joint.

    Attributes:
        prim: Its prim.
        ends: What it connects: the first and the second body.
        motions: How the second moves from the first: none for a fixed joint, several for a chain.
        is_free: It restricts nothing.
        outside: It is left out of articulations, as one that closes a loop.
        collide: The bodies that it connects collide.
    """

    prim: Any
    ends: tuple[End, End]
    motions: list[Motion]
    is_free: bool = False
    outside: bool = False
    collide: bool = False


def read_joints(stage: Stage, parts: Parts) -> list[UsdJoint]:
    """The joints of a stage; raises `DescriptionError` if a number has no meaning.

    Joints that are switched off, connect nothing, or are of other kinds are reported and left out.
    """
    found = []
    for prim in stage.prims():
        if not prim.IsA(stage.pxr.UsdPhysics.Joint):
            continue
        kind = _TYPES.get(str(prim.GetTypeName()))
        if not stage.value(prim, "physics:jointEnabled", True):
            stage.leave_out(prim, "none: it is switched off", "the file says so", "physics:jointEnabled")
            continue
        if kind is None:
            stage.leave_out(prim, "nothing is joined", "this kind of joint is not built")
            continue
        joint = _read(stage, parts, prim, kind)
        if joint is not None:
            found.append(joint)
    return _in_series(found)


def _in_series(joints: list[UsdJoint]) -> list[UsdJoint]:
    """Joints that move between the same two bodies come one after the other, as in a body of MJCF."""
    first: dict[tuple[int, int], UsdJoint] = {}
    kept = []
    for joint in joints:
        before, after = joint.ends
        key = (id(before.part), id(after.part))
        moves = (
            bool(joint.motions) and not joint.outside and before.part is not None and after.part is not None
        )
        if not moves or key not in first:
            kept.append(joint)
            if moves:
                first[key] = joint
            continue
        whole = first[key]
        shift = compose(inverse(whole.ends[1].frame), after.frame)
        whole.motions += [
            replace(it, shift=shift if it is joint.motions[0] else it.shift) for it in joint.motions
        ]
        whole.ends = (whole.ends[0], after)
    return kept


def _read(stage: Stage, parts: Parts, prim: Any, kind: str) -> UsdJoint | None:
    ends = (_end(stage, parts, prim, 0), _end(stage, parts, prim, 1))
    if ends[0].part is ends[1].part:
        stage.leave_out(prim, "nothing is joined", "both ends are on one body, or on nothing that moves")
        return None
    for name in ("breakForce", "breakTorque"):
        if stage.number(prim, f"physics:{name}", inf) < inf:
            stage.leave_out(prim, "it never breaks", "joints do not break", f"physics:{name}")
    joint = UsdJoint(prim, ends, [])
    joint.outside = bool(stage.value(prim, "physics:excludeFromArticulation", False))
    joint.collide = bool(stage.value(prim, "physics:collisionEnabled", False))
    name = stage.name_of(prim)
    if kind in ("revolute", "prismatic"):
        _single(stage, joint, name, kind)
    elif kind == "spherical":
        joint.motions = [_spherical(stage, prim, name)]
    elif kind == "general":
        _general(stage, joint, name)
    return joint


def _end(stage: Stage, parts: Parts, prim: Any, number: int) -> End:
    """An end: the body that the relationship names or that is around it, and the frame there."""
    targets = stage.targets(prim, f"physics:body{number}")
    position = np.array([*numbers(stage.value(prim, f"physics:localPos{number}", (0.0,) * 3)), 1.0])
    turn = numbers(stage.value(prim, f"physics:localRot{number}", (0.0, 0.0, 0.0, 1.0)))
    length = float(np.linalg.norm(turn))
    if not (np.isfinite(position).all() and 0.0 < length < inf):
        raise stage.error(prim, f"its frame {number} has no meaning")
    x, y, z, w = (component / length for component in turn)
    frame = stage.matrix(targets[0]) if targets else stage.world_matrix()
    around, _ = rigid(frame)
    px, py, pz = (frame @ position)[:3].tolist()
    pose = compose(around, Pose(orientation=(x, y, z, w)))
    in_world = Pose((px, py, pz), pose.orientation)
    part = parts.of(targets[0]) if targets else None
    if part is None:
        return End(None, in_world, targets[0] if targets else None)
    if part.prim == targets[0]:
        # Without the way through the world, no digit is lost.
        lx, ly, lz = (part.scale @ position[:3]).tolist()
        return End(part, Pose((lx, ly, lz), (x, y, z, w)), part.prim)
    return End(part, compose(inverse(part.pose), in_world), targets[0])


def _single(stage: Stage, joint: UsdJoint, name: str, kind: str) -> None:
    prim, angular = joint.prim, kind == "revolute"
    axis = str(stage.value(prim, "physics:axis", "X"))
    if axis not in _AXES:
        raise stage.error(prim, f"physics:axis is {axis!r}; expected X, Y or Z")
    bounds = _bounds(stage, prim, "physics:lowerLimit", "physics:upperLimit", angular=angular)
    motion = Motion(name, HINGE if angular else SLIDER, axis=_AXES[axis])
    tokens = ("angular", f"rot{axis}") if angular else ("linear", f"trans{axis}")
    _finish(stage, prim, motion, bounds, tokens)
    joint.motions = [motion]


def _bounds(stage: Stage, prim: Any, lower: str, upper: str, *, angular: bool) -> Range:
    """Bounds of a motion [rad or m]; infinite where there is none."""
    low, high = stage.number(prim, lower, -inf), stage.number(prim, upper, inf)
    return (radians(low), radians(high)) if angular else (low * stage.unit, high * stage.unit)


def _finish(stage: Stage, prim: Any, motion: Motion, bounds: Range, tokens: tuple[str, ...]) -> None:
    """Read drive, limit and friction of a motion; the tokens are those of its degree of freedom."""
    angular = motion.type in HINGES
    drives = (read_drive(stage, prim, motion.name, token, angular=angular) for token in tokens)
    motion.drive = next((it for it in drives if it is not None), None)
    effort = motion.drive.actuator.force_range[1] if motion.drive is not None else inf
    fastest = stage.number(prim, "physxJoint:maxJointVelocity", inf)
    fastest = radians(fastest) if angular else fastest * stage.unit
    if bounds[0] > bounds[1]:
        # It does not move.
        bounds = (0.0, 0.0)
    motion.limit = JointLimit(*bounds, effort=effort, velocity=fastest)
    if fastest < inf and not stage.value(prim, "carom:speed", False):
        stage.leave_out(prim, "its speed has no bound", "joints have none", "physxJoint:maxJointVelocity")
    heavy = stage.mass_unit * (stage.unit**2 if angular else 1.0)
    force = stage.mass_unit * stage.unit * (stage.unit if angular else 1.0)
    for name in ("physxJoint:armature", "newton:armature", "mjc:armature"):
        motion.armature = stage.number(prim, name, motion.armature / heavy) * heavy
    for name in ("newton:friction", "mjc:frictionloss"):
        motion.friction = stage.number(prim, name, motion.friction / force) * force
    motion.damping = stage.number(prim, "mjc:damping", 0.0) * heavy
    motion.stiffness = stage.number(prim, "mjc:stiffness", 0.0) * heavy
    motion.reference = stage.number(prim, "mjc:springref", 0.0) * (1.0 if angular else stage.unit)
    motion.mimic = _mimic(stage, prim, angular=angular)


def _mimic(stage: Stage, prim: Any, *, angular: bool) -> Mimic | None:
    """What a joint follows by `NewtonMimicAPI`: offset + factor times the other."""
    leaders = stage.targets(prim, "newton:mimicJoint")
    if not leaders or not stage.value(prim, "newton:mimicEnabled", True):
        return None
    offset = stage.number(prim, "newton:mimicCoef0", 0.0)
    factor = stage.number(prim, "newton:mimicCoef1", 1.0)
    leads = str(leaders[0].GetTypeName()) == "PhysicsRevoluteJoint"
    if angular != leads:
        # In radians and metres.
        factor *= radians(1.0) / stage.unit if angular else stage.unit / radians(1.0)
    return Mimic(stage.name_of(leaders[0]), factor, radians(offset) if angular else offset * stage.unit)


def _spherical(stage: Stage, prim: Any, name: str) -> Motion:
    stage.value(prim, "physics:axis")
    for number in (0, 1):
        cone = f"physics:coneAngle{number}Limit"
        if stage.number(prim, cone, -1.0) >= 0.0:
            stage.leave_out(prim, "it turns without limits", "limits of cones are not built", cone)
    return Motion(name, BALL)


def _general(stage: Stage, joint: UsdJoint, name: str) -> None:
    """A joint that `LimitAPI` restricts: directions with a lower limit above the upper one do not move."""
    prim, open_ways = joint.prim, []
    whole = _limited(stage, prim, "distance")
    if whole != (-inf, inf):
        stage.leave_out(
            prim, "its distance has no bound", "limits of distances are not built", "limit:distance"
        )
    for token in _DIRECTIONS:
        low, high = _limited(stage, prim, token)
        if low <= high:
            open_ways.append((token, (low, high)))
    tokens = [token for token, _ in open_ways]
    turns = [token for token in tokens if token.startswith("rot")]
    joint.is_free = len(open_ways) == 6 and all(bounds == (-inf, inf) for _, bounds in open_ways)
    if joint.is_free:
        return
    if len(turns) == 3:
        for token, bounds in open_ways:
            if token in turns and bounds != (-inf, inf):
                stage.leave_out(
                    prim, "it turns without limits", "limits of balls are not built", f"limit:{token}"
                )
        open_ways = [it for it in open_ways if it[0] not in turns]
    elif len(turns) == 2:
        stage.leave_out(prim, "its angles are those of one axis after the other", "two axes make a chain")
    for token, bounds in open_ways:
        angular = token.startswith("rot")
        low, high = bounds
        scaled = (radians(low), radians(high)) if angular else (low * stage.unit, high * stage.unit)
        one = name if len(open_ways) == 1 and len(turns) < 3 else f"{name}@{token}"
        motion = Motion(one, HINGE if angular else SLIDER, axis=_AXES[token[-1]])
        _finish(stage, prim, motion, scaled, (token,))
        joint.motions.append(motion)
    if len(turns) == 3:
        joint.motions.append(Motion(name, BALL))


def _limited(stage: Stage, prim: Any, token: str) -> Range:
    """The limit of a degree of freedom, as the file has it; infinite where there is none."""
    low = stage.number(prim, f"limit:{token}:physics:low", -inf)
    return low, stage.number(prim, f"limit:{token}:physics:high", inf)


def position_of(motion: Motion, between: Pose) -> tuple[float, Quaternion]:
    """The position of a motion, and its turn, from the pose of the second frame in the first."""
    relative = homogeneous(between)
    if motion.type in SLIDES:
        return float(np.dot(motion.axis, relative[:3, 3])), (0.0, 0.0, 0.0, 1.0)
    turn = quaternion_from_matrix(as_matrix(relative[:3, :3]))
    about = float(np.dot(motion.axis, turn[:3]))
    return 2.0 * float(np.arctan2(about, turn[3])), turn
