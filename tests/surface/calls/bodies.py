"""Bodies, their bases, their links, and what these are made of."""

from ..call import Call, Calls
from ..scene import ARM, BALL, CRATE, NO_BODY, PLANE, SHOULDER, TILTED, UPRIGHT, WELD, ZOO

CALLS = {
    "getNumBodies": Calls(),
    "getBodyUniqueId": Calls({"serialIndex": 3}, forms=[Call("too high", (77,)), Call("too low", (-1,))]),
    "getBodyInfo": Calls(
        {"bodyUniqueId": ZOO},
        forms=[Call("of shapes", (BALL,))],
        bad=[{"bodyUniqueId": NO_BODY}, {"bodyUniqueId": -1}],
    ),
    "removeBody": Calls(
        {"bodyUniqueId": CRATE}, forms=[Call("unknown", (NO_BODY,)), Call("on a constraint", (5,))]
    ),
    "computeDofCount": Calls(
        {"bodyUniqueId": ARM}, forms=[Call("a free one", (CRATE,)), Call("unknown", (NO_BODY,))]
    ),
    "getBasePositionAndOrientation": Calls(
        {"bodyUniqueId": CRATE}, bad=[{"bodyUniqueId": NO_BODY}, {"bodyUniqueId": -1}]
    ),
    "resetBasePositionAndOrientation": Calls(
        {"bodyUniqueId": CRATE, "posObj": [1, 2, 3], "ornObj": list(UPRIGHT)},
        forms=[
            Call("a tuple", (CRATE, (1, 2, 3), (0, 0, 0.6, 0.8))),
            Call("not of unit length", (CRATE, [1, 2, 3], [0, 0, 3, 4])),
            Call("a fixed base", (ZOO, [0, 0, 2], list(TILTED))),
            Call("unknown", (NO_BODY, [0, 0, 2], list(TILTED))),
        ],
        bad=[{"posObj": [1, 2]}, {"ornObj": [0, 0, 1]}],
    ),
    "getBaseVelocity": Calls({"bodyUniqueId": CRATE}, bad=[{"bodyUniqueId": NO_BODY}]),
    "resetBaseVelocity": Calls(
        {"objectUniqueId": CRATE, "linearVelocity": [1, 2, 3]},
        other={"angularVelocity": [0.1, 0.2, 0.3]},
        forms=[
            Call("turning alone", (), {"objectUniqueId": CRATE, "angularVelocity": [1, 0, 0]}),
            Call("unknown", (NO_BODY, [1, 0, 0])),
        ],
        bad=[Call("nothing", (CRATE,)), {"linearVelocity": [1, 2]}],
    ),
    "getAABB": Calls(
        {"bodyUniqueId": ZOO},
        other={"linkIndex": 1},
        bad=[{"bodyUniqueId": -1}, {"bodyUniqueId": NO_BODY}, {"linkIndex": -2}, {"linkIndex": 77}],
    ),
    "getLinkState": Calls(
        {"bodyUniqueId": ARM, "linkIndex": 1},
        other={"computeLinkVelocity": 1, "computeForwardKinematics": 1},
        forms=[Call("too high", (ARM, 77)), Call("all", (ZOO, 3, 1, 1))],
        bad=[{"bodyUniqueId": -1}, {"bodyUniqueId": NO_BODY}, {"linkIndex": -1}],
    ),
    "getLinkStates": Calls(
        {"bodyUniqueId": ARM, "linkIndices": [0, 2]},
        other={"computeLinkVelocity": 1, "computeForwardKinematics": 1},
        forms=[Call("a range", (ZOO, range(4))), Call("none", (ZOO, []))],
        bad=[{"bodyUniqueId": -1}, {"bodyUniqueId": NO_BODY}, {"linkIndices": 5}, {"linkIndices": [0, 77]}],
    ),
    "getDynamicsInfo": Calls(
        {"bodyUniqueId": ZOO, "linkIndex": -1},
        forms=[
            Call("a link", (ZOO, SHOULDER)),
            Call("a fixed joint", (ZOO, WELD)),
            Call("nothing heavy", (PLANE, -1)),
        ],
        bad=[{"bodyUniqueId": -1}, {"bodyUniqueId": NO_BODY}, {"linkIndex": -2}, {"linkIndex": 77}],
    ),
    "changeDynamics": Calls(
        {"bodyUniqueId": CRATE, "linkIndex": -1},
        other={
            "mass": 3.0,
            "lateralFriction": 0.9,
            "spinningFriction": 0.1,
            "rollingFriction": 0.2,
            "restitution": 0.4,
            "linearDamping": 0.5,
            "angularDamping": 0.6,
            "contactStiffness": 1000.0,
            "contactDamping": 10.0,
            "frictionAnchor": 1,
            "localInertiaDiagonal": [0.1, 0.2, 0.3],
            "ccdSweptSphereRadius": 0.1,
            "contactProcessingThreshold": 0.2,
            "activationState": 2,
            "jointDamping": 0.3,
            "anisotropicFriction": [1, 0.5, 0.2],
            "maxJointVelocity": 0.01,
            "collisionMargin": 0.02,
            "jointLowerLimit": -0.5,
            "jointUpperLimit": 2.0,
            "jointLimitForce": 5.0,
            "sleepThreshold": 0.1,
        },
        along={
            "contactStiffness": {"contactDamping": 10.0},
            "contactDamping": {"contactStiffness": 500.0},
            "jointDamping": {"bodyUniqueId": ARM, "linkIndex": 1},
            "jointLowerLimit": {"bodyUniqueId": ARM, "linkIndex": 1, "jointUpperLimit": 0.38},
            "jointUpperLimit": {"bodyUniqueId": ARM, "linkIndex": 1, "jointLowerLimit": 0.42},
            "jointLimitForce": {
                "bodyUniqueId": ARM,
                "linkIndex": 1,
                "jointLowerLimit": 0.42,
                "jointUpperLimit": 2,
            },
            "maxJointVelocity": {"bodyUniqueId": ARM},
        },
        forms=[
            Call("a link", (ZOO, 1), {"mass": 0.8, "lateralFriction": 0.3}),
            Call("unknown body", (NO_BODY, -1, 1.0)),
            Call("unknown link", (ZOO, 77, 1.0)),
        ],
        bad=[{"contactStiffness": 1000.0}, {"contactDamping": 1.0}, {"mass": "heavy"}],
    ),
    "enableJointForceTorqueSensor": Calls(
        {"bodyUniqueId": ZOO, "jointIndex": SHOULDER},
        other={"enableSensor": 0},
        bad=[{"bodyUniqueId": -1}, {"bodyUniqueId": NO_BODY}, {"jointIndex": -1}, {"jointIndex": 77}],
    ),
    "applyExternalForce": Calls(
        {"objectUniqueId": CRATE, "linkIndex": -1, "forceObj": [5, 1, 0], "posObj": [0.1, 3, 5], "flags": 2},
        forms=[
            Call("in the frame of the link", (CRATE, -1, [5, 1, 0], [0.1, 0, 0], 1)),
            Call("on a link", (ARM, 1, [5, 1, 0], [0.1, 0, 0], 1)),
            Call("unknown body", (NO_BODY, -1, [5, 1, 0], [0.1, 0, 0], 1)),
        ],
        bad=[{"forceObj": [5]}, {"posObj": [3]}, {"flags": 7}],
    ),
    "applyExternalTorque": Calls(
        {"objectUniqueId": CRATE, "linkIndex": -1, "torqueObj": [1, 2, 0], "flags": 2},
        forms=[
            Call("in the frame of the link", (CRATE, -1, [1, 2, 0], 1)),
            Call("on a link", (ARM, 1, [1, 2, 0], 1)),
        ],
        bad=[{"torqueObj": [5]}, {"linkIndex": -2}, {"flags": 7}],
    ),
    "unsupportedChangeScaling": Calls({"bodyUniqueId": BALL, "scaling": [2, 2, 2]}, bad=[{"scaling": [1]}]),
}
