"""Rotations and transforms: they need no connection."""

from ..call import Calls

TURN, OTHER = [0.1, 0.2, 0.3, 0.9], [0.4, -0.2, 0.1, 0.7]
SHIFT = [1, -2, 3]
_TWO = {"quaternionStart": TURN, "quaternionEnd": OTHER}
_SHORT = [{"quaternionStart": [0, 1]}, {"quaternionEnd": [0, 1]}]

CALLS = {
    "getQuaternionFromEuler": Calls(
        {"eulerAngles": [0.1, 0.2, 0.3]}, bad=[{"eulerAngles": [1]}, {"eulerAngles": 5}]
    ),
    "getEulerFromQuaternion": Calls({"quaternion": TURN}, bad=[{"quaternion": [1]}, {"quaternion": 5}]),
    "getMatrixFromQuaternion": Calls({"quaternion": TURN}, bad=[{"quaternion": [1]}]),
    "multiplyTransforms": Calls(
        {
            "positionA": SHIFT,
            "orientationA": [0, 0.6, 0, 0.8],
            "positionB": [0, 1, 0],
            "orientationB": [0.6, 0, 0, 0.8],
        },
        bad=[{"positionA": [1]}, {"orientationB": [1]}],
    ),
    "invertTransform": Calls(
        {"position": SHIFT, "orientation": [0, 0.6, 0, 0.8]}, bad=[{"position": [1]}, {"orientation": [1]}]
    ),
    "rotateVector": Calls(
        {"quaternion": [0, 0.6, 0, 0.8], "vector": SHIFT}, bad=[{"quaternion": [1]}, {"vector": [1]}]
    ),
    "getQuaternionFromAxisAngle": Calls({"axis": [1, 2, 0], "angle": 0.4}, bad=[{"axis": [1]}]),
    "getAxisAngleFromQuaternion": Calls({"quaternion": [0, 0.6, 0, 0.8]}, bad=[{"quaternion": [1]}]),
    "getQuaternionSlerp": Calls({**_TWO, "interpolationFraction": 0.3}, bad=_SHORT),
    "getDifferenceQuaternion": Calls(_TWO, bad=_SHORT),
    "getAxisDifferenceQuaternion": Calls(_TWO, bad=_SHORT),
    "calculateVelocityQuaternion": Calls({**_TWO, "deltaTime": 0.1}, bad=_SHORT),
}
