"""Questions about states, contacts and looks."""

from __future__ import annotations

from typing import Any

from tools.differ.maker import Maker


def state(maker: Maker) -> None:
    """Ask for the state of a body, a joint or a link."""
    body = maker.body()
    reference, count = body.reference, len(body.joints)
    forward = maker.some(computeLinkVelocity=maker.one((0, 1)), computeForwardKinematics=maker.one((0, 1)))
    kind = maker.random.randrange(10)
    if kind < 2:
        maker.call("getLinkState", reference, maker.link(body, base=False), **forward)
    elif kind < 4 and count:
        links = maker.random.sample(range(count), maker.random.randint(1, count))
        maker.call("getLinkStates", reference, links, **forward)
    elif kind == 4 and count:
        maker.call("getJointStates", reference, list(range(count)))
    elif kind == 5:
        maker.call("getJointState", reference, maker.link(body, base=False))
    elif kind == 6:
        maker.call("getDynamicsInfo", reference, maker.link(body))
    elif kind == 7:
        maker.call("getBaseVelocity", reference)
    elif kind == 8:
        maker.call("getBasePositionAndOrientation", reference)
    elif count:
        maker.call("getJointInfo", reference, maker.link(body, base=False))


def contacts(maker: Maker) -> None:
    """Ask for contacts: all, or those of some bodies and links."""
    if maker.chance(0.3):
        maker.call("performCollisionDetection")
    keywords: dict[str, Any] = {}
    if maker.chance(0.5):
        first, second = maker.body(), maker.body()
        keywords = maker.some(bodyA=first.reference, bodyB=second.reference)
        for name, body in (("A", first), ("B", second)):
            if f"body{name}" in keywords and maker.chance(0.4):
                keywords[f"linkIndex{name}"] = maker.link(body)
    maker.call("getContactPoints", **keywords)


def look(maker: Maker) -> None:
    """Ask for the shapes of a body, or change how it looks."""
    body = maker.body()
    reference, link = body.reference, maker.link(body)
    kind = maker.random.randrange(7)
    if kind < 2:
        maker.call("getVisualShapeData", reference, **maker.some(flags=maker.one((0, 1))))
    elif kind < 4:
        maker.call("getCollisionShapeData", reference, link)
    elif kind == 4:
        keywords = maker.some(
            rgbaColor=[maker.share(), maker.share(), maker.share(), maker.one((1, 0.4, 0))],
            specularColor=[0.3, 0.2, 1],
            shapeIndex=maker.one((-1, 0)),
        )
        maker.call("changeVisualShape", reference, link, **keywords)
    elif kind == 5:
        maker.call("getMeshData", reference, link, **maker.some(flags=maker.one((0, 1))))
    else:
        maker.call("getBodyInfo", reference)
