"""Python code of the calls that rebuild a scene."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from carom.description import Collision, ConvexHull, Geometry, Heightfield, JointType, Mesh, Pose
from carom.description.joint import JOINT_CODE
from carom.description.transform import compose, inverse
from carom.layouts.flags import LoadFlags
from carom.model.body_spec import LinkSpec
from carom.scene.soft_body import SoftBody
from pybullet._calls.errors import logger
from pybullet._loading.multi_body import JOINT_TYPES

if TYPE_CHECKING:
    from carom.scene.body import Body
    from carom.scene.user_constraints import UserConstraint
    from pybullet._clients.clients import Client
    from pybullet._clients.origins import FileLoad

_START = (
    "import pybullet as p",
    "",
    "cin = p.connect(p.SHARED_MEMORY)",
    "if cin < 0:",
    "    cin = p.connect(p.GUI)",
    "bodies = {}",
)


class Raw(str):
    """An argument that is already Python code."""

    __slots__ = ()


def call(function: str, *arguments: Any, **keywords: Any) -> str:
    """A call of a function of PyBullet as Python code; keyword arguments of None are left out."""
    parts = [written(argument) for argument in arguments]
    parts += [f"{name}={written(value)}" for name, value in keywords.items() if value is not None]
    return f"p.{function}({', '.join(parts)})"


def written(value: Any) -> str:
    """A value as Python code, with all digits of numbers."""
    if isinstance(value, Raw):
        return str(value)
    if isinstance(value, np.ndarray):
        return repr(value.tolist())
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(written(item) for item in value)}]"
    return repr(float(value)) if isinstance(value, np.floating) else repr(value)


def _joint_type(kind: JointType) -> Raw:
    code = JOINT_CODE[kind]
    return Raw(f"p.JOINT_{code.name}" if code in JOINT_TYPES else "p.JOINT_FIXED")


def multi_body(body: Body, position: Sequence[float], orientation: Sequence[float]) -> str:
    """The call of `createMultiBody` that copies a body to a world pose of its base's link frame."""
    spec = body.spec
    kept = spec.flags & ~LoadFlags.USE_IMPLICIT_CYLINDER | LoadFlags.MAINTAIN_LINK_ORDER
    lists: dict[str, list[Any]] = {}
    if spec.links:
        lists = {
            "linkMasses": [body.dynamics(link).mass for link in range(body.joint_count)],
            "linkCollisionShapeIndices": [_collision(link.collisions) for link in spec.links],
            "linkVisualShapeIndices": [_visual(link) for link in spec.links],
            "linkPositions": [link.joint_frame.position for link in spec.links],
            "linkOrientations": [link.joint_frame.orientation for link in spec.links],
            "linkInertialFramePositions": [link.inertial_frame.position for link in spec.links],
            "linkInertialFrameOrientations": [link.inertial_frame.orientation for link in spec.links],
            "linkParentIndices": [link.parent + 1 for link in spec.links],
            "linkJointTypes": [_joint_type(link.joint_type) for link in spec.links],
            "linkJointAxis": [
                [component * link.joint_axis_length for component in link.joint_axis] for link in spec.links
            ],
        }
    return call(
        "createMultiBody",
        body.dynamics(-1).mass,
        _collision(spec.base.collisions),
        _visual(spec.base),
        position,
        orientation,
        spec.base.inertial_frame.position,
        spec.base.inertial_frame.orientation,
        **lists,
        flags=int(kept) if spec.links else int(kept & ~LoadFlags.MAINTAIN_LINK_ORDER),
    )


def _collision(shapes: tuple[Collision, ...]) -> Raw:
    return _shape(
        "Collision", [(shape.geometry, shape.frame.position, shape.frame.orientation) for shape in shapes]
    )


