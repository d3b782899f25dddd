"""Contacts, nearest points, overlaps and rays."""

from ..call import Call, Calls
from ..scene import BALL, CRATE, NO_BODY, PLANE, SPARE_BOX, SPARE_SPHERE, TILTED, ZOO

DOWN = ([-2, 0, 5], [-2, 0, -11])
THROUGH = {"rayFromPosition": [0, 3, 9], "rayToPosition": [0.05, 3, -1]}

CALLS = {
    "getContactPoints": Calls(
        other={"bodyA": BALL, "bodyB": PLANE, "linkIndexA": -1, "linkIndexB": -1},
        along={"linkIndexA": {"bodyA": BALL}, "linkIndexB": {"bodyA": PLANE, "bodyB": BALL}},
        forms=[Call("both", (PLANE, BALL)), Call("no contact", (CRATE,)), Call("unknown", (NO_BODY,))],
    ),
    "getClosestPoints": Calls(
        {"bodyA": BALL, "bodyB": PLANE, "distance": 1.0},
        other={
            "linkIndexA": -1,
            "linkIndexB": -1,
            "collisionShapeA": SPARE_SPHERE,
            "collisionShapeB": SPARE_BOX,
            "collisionShapePositionA": [0, 0, -9.3],
            "collisionShapePositionB": [-2, 0.1, -9.0],
            "collisionShapeOrientationA": list(TILTED),
            "collisionShapeOrientationB": list(TILTED),
        },
        along={
            "collisionShapeA": {"bodyA": -1, "collisionShapePositionA": [0, 0, -9.6]},
            "collisionShapeB": {"bodyB": -1, "collisionShapePositionB": [-2, 0, -9.0]},
            "collisionShapePositionA": {"bodyA": -1, "collisionShapeA": SPARE_SPHERE},
            "collisionShapePositionB": {"bodyB": -1, "collisionShapeB": SPARE_SPHERE},
            "collisionShapeOrientationA": {
                "bodyA": -1,
                "collisionShapeA": SPARE_SPHERE,
                "collisionShapePositionA": [0, 0, -9.6],
            },
            "collisionShapeOrientationB": {
                "bodyB": -1,
                "collisionShapeB": SPARE_SPHERE,
                "collisionShapePositionB": [-2, 0, -9.0],
            },
        },
        forms=[Call("far apart", (CRATE, PLANE, 0.1))],
    ),
    "getOverlappingObjects": Calls(
        {"aabbMin": [-2.1, -0.1, -9.8], "aabbMax": [-1.9, 0.1, -9.6]},
        forms=[Call("nothing", ([50, 50, 50], [51, 51, 51]))],
    ),
    "rayTest": Calls(
        {"rayFromPosition": DOWN[0], "rayToPosition": DOWN[1]},
        other={"collisionFilterMask": 2, "reportHitNumber": 0},
        forms=[Call("a miss", ([50, 50, 50], [50, 50, 51])), Call("a crate", tuple(THROUGH.values()))],
    ),
    "rayTestBatch": Calls(
        {"rayFromPositions": [DOWN[0], [0, 3, 9]], "rayToPositions": [DOWN[1], [0.05, 3, -1]]},
        other={
            "numThreads": 2,
            "parentObjectUniqueId": ZOO,
            "parentLinkIndex": 0,
            "reportHitNumber": 0,
            "collisionFilterMask": 2,
            "fractionEpsilon": 0.01,
        },
        along={"parentLinkIndex": {"parentObjectUniqueId": ZOO}},
        forms=[Call("no rays", ([], []))],
        bad=[
            {"rayFromPositions": None},
            {"rayFromPositions": [[0, 0, 0]]},
            {"rayFromPositions": [[0, 0], [0, 0]]},
            {"rayFromPositions": [[0, 0, 0]] * 16385, "rayToPositions": [[0, 0, 1]] * 16385},
        ],
    ),
}
