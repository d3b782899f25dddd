"""The window and what is drawn in it: what a world without one says."""

from ..call import Call, Calls
from ..scene import CRATE, ZOO

LINE = {"lineFromXYZ": [0, 0, 0], "lineToXYZ": [1, 0, 0]}
PLACED = {"lifeTime": 1.0, "parentObjectUniqueId": ZOO, "parentLinkIndex": 0, "replaceItemUniqueId": 3}

CALLS = {
    "addUserDebugLine": Calls(
        LINE,
        other={"lineColorRGB": [1, 0, 0], "lineWidth": 2.0, **PLACED},
        bad=[{"lineFromXYZ": [0]}, {"lineToXYZ": [0]}, {"lineFromXYZ": 5}],
    ),
    "addUserDebugText": Calls(
        {"text": "here", "textPosition": [0, 0, 1]},
        other={"textColorRGB": [1, 0, 0], "textSize": 2.0, "textOrientation": [0, 0, 0, 1], **PLACED},
        bad=[{"textPosition": [0]}, {"textColorRGB": [1]}, {"textOrientation": [1]}, {"text": 5}],
    ),
    "addUserDebugPoints": Calls(
        {"pointPositions": [[0, 0, 0], [1, 0, 0]], "pointColorsRGB": [[1, 0, 0], [0, 1, 0]]},
        other={"pointSize": 3.0, **PLACED},
        bad=[{"pointColorsRGB": [[1, 0, 0]]}],
    ),
    "addUserDebugParameter": Calls(
        {"paramName": "speed"},
        other={"rangeMin": -1, "rangeMax": 2, "startValue": 0.5},
        bad=[{"paramName": 5}],
    ),
    "readUserDebugParameter": Calls({"itemUniqueId": 0}, bad=[{"itemUniqueId": -1}]),
    "removeUserDebugItem": Calls({"itemUniqueId": 0}),
    "removeAllUserDebugItems": Calls(),
    "removeAllUserParameters": Calls(),
    "setDebugObjectColor": Calls(
        {"objectUniqueId": CRATE, "linkIndex": -1}, other={"objectDebugColorRGB": [1, 0, 0]}
    ),
    "getDebugVisualizerCamera": Calls(),
    "configureDebugVisualizer": Calls(
        other={
            "flag": 2,
            "enable": 0,
            "lightPosition": [1, 2, 3],
            "shadowMapResolution": 1024,
            "shadowMapWorldSize": 5,
            "remoteSyncTransformInterval": 0.1,
            "shadowMapIntensity": 0.5,
            "rgbBackground": [1, 1, 1],
        },
        forms=[Call("switch", (7, 0))],
    ),
    "resetDebugVisualizerCamera": Calls(
        {"cameraDistance": 2, "cameraYaw": 30, "cameraPitch": -20, "cameraTargetPosition": [0, 0, 1]},
    ),
    "getKeyboardEvents": Calls(),
    "getMouseEvents": Calls(),
    "getVREvents": Calls(other={"deviceTypeFilter": 2, "allAnalogAxes": 1}),
    "setVRCameraState": Calls(
        other={
            "rootPosition": [0, 0, 1],
            "rootOrientation": [0, 0, 0, 1],
            "trackObject": ZOO,
            "trackObjectFlag": 1,
        }
    ),
}