def _visual(link: LinkSpec) -> Raw:
    """The call that creates a link's visual shape; -1 if its collision shape is drawn or no call can."""
    shapes = link.visuals
    touching = [(shape.geometry, shape.frame) for shape in link.collisions]
    plain = all(shape.material is None for shape in shapes)
    if plain and [(shape.geometry, shape.frame) for shape in shapes] == touching:
        return Raw("-1")
    if any(isinstance(shape.geometry, (Heightfield, ConvexHull)) for shape in shapes):
        return Raw("-1")
    colours = [None if shape.material is None else shape.material.rgba for shape in shapes]
    parts = [(shape.geometry, shape.frame.position, shape.frame.orientation) for shape in shapes]
    return _shape("Visual", parts, colours)


def _shape(kind: str, parts: list[Any], colours: Sequence[Any] = ()) -> Raw:
    """The call that creates a shape from its parts; -1 if there are no parts or no call can create it."""
    if not parts or any(not _arguments(geometry) for geometry, *_ in parts):
        return Raw("-1")
    frames = {"collision": "collisionFrame", "visual": "visualFrame"}[kind.lower()]
    height = "height" if kind == "Collision" else "length"
    if len(parts) == 1:
        geometry, position, orientation = parts[0]
        arguments = _arguments(geometry)
        if "height" in arguments:
            arguments[height] = arguments.pop("height")
        framed = position != (0.0, 0.0, 0.0) or orientation != (0.0, 0.0, 0.0, 1.0)
        if framed:
            arguments |= {f"{frames}Position": position, f"{frames}Orientation": orientation}
        if colours:
            arguments["rgbaColor"] = colours[0]
        return Raw(call(f"create{kind}Shape", **arguments))
    columns = [_arguments(geometry) for geometry, *_ in parts]
    arguments = {
        "shapeTypes": [column["shapeType"] for column in columns],
        "radii": [column.get("radius", 0.5) for column in columns],
        "halfExtents": [column.get("halfExtents", (1.0, 1.0, 1.0)) for column in columns],
        "lengths": [column.get("height", 1.0) for column in columns],
        "fileNames": [column.get("fileName", "") for column in columns],
        "meshScales": [column.get("meshScale", (1.0, 1.0, 1.0)) for column in columns],
        "planeNormals": [column.get("planeNormal", (0.0, 0.0, 1.0)) for column in columns],
        f"{frames}Positions": [position for _, position, _ in parts],
        f"{frames}Orientations": [orientation for *_, orientation in parts],
    }
    if colours:
        arguments["rgbaColors"] = [colour or (1.0, 1.0, 1.0, 1.0) for colour in colours]
    if any("vertices" in column or "heightfieldData" in column for column in columns):
        logger.warning(
            "saveWorld: no call can create a %s shape of several parts, one of them made of vertices or "
            "heights; it is left out. saveBullet keeps it.",
            kind.lower(),
        )
        return Raw("-1")
    return Raw(call(f"create{kind}ShapeArray", **arguments))


def _arguments(geometry: Geometry) -> dict[str, Any]:
    """The arguments of `createCollisionShape` for a shape; empty if it cannot create the shape."""
    if not geometry.geom_name:
        return {}
    flags = {"flags": Raw("p.GEOM_FORCE_CONCAVE_TRIMESH")} if _is_concave(geometry) else {}
    return {"shapeType": Raw(f"p.{geometry.geom_name}"), **geometry.call_arguments(), **flags}


def _is_concave(geometry: Geometry) -> bool:
    """Whether a shape is a mesh whose triangles collide."""
    return isinstance(geometry, Mesh) and geometry.concave


def scene_lines(client: Client) -> list[str]:
    """The lines of a script that rebuilds the scene of a client, which must not change meanwhile."""
    kind = ["p.resetSimulation(p.RESET_USE_DEFORMABLE_WORLD)"] if client.deformable else []
    return [*_START, *kind, *_bodies(client), *_constraints(client), *_parameters(client)]


def _bodies(client: Client) -> Iterator[str]:
    loaded: dict[FileLoad, dict[int, Body]] = {}
    for body in client.world.bodies.values():
        origin = client.origins.get(body.id)
        if origin is not None:
            loaded.setdefault(origin.load, {})[origin.index] = body
    for body in client.world.bodies.values():
        origin = client.origins.get(body.id)
        if origin is None:
            pose = _link_pose(body)
            yield f"bodies[{body.id}] = {multi_body(body, pose.position, pose.orientation)}"
            yield from _state(body)
        elif origin.load in loaded:
            yield from _file(origin.load, loaded.pop(origin.load))


