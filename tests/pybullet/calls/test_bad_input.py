"""Wrong ids, indices, lengths, types, NaN and infinities: a clear error, and a world as it was."""

import inspect
import re
from collections.abc import Callable
from importlib import import_module
from math import inf, nan
from typing import Any

import numpy as np
import pytest

import pybullet as p
from pybullet._clients.clients import clients

NO_BODY, NO_JOINT, NO_CLIENT = 99, 99, 7
TURN = [0, 0, 0, 1]
ZEROS = [0.0] * 3

# Every function of this version that needs a connection, in a call that is right. Body 0 is the arm.
CALLS: dict[str, list[Any]] = {
    "syncBodyInfo": [],
    "setTimeOut": [1.0],
    "setAdditionalSearchPath": ["."],
    "resetSimulation": [],
    "stepSimulation": [],
    "setGravity": [0.0, 0.0, -9.8],
    "setTimeStep": [0.01],
    "setDefaultContactERP": [0.1],
    "setRealTimeSimulation": [0],
    "setInternalSimFlags": [0],
    "setPhysicsEngineParameter": [],
    "getPhysicsEngineParameters": [],
    "loadURDF": ["robot.urdf"],
    "removeBody": [0],
    "getNumBodies": [],
    "getBodyUniqueId": [0],
    "getBodyInfo": [0],
    "getNumJoints": [0],
    "computeDofCount": [0],
    "getJointInfo": [0, 0],
    "getJointState": [0, 0],
    "getJointStates": [0, [0]],
    "getJointStateMultiDof": [0, 0],
    "getJointStatesMultiDof": [0, [0]],
    "resetJointState": [0, 0, 0.1],
    "resetJointStateMultiDof": [0, 0, [0.1]],
    "resetJointStatesMultiDof": [0, [0], [[0.1]]],
    "getLinkState": [0, 0],
    "getLinkStates": [0, [0]],
    "getDynamicsInfo": [0, 0],
    "changeDynamics": [0, 0],
    "getBasePositionAndOrientation": [0],
    "resetBasePositionAndOrientation": [0, ZEROS, TURN],
    "getBaseVelocity": [0],
    "resetBaseVelocity": [0, ZEROS],
    "setJointMotorControl": [0, 0, p.POSITION_CONTROL, 0.1],
    "setJointMotorControl2": [0, 0, p.POSITION_CONTROL],
    "setJointMotorControlArray": [0, [0], p.POSITION_CONTROL],
    "setJointMotorControlMultiDof": [0, 0, p.POSITION_CONTROL],
    "setJointMotorControlMultiDofArray": [0, [0], p.POSITION_CONTROL],
    "enableJointForceTorqueSensor": [0, 0],
    "applyExternalForce": [0, 0, ZEROS, ZEROS, p.LINK_FRAME],
    "applyExternalTorque": [0, 0, ZEROS, p.LINK_FRAME],
    "calculateInverseDynamics": [0, ZEROS, ZEROS, ZEROS],
    "calculateJacobian": [0, 0, ZEROS, ZEROS, ZEROS, ZEROS],
    "calculateMassMatrix": [0, ZEROS],
    "addUserDebugParameter": ["slider"],
    "readUserDebugParameter": [0],
    "removeUserDebugItem": [0],
    "removeAllUserDebugItems": [],
    "removeAllUserParameters": [],
    "addUserDebugLine": [ZEROS, ZEROS],
    "addUserDebugText": ["text", ZEROS],
    "addUserDebugPoints": [[ZEROS], [ZEROS]],
    "setDebugObjectColor": [0, 0],
    "getKeyboardEvents": [],
    "getMouseEvents": [],
    "getVREvents": [],
    "setVRCameraState": [],
    "configureDebugVisualizer": [],
    "resetDebugVisualizerCamera": [1.0, 0.0, 0.0, ZEROS],
    "getDebugVisualizerCamera": [],
}

