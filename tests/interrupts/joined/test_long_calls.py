"""A long call lets handlers of signals run before its end, without the lock, in a world of whole steps."""

from __future__ import annotations

import os
import signal
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from ctypes import c_int64
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import pybullet as p
import pybullet_data
from carom import World, Worlds
from carom.native.host import host
from pybullet._clients.clients import clients

pytestmark = pytest.mark.skipif(os.name != "posix", reason="needs signals of POSIX")
R2D2 = os.path.join(pybullet_data.getDataPath(), "r2d2.urdf")
PLANE = os.path.join(pybullet_data.getDataPath(), "plane.urdf")
CUBE = os.path.join(pybullet_data.getDataPath(), "cube_small.urdf")
# A thread that is told to stop, or a call that is to go on, takes so long at most [s].
PATIENCE = 60.0


@contextmanager
def handling(handler: Callable[[], object]) -> Iterator[None]:
    before = signal.signal(signal.SIGUSR1, lambda *_: handler())
    try:
        yield
    finally:
        signal.signal(signal.SIGUSR1, before)


def interrupting(ready: Callable[[], object], number: int = signal.SIGUSR1) -> threading.Thread:
    """A thread that sends the signal to this one as soon as it is time."""
    main = threading.get_ident()

    def send() -> None:
        until = time.monotonic() + PATIENCE
        while not ready() and time.monotonic() < until:
            time.sleep(0.001)
        signal.pthread_kill(main, number)

    thread = threading.Thread(target=send, daemon=True)
    thread.start()
    return thread


class Stepping:
    """A thread that takes steps until it is told to stop."""

    def __init__(self, step: Callable[[], object]) -> None:
        self.steps = 0
        self._stopped = threading.Event()
        self._step = step
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def _run(self) -> None:
        while not self._stopped.wait(0.002):
            self._step()
            self.steps += 1

    def stop(self) -> bool:
        """Whether it ends."""
        self._stopped.set()
        self._thread.join(PATIENCE)
        return not self._thread.is_alive()


# Many steps in one call


def made_worlds() -> Worlds:
    world = World()
    world.gravity = (0.0, 0.0, -9.8)
    world.load(PLANE)
    world.load(R2D2, (0.0, 0.0, 0.6))
    return Worlds(world, 8, threads=1)


def test_a_handler_that_joins_a_thread_runs_between_steps_of_worlds() -> None:
    worlds = made_worlds()
    worlds.step()
    count, seen, ends = 4000, [], []
    begin = worlds.time[0]
    thread = Stepping(worlds.step)

    def handle() -> None:
        ends.append(thread.stop())
        seen.append(worlds.time.copy())

    with handling(handle):
        sender = interrupting(lambda: worlds.time[0] > begin + 20 * worlds.time_step)
        worlds.step(count)
        sender.join()
    assert ends == [True]
    (times,) = seen
    assert len(set(times)) == 1
    assert times[0] < worlds.time[0] - 2 * worlds.time_step
    steps = (worlds.time - begin) / worlds.time_step
    np.testing.assert_allclose(steps, count + thread.steps, atol=1e-6)


def test_what_a_handler_raises_ends_a_call_of_many_steps_between_two() -> None:
    class Enough(Exception):
        pass

    def stop() -> None:
        raise Enough

    worlds, others = made_worlds(), made_worlds()
    with handling(stop):
        sender = interrupting(lambda: worlds.time[0] > 20 * worlds.time_step)
        with pytest.raises(Enough):
            worlds.step(4000)
        sender.join()
    assert len(set(worlds.time)) == 1
    steps = round(worlds.time[0] / worlds.time_step)
    assert 20 <= steps < 4000
    worlds.step(7)
    others.step(steps + 7)
    assert np.array_equal(state_of(worlds), state_of(others))


@pytest.mark.parametrize("at_once", [1, 9, 64])
def test_turns_leave_no_trace(at_once: int, monkeypatch: pytest.MonkeyPatch) -> None:
    worlds, others = made_worlds(), made_worlds()
    # Nothing is slow enough for shorter turns.
    monkeypatch.setattr("carom.worlds.stepping._PATIENCE", 1e3)
    monkeypatch.setattr(worlds, "_steps_at_once", at_once)
    worlds.step(150)
    for _ in range(150):
        others.step()
    assert np.array_equal(state_of(worlds), state_of(others))
    assert worlds.time.tolist() == others.time.tolist()
    assert worlds._engine.status.tolist() == others._engine.status.tolist()


