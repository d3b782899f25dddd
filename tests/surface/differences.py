"""Where Carom is meant to differ from PyBullet, or the other way round: each with the reason."""

from __future__ import annotations

from fnmatch import fnmatchcase

_BOUNDS = "bounds are those of where links are now; PyBullet's of where they were when last looked at"
_FILES = "a file that cannot be read or written is an error; PyBullet says nothing"
_GARBAGE = "PyBullet reports what happened to be in memory"
_SOLVER = "all types of solver are solved as type 1"

# (function, title of the call, what differs): why. Patterns as of file names.
MEANT: dict[tuple[str, str, str], str] = {
    ("calculateJacobian", "*linkIndex=77", "raises"): "there is no such link; PyBullet returns zeros",
    ("calculateMassMatrix", "*objPositions=[[]]", "raises"): "PyBullet reads behind the end of the list",
    ("changeConstraint", "keyword *", "constraint 1"): _GARBAGE,
    ("getConstraintInfo", "*", "value"): _GARBAGE,
    ("changeConstraint", "keyword gearAuxLink", "*"): "there is no such link",
    ("changeTexture", "*", "raises"): "there are no textures of no pixels",
    ("createConstraint", "*childBodyUniqueId=99", "*"): "there is no such body; PyBullet ties to the world",
    (
        "createMultiBody",
        "keyword batchPositions",
        "*",
    ): "PyBullet knows the last of a batch only, until syncBodyInfo",
    ("getDebugVisualizerCamera", "unknown keyword", "*"): "PyBullet does not look at the arguments",
    ("getDebugVisualizerCamera", "not connected", "*"): "PyBullet does not look at the arguments",
    ("loadMJCF", "*", "body 6 link 2 shapes"): _GARBAGE,
    ("loadURDF", "flag 256", "later body 6 joint *"): "global velocities lose digits in PyBullet",
    ("getLinkState*", "*", "* bounds"): _BOUNDS,
    (
        "rayTest*",
        "keyword reportHitNumber",
        "value",
    ): "hits count along the ray; PyBullet's as they are found",
    ("saveWorld", "bad 0*", "raises"): _FILES,
    ("setPhysicsEngineParameter", "keyword constraintSolverType", "later *"): _SOLVER,
    ("setPhysicsEngineParameter", "Dantzig's solver", "later *"): _SOLVER,
    (
        "submitProfileTiming",
        "the name without the space",
        "raises",
    ): "the keyword works without its space, too",
    ("syncBodyInfo", "*", "body 1 user data 0"): "PyBullet forgets user data",
    ("vhacd", "*", "raises"): _FILES,
}

# Texts that PyBullet's source has and that it never comes to, or not in this scene.
_ALWAYS = "the server always answers"
_NEVER = "what leads there is caught before"
UNHEARD: dict[tuple[str, str], str] = {
    ("addUserDebugParameter", "*"): "no name is wrong",
    ("calculateInverseDynamics", "Error in calculateInverseDynamics, please check arguments."): _NEVER,
    ("calculateJacobian", "Planar joints*"): "there is none in the scene",
    ("calculateJacobian", "Internal error*"): _ALWAYS,
    ("calculateMassMatrix", "Internal error*"): _ALWAYS,
    ("changeTexture", "Error processing*"): "what leads there ends PyBullet's process",
    ("changeVisualShape", "*"): _ALWAYS,
    ("resetVisualShapeData", "*"): _ALWAYS,
    ("connect", "Exceeding maximum number*"): "takes 1,024 worlds",
    ("connect", "Only one local in-process*"): "takes a display",
    ("connect", "* is not enabled in this pybullet build"): "depends on how PyBullet was built",
    ("createMultiBody", "createMultiBody failed."): _ALWAYS,
    ("enableJointForceTorqueSensor", "Error creating sensor."): _ALWAYS,
    ("getDebugVisualizerCamera", "*"): "takes a window",
    ("getDynamicsInfo", "Couldn't get dynamics info"): _ALWAYS,
    ("getJointStates", "getJointState failed (2)."): _NEVER,
    ("getPhysicsEngineParameters", "*"): _ALWAYS,
    ("getUserData", "*"): "user data are text",
    ("getVisualShapeData", "*"): _ALWAYS,
    ("loadBullet", "loadBullet exceeds body capacity"): "takes a file with very many bodies",
    ("rayTestBatch", "rayFromPositions and rayToPositions must be not None."): _NEVER,
    ("renderImage", "*"): "PyBullet raises SystemError instead",
    ("resetBaseVelocity", "error in resetJointState."): _NEVER,
    ("saveState", "*"): _ALWAYS,
    ("saveWorld", "*"): "PyBullet says nothing",
    ("setJointMotorControl*", "Error parsing arguments in setJointControl."): _NEVER,
    ("setJointMotorControl", "Illegal control mode."): _NEVER,
    ("sync*", "*"): _ALWAYS,
}


def meant(function: str, call: str, what: str) -> tuple[str, str, str] | None:
    """The entry of `MEANT` for a difference; None if it is not meant."""
    for pattern in MEANT:
        if all(map(fnmatchcase, (function, call, what), pattern)):
            return pattern
    return None


def unheard(function: str, text: str) -> str | None:
    """Why PyBullet never says something that its source has it say; None if it does."""
    for pattern, reason in UNHEARD.items():
        if all(map(fnmatchcase, (function, text), pattern)):
            return reason
    return None