# What PyBullet says first, by what is wrong. None: it is no error.
UNKNOWN_BODY: dict[str, str | None] = {
    "removeBody": None,
    "getBodyInfo": "Couldn't get body info",
    "getNumJoints": None,
    "computeDofCount": None,
    "getJointInfo": "GetJointInfo failed.",
    "getJointState": "getJointState failed.",
    "getJointStates": "getJointState failed.",
    "getJointStateMultiDof": "getJointState failed.",
    "getJointStatesMultiDof": "getJointState failed.",
    "resetJointState": "Joint index out-of-range.",
    "resetJointStateMultiDof": "Joint index out-of-range.",
    "resetJointStatesMultiDof": "Joint index out-of-range.",
    "getLinkState": "getLinkState failed.",
    "getLinkStates": "getLinkState failed.",
    "getDynamicsInfo": "getDynamicsInfo failed; invalid return status",
    "changeDynamics": None,
    "getBasePositionAndOrientation": "GetBasePositionAndOrientation failed.",
    "resetBasePositionAndOrientation": None,
    "getBaseVelocity": "getBaseVelocity failed.",
    "resetBaseVelocity": None,
    "setJointMotorControl": "Joint index out-of-range.",
    "setJointMotorControl2": "Joint index out-of-range.",
    "setJointMotorControlArray": "Joint index out-of-range.",
    "setJointMotorControlMultiDof": "Joint index out-of-range.",
    "setJointMotorControlMultiDofArray": "Joint index out-of-range.",
    "enableJointForceTorqueSensor": "Error: invalid jointIndex.",
    "applyExternalForce": None,
    "applyExternalTorque": None,
    "calculateInverseDynamics": "Error in calculateInverseDynamics, please check arguments.",
    "calculateJacobian": "calculateJacobian [numDof] needs to be positive",
    "calculateMassMatrix": "Internal error in calculateMassMatrix",
}
NEGATIVE_BODY = {
    "getJointState": "getJointState failed; invalid bodyUniqueId",
    "getJointStates": "getJointState failed; invalid bodyUniqueId",
    "getJointStateMultiDof": "getJointState failed; invalid bodyUniqueId",
    "getJointStatesMultiDof": "getJointState failed; invalid bodyUniqueId",
    "getLinkState": "getLinkState failed; invalid bodyUniqueId",
    "getLinkStates": "getLinkState failed; invalid bodyUniqueId",
    "getDynamicsInfo": "getDynamicsInfo failed; invalid bodyUniqueId",
    "enableJointForceTorqueSensor": "Error: invalid bodyUniqueId",
}
UNKNOWN_JOINT: dict[str, str | None] = {
    "getJointInfo": "GetJointInfo failed.",
    "getJointState": "getJointState failed (2).",
    "getJointStates": "Joint index out-of-range.",
    "getJointStateMultiDof": "getJointState failed (2).",
    "getJointStatesMultiDof": "getJointState failed (2).",
    "resetJointState": "Joint index out-of-range.",
    "resetJointStateMultiDof": "Joint index out-of-range.",
    "resetJointStatesMultiDof": "Joint index out-of-range.",
    "getLinkState": None,
    "getLinkStates": None,
    "getDynamicsInfo": "getDynamicsInfo failed; invalid return status",
    "changeDynamics": None,
    "setJointMotorControl": "Joint index out-of-range.",
    "setJointMotorControl2": "Joint index out-of-range.",
    "setJointMotorControlArray": "Joint index out-of-range.",
    "setJointMotorControlMultiDof": "Joint index out-of-range.",
    "setJointMotorControlMultiDofArray": "Joint index out-of-range.",
    "enableJointForceTorqueSensor": "Error: invalid jointIndex.",
    "applyExternalForce": "Invalid link index, has to be -1 or larger",
    "applyExternalTorque": "Invalid link index, has to be -1 or larger",
    "calculateJacobian": "Internal error in calculateJacobian",
}
NEGATIVE_JOINT = {
    "getJointState": "getJointState failed; invalid jointIndex",
    "getJointStateMultiDof": "getJointState failed; invalid jointIndex",
    "getLinkState": "getLinkState failed; invalid linkIndex",
    "getDynamicsInfo": "getDynamicsInfo failed; invalid linkIndex",
}


MODULES = (
    "_algorithms.algebra",
    "_bodies.bodies",
    "_connections.connection",
    "_window.debug_drawing",
    "_bodies.dynamics",
    "_engine.engine",
    "_bodies.forces",
    "_window.gui",
    "_joints.joints",
    "_bodies.links",
    "_loading.loading",
    "_joints.motors",
    "_joints.motors_multi_dof",
)