def state_of(worlds: Worlds) -> Any:
    robot = worlds[1]
    return np.concatenate(
        [robot.joints.positions, robot.joints.velocities, robot.base_inertial_poses], axis=1
    )


def test_a_handler_that_joins_a_thread_runs_between_steps_of_a_world() -> None:
    world = World(gravity=(0.0, 0.0, -9.8))
    world.load(PLANE)
    world.load(R2D2, (0.0, 0.0, 0.6))
    count, seen, ends = 20_000, [], []
    thread = Stepping(world.step)

    def handle() -> None:
        ends.append(thread.stop())
        seen.append(world.time)

    with handling(handle):
        sender = interrupting(lambda: world.time > 20 * world.time_step)
        world.step(count)
        sender.join()
    assert ends == [True]
    assert seen[0] < world.time - 2 * world.time_step
    assert world.time / world.time_step == pytest.approx(count + thread.steps)


# One long step


@pytest.fixture
def impatient() -> Iterator[None]:
    """Every step counts as one that takes long."""
    assert host is not None
    patience = c_int64.in_dll(host.symbols, "carom_patience")
    before, patience.value = patience.value, 0
    yield
    patience.value = before


def pile(count: int) -> int:
    client = p.connect(p.DIRECT)
    p.setGravity(0, 0, -10)
    p.loadURDF(PLANE)
    for place in range(count):
        p.loadURDF(CUBE, [0.004 * (place % 3), 0, 0.03 + 0.06 * place])
    p.loadURDF(R2D2, [1, 0, 0.6])
    for _ in range(30):
        p.stepSimulation()
    return client


def poses() -> list[Any]:
    bodies = range(p.getNumBodies())
    return [(p.getBasePositionAndOrientation(body), p.getBaseVelocity(body)) for body in bodies]


def after(steps: int) -> list[Any]:
    for _ in range(steps):
        p.stepSimulation()
    return poses()


@pytest.fixture
def client() -> Iterator[int]:
    number = pile(20)
    yield number
    with suppress(p.error):
        p.disconnect(number)


def under_way(world: Any) -> Callable[[], bool]:
    """Whether the next step has begun. A time to wait may be over before it, on a busy machine."""
    before = bytes(world.position_memory)
    return lambda: bytes(world.position_memory) != before


def interrupted(step: Callable[[], object], handler: Callable[[], object], *, prepared: bool = True) -> None:
    """Take a long step in which a signal comes."""
    p.setPhysicsEngineParameter(numSubSteps=1500)
    p.setTimeStep(1.0)
    world = clients[0].world
    # Otherwise the step does it.
    if prepared:
        world.prepare()
    with handling(handler):
        sender = interrupting(under_way(world))
        try:
            step()
        finally:
            sender.join()
            p.setPhysicsEngineParameter(numSubSteps=0)
            p.setTimeStep(1 / 240)


@pytest.mark.usefixtures("impatient", "client")
@pytest.mark.parametrize("name", ["pybullet", "World"])
@pytest.mark.parametrize("prepared", [True, False])
def test_a_long_step_is_taken_after_the_handler(name: str, prepared: bool) -> None:
    world = clients[0].world
    step = p.stepSimulation if name == "pybullet" else world.step
    before, time_before, seen = poses(), world.time, []
    interrupted(step, lambda: seen.append((poses(), world.time)), prepared=prepared)
    assert seen == [(before, time_before)]
    assert world.time == time_before + 1.0
    reached = after(5)
    p.disconnect()
    pile(20)
    interrupted(p.stepSimulation, lambda: None)
    assert after(5) == reached


@pytest.mark.usefixtures("impatient", "client")
def test_the_lock_is_free_while_the_handler_of_a_long_step_runs() -> None:
    thread = Stepping(lambda: p.getBasePositionAndOrientation(1))
    ends: list[bool] = []
    interrupted(p.stepSimulation, lambda: ends.append(thread.stop()))
    assert ends == [True]


@pytest.mark.usefixtures("impatient", "client")
def test_what_a_handler_raises_is_raised_in_place_of_a_long_step() -> None:
    class Enough(Exception):
        pass

    def stop() -> None:
        raise Enough

    world, before = clients[0].world, poses()
    time_before = world.time
    for step in (p.stepSimulation, world.step):
        began = time.monotonic()
        with pytest.raises(Enough):
            interrupted(step, stop)
        assert (poses(), world.time) == (before, time_before)
        rest(began)


