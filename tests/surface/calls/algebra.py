"""Inverse kinematics, inverse dynamics, Jacobians and mass matrices."""

from ..call import Call, Calls
from ..scene import ARM, NO_BODY, ZOO

THREE = [0.1, 0.4, 0.05]
TARGET = [3.2, 0.1, 1.7]
_IK = {
    "lowerLimits": [-2, -2.5, -0.1],
    "upperLimits": [2, 2.5, 0.2],
    "jointRanges": [4, 5, 0.3],
    "restPoses": [0, 0.2, 0],
    "jointDamping": [0.1, 0.1, 0.1],
    "currentPositions": [0.3, 0.3, 0],
    "maxNumIterations": 5,
    "residualThreshold": 0.1,
}
_NULL_SPACE = {name: _IK[name] for name in ("lowerLimits", "upperLimits", "jointRanges", "restPoses")}
_PATIENT = {"maxNumIterations": 500, "residualThreshold": 1e-7}

CALLS = {
    "calculateInverseKinematics": Calls(
        {"bodyUniqueId": ARM, "endEffectorLinkIndex": 2, "targetPosition": TARGET, **_PATIENT},
        other={"targetOrientation": [0, 0.2, 0, 0.98], "solver": 0, **_IK},
        along=dict.fromkeys(_NULL_SPACE, _NULL_SPACE),
        forms=[
            Call(
                "the body by its other name",
                (),
                {"bodyIndex": ARM, "endEffectorLinkIndex": 2, "targetPosition": TARGET},
            ),
        ],
        bad=[
            {"bodyUniqueId": NO_BODY},
            {"endEffectorLinkIndex": 77},
            {"targetPosition": [1, 2]},
            {"currentPositions": [0.1]},
        ],
    ),
    "calculateInverseKinematics2": Calls(
        {"bodyUniqueId": ARM, "endEffectorLinkIndices": [2], "targetPositions": [TARGET], **_PATIENT},
        other={"solver": 0, **_IK},
        along=dict.fromkeys(_NULL_SPACE, _NULL_SPACE),
        bad=[
            {"bodyUniqueId": NO_BODY},
            {"endEffectorLinkIndices": [77]},
            {"targetPositions": []},
            {"currentPositions": [0.1]},
        ],
    ),
    "calculateInverseDynamics": Calls(
        {
            "bodyUniqueId": ARM,
            "objPositions": THREE,
            "objVelocities": [0.1, 0.2, 0.3],
            "objAccelerations": [1, 2, 3],
        },
        other={"flags": 0},
        forms=[
            Call(
                "the body by its other name",
                (),
                {"bodyIndex": ARM, "objPositions": THREE, "objVelocities": THREE, "objAccelerations": THREE},
            ),
        ],
        bad=[{"bodyUniqueId": NO_BODY}, {"objVelocities": [1]}, {"objPositions": [1]}, {"objPositions": []}],
    ),
    "calculateJacobian": Calls(
        {
            "bodyUniqueId": ARM,
            "linkIndex": 2,
            "localPosition": [0, 0, 0.1],
            "objPositions": THREE,
            "objVelocities": [0.1, 0.2, 0.3],
            "objAccelerations": [0, 0, 0],
        },
        bad=[
            {"bodyUniqueId": ZOO},
            {"bodyUniqueId": NO_BODY},
            {"localPosition": [0]},
            {"objPositions": [1]},
            {"linkIndex": 77},
        ],
    ),
    "calculateMassMatrix": Calls(
        {"bodyUniqueId": ARM, "objPositions": THREE},
        other={"flags": 1},
        bad=[{"bodyUniqueId": NO_BODY}, {"objPositions": []}, {"objPositions": 5}],
    ),
}