def test_the_table_has_every_function_that_needs_a_connection() -> None:
    needs_none = {
        "connect",
        "disconnect",
        "isConnected",
        "getConnectionInfo",
        "getAPIVersion",
        "isNumpyEnabled",
        "calculateVelocityQuaternion",
        "rotateVector",
    }
    for module in MODULES:
        for name in import_module(f"pybullet.{module}").__all__:
            description = getattr(p, name).__doc__ or ""
            if name not in needs_none and not re.search("Needs no connection|Not used\\.", description):
                assert name in CALLS


@pytest.mark.parametrize("name", CALLS)
def test_without_a_connection(name: str) -> None:
    _refuses(lambda: getattr(p, name)(*CALLS[name]), "Not connected to physics server.")
    _refuses(lambda: getattr(p, name)(*CALLS[name], physicsClientId=-1), "Not connected to physics server.")


@pytest.mark.parametrize("name", CALLS)
def test_a_client_that_is_no_integer(arm: int, name: str) -> None:
    for number in ("0", None, [0], 0.5):
        with pytest.raises(TypeError):
            getattr(p, name)(*CALLS[name], physicsClientId=number)


@pytest.mark.parametrize("name", UNKNOWN_BODY)
def test_a_body_that_does_not_exist(arm: int, name: str) -> None:
    unchanged = _watch(arm)
    call = _with(name, 0, NO_BODY)
    _answers(call, UNKNOWN_BODY[name])
    _answers(_with(name, 0, -1), NEGATIVE_BODY.get(name, UNKNOWN_BODY[name]))
    unchanged()


@pytest.mark.parametrize("name", UNKNOWN_BODY)
def test_a_body_that_is_no_integer(arm: int, name: str) -> None:
    unchanged = _watch(arm)
    for body in ("0", None, [0], 0.5, object()):
        with pytest.raises((TypeError, p.error)):
            _with(name, 0, body)()
    unchanged()


@pytest.mark.parametrize("name", UNKNOWN_BODY)
def test_a_body_number_beyond_32_bits(arm: int, name: str) -> None:
    with pytest.raises((OverflowError, p.error)):
        _with(name, 0, 2**40)()


@pytest.mark.parametrize("name", UNKNOWN_JOINT)
def test_a_joint_that_does_not_exist(arm: int, name: str) -> None:
    unchanged = _watch(arm)
    listed = isinstance(CALLS[name][1], list)
    _answers(_with(name, 1, [NO_JOINT] if listed else NO_JOINT), UNKNOWN_JOINT[name])
    _answers(_with(name, 1, [-5] if listed else -5), NEGATIVE_JOINT.get(name, UNKNOWN_JOINT[name]))
    unchanged()


@pytest.mark.parametrize("name", UNKNOWN_JOINT)
def test_a_joint_that_is_no_integer(arm: int, name: str) -> None:
    unchanged = _watch(arm)
    listed = isinstance(CALLS[name][1], list)
    for joint in ("0", None, {}, 0.5, object()):
        with pytest.raises((TypeError, p.error)):
            _with(name, 1, [joint] if listed else joint)()
    unchanged()


@pytest.mark.parametrize("name", [name for name in UNKNOWN_JOINT if isinstance(CALLS[name][1], list)])
@pytest.mark.parametrize("joints", [0, None, 1.5, object()])
def test_joints_that_are_no_sequence(arm: int, name: str, joints: Any) -> None:
    with pytest.raises((TypeError, p.error)):
        _with(name, 1, joints)()


# Function, argument by name, PyBullet's text when it is no number of the right kind.
NUMBERS: list[tuple[str, str]] = [
    ("setTimeOut", "timeOutInSeconds"),
    ("setGravity", "gravX"),
    ("setGravity", "gravZ"),
    ("setTimeStep", "timeStep"),
    ("setDefaultContactERP", "defaultContactERP"),
    *(
        ("setPhysicsEngineParameter", name)
        for name in (
            "fixedTimeStep",
            "splitImpulsePenetrationThreshold",
            "contactBreakingThreshold",
            "restitutionVelocityThreshold",
            "erp",
            "contactERP",
            "frictionERP",
            "allowedCcdPenetration",
            "solverResidualThreshold",
            "contactSlop",
            "globalCFM",
            "warmStartingFactor",
            "sparseSdfVoxelSize",
        )
    ),
    ("resetJointState", "targetValue"),
    ("resetJointState", "targetVelocity"),
    ("setJointMotorControl2", "targetPosition"),
    ("setJointMotorControl2", "targetVelocity"),
    ("setJointMotorControl2", "positionGain"),
    ("setJointMotorControl2", "velocityGain"),
    *(
        ("changeDynamics", name)
        for name in (
            "mass",
            "lateralFriction",
            "spinningFriction",
            "rollingFriction",
            "restitution",
            "linearDamping",
            "angularDamping",
            "contactStiffness",
            "contactDamping",
            "ccdSweptSphereRadius",
            "contactProcessingThreshold",
            "jointDamping",
            "maxJointVelocity",
            "collisionMargin",
            "jointLowerLimit",
            "jointUpperLimit",
            "jointLimitForce",
            "sleepThreshold",
        )
    ),
    ("addUserDebugParameter", "rangeMin"),
    ("addUserDebugParameter", "startValue"),
    ("addUserDebugLine", "lineWidth"),
    ("addUserDebugText", "textSize"),
    ("addUserDebugPoints", "pointSize"),
    ("configureDebugVisualizer", "shadowMapIntensity"),
    ("resetDebugVisualizerCamera", "cameraYaw"),
    ("loadURDF", "globalScaling"),
]


