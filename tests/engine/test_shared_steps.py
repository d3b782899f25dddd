"""A lone world whose islands several threads solve: the bits are those of one thread, whatever happens."""

from __future__ import annotations

import gc
import math
import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from ctypes import c_int64
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.patience import PATIENCE

from carom import World
from carom.engine import shared_steps
from carom.errors import SimulationError
from carom.layouts.contacts import THERE
from carom.native.host import host
from carom.profiling import profile

LAWS = ("compliant", "rigid", "bullet")
ROBOT = """
<mujoco><worldbody><body><freejoint/><geom type="sphere" size=".12" mass="3"/>
  <body pos=".12 0 0"><joint name="hip" axis="0 1 0" range="-60 60" damping=".2"/>
    <geom type="capsule" fromto="0 0 0 .2 0 -.1" size=".03" mass=".4"/>
    <body pos=".2 0 -.1"><joint name="knee" axis="0 1 0" range="-40 40" damping=".1"/>
      <geom type="capsule" fromto="0 0 0 .1 0 -.3" size=".03" mass=".2"/></body></body></body></worldbody>
  <actuator><position joint="hip" kp="20"/><position joint="knee" kp="10"/></actuator></mujoco>
"""


@pytest.fixture(autouse=True)
def everything_shared(monkeypatch: pytest.MonkeyPatch) -> None:
    """Everything is shared in small worlds, too."""
    monkeypatch.setattr(shared_steps, "_FEWEST_ROWS", 0)
    monkeypatch.setattr(shared_steps, "_FEWEST_MOVING", shared_steps.FEWEST_LINKS)


def piles(threads: int, law: str = "compliant") -> World:
    """Piles of balls, boxes and capsules."""
    world = World(gravity=(0.0, 0.0, -9.81), contact=law, threads=threads)
    world.add_plane()
    for place in range(72):
        across, along, height = place % 4, place // 4 % 6, place // 24
        at = (3.0 * across + 0.03 * height, 3.0 * along, 0.12 + 0.23 * height)
        if height == 0:
            world.add_box((0.1, 0.12, 0.09), position=at)
        elif height == 1:
            world.add_sphere(0.1, position=at)
        else:
            world.add_capsule(0.08, 0.2, position=at)
    return world


