"""Motors."""

from ..call import Call, Calls
from ..scene import ARM, DRAWER, NO_BODY, SHOULDER, SOCKET, WELD, ZOO

VELOCITY, TORQUE, POSITION, PD, STABLE_PD = range(5)
_TURN = [0, 0.6, 0, 0.8]
_WRONG = [{"jointIndex": 77}, {"bodyUniqueId": NO_BODY}, {"controlMode": 99}]

CALLS = {
    "setJointMotorControl2": Calls(
        {"bodyUniqueId": ZOO, "jointIndex": SHOULDER, "controlMode": POSITION},
        other={
            "targetPosition": 0.8,
            "targetVelocity": 0.5,
            "force": 2.0,
            "positionGain": 0.3,
            "velocityGain": 0.4,
            "maxVelocity": 0.2,
        },
        along={"maxVelocity": {"targetPosition": 1.2}},
        forms=[
            Call("velocity", (ZOO, SHOULDER, VELOCITY), {"targetVelocity": 1.0, "force": 50}),
            Call("torque", (ZOO, SHOULDER, TORQUE), {"force": 5}),
            Call("PD", (ZOO, SHOULDER, PD, 0.8, 0.0, 100, 20, 1)),
            Call("off", (ZOO, SHOULDER, VELOCITY), {"force": 0}),
            Call(
                "the body by its other name",
                (),
                {"bodyIndex": ZOO, "jointIndex": DRAWER, "controlMode": POSITION, "targetPosition": 0.1},
            ),
            Call("a fixed joint", (ZOO, WELD, POSITION), {"targetPosition": 1.0}),
        ],
        bad=[*_WRONG, {"jointIndex": -1}, {"controlMode": STABLE_PD}, {"targetPosition": "up"}],
    ),
    "setJointMotorControlArray": Calls(
        {"bodyUniqueId": ARM, "jointIndices": [0, 1], "controlMode": POSITION},
        other={
            "targetPositions": [0.3, 0.5],
            "targetVelocities": [0.1, 0.2],
            "forces": [1, 0.5],
            "positionGains": [0.2, 0.3],
            "velocityGains": [0.5, 0.6],
        },
        forms=[
            Call(
                "velocity", (ARM, [0, 1, 2], VELOCITY), {"targetVelocities": [1, 0.5, 0], "forces": [9, 9, 9]}
            ),
            Call("torque", (ARM, range(3), TORQUE), {"forces": [1, 0.5, 0]}),
            Call(
                "the body by its other name",
                (),
                {"bodyIndex": ARM, "jointIndices": [0], "controlMode": POSITION, "targetPositions": [0.3]},
            ),
        ],
        bad=[
            {"jointIndices": [0, 77]},
            {"jointIndices": 5},
            {"bodyUniqueId": NO_BODY},
            {"controlMode": 99},
            {"targetPositions": [1]},
            {"targetVelocities": [1]},
            {"forces": [1]},
            {"positionGains": [1]},
            {"velocityGains": [1]},
        ],
    ),
    "setJointMotorControl": Calls(
        forms=[
            Call("target alone", (ZOO, SHOULDER, POSITION, 0.8)),
            Call("with a force", (ZOO, SHOULDER, POSITION, 0.8, 3.0)),
            Call("with a force and a gain", (ZOO, SHOULDER, POSITION, 0.8, 30.0, 0.2)),
            Call("velocity", (ZOO, SHOULDER, VELOCITY, 0.8, 30.0)),
            Call("torque", (ZOO, SHOULDER, TORQUE, 3.0)),
            Call("eight arguments", (ZOO, SHOULDER, POSITION, 0.8, 0.1, 30.0, 0.2, 0.5)),
        ],
        bad=[
            Call("too few", (ZOO, SHOULDER, POSITION)),
            Call("no such joint", (ZOO, 77, POSITION, 0.8)),
            Call("no such body", (NO_BODY, 0, POSITION, 0.8)),
            Call("no such mode", (ZOO, SHOULDER, 99, 0.8)),
            Call("a target that is no number", (ZOO, SHOULDER, POSITION, "up")),
        ],
    ),
    "setJointMotorControlMultiDof": Calls(
        {"bodyUniqueId": ZOO, "jointIndex": SOCKET, "controlMode": POSITION},
        other={
            "targetPosition": _TURN,
            "targetVelocity": [0.1, 0.2, 0.3],
            "force": [3, 3, 3],
            "positionGain": 0.3,
            "velocityGain": 0.4,
            "maxVelocity": 0.2,
            "damping": 0.5,
        },
        along={"positionGain": {"targetPosition": _TURN}, "maxVelocity": {"targetPosition": _TURN}},
        forms=[
            Call("torque", (ZOO, SOCKET, TORQUE), {"force": [0.1, 0.2, 0]}),
            Call("one freedom", (ZOO, SHOULDER, POSITION, [0.8]), {"force": [50]}),
        ],
        bad=[*_WRONG, {"jointIndex": -1}],
    ),
    "setJointMotorControlMultiDofArray": Calls(
        {"bodyUniqueId": ZOO, "jointIndices": [SHOULDER, SOCKET], "controlMode": POSITION},
        other={
            "targetPositions": [[0.8], _TURN],
            "targetVelocities": [[0.1], [0.1, 0.2, 0.3]],
            "forces": [[20], [3, 3, 3]],
            "positionGains": [0.2, 0.3],
            "velocityGains": [0.5, 0.6],
            "maxVelocities": [0.2, 0.3],
        },
        along={
            "positionGains": {"targetPositions": [[0.8], _TURN]},
            "maxVelocities": {"targetPositions": [[0.8], _TURN]},
        },
        forms=[Call("torque", (ZOO, [SHOULDER, SOCKET], TORQUE), {"forces": [[2], [0.1, 0.2, 0]]})],
        bad=[{"jointIndices": [0, 77]}, {"jointIndices": 5}, {"bodyUniqueId": NO_BODY}, {"controlMode": 99}],
    ),
}