@pytest.mark.parametrize(("name", "argument"), NUMBERS)
def test_a_number_that_is_not_finite(arm: int, name: str, argument: str) -> None:
    unchanged = _watch(arm)
    for value in (nan, inf, -inf, np.float64("nan")):
        with pytest.raises(p.error, match=f"{argument} has to be a finite number, not"):
            _named(name, argument, value)()
    unchanged()


@pytest.mark.parametrize(("name", "argument"), NUMBERS)
def test_a_number_that_is_none(arm: int, name: str, argument: str) -> None:
    unchanged = _watch(arm)
    for value in ("0.1", None, [0.1], 1j, object()):
        with pytest.raises(TypeError):
            _named(name, argument, value)()
    unchanged()


# Function, argument by name, its length (None: any), PyBullet's text.
VECTORS: list[tuple[str, str, int | None, str]] = [
    ("loadURDF", "basePosition", 3, "Cannot convert basePosition."),
    ("loadURDF", "baseOrientation", 4, "Cannot convert baseOrientation."),
    ("resetBasePositionAndOrientation", "posObj", 3, "position needs a 3 coordinates [x,y,z]."),
    (
        "resetBasePositionAndOrientation",
        "ornObj",
        4,
        "orientation needs a 4 coordinates, quaternion [x,y,z,w].",
    ),
    ("applyExternalForce", "forceObj", 3, "force needs a 3 coordinates [x,y,z]."),
    ("applyExternalForce", "posObj", 3, "position needs a 3 coordinates [x,y,z]."),
    ("applyExternalTorque", "torqueObj", 3, "torque needs a 3 coordinates [x,y,z]."),
    ("resetJointStateMultiDof", "targetValue", None, "Expected an position and/or velocity list."),
    ("resetJointStateMultiDof", "targetVelocity", None, "Expected an position and/or velocity list."),
    ("setJointMotorControlMultiDof", "targetPosition", None, "expected a targetPosition sequence"),
    ("setJointMotorControlMultiDof", "targetVelocity", None, "expected a targetVelocity sequence"),
    ("setJointMotorControlMultiDof", "force", None, "expected a force sequence"),
    ("changeDynamics", "localInertiaDiagonal", 3, "localInertiaDiagonal needs 3 numbers."),
    ("changeDynamics", "anisotropicFriction", 3, "anisotropicFriction needs 3 numbers."),
    ("calculateInverseDynamics", "objPositions", 3, "Error in calculateInverseDynamics"),
    ("calculateJacobian", "localPosition", 3, "calculateJacobian [numDof] needs to be positive"),
    ("calculateJacobian", "objPositions", 3, "calculateJacobian [numDof] needs to be positive"),
    ("calculateJacobian", "objVelocities", 3, "calculateJacobian [numDof] needs to be positive"),
    ("calculateJacobian", "objAccelerations", 3, "calculateJacobian [numDof] needs to be positive"),
    ("calculateMassMatrix", "objPositions", None, "calculateMassMatrix [numJoints] needs to be positive"),
    ("addUserDebugLine", "lineFromXYZ", 3, "Error converting lineFrom[3]"),
    ("addUserDebugLine", "lineToXYZ", 3, "Error converting lineTo[3]"),
    ("addUserDebugText", "textPosition", 3, "Error converting textPositionObj[3]"),
    ("addUserDebugText", "textColorRGB", 3, "Error converting textColorRGBObj[3]"),
    ("addUserDebugText", "textOrientation", 4, "Error converting textOrientation[4]"),
]


