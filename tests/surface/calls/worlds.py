"""Stepping, the parameters of the engine, and states."""

from ..call import Call, Calls
from ..scene import BALL

BULLET, SCRIPT = "<temp>/scene.bullet", "<temp>/scene.py"

CALLS = {
    "stepSimulation": Calls(
        forms=[Call("with a client by position", (0,))],
    ),
    "performCollisionDetection": Calls(),
    "resetSimulation": Calls(
        other={"flags": 2},
        forms=[Call("simple broad phase", (4,))],
    ),
    "setGravity": Calls(
        {"gravX": 1, "gravY": -2.5, "gravZ": 0},
        bad=[{"gravX": None}, {"gravZ": [0, 0, -9.8]}, Call("a list", ([0, 0, -9.8],))],
    ),
    "setTimeStep": Calls({"timeStep": 0.002}, bad=[{"timeStep": "short"}]),
    "setDefaultContactERP": Calls({"defaultContactERP": 0.3}, bad=[{"defaultContactERP": None}]),
    "setRealTimeSimulation": Calls({"enableRealTimeSimulation": 0}, bad=[{"enableRealTimeSimulation": 0.5}]),
    "setInternalSimFlags": Calls({"flags": 0}, bad=[{"flags": None}]),
    "getPhysicsEngineParameters": Calls(),
    "setPhysicsEngineParameter": Calls(
        other={
            "fixedTimeStep": 0.002,
            "numSolverIterations": 7,
            "useSplitImpulse": 0,
            "splitImpulsePenetrationThreshold": 0.1,
            "numSubSteps": 3,
            "collisionFilterMode": 0,
            "contactBreakingThreshold": 0.04,
            "maxNumCmdPer1ms": 10,
            "enableFileCaching": 0,
            "restitutionVelocityThreshold": 0.5,
            "erp": 0.4,
            "contactERP": 0.3,
            "frictionERP": 0.1,
            "enableConeFriction": 0,
            "deterministicOverlappingPairs": 1,
            "allowedCcdPenetration": 0.01,
            "jointFeedbackMode": 1,
            "solverResidualThreshold": 1e-9,
            "contactSlop": 0.001,
            "enableSAT": 1,
            "constraintSolverType": 2,
            "globalCFM": 1e-3,
            "minimumSolverIslandSize": 64,
            "reportSolverAnalytics": 1,
            "warmStartingFactor": 0.5,
            "sparseSdfVoxelSize": 0.3,
            "numNonContactInnerIterations": 3,
        },
        forms=[Call("Dantzig's solver", (), {"constraintSolverType": 3})],
        bad=[{"fixedTimeStep": "short"}, {"numSolverIterations": 1.5}],
    ),
    "submitProfileTiming": Calls(
        other={"eventName ": "think"},
        forms=[Call("a zone", ("think",))],
        bad=[
            Call("a name that is none", (1.5,)),
            Call("the name without the space", (), {"eventName": "think"}),
        ],
    ),
    "saveState": Calls(),
    "restoreState": Calls(
        other={"fileName": BULLET, "stateId": 0},
        forms=[Call("the state alone", (0,))],
        bad=[{"stateId": 77}, {"fileName": "<temp>/missing.bullet"}],
        first=[
            ("saveState",),
            ("saveBullet", BULLET),
            ("resetBasePositionAndOrientation", BALL, [5, 5, 5], [0, 0, 0, 1]),
        ],
    ),
    "removeState": Calls({"stateUniqueId": 0}, forms=[Call("unknown", (77,))], first=[("saveState",)]),
    "saveBullet": Calls(
        {"bulletFileName": BULLET},
        bad=[{"bulletFileName": "<temp>/no/such/folder.bullet"}, {"bulletFileName": 1}],
    ),
    "loadBullet": Calls({"bulletFileName": "<temp>/missing.bullet"}, bad=[{"bulletFileName": 1}]),
    "saveWorld": Calls(
        {"worldFileName": SCRIPT}, bad=[{"worldFileName": "<temp>/no/such/folder.py"}, {"worldFileName": 1}]
    ),
}
