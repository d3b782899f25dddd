"""Changes within changes: what interrupts a call may make any other, before it or after it, never within."""

from __future__ import annotations

import gc
import re
import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from types import FrameType
from typing import Any

import pytest
from tests.interrupts.faults import enters_or_leaves_a_section
from tests.interrupts.test_prepared_changes import made, summary
from tests.rings import few

import carom
import pybullet as p
from carom import World
from carom.errors import StateError
from carom.layouts.codes import UserConstraintKind
from carom.native import uninterrupted

_OURS = tuple(str(Path(package.__path__[0])) for package in (carom, p))
# Of the lines of a call, about so many are interrupted.
_TRIED = 3


# Changes of the world of `made`, which has a snapshot.
MODERN: dict[str, Callable[[World, Any], Any]] = {
    "load": lambda world, _: world.load_urdf("rrbot.urdf", (0.0, 2.0, 0.0), as_pybullet=True),
    "load a cloth": lambda world, _: world.load_cloth(size=(0.1, 0.1), cells=(1, 1), position=(0, 5, 1)),
    "remove": lambda world, _: world.remove(1),
    "restore": lambda world, state: world.restore(state, update_poses=True),
    "reset": lambda world, _: world.clear(),
    "constrain": lambda world, _: world.constrain_links(
        UserConstraintKind.FIXED, world.bodies[3], -1, None, -1
    ),
    "set gravity": lambda world, _: setattr(world, "gravity", (0.0, 0.0, -1.0)),
    "change dynamics": lambda world, _: world.bodies[3].change_dynamics(0, mass=2.0, lateral_friction=0.3),
    "step": lambda world, _: world.step(),
    "place a base": lambda world, _: world.bodies[3].set_inertial_pose((0.0, 0.0, 1.0), (0.0, 0.6, 0.0, 0.8)),
    "push a base": lambda world, _: world.bodies[3].set_base_velocity((0.0, 0.0, 1.0), (0.0, 0.6, 0.0)),
    "turn a joint": lambda world, _: world.bodies[3].joints.movable[0].reset(0.3, 0.4),
    "turn joints": lambda world, _: world.bodies[3].joints.reset([0.3, 0.4], 0.5),
    "aim a motor": lambda world, _: world.bodies[3].joints.movable[0].set_position_target(0.3, max_force=3.0),
    "apply a torque": lambda world, _: world.bodies[3].joints.movable[0].set_torque(0.3),
    "apply a force": lambda world, _: world.bodies[3].links[0].apply_force((1.0, 2.0, 3.0)),
}


def _modern(name: str, world: World, state: Any) -> bool:
    """Make a change; false if it is refused, as when its bodies have been removed."""
    try:
        MODERN[name](world, state)
    except (KeyError, ValueError, StateError) as problem:
        assert re.search("no longer|no body|saved|removed", str(problem)), problem
        return False
    return True


def _start() -> tuple[World, Any]:
    world = made()
    state = world.snapshot()
    world.step(2)
    return world, state


def _whole(world: World) -> tuple[Any, ...]:
    """All there is, once a step has shown that it fits together."""
    world.copy().step(2)
    world.step()
    return summary(world)


@cache
def _in_turn(*names: str) -> tuple[Any, ...]:
    world, state = _start()
    outcomes = {name: _modern(name, world, state) for name in names}
    return (*(outcomes[name] for name in sorted(names)), _whole(world))


@contextmanager
def _at_line(number: int, do: Callable[[], Any]) -> Iterator[list[int]]:
    """Do something at a line of a call of ours, be it in a section or not; the number of lines so far."""
    state, count = uninterrupted._State, [0]

    def trace(frame: FrameType, event: str, _: Any) -> Any:
        file = frame.f_code.co_filename
        if not file.startswith(_OURS) or file == uninterrupted.__file__:
            return None
        if event == "line" and not enters_or_leaves_a_section(file, frame.f_lineno):
            count[0] += 1
            if count[0] == number:
                # What is done now is not traced.
                sys.settrace(None)
                do()
        return trace

    before, state.keeps_tracing = sys.gettrace(), True
    sys.settrace(trace)
    try:
        yield count
    finally:
        sys.settrace(before)
        state.keeps_tracing = False


@contextmanager
def _by_signal(number: int, do: Callable[[], Any]) -> Iterator[None]:
    before = signal.signal(signal.SIGINT, lambda *_: do())
    try:
        with _at_line(number, lambda: signal.raise_signal(signal.SIGINT)):
            yield
    finally:
        signal.signal(signal.SIGINT, before)


class _Last:
    def __init__(self, do: Callable[[], Any]) -> None:
        self._do, self._itself = do, self

    def __del__(self) -> None:
        self._do()


@contextmanager
def _by_finalizer(number: int, do: Callable[[], Any]) -> Iterator[None]:
    def lose() -> None:
        _Last(do)
        # The next object that is made starts garbage collection, if that is enabled.
        gc.set_threshold(1)

    threshold = gc.get_threshold()
    gc.collect()
    try:
        with _at_line(number, lose):
            yield
        gc.set_threshold(*threshold)
        gc.collect()
    finally:
        gc.set_threshold(*threshold)


@contextmanager
def _by_tracer(number: int, do: Callable[[], Any]) -> Iterator[None]:
    """As a debugger, whose trace function is put aside in sections."""
    with _at_line(number, do):
        uninterrupted._State.keeps_tracing = False
        yield


WAYS = {"signal": _by_signal, "finalizer": _by_finalizer, "tracer": _by_tracer}


def _lines(call: Callable[[], Any], *, in_sections: bool = True) -> range:
    """Some lines of a call."""
    with _at_line(0, lambda: None) as count:
        uninterrupted._State.keeps_tracing = in_sections
        call()
    return range(1, count[0] + 1, max(1, count[0] // _TRIED))


# Those that can be in the way of all others, in the order of the calls.
_INNER = ("load", "remove", "restore", "reset", "constrain")


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("outer", few(MODERN, 1))
def test_a_change_within_a_change_comes_before_or_after_it(outer: str, way: str) -> None:
    for inner in _INNER:
        if inner != outer:
            _check(outer, inner, way)


def _check(outer: str, inner: str, way: str) -> None:
    allowed = [_in_turn(inner, outer), _in_turn(outer, inner)]
    world, state = _start()
    for line in _lines(lambda: _modern(outer, world, state), in_sections=way != "tracer"):
        _check_line(outer, inner, way, line, allowed)


def _check_line(outer: str, inner: str, way: str, line: int, allowed: list[tuple[Any, ...]]) -> None:
    world, state = _start()
    outcomes: dict[str, bool] = {}
    with WAYS[way](line, lambda: outcomes.setdefault(inner, _modern(inner, world, state))):
        outcomes[outer] = _modern(outer, world, state)
    if inner in outcomes:
        found = (*(outcomes[name] for name in sorted((inner, outer))), _whole(world))
        assert found in allowed, f"{inner} within {outer} at line {line}"
