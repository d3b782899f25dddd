"""What has no effect on motion: user data, drawings, and maths."""

from __future__ import annotations

from typing import Any

from tools.differ.maker import Maker

_CLEARING = (
    "removeAllUserDebugItems",
    "removeAllUserParameters",
    "getDebugVisualizerCamera",
    "getKeyboardEvents",
    "getMouseEvents",
    "getVREvents",
)


def book(maker: Maker) -> None:
    """Keep texts with bodies, and ask for them."""
    body = maker.body()
    kind = maker.random.randrange(9)
    if kind < 3 or not maker.data:
        key, text = maker.one(("a", "b", "key")), maker.one(("x", "", "value ü", "1"))
        keywords = maker.some(linkIndex=maker.link(body), visualShapeIndex=maker.one((-1, 0)))
        maker.data.append(maker.call("addUserData", body.reference, key, text, **keywords))
    elif kind == 3:
        maker.call("getUserData", maker.one(maker.data))
    elif kind == 4:
        link = maker.some(linkIndex=maker.link(body))
        maker.call("getUserDataId", body.reference, maker.one(("a", "b")), **link)
    elif kind == 5:
        maker.call("getNumUserData", body.reference)
    elif kind == 6:
        maker.call("getUserDataInfo", body.reference, 0)
    elif kind == 7:
        maker.call("removeUserData", maker.one(maker.data))
    else:
        maker.call("syncUserData", **maker.some(bodyUniqueIds=[body.reference]))


def debug(maker: Maker) -> None:
    """Draw, and ask for what the window has."""
    body = maker.body()
    link = maker.link(body)
    parent = maker.some(parentObjectUniqueId=body.reference, parentLinkIndex=link, lifeTime=maker.one((0, 1)))
    kind = maker.random.randrange(9)
    if kind == 0 or not maker.items:
        keywords = {**maker.some(lineColorRGB=[1, 0, 0], lineWidth=2), **parent}
        maker.items.append(maker.call("addUserDebugLine", maker.vector(), maker.vector(), **keywords))
    elif kind == 1:
        looks = maker.some(textColorRGB=[1, 0, 0], textSize=2, textOrientation=maker.turn())
        maker.items.append(maker.call("addUserDebugText", "text", maker.vector(), **looks, **parent))
    elif kind == 2:
        values = maker.one(([], [0, 1, 0.5], [1, 0, 0.5], [-1, 1]))
        maker.items.append(maker.call("addUserDebugParameter", "name", *values))
    elif kind == 3:
        maker.call("readUserDebugParameter", maker.one(maker.items))
    elif kind == 4:
        maker.call("removeUserDebugItem", maker.one(maker.items))
    elif kind == 5:
        maker.call(maker.one(_CLEARING))
    elif kind == 6:
        keywords = {**maker.some(pointSize=3), **parent}
        maker.items.append(maker.call("addUserDebugPoints", [maker.vector()], [[1, 0, 0]], **keywords))
    elif kind == 7:
        colour = maker.some(objectDebugColorRGB=[1, 0, 0])
        maker.call("setDebugObjectColor", body.reference, link, **colour)
    else:
        maker.call("configureDebugVisualizer", maker.one((1, 2, 7)), maker.one((0, 1)))


def maths(maker: Maker) -> None:
    """Ask for turns, transforms and matrices."""
    q, t, v, w = maker.turn(), maker.turn(), maker.vector(), maker.vector()
    angles = [maker.number(-90, 90), maker.number(-180, 180), maker.number(-90, 90)]
    calls: tuple[tuple[Any, ...], ...] = (
        ("getEulerFromQuaternion", q),
        ("getQuaternionFromEuler", maker.vector(3)),
        ("getMatrixFromQuaternion", q),
        ("multiplyTransforms", v, q, w, t),
        ("invertTransform", v, q),
        ("getAxisAngleFromQuaternion", q),
        ("getQuaternionFromAxisAngle", v, maker.number(-4, 4)),
        ("getDifferenceQuaternion", q, t),
        ("getQuaternionSlerp", q, t, maker.number(-0.2, 1.2)),
        ("rotateVector", q, v),
        ("calculateVelocityQuaternion", q, t, maker.number(0.1, 1)),
        ("getAxisDifferenceQuaternion", q, t),
        ("computeProjectionMatrix", -1, 1.5, -0.5, 1, 0.1, 10),
        ("computeViewMatrix", maker.vector(3), v, [0, 0, 1]),
        ("computeViewMatrixFromYawPitchRoll", v, 2, *angles, maker.one((1, 2))),
    )
    function, *arguments = maker.one(calls)
    maker.call(function, *arguments)
