"""Writing a joint of a robot as a prim of the physics schema."""

from __future__ import annotations

from math import degrees, inf
from typing import TYPE_CHECKING, Any

from carom.description import Joint
from carom.description.joint import BALL_TYPES, JOINTS, ONE_AXIS, PLANE_TYPES, SLIDES, STILL, WITHOUT_LIMIT
from carom.description.pose import IDENTITY, Quaternion, Vector3
from carom.description.transform import multiplied, turn_of_z

if TYPE_CHECKING:
    from carom.formats.usd.target import Target

_AXES: dict[Vector3, str] = {(1.0, 0.0, 0.0): "X", (0.0, 1.0, 0.0): "Y", (0.0, 0.0, 1.0): "Z"}
_NOT_SAID = ("limit_compliance", "friction_compliance", "safety")


def write_joint(target: Target, joint: Joint) -> None:
    """Write a joint; what the schema cannot say is reported.

    Damping, dry friction, armature and springs are attributes of MuJoCo's schema, `mjc:`, and `<mimic>` is
    one of Newton's. An effort is a drive without gains, which is a motor here.
    """
    pxr, put = target.pxr, target.values.put
    kind = getattr(pxr.UsdPhysics, JOINTS[joint.type].usd)
    prim = kind.Define(target.stage, target.joints[joint.name]).GetPrim()
    target.name(prim, joint.name)
    prim.GetRelationship("physics:body0").SetTargets([target.links[joint.parent]])
    prim.GetRelationship("physics:body1").SetTargets([target.links[joint.child]])
    turn, axis = _turn(joint)
    put(prim, "physics:localPos0", "Point3f", joint.frame.position)
    put(prim, "physics:localRot0", "Quatf", multiplied(joint.frame.orientation, turn))
    put(prim, "physics:localRot1", "Quatf", turn)
    if joint.type in PLANE_TYPES:
        for token in ("transZ", "rotX", "rotY"):
            _lock(target, prim, token)
    if joint.type in ONE_AXIS:
        put(prim, "physics:axis", "Token", axis)
        _limits(target, prim, joint)
        _dynamics(target, prim, joint)
    elif joint.damping or joint.friction or joint.armature or joint.stiffness:
        target.leave_out("joint", "it moves without them", "USD has none for this kind of joint", "dynamics")
    for name in _NOT_SAID:
        if getattr(joint, name) is not None:
            effect = "none: nothing simulates it" if name == "safety" else "it has no effect"
            target.leave_out("joint", effect, "USD does not say it", name)


def _turn(joint: Joint) -> tuple[Quaternion, str]:
    """What turns the frame of a joint so that its axis is one of x, y and z, and which."""
    if joint.type in (*STILL, *BALL_TYPES):
        return IDENTITY.orientation, "X"
    if joint.axis in _AXES and joint.type not in PLANE_TYPES:
        return IDENTITY.orientation, _AXES[joint.axis]
    return turn_of_z(joint.axis), "Z"


def _lock(target: Target, prim: Any, token: str) -> None:
    target.pxr.UsdPhysics.LimitAPI.Apply(prim, token)
    target.values.put(prim, f"limit:{token}:physics:low", "Float", 1.0)
    target.values.put(prim, f"limit:{token}:physics:high", "Float", -1.0)


def _limits(target: Target, prim: Any, joint: Joint) -> None:
    limit, put = joint.limit, target.values.put
    angular = joint.type not in SLIDES
    if joint.type not in WITHOUT_LIMIT and limit.lower <= limit.upper:
        for name, bound in (("lower", limit.lower), ("upper", limit.upper)):
            if abs(bound) < inf:
                put(prim, f"physics:{name}Limit", "Float", degrees(bound) if angular else bound)
    if 0.0 < limit.effort < inf:
        token = "angular" if angular else "linear"
        target.pxr.UsdPhysics.DriveAPI.Apply(prim, token)
        put(prim, f"drive:{token}:physics:maxForce", "Float", limit.effort)
    if 0.0 < limit.velocity < inf:
        speed = degrees(limit.velocity) if angular else limit.velocity
        put(prim, "physxJoint:maxJointVelocity", "Float", speed)
        # As in the file that it is from, it bounds what motors ask for, and not the joint.
        put(prim, "carom:speed", "Bool", True)


def _dynamics(target: Target, prim: Any, joint: Joint) -> None:
    put = target.values.put
    stated = {
        "mjc:damping": joint.damping,
        "mjc:frictionloss": joint.friction,
        "mjc:armature": joint.armature,
        "mjc:stiffness": joint.stiffness,
        "mjc:springref": joint.spring_reference,
    }
    for name, value in stated.items():
        if value:
            put(prim, name, "Double", value)
    if any(stated.values()):
        prim.AddAppliedSchema("MjcJointAPI")
    mimic = joint.mimic
    if mimic is None or mimic.joint not in target.joints:
        return
    prim.AddAppliedSchema("NewtonMimicAPI")
    prim.CreateRelationship("newton:mimicJoint", True).SetTargets([target.joints[mimic.joint]])
    angular = joint.type not in SLIDES
    leader = next(it for it in target.robot.joints if it.name == mimic.joint)
    leads = leader.type not in SLIDES
    factor = mimic.multiplier
    if angular != leads:
        # In degrees and metres.
        factor = degrees(factor) if angular else factor / degrees(1.0)
    put(prim, "newton:mimicCoef0", "Float", degrees(mimic.offset) if angular else mimic.offset)
    put(prim, "newton:mimicCoef1", "Float", factor)
