"""Programs that see what every getter says right after every other call, before the next step and after it.

In one small scene with contacts, a constraint, an arm and a floating body a few steps are made; then
comes one kind of call, and all getters.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from tools.differ.programs import Call

FLOOR, ARM, BALL, OTHER_BALL, THIRD_BALL, FLOATING, TIED = range(7)
"""Bodies of the scene; the floating one has three links, the tied one hangs on a constraint."""
_SHAPE_OF_BALLS = 1
_TURN = (0, 0, 1, 0)
_BALL_TURN = (0, 0, 0.6, 0.8)
_CONSTRAINT = 1
Row = tuple[Any, ...]
"""Function, arguments, and a dictionary of keyword arguments where there are any."""


def _with(function: str, *arguments: Any, **keywords: Any) -> Row:
    return (function, *arguments, keywords)


def _base(body: int, place: tuple[float, ...], turn: tuple[float, ...] = (0, 0, 0, 1)) -> Row:
    return "resetBasePositionAndOrientation", body, place, turn


def _dynamics(body: int, link: int, **keywords: Any) -> Row:
    return _with("changeDynamics", body, link, **keywords)


CALLS: dict[str, tuple[Row, ...]] = {
    "nothing": (),
    "a step": (("stepSimulation",),),
    "a ball removed": (("removeBody", OTHER_BALL),),
    "the arm removed": (("removeBody", ARM),),
    "the floor removed": (("removeBody", FLOOR),),
    "the tied body removed": (("removeBody", TIED),),
    "a body made": (("createMultiBody", 1, _SHAPE_OF_BALLS, -1, [5, 5, 5]),),
    "a file loaded": (("loadURDF", "r2d2.urdf", [8, 8, 1]),),
    "a file loaded and removed": (("loadURDF", "cube.urdf", [8, 8, 1]), ("removeBody", 7)),
    "a ball lifted": (_base(BALL, (0, 3, 1)),),
    "a ball put where it is": (_base(BALL, (0, 0, 0.0999)),),
    "the floating body put elsewhere": (_base(FLOATING, (-3, 0, 3), _TURN),),
    "the arm put elsewhere": (_base(ARM, (3, 3, 1), _TURN),),
    "velocities of a base": (("resetBaseVelocity", FLOATING, [1, 2, 3], [3, 2, 1]),),
    "a velocity of a base": (("resetBaseVelocity", FLOATING, [1, 2, 3]),),
    "a velocity of a ball": (("resetBaseVelocity", BALL, [1, 2, 3]),),
    "a joint of the arm set": (("resetJointState", ARM, 3, 0.5),),
    "a joint of the floating body set": (("resetJointState", FLOATING, 0, 0.5, 2),),
    "a ball joint set": (("resetJointStateMultiDof", FLOATING, 2, _BALL_TURN),),
    "a ball joint and its velocity set": (("resetJointStateMultiDof", FLOATING, 2, _BALL_TURN, [1, 2, 3]),),
    "joints set": (("resetJointStatesMultiDof", FLOATING, [0, 1], [[0.1], [0.2]]),),
    "changeDynamics of nothing": (("changeDynamics", BALL, -1),),
    "mass": (_dynamics(BALL, -1, mass=3),),
    "mass 0": (_dynamics(BALL, -1, mass=0),),
    "mass of a link": (_dynamics(FLOATING, 0, mass=3),),
    "damping": (_dynamics(FLOATING, 0, linearDamping=0.5, jointDamping=1),),
    "inertia": (_dynamics(FLOATING, -1, localInertiaDiagonal=[1, 2, 3]),),
    "sleep": (_dynamics(FLOATING, -1, activationState=8),),
    "margin": (_dynamics(FLOATING, -1, collisionMargin=0.02),),
    "a pair of links that may not touch": (("setCollisionFilterPair", BALL, FLOOR, -1, -1, 0),),
    "another pair": (("setCollisionFilterPair", ARM, FLOOR, 3, -1, 0),),
    "a mask": (("setCollisionFilterGroupMask", BALL, -1, 0, 0),),
    "a constraint": (
        ("createConstraint", BALL, -1, OTHER_BALL, -1, 4, [0, 0, 0], [0.5, 0, 0], [-0.5, 0, 0]),
    ),
    "a constraint removed": (("removeConstraint", _CONSTRAINT),),
    "a constraint changed": (_with("changeConstraint", _CONSTRAINT, maxForce=1),),
    "gravity": (("setGravity", 0, 0, 3),),
    "the time step": (("setTimeStep", 0.01),),
    "iterations": (_with("setPhysicsEngineParameter", numSolverIterations=3),),
    "the frame of sensors": (_with("setPhysicsEngineParameter", jointFeedbackMode=3),),
    "a sensor off": (("enableJointForceTorqueSensor", ARM, 3, 0),),
    "a sensor on": (("enableJointForceTorqueSensor", ARM, 4, 1),),
    "a motor": (_with("setJointMotorControl2", ARM, 3, 2, targetPosition=1),),
    "a motor off": (_with("setJointMotorControl2", ARM, 3, 0, force=0),),
    "a torque": (_with("setJointMotorControl2", ARM, 3, 1, force=5),),
    "a motor of a ball joint": (
        _with("setJointMotorControlMultiDof", FLOATING, 2, 2, targetPosition=_BALL_TURN),
    ),
    "a force": (("applyExternalForce", BALL, -1, [1, 2, 30], [0, 0, 0], 1),),
    "collisions": (("performCollisionDetection",),),
    "a ball lifted, and collisions": (_base(BALL, (0, 3, 1)), ("performCollisionDetection",)),
    "nearest points": (("getClosestPoints", FLOATING, ARM, 9),),
    "forward kinematics": (_with("getLinkState", FLOATING, 0, computeForwardKinematics=1),),
    "forward kinematics with velocities": (("getLinkState", FLOATING, 0, 1, 1),),
    "inverse dynamics": (("calculateInverseDynamics", ARM, [0.0] * 7, [0.0] * 7, [0.0] * 7),),
    "a Jacobian": (("calculateJacobian", ARM, 6, [0, 0, 0], [0.0] * 7, [0.0] * 7, [0.0] * 7),),
    "a mass matrix": (("calculateMassMatrix", ARM, [0.0] * 7),),
    "inverse kinematics": (("calculateInverseKinematics", ARM, 6, [3.2, 3.2, 0.5]),),
    "a state saved": (("saveState",),),
    "a state saved and restored": (("saveState",), ("restoreState", 0)),
    "a state restored after steps": (
        ("saveState",),
        ("stepSimulation",),
        ("stepSimulation",),
        ("restoreState", 0),
    ),
    "a colour": (_with("changeVisualShape", FLOATING, 0, rgbaColor=[1, 0, 0, 1]),),
    "another size": (("unsupportedChangeScaling", BALL, [2, 2, 2]),),
    "a shape removed": (("removeCollisionShape", 1),),
    "a ray": (("rayTest", [0, 0, 1], [0, 0, -1]),),
    "everything removed": (("resetSimulation",),),
    "drawings removed": (("removeAllUserDebugItems",),),
    "no real time": (("setRealTimeSimulation", 0),),
}
"""What is called, by a name."""
_LINKS = {ARM: (3, 6), FLOATING: (0, 1, 2)}
_BOUNDS = ((ARM, 6), (BALL, -1), (FLOATING, -1), (FLOATING, 0), (FLOATING, 2), (TIED, -1))
GETTERS: tuple[Row, ...] = (
    *(("getLinkState", body, link, v) for body, links in _LINKS.items() for link in links for v in (0, 1)),
    *(
        ("getJointState", body, joint)
        for body, joints in {ARM: (3, 4), FLOATING: (0, 1)}.items()
        for joint in joints
    ),
    *(("getJointStateMultiDof", FLOATING, joint) for joint in range(3)),
    *(("getBasePositionAndOrientation", body) for body in (ARM, BALL, FLOATING, TIED)),
    *(("getBaseVelocity", body) for body in (ARM, BALL, FLOATING, TIED)),
    *(("getAABB", *link) for link in _BOUNDS),
    *(
        ("getDynamicsInfo", body, link)
        for body, link in ((BALL, -1), (FLOATING, -1), (FLOATING, 0), (FLOATING, 1))
    ),
    ("getConstraintState", _CONSTRAINT),
    ("getConstraintInfo", _CONSTRAINT),
    ("getNumConstraints",),
    ("getNumBodies",),
    *(("getBodyUniqueId", place) for place in (0, 3, 6)),
    ("getContactPoints",),
    ("getContactPoints", BALL),
    ("getContactPoints", FLOOR, BALL),
    ("getContactPoints", OTHER_BALL),
    ("rayTest", [0, 0, 2], [0, 0, -1]),
    ("rayTest", [-3, 0, 5], [-3, 0, -1]),
    ("rayTest", [3, 3, 3], [3, 3, -1]),
    ("getClosestPoints", BALL, FLOOR, 1),
    ("getClosestPoints", FLOATING, FLOOR, 5),
    ("getClosestPoints", BALL, OTHER_BALL, 5),
    ("getPhysicsEngineParameters",),
    ("getCollisionShapeData", BALL, -1),
    ("getCollisionShapeData", FLOATING, 0),
    ("calculateMassMatrix", ARM, [0.1] * 7),
    ("getVisualShapeData", FLOATING),
    ("getJointInfo", FLOATING, 0),
    _with("getLinkState", FLOATING, 2, computeForwardKinematics=1),
    ("stepSimulation",),
    ("@probe",),
    ("getContactPoints", BALL),
    ("getJointState", ARM, 3),
    ("stepSimulation",),
    ("@probe",),
    ("getConstraintState", _CONSTRAINT),
)
"""What is asked after each."""


def programs_of_getters() -> Iterator[tuple[str, list[Call]]]:
    """Programs, each with its name: without substeps and with three."""
    for substeps in (0, 3):
        for name, rows in CALLS.items():
            made = [*_scene(substeps), *rows, *GETTERS]
            yield f"{name}, {substeps} substeps", [_call(number, row) for number, row in enumerate(made)]


def _call(number: int, row: Row) -> Call:
    function, *arguments = row
    keywords = arguments.pop() if arguments and isinstance(arguments[-1], dict) else {}
    return {"f": function, "a": arguments, "k": keywords, "id": number}


def _scene(substeps: int) -> Iterator[Row]:
    yield "setGravity", 0, 0, -10
    yield _with("setPhysicsEngineParameter", numSubSteps=substeps)
    yield _with("createCollisionShape", 3, halfExtents=[5, 5, 0.5])
    yield _with("createCollisionShape", 2, radius=0.1)
    yield _with("createCollisionShape", 3, halfExtents=[0.1, 0.05, 0.07])
    floor, ball, box = range(3)
    yield "createMultiBody", 0, floor, -1, [0, 0, -0.5]
    yield _with("loadURDF", "kuka_iiwa/model.urdf", [3, 3, 0], useFixedBase=1)
    for number in range(3):
        yield "createMultiBody", 1, ball, -1, [number, 0.1 * number, 0.0999]
    links = {
        "linkMasses": [0.5, 0.3, 0.2],
        "linkCollisionShapeIndices": [box, ball, box],
        "linkVisualShapeIndices": [-1] * 3,
        "linkPositions": [[0.3, 0, 0], [0.3, 0.1, 0], [0, 0.4, 0.1]],
        "linkOrientations": [[0, 0, 0, 1]] * 3,
        "linkInertialFramePositions": [[0.05, 0, 0], [0, 0, 0], [0, 0.02, 0]],
        "linkInertialFrameOrientations": [[0, 0, 0, 1]] * 3,
        "linkParentIndices": [0, 1, 1],
        "linkJointTypes": [0, 1, 2],
        "linkJointAxis": [[0, 1, 0], [1, 0, 0], [0, 0, 1]],
    }
    yield _with("createMultiBody", 1, box, -1, [-3, 0, 2], [0, 0.38268343, 0, 0.92387953], **links)
    yield "createMultiBody", 1, ball, -1, [-3, 3, 2]
    yield "createConstraint", TIED, -1, -1, -1, 5, [0, 0, 0], [0.3, 0, 0], [-2.7, 3, 2]
    yield "enableJointForceTorqueSensor", ARM, 3, 1
    yield "enableJointForceTorqueSensor", FLOATING, 0, 1
    for joint in range(7):
        yield _with("setJointMotorControl2", ARM, joint, 2, targetPosition=0.3 * joint, force=100)
    yield "resetBaseVelocity", FLOATING, [0.5, 0.2, 0], [0, 0, 1]
    for _ in range(5):
        yield ("stepSimulation",)
