"""What can be told of a world from outside: the effect of a call is what it changes of this."""

from __future__ import annotations

from typing import Any

STEPS = 3


def observe(p: Any) -> dict[str, Any]:
    """Everything the getters say, before and after some steps."""
    if not p.isConnected():
        return {"connected": 0}
    seen: dict[str, Any] = {"parameters": p.getPhysicsEngineParameters()}
    bodies = [p.getBodyUniqueId(serial) for serial in range(p.getNumBodies())]
    seen["bodies"] = bodies
    for body in bodies:
        seen |= _made_of(p, body)
    constraints = [p.getConstraintUniqueId(serial) for serial in range(p.getNumConstraints())]
    for constraint in constraints:
        seen[f"constraint {constraint}"] = p.getConstraintInfo(constraint)
    seen |= _motion(p, bodies, "")
    for _ in range(STEPS):
        p.stepSimulation()
    seen |= _motion(p, bodies, "later ")
    seen["later contacts"] = [point[1:5] for point in p.getContactPoints()]
    return seen


def _made_of(p: Any, body: int) -> dict[str, Any]:
    links = range(-1, p.getNumJoints(body))
    name = f"body {body}"
    seen = {f"{name} name": p.getBodyInfo(body), f"{name} looks": p.getVisualShapeData(body)}
    for link in links:
        seen[f"{name} link {link} dynamics"] = p.getDynamicsInfo(body, link)
        seen[f"{name} link {link} shapes"] = p.getCollisionShapeData(body, link)
        seen[f"{name} link {link} bounds"] = p.getAABB(body, link)
    for joint in links[1:]:
        seen[f"{name} joint {joint}"] = p.getJointInfo(body, joint)
    for entry in range(p.getNumUserData(body)):
        info = p.getUserDataInfo(body, entry)
        seen[f"{name} user data {entry}"] = [info, p.getUserData(info[0])]
    return seen


def _motion(p: Any, bodies: list[int], when: str) -> dict[str, Any]:
    seen = {}
    for body in bodies:
        seen[f"{when}body {body} pose"] = p.getBasePositionAndOrientation(body)
        seen[f"{when}body {body} velocity"] = p.getBaseVelocity(body)
        for joint in range(p.getNumJoints(body)):
            seen[f"{when}body {body} joint {joint} state"] = p.getJointStateMultiDof(body, joint)
    return seen