def rest(began: float) -> None:
    """Wait until steps are broken off again: ten times as long as the last one took that was."""
    time.sleep(10.0 * (time.monotonic() - began))


@pytest.fixture
def ctrl_c() -> Iterator[None]:
    """Ctrl-C raises `KeyboardInterrupt`, also where tests run in several processes, which ignore it."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.usefixtures("impatient", "client", "ctrl_c")
def test_ctrl_c_ends_a_long_step() -> None:
    world, before = clients[0].world, poses()
    time_before = world.time
    for step in (p.stepSimulation, world.step):
        p.setPhysicsEngineParameter(numSubSteps=3000)
        world.prepare()
        sender, began = interrupting(under_way(world), signal.SIGINT), time.monotonic()
        with pytest.raises(KeyboardInterrupt):
            step()
        sender.join()
        assert (poses(), world.time) == (before, time_before)
        rest(began)


@pytest.mark.usefixtures("impatient", "client")
@pytest.mark.parametrize("name", ["pybullet", "World"])
def test_a_handler_may_change_the_scene_of_a_long_step(name: str) -> None:
    world = clients[0].world
    step = p.stepSimulation if name == "pybullet" else world.step
    last, time_before = p.getNumBodies() - 1, world.time
    interrupted(step, lambda: p.removeBody(last))
    assert p.getNumBodies() == last
    assert world.time == time_before + 1.0


@pytest.mark.usefixtures("impatient", "client")
def test_a_handler_may_end_the_connection_of_a_long_step() -> None:
    refused = []

    def step() -> None:
        try:
            p.stepSimulation()
        except p.error as problem:
            refused.append(str(problem))

    with suppress(p.error):
        interrupted(step, p.disconnect)
    # The world is still there for a step that has made its arrays longer; others look for the connection.
    assert all("Not connected" in problem for problem in refused)
    assert not p.isConnected()


@pytest.mark.usefixtures("impatient", "client")
def test_a_step_within_a_call_is_not_broken_off() -> None:
    world, times = clients[0].world, []
    time_before = world.time

    def step() -> None:
        with world.call_lock:
            world.step()

    interrupted(step, lambda: times.append(world.time))
    assert times == [time_before + 1.0]


@contextmanager
def ringing(every: float) -> Iterator[list[int]]:
    """Signals come all the time."""
    rings = [0]

    def ring(*_: object) -> None:
        rings[0] += 1

    before = signal.signal(signal.SIGALRM, ring)
    signal.setitimer(signal.ITIMER_REAL, every, every)
    try:
        yield rings
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0.0)
        signal.signal(signal.SIGALRM, before)


def stack(contact: str = "bullet", substeps: int = 1) -> World:
    world = World(gravity=(0.0, 0.0, -9.8), contact=contact)
    world.parameters.substeps = substeps
    world.load(PLANE)
    for place in range(100):
        world.load(CUBE, (0.3 * (place % 12), 0.0, 0.03 + 0.06 * (place // 12)))
    world.load(R2D2, (0.0, 1.0, 0.6))
    return world


def soft() -> World:
    world = World(gravity=(0.0, 0.0, -9.8))
    world.load(PLANE)
    world.load_soft_solid(position=(0.0, 0.0, 0.2))
    world.load(CUBE, (0.0, 0.0, 0.4))
    return world


SCENES: dict[str, Callable[[], World]] = {
    "bullet": stack,
    "substeps": lambda: stack(substeps=3),
    "rigid": lambda: stack("rigid"),
    "compliant": lambda: stack("compliant"),
    "soft": soft,
}


def count_broken_off(world: World) -> list[int]:
    """How many steps are broken off from now on."""
    take, count, quick = world.quick.take_step, [0], world.quick

    def taken() -> bool:
        well = take()
        count[0] += quick.was_broken_off
        return well

    quick.take_step = taken
    return count


@pytest.mark.usefixtures("impatient")
@pytest.mark.parametrize("name", SCENES)
def test_steps_that_were_broken_off_leave_no_trace(name: str, tmp_path: Path) -> None:
    expected, world = SCENES[name](), SCENES[name]()
    count = count_broken_off(world)
    with ringing(3e-4):
        world.step(60)
    assert count[0]
    expected.step(60)
    files = []
    for number, it in enumerate((world, expected)):
        it.save(tmp_path / f"{number}.world")
        files.append((tmp_path / f"{number}.world").read_bytes())
    assert files[0] == files[1]
