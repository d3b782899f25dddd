"""Joints and constraints."""

from ..call import Call, Calls
from ..scene import ARM, AXLE, BALL, CRATE, DRAWER, HANG, NO_BODY, SHOULDER, SOCKET, TILTED, WELD, ZOO

FIXED, POINT, GEAR, PRISMATIC = 4, 5, 6, 1

CALLS = {
    "getNumJoints": Calls(
        {"bodyUniqueId": ZOO}, forms=[Call("a single link", (BALL,)), Call("unknown", (NO_BODY,))]
    ),
    "getJointInfo": Calls(
        {"bodyUniqueId": ZOO, "jointIndex": SHOULDER},
        forms=[Call(f"joint {joint}", (ZOO, joint)) for joint in (DRAWER, WELD, SOCKET, AXLE)],
        bad=[{"bodyUniqueId": NO_BODY}, {"bodyUniqueId": -1}, {"jointIndex": -1}, {"jointIndex": 77}],
    ),
    "getJointState": Calls(
        {"bodyUniqueId": ZOO, "jointIndex": SHOULDER},
        forms=[Call(f"joint {joint}", (ZOO, joint)) for joint in (DRAWER, WELD, SOCKET, AXLE)],
        bad=[{"bodyUniqueId": NO_BODY}, {"bodyUniqueId": -1}, {"jointIndex": -1}, {"jointIndex": 77}],
    ),
    "getJointStates": Calls(
        {"bodyUniqueId": ARM, "jointIndices": [0, 2]},
        forms=[Call("a range", (ARM, range(3))), Call("none", (ARM, []))],
        bad=[
            {"bodyUniqueId": NO_BODY},
            {"bodyUniqueId": -1},
            {"jointIndices": 1},
            {"jointIndices": [0, 77]},
            {"jointIndices": [-1]},
        ],
    ),
    "getJointStateMultiDof": Calls(
        {"bodyUniqueId": ZOO, "jointIndex": SOCKET},
        forms=[Call(f"joint {joint}", (ZOO, joint)) for joint in (SHOULDER, DRAWER, WELD, AXLE)],
        bad=[{"bodyUniqueId": NO_BODY}, {"bodyUniqueId": -1}, {"jointIndex": -1}, {"jointIndex": 77}],
    ),
    "getJointStatesMultiDof": Calls(
        {"bodyUniqueId": ZOO, "jointIndex": [SHOULDER, SOCKET]},
        forms=[Call("a range", (ZOO, range(5))), Call("none", (ZOO, []))],
        bad=[{"bodyUniqueId": NO_BODY}, {"bodyUniqueId": -1}, {"jointIndex": 1}, {"jointIndex": [0, 77]}],
    ),
    "resetJointState": Calls(
        {"bodyUniqueId": ZOO, "jointIndex": SHOULDER, "targetValue": 0.7},
        other={"targetVelocity": 0.4},
        forms=[Call("a fixed joint", (ZOO, WELD, 1.0)), Call("a ball", (ZOO, SOCKET, 1.0))],
        bad=[{"bodyUniqueId": NO_BODY}, {"jointIndex": -1}, {"jointIndex": 77}, {"targetValue": None}],
    ),
    "resetJointStateMultiDof": Calls(
        {"bodyUniqueId": ZOO, "jointIndex": SOCKET, "targetValue": [0, 0.6, 0, 0.8]},
        other={"targetVelocity": [0.1, 0.2, 0.3]},
        forms=[Call("one freedom", (ZOO, DRAWER, [0.2], [0.1]))],
        bad=[{"bodyUniqueId": NO_BODY}, {"jointIndex": -1}, {"jointIndex": 77}, {"targetValue": 5}],
    ),
    "resetJointStatesMultiDof": Calls(
        {"bodyUniqueId": ZOO, "jointIndices": [DRAWER, SOCKET], "targetValues": [[0.2], [0, 0.6, 0, 0.8]]},
        other={"targetVelocities": [[0.3], [0.1, 0.2, 0.3]]},
        bad=[
            {"bodyUniqueId": NO_BODY},
            {"jointIndices": 1},
            {"jointIndices": [0]},
            {"jointIndices": [0, 77]},
            {"targetValues": 5},
            {"targetValues": [1, 2]},
        ],
    ),
    "createConstraint": Calls(
        {
            "parentBodyUniqueId": CRATE,
            "parentLinkIndex": -1,
            "childBodyUniqueId": -1,
            "childLinkIndex": -1,
            "jointType": FIXED,
            "jointAxis": [0, 0, 1],
            "parentFramePosition": [0.1, 0, 0],
            "childFramePosition": [0, 3, 5],
        },
        other={"parentFrameOrientation": list(TILTED), "childFrameOrientation": list(TILTED)},
        forms=[
            Call("a point", (CRATE, -1, -1, -1, POINT, [0, 0, 0], [0, 0, 0.2], [0, 3, 5])),
            Call("a slider", (CRATE, -1, -1, -1, PRISMATIC, [1, 0, 0], [0, 0, 0], [0, 3, 5])),
            Call("between two bodies", (CRATE, -1, BALL, -1, POINT, [0, 0, 0], [1, 0, 0], [0, 0, 1])),
            Call("a gear", (ARM, 0, ARM, 1, GEAR, [0, 1, 0], [0, 0, 0], [0, 0, 0])),
        ],
        bad=[
            {"parentBodyUniqueId": NO_BODY},
            {"parentLinkIndex": 77},
            {"childBodyUniqueId": NO_BODY},
            {"jointType": 99},
        ],
    ),
    "changeConstraint": Calls(
        {"userConstraintUniqueId": HANG},
        other={
            "jointChildPivot": [0, -3, 4.5],
            "jointChildFrameOrientation": list(TILTED),
            "maxForce": 2.0,
            "gearRatio": 3.0,
            "gearAuxLink": 1,
            "relativePositionTarget": 0.5,
            "erp": 0.4,
        },
        forms=[Call("unknown", (77, [0, 0, 0]))],
    ),
    "removeConstraint": Calls({"userConstraintUniqueId": HANG}, forms=[Call("unknown", (77,))]),
    "getNumConstraints": Calls(),
    "getConstraintUniqueId": Calls(
        {"serialIndex": 0}, forms=[Call("too high", (77,)), Call("too low", (-1,))]
    ),
    "getConstraintInfo": Calls(
        {"constraintUniqueId": HANG}, bad=[{"constraintUniqueId": 77}, {"constraintUniqueId": -1}]
    ),
    "getConstraintState": Calls(
        {"constraintUniqueId": HANG}, bad=[{"constraintUniqueId": 77}, {"constraintUniqueId": -1}]
    ),
}