def robots(threads: int, law: str = "compliant") -> World:
    """Robots of a file of MuJoCo's that fall on a floor, some of them on each other."""
    world = World(gravity=(0.0, 0.0, -9.81), contact=law, threads=threads)
    world.add_plane()
    for place in range(24):
        world.load(ROBOT, (0.7 * (place % 6), 1.5 * (place // 6), 0.5 + 0.02 * place))
    return world


def euler(threads: int, law: str = "compliant") -> World:
    """The same with MuJoCo's usual integrator."""
    world = robots(threads, "bullet" if law == "bullet" else "compliant")
    world.integrator = "euler"
    return world


def tied(threads: int, law: str = "compliant") -> World:
    """Pairs of boxes that hang together, above a floor."""
    world = World(gravity=(0.0, 0.0, -9.81), contact=law, threads=threads)
    world.add_plane()
    for place in range(36):
        at = (2.0 * (place % 6), 2.0 * (place // 6), 0.3)
        one = world.add_box((0.1, 0.1, 0.1), position=at)
        other = world.add_box((0.1, 0.1, 0.1), position=(at[0] + 0.3, at[1], at[2] + 0.01 * place))
        world.constrain(one, other, "point", at=(at[0] + 0.15, at[1], at[2]))
    return world


def bits(world: World) -> dict[str, bytes]:
    """All state of a world, and its contacts."""
    state = {name: array.tobytes() for name, array in world.arrays.state.numpy.items()}
    del state["status_entry"]
    contacts = world.contact_arrays.contacts.numpy
    count = int(contacts["count_contacts"][0, THERE])
    return state | {
        name: array[0, :count].tobytes() for name, array in contacts.items() if name.startswith("contact_")
    }


def team_of(world: World) -> Any:
    """The threads of a world, which has shared a step."""
    shared = world.engine._shared
    assert shared is not None
    assert shared._team is not None
    return shared._team


def wait_until_helped(world: World) -> None:
    """Take steps until a thread has helped: on a busy machine all may come too late for a while."""
    until = time.monotonic() + PATIENCE
    while not any(helper.part for helper in team_of(world)._helpers):
        world.step()
        assert time.monotonic() < until


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("make", [piles, robots, euler, tied])
def test_bits_are_the_same_for_any_number_of_threads(make: Callable[[int, str], World], law: str) -> None:
    lone = make(1, law)
    lone.step(60)
    assert lone.engine._shared is None
    expected = bits(lone)
    for threads in (2, 3, 4):
        world = make(threads, law)
        world.step(60)
        assert team_of(world)._team.begun == threads - 1
        assert bits(world) == expected
        # Arrays were too short at first.
        assert world.engine.growths == lone.engine.growths > 0


def test_threads_help() -> None:
    world = piles(2)
    world.step()
    wait_until_helped(world)


def test_a_world_of_few_bodies_stays_with_one_thread() -> None:
    world = World(gravity=(0.0, 0.0, -9.81), threads=4)
    world.add_plane()
    world.add_box()
    world.step(3)
    assert world.engine._shared is not None
    assert world.engine._shared._team is None


@pytest.mark.parametrize("fewest", [0, 1_000_000])
def test_constraints_are_shared_in_steps_of_many_contacts(
    monkeypatch: pytest.MonkeyPatch, fewest: int
) -> None:
    monkeypatch.setattr(shared_steps, "_FEWEST_ROWS", fewest)
    monkeypatch.setattr(shared_steps, "_FEWEST_MOVING", 1_000_000)
    world = piles(2)
    world.step(5)
    shared = team_of(world)._team.part
    # A step is taken again where arrays were too short.
    assert shared >= 5 if fewest == 0 else shared == 0


def test_bodies_and_parameters_that_change_between_steps_reach_all_threads() -> None:
    worlds = [piles(1), piles(3)]
    for world in worlds:
        world.step(5)
        world.time_step = 0.002
        world.gravity = (1.0, 0.0, -5.0)
        world.step(5)
        for place in range(6):
            world.add_sphere(0.1, position=(3.0 * place, 2.0, 0.15))
        world.step(20)
        world.contact = "bullet"
        world.change_parameters(solver_iterations=7)
        world.step(20)
        tie = world.constrain(world.bodies[10], world.bodies[20], "point")
        world.step(3)
        tie.remove()
        world.step(3)
        world.remove(world.bodies[3])
        world.step(20)
    assert bits(worlds[0]) == bits(worlds[1])


def test_a_profile_shows_the_steps_of_one_thread_and_leaves_the_others_in_place() -> None:
    worlds = [piles(1), piles(3)]
    for world in worlds:
        world.step(5)
        profile(world, 5)
        world.step(20)
    assert bits(worlds[0]) == bits(worlds[1])


def test_substeps_are_shared_also_where_they_are_watched() -> None:
    class Watcher:
        def after_substep(self) -> None: ...

        def step_repeated(self) -> None: ...

    worlds = [piles(1), piles(3)]
    for world in worlds:
        world.substeps = 3
        world.step(5)
        world.watch_substeps(Watcher())
        world.step(5)
    assert bits(worlds[0]) == bits(worlds[1])


def test_a_copy_has_as_many_threads() -> None:
    world = piles(3)
    world.step(10)
    other = world.copy()
    world.step(10)
    other.step(10)
    assert team_of(other)._team.begun == 2
    assert bits(world) == bits(other)


def test_a_saved_world_does_not_state_threads(tmp_path: Path) -> None:
    for name, threads in (("one", 1), ("two", 2)):
        world = piles(threads)
        world.step(3)
        world.save(tmp_path / name)
    assert (tmp_path / "one").read_bytes() == (tmp_path / "two").read_bytes()


@pytest.mark.parametrize("threads", [1, 2, 4])
def test_a_step_that_fails_is_undone_and_names_the_first_body_at_fault(threads: int) -> None:
    world, spared = piles(threads), piles(threads)
    for one in (world, spared):
        one.step(10)
    before = bits(world)
    for body in (7, 30, 50, 66):
        world.link_force[world.bodies[body].first_link] = math.nan
    for _ in range(5):
        with pytest.raises(SimulationError, match=r"body 7 "):
            world.step()
        # Forces are dropped.
        before["link_wrench"] = bits(world)["link_wrench"]
        assert bits(world) == before
        for body in (66, 50, 30, 7):
            world.link_force[world.bodies[body].first_link] = math.nan
    with pytest.raises(SimulationError, match=r"body 7 "):
        world.step()
    world.step(20)
    spared.step(20)
    assert bits(world) == bits(spared)


@pytest.fixture
def impatient() -> Iterator[None]:
    """Every step is watched, and broken off for each signal."""
    assert host is not None
    patience = c_int64.in_dll(host.symbols, "carom_patience")
    before, patience.value = patience.value, 0
    yield
    patience.value = before


@contextmanager
def signals(handler: Callable[[], object]) -> Iterator[None]:
    """Send signals to this thread again and again."""
    before = signal.signal(signal.SIGUSR1, lambda *_: handler())
    main, over = threading.get_ident(), threading.Event()

    def send() -> None:
        while not over.wait(0.003):
            signal.pthread_kill(main, signal.SIGUSR1)

    sender = threading.Thread(target=send, daemon=True)
    sender.start()
    try:
        yield
    finally:
        over.set()
        sender.join()
        signal.signal(signal.SIGUSR1, before)


@pytest.mark.skipif(os.name != "posix", reason="needs signals of POSIX")
@pytest.mark.usefixtures("impatient")
def test_steps_broken_off_by_signals_are_taken_all_the_same() -> None:
    worlds = [piles(1), piles(3)]
    seen = []
    for world in worlds:
        world.substeps = 40
        world.time_step = 0.1
    with signals(lambda: seen.append(worlds[1].time)):
        for world in worlds:
            world.step(12)
    assert seen
    assert bits(worlds[0]) == bits(worlds[1])


@pytest.mark.skipif(os.name != "posix", reason="needs signals of POSIX")
@pytest.mark.usefixtures("impatient")
def test_what_a_handler_raises_leaves_the_world_between_two_steps() -> None:
    class Enough(Exception):
        pass

    def stop() -> None:
        if world.time > 0.01:
            raise Enough

    world, other = piles(3), piles(1)
    with pytest.raises(Enough), signals(stop):
        while True:
            world.step(1000)
    steps = round(world.time / world.time_step)
    other.step(steps)
    assert bits(world) == bits(other)
    world.step(10)
    other.step(10)
    assert bits(world) == bits(other)


def test_worlds_of_several_threads_of_python_do_not_disturb_each_other() -> None:
    expected = piles(1)
    expected.step(40)
    worlds = [piles(3) for _ in range(3)]
    threads = [threading.Thread(target=world.step, args=(40,)) for world in worlds]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for world in worlds:
        assert bits(world) == bits(expected)


@pytest.mark.skipif(not Path("/proc/self/task").exists(), reason="needs Linux")
def test_threads_end_with_their_world() -> None:
    def count() -> int:
        return len(os.listdir("/proc/self/task"))

    gc.collect()
    before = count()
    for _ in range(20):
        world = piles(4)
        world.step(2)
        assert count() >= before + 3
        world.clear()
    gc.collect()
    until = time.monotonic() + PATIENCE
    # They have left, but the system may still list one.
    while count() > before and time.monotonic() < until:
        time.sleep(0.01)
    assert count() == before


FORK = """
import os, sys, warnings
from carom.engine import shared_steps
from tests.engine.test_shared_steps import bits, piles, team_of, wait_until_helped

warnings.simplefilter("ignore", DeprecationWarning)
shared_steps._FEWEST_ROWS = 0
world, lone = piles(3), piles(1)
for one in (world, lone):
    one.step(10)
child = os.fork()
for one in (world, lone):
    one.step(20)
same = bits(world) == bits(lone) and team_of(world)._team.begun == 2
# In a child they are others, which have seen no step before.
wait_until_helped(world)
if child == 0:
    del world
    os._exit(0 if same else 1)
_, status = os.waitpid(child, 0)
print(os.waitstatus_to_exitcode(status), same)
"""


@pytest.mark.skipif(not hasattr(os, "fork"), reason="there is no fork on this system")
def test_a_forked_process_goes_on_with_threads_of_its_own() -> None:
    root = Path(__file__).parents[2]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(root), *filter(None, sys.path)])}
    done = subprocess.run(
        [sys.executable, "-c", FORK],
        capture_output=True,
        text=True,
        timeout=300,
        check=True,
        env=environment,
    )
    assert done.stdout.split() == ["0", "True"]


@pytest.mark.parametrize("threads", [0, -2])
def test_a_number_of_threads_that_is_not_positive_is_refused(threads: int) -> None:
    with pytest.raises(ValueError, match=f"threads must be at least 1, not {threads}"):
        World(threads=threads)


@pytest.mark.parametrize("threads", [1.5, "2", None, True])
def test_what_is_no_number_of_threads_is_refused(threads: Any) -> None:
    with pytest.raises(TypeError, match="threads must be a whole number of at least 1, not"):
        World(threads=threads)


def test_integers_of_numpy_are_numbers_of_threads() -> None:
    count: Any = np.int64(2)
    assert World(threads=count).island_threads == 2