@pytest.mark.parametrize(("name", "argument", "length", "problem"), VECTORS)
def test_a_vector_of_the_wrong_kind(
    arm: int, name: str, argument: str, length: int | None, problem: str
) -> None:
    unchanged = _watch(arm)
    right: list[Any] = [0.5] * (length or 1)
    wrong: list[Any] = [
        7,
        1.5,
        object(),
        [*right[1:], "x"],
        [*right[1:], None],
        [*right[1:], nan],
        [*right[1:], inf],
    ]
    wrong += [np.array([*right[1:], nan]), np.ones((len(right), 2))]
    if length is not None:
        wrong += [[], right[1:], [*right, 0.5], {}, ""]
    for value in wrong:
        _refuses(_named(name, argument, value), problem)
    unchanged()


ARRAYS = {
    "targetPositions": "number of target positions should match the number of joint indices",
    "targetVelocities": "number of target velocies should match the number of joint indices",
    "forces": "number of forces should match the joint indices",
    "positionGains": "number of kps should match the joint indices",
    "velocityGains": "number of kds should match the number of joint indices",
}


@pytest.mark.parametrize("argument", ARRAYS)
def test_an_array_of_motors_with_a_wrong_list(arm: int, argument: str) -> None:
    unchanged = _watch(arm)

    def set_motors(values: Any) -> None:
        given: dict[str, Any] = {argument: values}
        p.setJointMotorControlArray(arm, [0, 1], p.POSITION_CONTROL, **given)

    for wrong in ([0.1], [0.1, 0.2, 0.3], 0.5, []):
        _refuses(lambda wrong=wrong: set_motors(wrong), ARRAYS[argument])
    for wrong in ([0.1, "x"], [0.1, None], [0.1, 1j]):
        with pytest.raises(TypeError):
            set_motors(wrong)
    with pytest.raises(p.error, match=argument):
        set_motors([0.1, nan])
    unchanged()


def test_forces_of_motors_may_be_infinite_but_torques_may_not(arm: int) -> None:
    p.setJointMotorControl2(arm, 0, p.VELOCITY_CONTROL, force=inf)
    p.setJointMotorControlArray(arm, [0], p.POSITION_CONTROL, forces=[inf])
    p.stepSimulation()
    with pytest.raises(p.error, match="force has to be a finite number"):
        p.setJointMotorControl2(arm, 0, p.TORQUE_CONTROL, force=inf)
    with pytest.raises(p.error, match="forces has to be a finite number"):
        p.setJointMotorControlArray(arm, [0], p.TORQUE_CONTROL, forces=[inf])
    with pytest.raises(p.error, match="force has to be a finite number"):
        p.setJointMotorControl2(arm, 0, p.VELOCITY_CONTROL, force=-inf)


@pytest.mark.parametrize("mode", [-1, p.STABLE_PD_CONTROL, 9])
def test_modes_that_do_not_exist(arm: int, mode: int) -> None:
    for call in (
        lambda: p.setJointMotorControl2(arm, 0, mode),
        lambda: p.setJointMotorControlArray(arm, [0], mode),
        lambda: p.setJointMotorControl(arm, 0, mode, 0.1, 0.1, 1, 0.1, 1),
        lambda: p.setJointMotorControlMultiDof(arm, 0, mode, [0.1]),
        lambda: p.setJointMotorControlMultiDofArray(arm, [0], 9, [[0.1]]),
    ):
        _refuses(call, "Illegal control mode.")


def test_frames_of_forces_that_do_not_exist(arm: int) -> None:
    problem = "flag has to be either WORLD_FRAME or LINK_FRAME"
    _refuses(lambda: p.applyExternalForce(arm, 0, ZEROS, ZEROS, 3), problem)
    _refuses(lambda: p.applyExternalTorque(arm, 0, ZEROS, 0), problem)


