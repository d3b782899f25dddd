"""Writing a scene as a script."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from carom.description import Pose
from carom.description.transform import compose, inverse
from pybullet._calls.arguments import text
from pybullet._calls.builtin import exported
from pybullet._calls.errors import fail
from pybullet._clients.clients import Client, client_of

if TYPE_CHECKING:
    from carom.scene.body import Body
    from carom.scene.soft_body import SoftBody
    from carom.scene.user_constraints import UserConstraint
    from pybullet._clients.origins import FileLoad

__all__ = ["saveWorld"]

_FAILED = "saveWorld command execution failed."
_START = (
    "import pybullet as p",
    "",
    "cin = p.connect(p.SHARED_MEMORY)",
    "if cin < 0:",
    "    cin = p.connect(p.GUI)",
    "bodies = {}",
)


@exported
def saveWorld(worldFileName: str, physicsClientId: int = 0) -> None:
    """Writes a script that rebuilds the scene.

    The script connects, loads the files of the bodies, or creates bodies from shapes, and sets poses,
    velocities and joint states. Then it sets constraints, gravity and the time step. Its dictionary `bodies`
    maps present ids to new ids. Colours, friction and motors are not written; `saveBullet` keeps everything.

    Args:
        worldFileName: The script; an existing file is replaced.
        physicsClientId: The connection.

    Raises:
        pybullet.error: Not connected, or the file cannot be written.

    Examples:
        >>> p.saveWorld(folder + "/scene.py")
        >>> "loadURDF" in open(folder + "/scene.py").read()
        True
    """
    client = client_of(physicsClientId)
    name = text(worldFileName, "worldFileName")
    with client.lock:
        kind = ["p.resetSimulation(p.RESET_USE_DEFORMABLE_WORLD)"] if client.deformable else []
        lines = [*_START, *kind, *_bodies(client), *_constraints(client), *_parameters(client)]
    try:
        with open(name, "w", encoding="utf-8") as file:
            file.write("\n".join(lines) + "\n")
    except (OSError, ValueError) as problem:
        fail(_FAILED, f"{problem}.")


def _bodies(client: Client) -> Iterator[str]:
    from pybullet._loading.shape_script import multi_body

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
    from pybullet._loading.shape_script import call

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
    from pybullet._loading.shape_script import Raw, call

    handle, world = Raw(f"bodies[{body.id}]"), body.world
    pose = _com_pose(body)
    yield call("resetBasePositionAndOrientation", handle, pose.position, pose.orientation)
    velocity = world.velocity[body.first_velocity :][:6].tolist()
    if any(velocity):
        yield call("resetBaseVelocity", handle, velocity[3:], velocity[:3])
    soft = _soft(body)
    if soft is not None:
        yield call("resetMeshData", handle, soft.nodes.tolist())
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
        soft = _soft(body)
        if soft is not None:
            yield from _anchors(soft)


def _soft(body: Body) -> SoftBody | None:
    if body.spec.soft is None:
        return None
    from carom.scene.soft_body import SoftBody

    assert isinstance(body, SoftBody)
    return body


def _anchors(soft: SoftBody) -> Iterator[str]:
    from pybullet._loading.shape_script import Raw, call

    handles = {id(body.rows): Raw(f"bodies[{body.id}]") for body in soft.world.bodies.values()}
    for anchor in soft.anchors:
        holder = -1 if anchor.body is None else handles[id(anchor.body)]
        yield call("createSoftBodyAnchor", handles[id(soft.rows)], anchor.node, holder, anchor.link)


def _constraint(it: UserConstraint) -> Iterator[str]:
    from pybullet._loading.shape_script import Raw, call

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
    from pybullet._loading.shape_script import call

    parameters = client.world.parameters
    yield call("setGravity", *parameters.gravity)
    yield call(
        "setPhysicsEngineParameter",
        fixedTimeStep=parameters.time_step,
        numSolverIterations=parameters.solver_iterations,
        numSubSteps=parameters.substeps,
    )
