"""Simulation by the wall clock."""

import logging
from collections.abc import Callable
from threading import Event, Thread
from time import sleep
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.patience import PATIENCE

import pybullet as p
from pybullet._clients.clients import clients
from pybullet._clients.real_time import Pace


@given(st.lists(st.floats(0.0, 0.05), max_size=200), st.floats(0.001, 0.05))
def test_nothing_drifts_while_the_world_keeps_up(pauses: list[float], time_step: float) -> None:
    now, steps = 0.0, 0
    pace = Pace(now)
    for pause in pauses:
        now += pause
        steps += pace.steps_due(now, time_step)
        assert -1e-9 <= now - steps * time_step < time_step + 1e-9


def test_a_long_sleep_is_not_caught_up_with() -> None:
    pace = Pace(0.0)
    assert pace.steps_due(1000.0, 0.01) <= 10
    assert pace.steps_due(1000.0, 0.01) == 0
    assert pace.steps_due(1000.02, 0.01) in (1, 2)


def test_steps_longer_than_the_lag_still_come() -> None:
    pace = Pace(0.0)
    assert [pace.steps_due(now, 1.0) for now in (0.5, 1.25, 2.5)] == [0, 1, 1]


def test_the_world_moves_by_itself_and_stops(monkeypatch: pytest.MonkeyPatch) -> None:
    p.connect(p.GUI)
    stepped = _step_event(monkeypatch)
    p.setRealTimeSimulation(1)
    p.setRealTimeSimulation(1)
    assert p.getPhysicsEngineParameters()["useRealTimeSimulation"] == 1
    assert stepped.wait(PATIENCE)
    p.setRealTimeSimulation(0)
    stepped.clear()
    assert clients[0].clock is None
    assert p.getPhysicsEngineParameters()["useRealTimeSimulation"] == 0
    assert not stepped.wait(0.05)


def test_scripts_may_go_on_calling(monkeypatch: pytest.MonkeyPatch, arm_path: str) -> None:
    p.connect(p.GUI)
    stepped = _step_event(monkeypatch)
    p.setRealTimeSimulation(1)
    for _ in range(20):
        body = p.loadURDF(arm_path, useFixedBase=1)
        p.setJointMotorControl2(body, 0, p.POSITION_CONTROL, 0.3)
        p.getJointStates(body, [0, 1])
        p.stepSimulation()
        p.removeBody(body)
    assert stepped.wait(PATIENCE)
    p.resetSimulation()


@pytest.mark.parametrize(
    "call",
    [
        lambda cube, tie: p.rayTest([0, 0, 2], [0, 0, -2]),
        lambda cube, tie: p.rayTestBatch([[0, 0, 2]], [[0, 0, -2]]),
        lambda cube, tie: p.getClosestPoints(cube, cube + 1, 5.0),
        lambda cube, tie: p.getOverlappingObjects([-1, -1, -1], [1, 1, 1]),
        lambda cube, tie: p.getContactPoints(),
        lambda cube, tie: p.setCollisionFilterGroupMask(cube, -1, 1, 1),
        lambda cube, tie: p.setCollisionFilterPair(cube, cube + 1, -1, -1, 0),
        lambda cube, tie: p.changeConstraint(tie, maxForce=5),
        lambda cube, tie: p.performCollisionDetection(),
        lambda cube, tie: p.removeConstraint(tie),
    ],
    ids=[
        "ray",
        "rays",
        "closest",
        "overlapping",
        "contacts",
        "mask",
        "pair",
        "constraint",
        "detection",
        "removal",
    ],
)
def test_calls_that_need_the_arrays_wait_for_the_end_of_a_step(call: Callable[[int, int], object]) -> None:
    p.connect(p.DIRECT)
    shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1, 0.1, 0.1])
    cube, other = p.createMultiBody(1, shape), p.createMultiBody(1, shape, basePosition=[0, 0, 0.5])
    tie = p.createConstraint(cube, -1, other, -1, p.JOINT_POINT2POINT, [0, 0, 1], [0, 0, 0.25], [0, 0, -0.25])
    done = Event()

    def run() -> None:
        call(cube, tie)
        done.set()

    with clients[0].lock:
        thread = Thread(target=run)
        thread.start()
        assert not done.wait(0.05)
    assert done.wait(PATIENCE)
    thread.join()
    p.disconnect()


def test_disconnecting_stops_the_clock(monkeypatch: pytest.MonkeyPatch) -> None:
    p.connect(p.GUI)
    stepped = _step_event(monkeypatch)
    p.setRealTimeSimulation(1)
    assert stepped.wait(PATIENCE)
    p.disconnect()
    stepped.clear()
    assert not stepped.wait(0.05)


def test_the_clock_stops_while_it_waits_for_its_turn(monkeypatch: pytest.MonkeyPatch) -> None:
    """As in a server, which holds the lock during every call."""
    p.connect(p.GUI)
    client = clients[0]
    p.setRealTimeSimulation(1)
    stepped = _step_event(monkeypatch)

    def stop() -> None:
        with client.lock:
            stepped.clear()
            # Many steps of the clock.
            sleep(0.1)
            p.setRealTimeSimulation(0)

    stopping = Thread(target=stop, daemon=True)
    stopping.start()
    stopping.join(PATIENCE)
    assert not stopping.is_alive()
    assert not stepped.wait(0.05)


def test_a_world_that_breaks_stops_with_a_message(
    monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    p.connect(p.GUI)
    failed = Event()

    def fail() -> None:
        failed.set()
        raise RuntimeError("broken")

    monkeypatch.setattr(clients[0].world, "step", fail)
    with caplog.at_level(logging.ERROR, logger="pybullet"):
        p.setRealTimeSimulation(1)
        assert failed.wait(PATIENCE)
        p.setRealTimeSimulation(0)
    assert "Real-time simulation has stopped." in caplog.text


def test_without_a_window_nothing_moves_by_itself(client: int) -> None:
    p.setRealTimeSimulation(1)
    assert p.getPhysicsEngineParameters()["useRealTimeSimulation"] == 1
    assert clients[client].clock is None


def _step_event(monkeypatch: pytest.MonkeyPatch) -> Event:
    """Tells when the world of client 0 has made a step in the background."""
    stepped, step = Event(), clients[0].world.step

    def noted_step(*arguments: Any) -> None:
        step(*arguments)
        stepped.set()

    monkeypatch.setattr(clients[0].world, "step", noted_step)
    return stepped
