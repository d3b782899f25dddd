"""Calls of the drop-in within calls that change something: done at once, after these, or refused as alone."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import suppress
from copy import deepcopy
from pathlib import Path
from typing import Any

import pytest
from tests.interrupts.scenes import CALLS, Scene, build, differences, follow, look
from tests.interrupts.test_nested_changes import WAYS, _at_line
from tests.rings import few

import pybullet as p
import pybullet_data
from carom.native import uninterrupted
from pybullet._clients.clients import clients

OUTER = {
    name: CALLS[name]
    for name in (
        *("loadURDF of an arm", "createMultiBody", "removeBody", "restoreState", "loadBullet"),
        *("createConstraint", "changeDynamics", "resetBasePositionAndOrientation", "setGravity"),
    )
} | {
    "resetSimulation": lambda _: p.resetSimulation(),
    "saveState": lambda _: p.saveState(),
    "saveWorld": lambda scene: p.saveWorld(f"{scene.world_file}.py"),
    "stepSimulation": lambda _: p.stepSimulation(),
}

# What a handler may do. Of them, some may be refused, as they are alone after what they come after.
INNER: dict[str, Callable[[Scene], Any]] = {
    "loadURDF": lambda _: p.loadURDF("sphere_small.urdf", [0, 3, 1]),
    "removeBody": lambda scene: p.removeBody(scene.cube),
    "stepSimulation": lambda _: p.stepSimulation(),
    "resetSimulation": lambda _: p.resetSimulation(),
    "saveState": lambda _: p.saveState(),
    "restoreState": lambda scene: p.restoreState(scene.state),
}
_LINES = 3


@pytest.fixture
def folder(tmp_path: Path) -> Iterator[Path]:
    p.connect(p.DIRECT)
    yield tmp_path
    for number in list(clients):
        p.disconnect(number)


def _done(call: Callable[[Scene], Any], scene: Scene) -> bool:
    """Make a call; false if it is refused by an error that says why."""
    try:
        call(scene)
    except p.error as problem:
        assert len(str(problem)) > 15, problem
        return False
    return True


def _lines(call: Callable[[Scene], Any], scene: Scene, way: str) -> range:
    with _at_line(0, lambda: None) as count:
        uninterrupted._State.keeps_tracing = way != "tracer"
        call(scene)
    return range(1, count[0] + 1, max(1, count[0] // _LINES))


def _in_turn(folder: Path, *calls: Callable[[Scene], Any]) -> tuple[list[bool], dict[str, Any], str]:
    scene = build(folder)
    outcomes = [_done(call, scene) for call in calls]
    return outcomes, deepcopy(look()), _goes_on()


def _goes_on() -> str:
    if not p.getNumBodies():
        p.setAdditionalSearchPath(pybullet_data.getDataPath())
        p.loadURDF("plane.urdf")
    # Not a number is not the same as itself.
    return repr(follow())


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("outer", few(OUTER, 1))
def test_a_call_within_a_call_comes_before_or_after_it(outer: str, way: str, folder: Path) -> None:
    call = OUTER[outer]
    build(folder)
    call(build(folder))
    lines = _lines(call, build(folder), way)
    for name, inner in INNER.items():
        orders = []
        outcomes, seen, comes = _in_turn(folder, inner, call)
        orders.append((outcomes[::-1], seen, comes))
        orders.append(_in_turn(folder, call, inner))
        for line in lines:
            scene = build(folder)
            done: list[bool] = []

            def interrupt(scene: Scene = scene, done: list[bool] = done, inner: Any = inner) -> None:
                done.append(_done(inner, scene))

            with WAYS[way](line, interrupt):
                outer_done = _done(call, scene)
            if not done:
                continue
            now = deepcopy(look())
            found = [outer_done, *done], now
            fitting = [it for it in orders if it[0] == found[0] and not differences(it[1], now)]
            assert fitting, (name, line, found[0], [(it[0], differences(it[1], now)) for it in orders])
            assert _goes_on() in [it[2] for it in fitting], (name, line)


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("outer", few(OUTER, 1))
def test_connections_come_and_go_within_a_call(outer: str, way: str, folder: Path) -> None:
    call = OUTER[outer]
    call(build(folder))
    lines = _lines(call, build(folder), way)
    other = p.connect(p.DIRECT)
    p.loadURDF(pybullet_data.getDataPath() + "/plane.urdf", physicsClientId=other)

    def change_others() -> None:
        with suppress(p.error):
            p.disconnect(other)
        number = p.connect(p.DIRECT)
        assert number == other
        p.loadURDF(pybullet_data.getDataPath() + "/r2d2.urdf", physicsClientId=number)
        p.stepSimulation(number)
        called.append(number)

    def end() -> None:
        p.disconnect()
        called.append(0)

    for line in lines:
        for interrupt in (change_others, end):
            called: list[int] = []
            scene = build(folder)
            with WAYS[way](line, interrupt):
                outer_done = _done(call, scene)
            if interrupt is end and called:
                assert p.isConnected() == 0
                assert p.connect(p.DIRECT) == 0
                assert p.getNumBodies() == 0
            else:
                assert outer_done
            assert p.getNumBodies(physicsClientId=other) == 1
            p.setAdditionalSearchPath(pybullet_data.getDataPath())
            assert follow() is not None
