"""What each function does to a world, and so what may happen in the middle of a call.

PyBullet's functions are atomic: they are C code that holds the GIL. Here a call has the world for itself from
its arguments to its results (`native/source/changes/gate.h`), and other threads wait. In the thread itself,
signal handlers, finalizers and trace functions may run between the lines of a function that only reads: if
they call functions of this connection, it reads again. In the middle of a function that changes something
they do not, unless all it does is to commit one change: if others come first, that does nothing, and is
prepared again.
"""

from __future__ import annotations

from types import CodeType

FREE = frozenset(
    # These need no world.
    {"calculateVelocityQuaternion", "computeProjectionMatrix", "computeProjectionMatrixFOV"}
    | {"computeViewMatrix", "computeViewMatrixFromYawPitchRoll", "getAPIVersion"}
    | {"getAxisAngleFromQuaternion", "getAxisDifferenceQuaternion", "getDifferenceQuaternion"}
    | {"getEulerFromQuaternion", "getMatrixFromQuaternion", "getQuaternionFromAxisAngle"}
    | {"getQuaternionFromEuler", "getQuaternionSlerp", "invertTransform", "isNumpyEnabled"}
    | {"multiplyTransforms", "rotateVector", "vhacd"}
    # About the connection itself.
    | {"connect", "disconnect", "getConnectionInfo", "isConnected", "setTimeOut"}
    # The threads of the window need the lock to answer.
    | {"addUserDebugLine", "addUserDebugParameter", "addUserDebugPoints", "addUserDebugText"}
    | {"configureDebugVisualizer", "getDebugVisualizerCamera", "getKeyboardEvents", "getMouseEvents"}
    | {"getVREvents", "readUserDebugParameter", "removeAllUserDebugItems", "removeAllUserParameters"}
    | {"removeUserDebugItem", "renderImage", "resetDebugVisualizerCamera", "setDebugObjectColor"}
    | {"setVRCameraState"}
    # A step waits while the window pauses, and plugins are code of the user.
    | {"executePluginCommand", "loadPlugin", "stepSimulation", "submitProfileTiming", "unloadPlugin"}
)
"""Functions that do not need the lock of a world, or take it themselves."""

COMMITS = frozenset({"setGravity", "createConstraint", "changeConstraint", "removeConstraint"})
"""Functions that make one change after they have only read, which is one of `quick.first_change`."""

_BEGINNINGS = ("calculate", "compute", "get", "ray", "save")
_READS = frozenset({"performCollisionDetection"})


def reads(name: str) -> bool:
    """Whether a function, which is none of `FREE`, leaves the world as it is and can be called again."""
    return (name.startswith(_BEGINNINGS) and name != "saveState") or name in _READS


def client_place(code: CodeType) -> int:
    """Position of `physicsClientId` among the positional arguments of a function; -1 if it is none."""
    names = code.co_varnames[: code.co_argcount]
    return names.index("physicsClientId") if "physicsClientId" in names else -1
