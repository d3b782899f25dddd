"""Loading."""

from ..call import Call, Calls
from ..scene import DATA, ROBOTS, TILTED

CUBE = f"{DATA}/cube_small.urdf"
SCENES = "<repo>/tests/formats/data"
MISSING = "<temp>/missing"

CALLS = {
    "setAdditionalSearchPath": Calls({"path": DATA}, bad=[{"path": None}]),
    "loadURDF": Calls(
        {"fileName": CUBE},
        other={
            "basePosition": [1, 2, 3],
            "baseOrientation": list(TILTED),
            "useMaximalCoordinates": 0,
            "useFixedBase": 1,
            "flags": 2,
            "globalScaling": 2.0,
        },
        forms=[
            Call("three more numbers", (CUBE, 1, 2, 3)),
            Call("seven more numbers", (CUBE, 1, 2, 3, 0, 0.6, 0, 0.8)),
            Call("lists by position", (CUBE, [1, 2, 3], [0, 0.6, 0, 0.8], 0, 1)),
            *(
                Call(f"flag {flag}", (f"{ROBOTS}/zoo.urdf",), {"basePosition": [0, 0, 9], "flags": flag})
                for flag in (2, 8, 16, 32, 128, 256, 1024, 2048, 4096, 8192, 32768, 65536, 131072, 262144)
            ),
            Call("flag 524288", (f"{ROBOTS}/zoo.urdf",), {"basePosition": [0, 0, 9], "flags": 524288}),
            Call("flag 1048576", (CUBE,), {"basePosition": [0, 0, 9], "flags": 1048576}),
            Call("flag 2097152", (CUBE,), {"basePosition": [0, 0, 9], "flags": 2097152}),
            Call("flag 4194304", (CUBE,), {"basePosition": [0, 0, 9], "flags": 4194304}),
            Call("flag 8388608", (CUBE,), {"basePosition": [0, 0, 9], "flags": 8388608}),
        ],
        bad=[
            {"basePosition": [0, 0]},
            {"baseOrientation": [0, 0, 0]},
            {"fileName": f"{MISSING}.urdf"},
            {"fileName": ""},
            {"fileName": 1},
        ],
    ),
    "loadSDF": Calls(
        {"sdfFileName": f"{SCENES}/sdf/arm.sdf"},
        other={"useMaximalCoordinates": 0, "globalScaling": 2.0},
        bad=[{"sdfFileName": f"{MISSING}.sdf"}, {"sdfFileName": 1}],
    ),
    "loadMJCF": Calls(
        {"mjcfFileName": "<repo>/tests/surface/sled.xml"},
        other={"flags": 512, "useMultiBody": 1},
        bad=[{"mjcfFileName": f"{MISSING}.xml"}, {"mjcfFileName": 1}],
    ),
    "loadSoftBody": Calls(
        {"fileName": f"{MISSING}.obj"},
        other={
            "basePosition": [0, 0, 1],
            "baseOrientation": [0, 0, 0, 1],
            "scale": 2.0,
            "mass": 1.0,
            "collisionMargin": 0.01,
            "useMassSpring": 1,
            "useBendingSprings": 1,
            "useNeoHookean": 1,
            "springElasticStiffness": 2.0,
            "springDampingStiffness": 0.2,
            "springDampingAllDirections": 1,
            "springBendingStiffness": 0.2,
            "NeoHookeanMu": 2.0,
            "NeoHookeanLambda": 2.0,
            "NeoHookeanDamping": 0.2,
            "frictionCoeff": 0.5,
            "useFaceContact": 1,
            "useSelfCollision": 1,
            "repulsionStiffness": 0.6,
            "simFileName": f"{MISSING}.vtk",
        },
        bad=[{"basePosition": [0]}, {"baseOrientation": [0]}, {"fileName": 1}],
    ),
    "createSoftBodyAnchor": Calls(
        {"softBodyBodyUniqueId": 3, "nodeIndex": 0},
        other={"bodyUniqueId": 1, "linkIndex": 0, "bodyFramePosition": [0, 0, 0]},
    ),
    "getTetraMeshData": Calls({"bodyUniqueId": 3}, other={"flags": 1}, bad=[{"bodyUniqueId": 99}]),
    "resetMeshData": Calls({"bodyUniqueId": 3, "vertices": [[0, 0, 0]]}, bad=[{"bodyUniqueId": 99}]),
}
