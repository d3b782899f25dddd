"""Camera images and camera matrices."""

from ..call import Call, Calls

VIEW = [1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, -2, -6, 1]
PROJECTION = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1.002, -1, 0, 0, -0.2002, 0]
SMALL = {"width": 16, "height": 8}

CALLS = {
    "getCameraImage": Calls(
        SMALL,
        other={
            "viewMatrix": VIEW,
            "projectionMatrix": PROJECTION,
            "lightDirection": [1, 1, 1],
            "lightColor": [1, 0.5, 0.5],
            "lightDistance": 3.0,
            "shadow": 1,
            "lightAmbientCoeff": 0.3,
            "lightDiffuseCoeff": 0.3,
            "lightSpecularCoeff": 0.3,
            "renderer": 65536,
            "flags": 1,
            "projectiveTextureView": VIEW,
            "projectiveTextureProj": PROJECTION,
        },
        forms=[Call("by position", (16, 8, VIEW, PROJECTION))],
        bad=[{"width": "wide"}],
    ),
    "renderImage": Calls(
        forms=[
            Call("size", (16, 8)),
            Call("matrices", (16, 8, VIEW, PROJECTION)),
            Call("places", (16, 8, [1, 1, 1], [0, 0, 0], [0, 0, 1], 0.1, 10)),
            Call("places and a field of view", (16, 8, [1, 1, 1], [0, 0, 0], [0, 0, 1], 0.1, 10, 60)),
            Call("angles", (16, 8, [0, 0, 0], 3, 20, -30, 0, 2, 0.1, 10, 60)),
        ],
        bad=[
            Call("three arguments", (16, 8, VIEW)),
            Call("no matrix", (16, 8, [1], PROJECTION)),
            Call("no position", (16, 8, [1], [0, 0, 0], [0, 0, 1], 0.1, 10)),
            Call("no position, with a field of view", (16, 8, [1], [0, 0, 0], [0, 0, 1], 0.1, 10, 60)),
            Call("no target", (16, 8, [0], 3, 20, -30, 0, 2, 0.1, 10, 60)),
            Call("no number", (16, "high")),
            Call("no position, target or up", (16, 8, [1, 1, 1], [0], [0, 0, 1], 0.1, 10, 60)),
        ],
    ),
    "computeViewMatrix": Calls(
        {"cameraEyePosition": [1, 2, 3], "cameraTargetPosition": [0, 0.5, 0], "cameraUpVector": [0, 0, 1]},
        bad=[{"cameraEyePosition": [1]}, {"cameraTargetPosition": 3}],
    ),
    "computeViewMatrixFromYawPitchRoll": Calls(
        {
            "cameraTargetPosition": [1, 2, 3],
            "distance": 2,
            "yaw": 30,
            "pitch": -20,
            "roll": 5,
            "upAxisIndex": 2,
        },
        forms=[Call("y upwards", ([1, 2, 3], 2, 30, -20, 5, 1))],
        bad=[{"cameraTargetPosition": [1]}, {"distance": "far"}],
    ),
    "computeProjectionMatrix": Calls(
        {"left": -1, "right": 2, "bottom": -0.5, "top": 0.7, "nearVal": 0.1, "farVal": 9},
        bad=[{"left": "far"}],
    ),
    "computeProjectionMatrixFOV": Calls(
        {"fov": 60, "aspect": 1.5, "nearVal": 0.1, "farVal": 9}, bad=[{"fov": None}]
    ),
}