def _file(load: FileLoad, bodies: dict[int, Body]) -> Iterator[str]:
    """The lines that load one file and set its bodies' states; bodies removed since are removed again."""
    first = next(iter(bodies.values()))
    assert first.spec.source is not None
    path = str(first.spec.source.absolute())
    if load.takes_pose:
        pose = _link_pose(first)
        yield f"objects = [{call(load.function, path, pose.position, pose.orientation, **load.arguments)}]"
    else:
        yield f"objects = {call(load.function, path, **load.arguments)}"
    for index in range(load.count):
        if index in bodies:
            yield f"bodies[{bodies[index].id}] = objects[{index}]"
            yield from _state(bodies[index])
        else:
            yield f"p.removeBody(objects[{index}])"


def _com_pose(body: Body) -> Pose:
    x, y, z, qx, qy, qz, qw = body.world.position[body.first_position :][:7].tolist()
    return Pose((x, y, z), (qx, qy, qz, qw))


def _link_pose(body: Body) -> Pose:
    return compose(_com_pose(body), inverse(body.spec.base.inertial_frame))


def _state(body: Body) -> Iterator[str]:
    handle, world = Raw(f"bodies[{body.id}]"), body.world
    pose = _com_pose(body)
    yield call("resetBasePositionAndOrientation", handle, pose.position, pose.orientation)
    velocity = world.velocity[body.first_velocity :][:6].tolist()
    if any(velocity):
        yield call("resetBaseVelocity", handle, velocity[3:], velocity[:3])
    if isinstance(body, SoftBody):
        yield call("resetMeshData", handle, body.nodes.tolist())
    for joint in range(body.joint_count):
        q, u = body.position_index[joint], body.velocity_index[joint]
        positions = world.position[q:][: body.position_count[joint]].tolist()
        velocities = world.velocity[u:][: body.velocity_count[joint]].tolist()
        if len(positions) in (1, 4):
            yield call("resetJointStateMultiDof", handle, joint, positions, velocities)


def _constraints(client: Client) -> Iterator[str]:
    for constraint in client.world.user_constraints.all:
        yield from _constraint(constraint)
    for body in client.world.bodies.values():
        if isinstance(body, SoftBody):
            yield from _anchors(body)


def _anchors(soft: SoftBody) -> Iterator[str]:
    handles = {id(body.rows): Raw(f"bodies[{body.id}]") for body in soft.world.bodies.values()}
    for anchor in soft.anchors:
        holder = -1 if anchor.body is None else handles[id(anchor.body)]
        yield call("createSoftBodyAnchor", handles[id(soft.rows)], anchor.node, holder, anchor.link)


def _constraint(it: UserConstraint) -> Iterator[str]:
    made = call(
        "createConstraint",
        Raw(f"bodies[{it.parent.id}]"),
        it.parent_link,
        -1 if it.child is None else Raw(f"bodies[{it.child.id}]"),
        it.child_link,
        int(it.kind),
        it.axis,
        it.parent_frame.position,
        it.child_frame.position,
        it.parent_frame.orientation,
        it.child_frame.orientation,
    )
    yield f"cid{it.id} = {made}"
    yield call(
        "changeConstraint",
        Raw(f"cid{it.id}"),
        maxForce=it.max_force,
        gearRatio=it.gear_ratio,
        gearAuxLink=it.gear_auxiliary_link,
        relativePositionTarget=it.relative_position_target,
        erp=it.erp,
    )


def _parameters(client: Client) -> Iterator[str]:
    parameters = client.world.parameters
    yield call("setGravity", *parameters.gravity)
    yield call(
        "setPhysicsEngineParameter",
        fixedTimeStep=parameters.time_step,
        numSolverIterations=parameters.solver_iterations,
        numSubSteps=parameters.substeps,
    )
