"""What of a stage nothing has read, and what is lost with it."""

from __future__ import annotations

from typing import Any

from carom.formats.reading.ignored import Ignored, IgnoredList
from carom.formats.usd.geometry import SHAPES
from carom.formats.usd.stage import Stage

_BEYOND = "it is beyond what is read of the physics schema"
_LOOKS = ("none for the dynamics: it looks otherwise", "a picture is without it")
_NOTES = ("none: a note", "it is for other programs")
# Transforms are read through the library; the others say nothing about a simulation.
_SILENT = (
    *("xformOp:", "xformOpOrder", "visibility", "purpose", "extent", "proxyPrim", "collection:"),
    *("carom:", "physics:simulationOwner"),
)
_OF_LOOKS = (
    *("primvars:", "normals", "doubleSided", "subdivisionScheme", "material:", "interpolateBoundary"),
    *("faceVaryingLinearInterpolation", "triangleSubdivisionRule", "crease", "corner", "accelerations"),
    *("velocities", "outputs:", "inputs:", "info:", "family", "indices", "elementType", "subsetFamily:"),
    *("holeIndices", "width", "length", "orientation"),
)
_OF_NOTES = (
    *("ui:", "userProperties:", "omni:", "isaac:", "semantic", "mjcf:", "warpSim:", "Fabric:", "foundation:"),
    *("physics:engine", "physics:newton:", "physics:tensor:", "TimeStepsPerSecond", "mjc:group"),
)
_OF_SHAPES = ("radius", "height", "size", "axis", "points", "faceVertex", "physics:approximation")
_OF_SOLVERS = ("physxScene:", "physxArticulation:", "newton:maxSolverIterations", "newton:solver")
_OF_PHYSICS = ("physics:", "drive:", "limit:", "state:", "mjc:", "newton:", "physx")
_UNUSED = ("none: it has no use there", "the type of its prim does not need it")
_SOLVER = ("none for what is simulated: it sets another solver", "Carom's own value is used")
_LOOK_TYPES = ("Material", "Shader", "NodeGraph", "GeomSubset")
_RENDERING = ("RenderProduct", "RenderSettings", "RenderVar")
_KNOWN = (
    *SHAPES,
    *("", "Xform", "Scope", "Camera", "PhysicsScene", "PhysicsCollisionGroup", "PhysicsJoint"),
    *("PhysicsFixedJoint", "PhysicsRevoluteJoint", "PhysicsPrismaticJoint", "PhysicsSphericalJoint"),
    *("PhysicsDistanceJoint", "MjcActuator"),
)


def ignored_of(stage: Stage) -> IgnoredList:
    """What was reported while a stage was read, and what was not read at all."""
    found = list(stage.left_out)
    for prim in stage.prims():
        found += _of_prim(stage, prim)
    return IgnoredList.of(found)


def _of_prim(stage: Stage, prim: Any) -> list[Ignored]:
    kind = str(prim.GetTypeName())
    if kind.endswith("Light") or kind in _RENDERING:
        return [Ignored(kind, stage.file, 1, (), 1, *_LOOKS)]
    if kind not in _KNOWN and kind not in _LOOK_TYPES:
        return [Ignored(kind, stage.file, 1, (), 1, "it is not there", "prims of this type are not built")]
    path = str(prim.GetPath())
    by_rule: dict[tuple[str, str], list[str]] = {}
    for it in prim.GetAuthoredProperties():
        name = str(it.GetName())
        if (path, name) in stage.read or name.startswith(_SILENT):
            continue
        by_rule.setdefault(_rule(kind, name), []).append(name)
    return [
        Ignored(kind or "prim", stage.file, 1, tuple(sorted(names)), 1, *rule)
        for rule, names in by_rule.items()
    ]


def _rule(kind: str, name: str) -> tuple[str, str]:
    """Consequence and reason for a property that was not read."""
    if name.startswith(_OF_NOTES):
        return _NOTES
    if name.startswith(_OF_SOLVERS):
        return _SOLVER
    is_round = name == "physics:approximation" and kind != "Mesh"
    if is_round or (name == "physics:axis" and kind == "PhysicsFixedJoint"):
        return _UNUSED
    if kind in SHAPES and name.startswith(_OF_SHAPES):
        return "none for the dynamics: it is not drawn", "it is no collider, and not to be seen on a body"
    if name.startswith(_OF_PHYSICS):
        return "it has no effect", _BEYOND
    if kind in _LOOK_TYPES or kind == "Camera" or name.startswith(_OF_LOOKS):
        return _LOOKS
    return "it has no effect", "no reader of Carom knows it"
