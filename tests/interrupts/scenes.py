"""A scene, calls that change it, and all there is to see of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

import pybullet as p
import pybullet_data
from carom.native.tables import ArrayTable
from pybullet._clients.clients import clients

_ROBOT = """<robot name="noted"><link name="base"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1"
ixy="0" ixz="0" iyz="0"/></inertial><collision><geometry><box size="0.1 0.1 0.1"/></geometry></collision>
<user-data key="who">it</user-data></link></robot>"""


@dataclass(frozen=True)
class Scene:
    """What calls need to know: bodies, a constraint, a state and files."""

    cube: int
    arm: int
    tie: int
    state: int
    shape: int
    world_file: str
    robot_file: str


def build(folder: Path) -> Scene:
    """Begin anew: some bodies that touch, tied to each other, after a few steps."""
    p.resetSimulation()
    p.setPhysicsEngineParameter(fixedTimeStep=1.0 / 240.0, numSubSteps=0, reportSolverAnalytics=0)
    clients[0].world.time = 0.0
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    p.setGravity(0, 0, -9.81)
    p.loadURDF("plane.urdf")
    gone = p.loadURDF("cube_small.urdf", [1, 0, 0.02])
    cube = p.loadURDF("cube_small.urdf", [0, 0, 0.02])
    arm = p.loadURDF("rrbot.urdf", [0, 1, 0], useFixedBase=1)
    other = p.loadURDF("sphere_small.urdf", [0.5, 0, 0.04])
    p.removeBody(gone)
    p.addUserData(cube, "name", "cube")
    p.setCollisionFilterPair(cube, arm, -1, 0, 0)
    tie = p.createConstraint(other, -1, -1, -1, p.JOINT_POINT2POINT, [0, 0, 0], [0, 0, 0], [0.5, 0, 0.1])
    shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.05, 0.05, 0.05])
    world_file, robot_file = folder / "scene.bullet", folder / "noted.urdf"
    if not world_file.exists():
        robot_file.write_text(_ROBOT)
        p.saveBullet(str(world_file))
    _go_on(2)
    state = p.saveState()
    _go_on(2)
    return Scene(cube, arm, tie, state, shape, str(world_file), str(robot_file))


def _load_into_nothing(scene: Scene) -> None:
    p.loadBullet(scene.world_file)


CALLS: dict[str, Callable[[Scene], Any]] = {
    "loadURDF": lambda scene: p.loadURDF(scene.robot_file, [0, 0, 1]),
    "loadURDF of an arm": lambda scene: p.loadURDF("kuka_iiwa/model.urdf", [0, -1, 0]),
    "loadSDF": lambda scene: p.loadSDF("kuka_iiwa/model.sdf"),
    "loadMJCF": lambda scene: p.loadMJCF("mjcf/hopper.xml"),
    "createMultiBody": lambda scene: p.createMultiBody(
        1.0, scene.shape, batchPositions=[[2, 0, height] for height in range(20)]
    ),
    "removeBody": lambda scene: p.removeBody(scene.cube),
    "removeBody of the last": lambda scene: p.removeBody(p.getBodyUniqueId(p.getNumBodies() - 1)),
    "resetSimulation": lambda scene: p.resetSimulation(),
    "createConstraint": lambda scene: p.createConstraint(
        scene.cube, -1, scene.arm, 0, p.JOINT_FIXED, [0, 0, 0], [0, 0, 0], [0, 0, 0]
    ),
    "removeConstraint": lambda scene: p.removeConstraint(scene.tie),
    "changeDynamics": lambda scene: p.changeDynamics(
        scene.arm,
        1,
        mass=2.0,
        lateralFriction=0.7,
        restitution=0.3,
        ccdSweptSphereRadius=0.1,
        jointDamping=0.4,
        jointLowerLimit=-0.3,
        jointUpperLimit=0.4,
        jointLimitForce=30.0,
        contactProcessingThreshold=0.1,
    ),
    "changeDynamics of a body": lambda scene: p.changeDynamics(
        scene.cube,
        -1,
        mass=0.0,
        linearDamping=0.3,
        angularDamping=0.2,
        maxJointVelocity=50.0,
        collisionMargin=0.002,
        sleepThreshold=0.5,
        activationState=p.ACTIVATION_STATE_ENABLE_SLEEPING | p.ACTIVATION_STATE_DISABLE_WAKEUP,
    ),
    "changeDynamics that frees": lambda scene: p.changeDynamics(scene.arm, -1, mass=3.0),
    "createCollisionShape": lambda scene: p.createCollisionShape(p.GEOM_SPHERE, radius=0.2),
    "removeCollisionShape": lambda scene: p.removeCollisionShape(scene.shape),
    "createVisualShape": lambda scene: p.createVisualShape(p.GEOM_SPHERE, radius=0.2),
    "addUserData": lambda scene: p.addUserData(scene.cube, "other", "text"),
    "restoreState": lambda scene: p.restoreState(scene.state),
    "loadBullet": lambda scene: p.loadBullet(scene.world_file),
    "setPhysicsEngineParameter": lambda scene: p.setPhysicsEngineParameter(
        fixedTimeStep=0.01,
        numSolverIterations=70,
        numSubSteps=2,
        erp=0.3,
        contactBreakingThreshold=0.03,
        reportSolverAnalytics=1,
    ),
    "setTimeStep": lambda scene: p.setTimeStep(0.01),
    "setGravity": lambda scene: p.setGravity(0, 0, -1),
    "resetJointState": lambda scene: p.resetJointState(scene.arm, 0, 0.4, 0.5),
    "resetJointStateMultiDof": lambda scene: p.resetJointStateMultiDof(scene.arm, 0, [0.4], [0.5]),
    "resetJointStatesMultiDof": lambda scene: p.resetJointStatesMultiDof(
        scene.arm, [0, 1], [[0.4], [0.3]], [[0.5], [0.6]]
    ),
    "resetBasePositionAndOrientation": lambda scene: p.resetBasePositionAndOrientation(
        scene.cube, [0, 1, 1], [0, 0, 0.6, 0.8]
    ),
    "resetBaseVelocity": lambda scene: p.resetBaseVelocity(scene.cube, [1, 2, 3], [4, 5, 6]),
    "setJointMotorControl2": lambda scene: p.setJointMotorControl2(
        scene.arm, 0, p.POSITION_CONTROL, targetPosition=0.3, force=4
    ),
    "setJointMotorControlArray": lambda scene: p.setJointMotorControlArray(
        scene.arm, [0, 1], p.VELOCITY_CONTROL, targetVelocities=[0.3, 0.4], forces=[1, 2]
    ),
    "setJointMotorControlMultiDofArray": lambda scene: p.setJointMotorControlMultiDofArray(
        scene.arm, [0, 1], p.POSITION_CONTROL, targetPositions=[[0.3], [0.4]], forces=[[1], [2]]
    ),
    "applyExternalForce": lambda scene: p.applyExternalForce(
        scene.cube, -1, [1, 2, 3], [0.1, 0.2, 0.3], p.LINK_FRAME
    ),
    "applyExternalTorque": lambda scene: p.applyExternalTorque(scene.cube, -1, [1, 2, 3], p.WORLD_FRAME),
    "enableJointForceTorqueSensor": lambda scene: p.enableJointForceTorqueSensor(scene.arm, 0, 1),
    "setCollisionFilterPair": lambda scene: p.setCollisionFilterPair(scene.cube, scene.arm, -1, 1, 0),
    "setCollisionFilterGroupMask": lambda scene: p.setCollisionFilterGroupMask(scene.cube, -1, 4, 2),
    "changeConstraint": lambda scene: p.changeConstraint(
        scene.tie, [0.1, 0.2, 0.3], [0, 0, 0.6, 0.8], maxForce=20, erp=0.3
    ),
    "unsupportedChangeScaling": lambda scene: p.unsupportedChangeScaling(scene.cube, [2, 2, 2]),
    "removeUserData": lambda scene: p.removeUserData(p.getUserDataId(scene.cube, "name")),
    "removeState": lambda scene: p.removeState(scene.state),
    "restoreState of a file": lambda scene: p.restoreState(fileName=scene.world_file),
}


def look() -> dict[str, Any]:
    """Everything there is in the world, and what the drop-in knows of it."""
    client = clients[0]
    world = client.world
    seen: dict[str, Any] = {
        "bodies": [
            (
                number,
                body.name,
                vars(body)["rows"],
                [body.first_link, body.first_position, body.first_velocity],
                [body.position_index, body.velocity_index],
                body.fixed_base,
                [asdict(body.dynamics(link)) for link in range(-1, body.joint_count)],
            )
            for number, body in world.bodies.items()
        ],
        "numbers": (world.free_ids, world.next_id, world.user_constraints.next_id),
        "links": world.joint_constraints.tags._objects,
        "constraints": [
            (it.body.id, it.joint, it.kind, it.lower, it.upper, it.max_impulse, it.user and it.user.id)
            for it in world.joint_constraints.all
        ],
        "ties": [(it.id, it.parent.id, it.child and it.child.id) for it in world.user_constraints.all],
        "texts": [
            (number, datum, world.user_data.find(datum.body, datum.link, datum.shape, datum.key) is datum)
            for number, datum in world.user_data._by_id.items()
        ],
        "free texts": world.user_data._free,
        "rules": world.contact_arrays.shapes.filters.all,
        "shapes of bodies": [
            (link, body.rows, body.first, body.count)
            for link, body in world.contact_arrays.shapes._bodies.items()
        ],
        "parameters": p.getPhysicsEngineParameters(),
        "collision shapes": list(client.shapes.collisions._shapes),
        "free shapes": client.shapes.collisions._free,
        "visual shapes": list(client.shapes.visuals._shapes),
        "states": list(client.states),
        "origins": {
            number: client.origins[number].load.function
            for number in sorted(client.origins)
            if number in world.bodies
        },
        "time": world.time,
        "all parameters": asdict(world.parameters),
        "of the connection": (client.time_step, client.report_analytics, client.deformable),
        "user constraints": [
            (it.id, it.max_force, it.max_impulse, it.erp, it.child_frame) for it in world.user_constraints.all
        ],
        "sensors": [
            [body.has_sensor(joint) for joint in range(body.joint_count)] for body in world.bodies.values()
        ],
    }
    used = {axis: count for axis, count in world.arrays.used.items() if axis not in ("constraint", "row")}
    seen |= _rows("model", world.arrays.model, used)
    seen |= _rows("state", world.arrays.state, used)
    seen |= _rows("shapes", world.contact_arrays.shapes.table, world.contact_arrays.shapes.used)
    seen |= _rows(
        "contacts", world.contact_arrays.contacts, {"count": 1, "contact": world.contact_arrays.contact_count}
    )
    return seen


def _rows(name: str, table: ArrayTable, used: dict[str, int]) -> dict[str, Any]:
    """The rows in use of every field, and where there is something behind them."""
    seen: dict[str, Any] = {f"{name} used": used}
    for field, array in table.numpy.items():
        axis = field.partition("_")[0]
        if axis not in used:
            continue
        rows = array[0] if table.is_per_world(field) else array
        seen[f"{name} {field}"] = rows[: used[axis]].copy()
        if name != "contacts":
            seen[f"{name} {field} behind"] = bool(rows[used[axis] :].any())
    return seen


def follow() -> list[Any]:
    """What comes of it: steps, another body, and steps again."""
    seen: list[Any] = [_go_on(3)]
    seen.append(p.loadURDF("cube_small.urdf", [0, 0, 0.5]))
    seen.append(_go_on(3))
    p.removeBody(p.getBodyUniqueId(0))
    return [*seen, _go_on(2)]


def _go_on(steps: int) -> list[Any]:
    for _ in range(steps):
        p.stepSimulation()
    snapshot = clients[0].world.snapshot()
    return [p.getContactPoints(), *(array.tolist() for array in snapshot.state.values())]


def same(one: Any, other: Any) -> bool:
    """Whether two answers are the same to the last bit."""
    if isinstance(one, np.ndarray):
        return one.shape == other.shape and one.tobytes() == other.tobytes()
    return one == other


def differences(one: dict[str, Any], other: dict[str, Any]) -> list[str]:
    """Names of what is not the same in two looks."""
    names = one | other
    return [
        name for name in names if name not in one or name not in other or not same(one[name], other[name])
    ]
