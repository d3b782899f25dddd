"""What has to hold of a world after any sequence of calls."""

from __future__ import annotations

from collections.abc import Container, Iterator
from math import isfinite
from typing import Any

import numpy as np

import pybullet as p
from pybullet._clients.clients import clients

_STEPS = 3
# A field of `getDynamicsInfo`, and what it says of soft bodies.
_BODY_TYPE, _SOFT = 10, 3


class Broken(AssertionError):
    """Something that has to hold does not."""


class Fingerprint:
    """All that a refused call must leave alone: bodies, constraints, parameters, the state and contacts."""

    def __init__(self) -> None:
        world = clients[0].world
        self.scene = (
            list(world.bodies.keys()),
            [p.getConstraintUniqueId(place) for place in range(p.getNumConstraints())],
            p.getPhysicsEngineParameters(),
        )
        snapshot = world.snapshot()
        self.arrays = snapshot.state | snapshot.contacts | {"user_impulses": snapshot.user_impulses}
        # The next step makes it anew from the others.
        del self.arrays["overlap_sorted"]

    def check(self, now: Fingerprint, but: Container[str] = ()) -> None:
        """Raises `Broken` where another is not the same; `but` are names of arrays that may differ."""
        if self.scene != now.scene:
            raise Broken(f"the scene has changed from {self.scene} to {now.scene}")
        for name, array in self.arrays.items():
            if name not in but and not np.array_equal(array, now.arrays[name], equal_nan=True):
                raise Broken(f"{name} has changed")


def check_finite() -> None:
    """See that no getter gives a number that is not finite."""
    for name, answer in _answers():
        for number in _numbers(answer):
            if not isfinite(number):
                raise Broken(f"{name} gives {number}: {answer}")


def check_states() -> None:
    """See that what follows on a restored state is what followed when it was saved, to the last bit."""
    state = p.saveState()
    first = _after_steps()
    p.restoreState(state)
    second = _after_steps()
    p.removeState(state)
    if first != second:
        raise Broken(f"restoreState does not lead to the same: {first} and {second}")


def _after_steps() -> list[Any]:
    for _ in range(_STEPS):
        try:
            p.stepSimulation()
        except p.error as problem:
            return [str(problem)]
    return [*(answer for _, answer in _motion()), p.getContactPoints()]


def _bodies() -> list[int]:
    return [p.getBodyUniqueId(place) for place in range(p.getNumBodies())]


def _motion() -> Iterator[tuple[str, Any]]:
    for body in _bodies():
        yield f"pose of body {body}", p.getBasePositionAndOrientation(body)
        yield f"velocity of body {body}", p.getBaseVelocity(body)
        if p.getDynamicsInfo(body, -1)[_BODY_TYPE] == _SOFT:
            yield f"nodes of body {body}", p.getMeshData(body, flags=p.MESH_DATA_SIMULATION_MESH)
        for joint in range(p.getNumJoints(body)):
            yield f"state of joint {joint} of body {body}", p.getJointStateMultiDof(body, joint)
            yield f"state of link {joint} of body {body}", p.getLinkState(body, joint, 1, 1)


def _answers() -> Iterator[tuple[str, Any]]:
    yield from _motion()
    for body in _bodies():
        for link in range(-1, p.getNumJoints(body)):
            yield f"dynamics of link {link} of body {body}", p.getDynamicsInfo(body, link)
            yield f"shapes of link {link} of body {body}", p.getCollisionShapeData(body, link)
            yield f"bounds of link {link} of body {body}", p.getAABB(body, link)
    yield "contacts", p.getContactPoints()
    for place in range(p.getNumConstraints()):
        constraint = p.getConstraintUniqueId(place)
        yield f"forces of constraint {constraint}", p.getConstraintState(constraint)
    yield "parameters", p.getPhysicsEngineParameters()


def _numbers(answer: Any) -> Iterator[float]:
    if isinstance(answer, float):
        yield answer
    elif isinstance(answer, dict):
        yield from _numbers(tuple(answer.values()))
    elif isinstance(answer, (list, tuple)):
        for item in answer:
            yield from _numbers(item)
