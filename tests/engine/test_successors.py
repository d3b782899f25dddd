"""A constraint that is made after the same links were untied takes the rows of the one that was removed."""

from __future__ import annotations

from collections.abc import Iterator
from random import Random
from typing import Any

import numpy as np
import pytest
from tests.thorough.profiles import cases

import pybullet as p
from carom.world.world import World
from pybullet._clients.clients import client_of

_CUBES = 3
# In the first steps arrays become longer, after which the next step is prepared anew.
_GROWING = 4
_PIVOTS = [0.0, 0.0, 0.0], [0.1, -0.05, 0.2], [0.3, 0.0, 0.1]
_TURNS = None, [0.0, 0.0, 0.6, 0.8]
_AXES = [1.0, 0.0, 0.0], [0.0, 0.6, 0.8]
_Tie = tuple[Any, ...]
_FIXED: _Tie = (p.JOINT_FIXED, _PIVOTS[1], None, _AXES[0])

_ENDS = (0, -1), (0, 1), (1, 0), (2, -1)
_BETWEEN = ("tie", "tie", "untie", "untie", "pull", "detect", "iterations", "lift", "save", "restore", "step")


def _form(random: Random) -> _Tie:
    choices = (p.JOINT_FIXED, p.JOINT_FIXED, p.JOINT_PRISMATIC), _PIVOTS, _TURNS, _AXES
    return tuple(map(random.choice, choices))


def _story(random: Random) -> Iterator[tuple[Any, ...]]:
    """Steps, most of them after a constraint has been made again; often something else comes in between."""
    for _ in range(40):
        yield from [("step",)] * random.randint(0, 2)
        chance = random.random()
        if chance < 0.2:
            yield _other(random)
        between = _other(random) if chance > 0.7 else None
        bodies = random.choice([*[None] * 12, *_ENDS])
        yield "again", random.choice([1, 1, 1, 2, 3]), _form(random), between, bodies
        if chance > 0.9:
            yield _other(random)
    yield from [("step",)] * 2


def _other(random: Random) -> tuple[Any, ...]:
    what = random.choice(_BETWEEN)
    if what == "tie":
        return what, random.choice(_ENDS), _form(random)
    if what == "pull":
        return what, random.randrange(6), random.uniform(1.0, 50.0)
    return (what, random.randrange(6)) if what == "untie" else (what,)


@pytest.fixture(scope="module", autouse=True)
def clients() -> Iterator[None]:
    """Client 0 keeps what it can; client 1 makes everything anew."""
    assert [p.connect(p.DIRECT), p.connect(p.DIRECT)] == [0, 1]
    yield
    p.disconnect(1)
    p.disconnect(0)