@pytest.mark.parametrize("zero", [[0, 0, 0, 0], [1e-300, 0, 0, 0]], ids=repr)
def test_quaternions_without_a_direction(arm: int, zoo: int, zero: list[float]) -> None:
    for call in (
        lambda: p.resetBasePositionAndOrientation(arm, ZEROS, zero),
        lambda: p.resetJointStateMultiDof(zoo, 3, zero),
        lambda: p.setJointMotorControlMultiDof(zoo, 3, p.POSITION_CONTROL, zero),
        lambda: p.calculateInverseDynamics(zoo, [0.0] * 7, [0.0] * 7, [0.0] * 7, flags=1),
        lambda: p.multiplyTransforms(ZEROS, zero, ZEROS, TURN),
        lambda: p.invertTransform(ZEROS, zero),
        lambda: p.getMatrixFromQuaternion(zero),
        lambda: p.getQuaternionSlerp(zero, TURN, 0.5),
    ):
        with pytest.raises(p.error, match=r"quaternion of length (0|1e-300), which is no rotation"):
            call()


def test_old_motor_calls_that_cannot_be_read(arm: int) -> None:
    text = "Error parsing arguments in setJointControl."
    calls: list[tuple[Any, ...]] = [
        (),
        (arm, 0, 2),
        (arm, 0, 2, 0.1, 1, 0.1, 1),
        (arm, 0, p.TORQUE_CONTROL, 1, 2),
        (arm, 0, 3, 1),
    ]
    for arguments in calls:
        _refuses(lambda arguments=arguments: p.setJointMotorControl(*arguments), text)
    _refuses(lambda: p.setJointMotorControl(arm, 0, 2, "x"), "Error parsing arguments")  # pyright: ignore


def test_engine_parameters_that_make_no_sense(client: int) -> None:
    with pytest.raises(p.error, match="timeStep has to be greater than 0"):
        p.setTimeStep(0)
    with pytest.raises(p.error, match="fixedTimeStep has to be greater than 0"):
        p.setPhysicsEngineParameter(fixedTimeStep=0)
    with pytest.raises(p.error, match="numSubSteps"):
        p.setPhysicsEngineParameter(numSubSteps=2**30)
    with pytest.raises(TypeError):
        p.setPhysicsEngineParameter(numSolverIterations=1.5)  # pyright: ignore[reportArgumentType]
    assert p.getPhysicsEngineParameters()["fixedTimeStep"] == 1 / 240


def test_stiffness_and_damping_of_contacts_go_together(arm: int) -> None:
    text = "Both contactStiffness and contactDamping needs to be set together."
    _refuses(lambda: p.changeDynamics(arm, 0, contactStiffness=1), text)
    _refuses(lambda: p.changeDynamics(arm, 0, contactDamping=1), text)


def test_jacobians_of_joints_with_many_freedoms(zoo: int) -> None:
    text = "Spherirical joints are not supported in the pybullet binding"
    _refuses(lambda: p.calculateJacobian(zoo, 0, ZEROS, [0] * 6, [0] * 6, [0] * 6), text)


def _with(name: str, place: int, value: Any) -> Callable[[], Any]:
    """The right call with one argument replaced by position."""
    arguments = list(CALLS[name])
    arguments[place] = value
    return lambda: getattr(p, name)(*arguments)


def _named(name: str, argument: str, value: Any) -> Callable[[], Any]:
    """The right call with one argument replaced by name."""
    function = getattr(p, name)
    names = list(inspect.signature(function).parameters)
    arguments = dict(zip(names, CALLS[name], strict=False))
    arguments[argument] = value
    return lambda: function(**arguments)


def _refuses(call: Callable[[], Any], text: str) -> None:
    with pytest.raises(p.error) as caught:
        call()
    assert str(caught.value).startswith(text)


def _answers(call: Callable[[], Any], text: str | None) -> None:
    if text is None:
        call()
    else:
        _refuses(call, text)


def _watch(body: int) -> Callable[[], None]:
    """Checks later that body and world are as they are now."""

    def look() -> Any:
        joints = range(p.getNumJoints(body))
        return (
            p.getNumBodies(),
            p.getPhysicsEngineParameters(),
            p.getBasePositionAndOrientation(body),
            p.getBaseVelocity(body),
            p.getJointStates(body, joints),
            p.getLinkStates(body, joints, 1, 1),
            [p.getDynamicsInfo(body, link) for link in (-1, *joints)],
            _motors(body),
        )

    before = look()

    def check() -> None:
        assert look() == before

    return check


def _motors(body: int) -> list[float]:
    world = clients[0].world
    return [*world.motor.ravel(), *world.pd.ravel(), *world.joint_torque, *world.link_force.ravel()]
