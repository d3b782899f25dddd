"""Endless and very long arguments: nothing is read of them before their length is known to be right."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from itertools import repeat
from pathlib import Path
from typing import Any

import pytest
from tests.surface.calls import CALLS
from tests.surface.perform import Places
from tests.surface.scene import ARM, CRATE, build

import pybullet as p

_MAX_READ = 1000
_VAST = 10**12
# They end the scene, wait for somebody, or ask for libraries.
_LEFT_OUT = {"connect", "disconnect", "vhacd", "setTimeOut", "renderImage"}


class ReadTooMuch(BaseException):
    """An argument was read on and on."""


class Endless:
    """An iterator without end."""

    def __init__(self, item: Any = 0.0) -> None:
        self._item = item
        self._read = 0

    def __iter__(self) -> Endless:
        return self

    def __next__(self) -> Any:
        self._read += 1
        if self._read > _MAX_READ:
            raise ReadTooMuch
        return self._item


class Vast:
    """A sequence of a trillion items."""

    def __init__(self, length: int = _VAST) -> None:
        self._length = length

    def __len__(self) -> int:
        return self._length

    def __getitem__(self, place: int) -> float:
        if place > _MAX_READ:
            raise ReadTooMuch
        return 0.0


class Liar(Endless):
    """An iterable without end that says it has three items."""

    def __len__(self) -> int:
        return 3


_HOSTILE: dict[str, Callable[[], Any]] = {"endless": Endless, "vast": Vast, "huge": lambda: Vast(2**62)}


@pytest.fixture(autouse=True)
def _scene() -> Iterator[None]:
    p.connect(p.DIRECT)
    build(p)
    yield
    p.disconnect()


def _calls() -> Iterator[tuple[str, Mapping[str, Any], str]]:
    """Functions with their arguments, one of which can be a sequence."""
    for function, calls in CALLS.items():
        if function not in _LEFT_OUT:
            given = dict(calls.needed)
            for name in [*given, *calls.other]:
                arguments = {**given, **calls.along.get(name, {})}
                value = given.get(name, calls.other.get(name))
                if isinstance(value, (list, tuple, range)):
                    yield function, {**arguments, name: value}, name


@pytest.mark.parametrize("kind", _HOSTILE)
def test_nothing_is_read_without_end(kind: str, tmp_path: Path) -> None:
    places = Places(str(tmp_path))
    tried, broken = 0, []
    for function, arguments, name in _calls():
        real = {key: places.real(value) for key, value in arguments.items()}
        spoiled = [_HOSTILE[kind]()]
        if isinstance(real[name][0], (list, tuple)):
            spoiled.append([_HOSTILE[kind](), *list(real[name])[1:]])
        for value in spoiled:
            tried += 1
            try:
                getattr(p, function)(**{**real, name: value})
            except (p.error, TypeError):
                pass
            except BaseException as problem:
                broken.append(f"{function}({name}={value}): {problem!r}")
    assert tried > 100
    assert not broken


@pytest.mark.parametrize("values", [range(_VAST), range(10**30), repeat(0.0), iter([0.0, 0.0, 1.0])])
def test_vectors_have_three_numbers(values: Any) -> None:
    with pytest.raises(p.error, match=r"force needs a 3 coordinates \[x,y,z\]"):
        p.applyExternalForce(CRATE, -1, values, [0, 0, 0], p.LINK_FRAME)


def test_no_more_is_read_than_the_length_says() -> None:
    with pytest.raises(p.error, match="force needs a 3 coordinates"):
        p.applyExternalForce(CRATE, -1, Liar("no number"), [0, 0, 0], p.LINK_FRAME)  # type: ignore[arg-type]
    p.getJointStates(ARM, Liar(0))  # type: ignore[arg-type]
    p.getLinkStates(ARM, Liar(0))  # type: ignore[arg-type]


@pytest.mark.parametrize("joints", [range(_VAST), range(10**30), repeat(0)])
def test_lists_of_joints_may_be_too_long_after_a_usual_call(joints: Any) -> None:
    for _ in range(2):
        p.setJointMotorControlArray(ARM, [0, 1], p.VELOCITY_CONTROL)
    with pytest.raises(p.error, match="expected a sequence of joint indices"):
        p.setJointMotorControlArray(ARM, joints, p.VELOCITY_CONTROL)
    with pytest.raises(p.error, match=r"expected a sequence of joint indices"):
        p.getJointStates(ARM, joints)
    with pytest.raises(p.error, match=r"expected a sequence of joint indices"):
        p.getLinkStates(ARM, joints)


@pytest.mark.parametrize("targets", [range(_VAST), range(10**30), repeat(0.0)])
def test_lists_of_targets_may_be_too_long_after_a_usual_call(targets: Any) -> None:
    for _ in range(2):
        p.setJointMotorControlArray(ARM, [0, 1], p.POSITION_CONTROL, targetPositions=[0, 0])
    with pytest.raises(p.error, match="number of target positions should match"):
        p.setJointMotorControlArray(ARM, [0, 1], p.POSITION_CONTROL, targetPositions=targets)


def test_generators_are_refused_as_in_pybullet() -> None:
    with pytest.raises(p.error, match="pass a list"):
        p.resetBasePositionAndOrientation(CRATE, (x for x in (0, 0, 1)), [0, 0, 0, 1])  # type: ignore[arg-type]
    with pytest.raises(p.error, match="pass a list"):
        p.getJointStates(ARM, (joint for joint in (0, 1)))