class _Script:
    """What a script does in one of two worlds, and what it sees."""

    def __init__(self, client: int) -> None:
        self.client: dict[str, Any] = {"physicsClientId": client}
        self.makes_anew = client == 1
        self.ties: list[tuple[int, tuple[int, int]]] = []
        self.seen: list[Any] = []
        self.state: int | None = None
        p.resetSimulation(**self.client)
        p.setGravity(0, 0, -10, **self.client)
        plane = p.createCollisionShape(p.GEOM_PLANE, **self.client)
        box = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1] * 3, **self.client)
        for place in range(_CUBES):
            p.createMultiBody(1, box, basePosition=[0.3 * place, 0, 0.11], **self.client)
        p.createMultiBody(0, plane, **self.client)

    @property
    def world(self) -> World:
        return client_of(self.client["physicsClientId"]).world

    def tie(self, bodies: tuple[int, int], form: _Tie) -> None:
        kind, pivot, turn, axis = form
        parent, child = bodies
        number = p.createConstraint(
            parent, -1, child, -1, kind, axis, [0, 0, 0.1], pivot, childFrameOrientation=turn, **self.client
        )
        self.ties.append((number, bodies))

    def untie(self, place: int) -> tuple[int, int]:
        number, bodies = self.ties.pop(place % len(self.ties))
        p.removeConstraint(number, **self.client)
        return bodies

    def do(self, what: str, *arguments: Any) -> None:
        if what == "tie":
            self.tie(*arguments)
        elif what == "again" and self.ties:
            place, form, between, other_bodies = arguments
            bodies = self.untie(-place)
            if between is not None:
                self.do(*between)
            if self.makes_anew:
                self.world.scene_changed()
            self.tie(other_bodies or bodies, form)
        elif what == "untie" and self.ties:
            self.untie(arguments[0])
        elif what == "pull" and self.ties:
            number, _ = self.ties[arguments[0] % len(self.ties)]
            p.changeConstraint(number, maxForce=arguments[1], **self.client)
        elif what == "detect":
            p.performCollisionDetection(**self.client)
        elif what == "iterations":
            p.setPhysicsEngineParameter(numSolverIterations=7, **self.client)
        elif what == "lift":
            p.resetBasePositionAndOrientation(1, [0.3, 0, 0.2], [0, 0, 0, 1], **self.client)
        elif what == "save":
            self.state = p.saveState(**self.client)
        elif what == "restore" and self.state is not None:
            try:
                p.restoreState(self.state, **self.client)
            except p.error as problem:
                self.seen.append(str(problem))
        elif what == "step":
            self.step()

    def step(self) -> None:
        if self.makes_anew:
            self.world.scene_changed()
        p.stepSimulation(**self.client)
        for number, _ in self.ties:
            self.look(number)
        self.seen += [p.getBasePositionAndOrientation(body, **self.client) for body in range(_CUBES)]
        self.seen += [p.getBaseVelocity(body, **self.client) for body in range(_CUBES)]

    def let_arrays_grow(self) -> None:
        for _ in range(_GROWING):
            self.step()

    def look(self, number: int) -> None:
        self.seen.append(p.getConstraintInfo(number, **self.client))
        self.seen.append(p.getConstraintState(number, **self.client))


@pytest.mark.parametrize("seed", range(cases(24)))
def test_steps_are_those_that_are_prepared_anew(seed: int) -> None:
    random = Random(seed)
    scripts = [_Script(client) for client in (0, 1)]
    for script in scripts:
        for bodies in _ENDS:
            script.tie(bodies, _FIXED)
        script.let_arrays_grow()
    for what in _story(random):
        for script in scripts:
            script.do(*what)
            for number, _ in script.ties:
                script.look(number)
    assert scripts[0].seen == scripts[1].seen


@pytest.mark.parametrize("form", [_FIXED, (p.JOINT_FIXED, _PIVOTS[2], _TURNS[1], _AXES[1])])
def test_nothing_is_prepared_for_a_successor(form: _Tie, monkeypatch: pytest.MonkeyPatch) -> None:
    script = _Script(0)
    for bodies in ((2, -1), (0, 1)):
        script.tie(bodies, _FIXED)
    script.let_arrays_grow()
    number = script.ties[-1][0]
    monkeypatch.setattr(script.world, "_step_in_section", _refuse)
    for count in range(1, 4):
        script.do("again", 1, form, None, None)
        # Numbers count on, and forces are those of its own steps.
        assert script.ties[-1][0] == number + count
        assert not any(p.getConstraintState(script.ties[-1][0]))
        script.step()
        assert np.any(p.getConstraintState(script.ties[-1][0]))


def _refuse() -> None:
    raise AssertionError("Python has prepared or performed a step")


def test_what_else_has_changed_is_written() -> None:
    """The force of another constraint, changed meanwhile, is not forgotten."""
    script = _Script(0)
    script.tie((2, -1), (p.JOINT_POINT2POINT, [0.6, 0, 3.0], None, _AXES[0]))
    script.tie((0, -1), _FIXED)
    script.let_arrays_grow()
    bodies = script.untie(1)
    p.changeConstraint(script.ties[0][0], maxForce=0.5)
    script.tie(bodies, _FIXED)
    script.step()
    assert max(map(abs, p.getConstraintState(script.ties[0][0]))) <= 0.5 + 1e-9


def test_no_successor_takes_the_row_of_another() -> None:
    """A constraint that is last in the order of creation need not be the last of the rows."""
    script = _Script(0)
    for place in range(4):
        script.tie((place % _CUBES, -1), _FIXED)
    script.let_arrays_grow()
    # The last row moves up.
    script.untie(0)
    script.step()
    script.do("again", 1, _FIXED, None, None)
    script.step()
    while script.ties:
        script.untie(0)
        script.step()
