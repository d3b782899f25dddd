"""Threads that use one `World`: each call has the world for itself, from its arguments to its results."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from inspect import isfunction
from threading import Condition, Thread
from typing import Any

import numpy as np
import pytest

from carom import Camera, World, Worlds
from carom.algorithms.inverse_dynamics import inverse_dynamics
from carom.algorithms.inverse_kinematics import inverse_kinematics
from carom.algorithms.jacobian import jacobian
from carom.algorithms.mass_matrix import mass_matrix
from carom.worlds.body import BodyBatch
from carom.worlds.parts.joints import JointGroupBatch
from carom.worlds.parts.links import LinkBatches
from carom.worlds.parts.sensors import SensorBatches

_ROUNDS = 40
_BODIES = ("plane.urdf", "kuka_iiwa/model.urdf", "cube_small.urdf")


@pytest.fixture(autouse=True)
def frequent_turns() -> Iterator[None]:
    """Threads take turns as often as possible."""
    before = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    yield
    sys.setswitchinterval(before)


def made() -> World:
    world = World()
    world.gravity = (0.0, 0.0, -9.81)
    for place, file in enumerate(_BODIES):
        world.load_urdf(
            file, (0.7 * place - 0.7, 0.0, 0.05 * (place > 0)), as_pybullet=True, fixed_base=place < 2
        )
    world.bodies[1].joints.set_position_targets(0.5)
    return world


def _load_and_remove(world: World) -> list[int]:
    """Several, so that arrays grow."""
    added = [
        world.load_urdf("r2d2.urdf", (20.0, 3.0 * place, 50.0), as_pybullet=True).id for place in range(4)
    ]
    for number in added:
        world.remove(number)
    return added


def _image(world: World) -> list[int]:
    camera = Camera(24, 18, fx=20.0).look_at((2.0, 2.0, 1.5), (0.0, 0.0, 0.3))
    return np.unique(camera.capture(world).body_ids).tolist()


def _algorithms(world: World) -> list[Any]:
    arm, zeros = world.bodies[1], [0.0] * 7
    return [
        jacobian(arm, 6, (0.0, 0.0, 0.0), zeros)[0].tolist(),
        mass_matrix(arm, zeros).tolist(),
        inverse_dynamics(arm, zeros, zeros, zeros).tolist(),
        inverse_kinematics(arm, [6], [(0.3, 0.3, 0.8)], start=zeros, in_base_frame=True).positions,
    ]


def _rays(world: World) -> list[tuple[int, ...]]:
    starts = [(0.1 * i - 1.0, 0.0, 3.0) for i in range(20)]
    hits = world.queries().cast_rays(starts, [(x, y, -1.0) for x, y, _ in starts])
    return [(hit.body, hit.link) for hit in hits]


def _state(world: World) -> list[Any]:
    arm, cube = world.bodies[1], world.bodies[2]
    parts = [arm.joints.positions, arm.joints.velocities, *arm.links[6].pose, *cube.links[-1].velocity]
    return [part.tolist() for part in parts]


def _step(world: World) -> None:
    world.step(3)


def _restore(world: World) -> None:
    with world.lock:
        world.restore(world.snapshot())


CALLS: tuple[Callable[[World], Any], ...] = (
    _step,
    _load_and_remove,
    _state,
    _rays,
    _image,
    _algorithms,
    _restore,
)


def run(threads: list[Thread], errors: list[BaseException]) -> None:
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(120.0)
    assert not errors, errors[0]
    assert not any(thread.is_alive() for thread in threads)


@pytest.mark.parametrize("count", [2, 4])
def test_calls_in_a_fixed_order_give_the_same_bits_whoever_makes_them(count: int) -> None:
    alone = made()
    order = [CALLS[turn % len(CALLS)] for turn in range(5 * len(CALLS))]
    expected = [call(alone) for call in order]
    world, turns, errors = made(), Condition(), list[BaseException]()
    results: list[Any] = []

    def work(place: int) -> None:
        try:
            for turn in range(place, len(order), count):
                with turns:
                    turns.wait_for(lambda: len(results) == turn or errors, 60.0)  # noqa: B023
                    results.append(order[turn](world))
                    turns.notify_all()
        except BaseException as error:
            errors.append(error)
            raise

    run([Thread(target=work, args=(place,)) for place in range(count)], errors)
    assert results == expected
    assert world.snapshot().state["position"].tobytes() == alone.snapshot().state["position"].tobytes()


@pytest.mark.parametrize("count", [2, 4])
def test_each_call_of_threads_at_once_has_the_world_for_itself(count: int) -> None:
    world, errors = made(), list[BaseException]()
    still = _algorithms(made())
    steps = 3 * _ROUNDS * (count // 2)

    def work(place: int) -> None:
        try:
            for turn in range(_ROUNDS):
                if place % 2 == 0:
                    _step(world)
                    continue
                added = _load_and_remove(world)
                assert len(set(added)) == 4
                assert _algorithms(world) == still
                assert len(_rays(world)) == 20
                assert 0 in _image(world)
                if turn % 4 == 0:
                    _state(world)
        except BaseException as error:
            errors.append(error)
            raise

    run([Thread(target=work, args=(place,)) for place in range(count)], errors)
    assert list(world.bodies.keys()) == [0, 1, 2]
    # The bodies that came and went were far away: the others have moved as if they had not.
    alone = made()
    alone.step(steps)
    assert world.time == alone.time
    assert _state(world) == _state(alone)


def test_a_reader_sees_whole_steps_only() -> None:
    world = made()
    for place in range(10):
        world.load_urdf("r2d2.urdf", (5.0 * place, 9.0, 0.5), as_pybullet=True)
    stepping, seen = True, set[bytes]()

    def state() -> bytes:
        return b"".join(array.tobytes() for array in world.snapshot().state.values())

    def read() -> None:
        while stepping:
            seen.add(state())

    known = {state()}
    reader = Thread(target=read)
    reader.start()
    try:
        for _ in range(100):
            world.step()
            known.add(state())
    finally:
        stepping = False
        reader.join()
    assert seen
    assert seen <= known


def test_other_threads_wait_for_the_lock() -> None:
    world, done = made(), list[str]()
    thread = Thread(target=lambda: (_step(world), done.append("stepped")))
    with world.lock:
        thread.start()
        thread.join(0.2)
        assert not done
        # The thread that has it goes on.
        world.step()
        _state(world)
    thread.join()
    assert done == ["stepped"]


def test_worlds_do_not_wait_for_each_other() -> None:
    one, other = made(), made()
    thread = Thread(target=lambda: _step(other))
    with one.lock:
        thread.start()
        thread.join(10.0)
        assert not thread.is_alive()


CALLS_OF_WORLDS: dict[str, Callable[[Worlds], Any]] = {
    "step": Worlds.step,
    "contacts": lambda worlds: worlds.contacts(2),
    "linearize": lambda worlds: worlds.linearize(),
    "velocities": lambda worlds: worlds[2].base_velocities,
    "set velocities": lambda worlds: worlds[2].set_base_velocities([0.0] * 6),
    "set joints": lambda worlds: setattr(worlds[2].joints, "positions", 0.0),
    "targets": lambda worlds: worlds[2].joints.set_position_targets(0.0),
    "controls": lambda worlds: setattr(worlds[2].actuators, "controls", np.zeros((3, 0))),
    "dynamics": lambda worlds: worlds[2].dynamics(-1),
    "mass matrices": lambda worlds: worlds[2].mass_matrix(),
    "gravity": lambda worlds: worlds[2].algorithms.gravity_forces(),
    "sensors": lambda worlds: worlds[2].sensors.read(),
}


@pytest.mark.parametrize("name", CALLS_OF_WORLDS)
def test_calls_of_worlds_wait_for_each_other(name: str) -> None:
    worlds, done = Worlds(made(), 3), list[str]()
    call = CALLS_OF_WORLDS[name]
    # Modules are known the second time.
    call(worlds)
    thread = Thread(target=lambda: (call(worlds), done.append("done")))
    with worlds.lock:
        thread.start()
        thread.join(0.2)
        assert not done
        worlds.step()
    thread.join()
    assert done == ["done"]
    assert worlds.time.tolist() == pytest.approx([(3.0 if name == "step" else 1.0) / 240.0] * 3)


# They call others, which wait.
_CALL_OTHERS = {"inverse_kinematics", "forward_dynamics", "velocity_servo", "hold", "reset", "enable_sensors"}
# The first takes the lock itself, as often as handlers of signals run in the middle; so does the window.
_IN_TURNS = {"step", "view"}


@pytest.mark.parametrize("kind", [Worlds, BodyBatch, JointGroupBatch, LinkBatches, SensorBatches])
def test_all_methods_of_worlds_wait(kind: type) -> None:
    methods = {name: getattr(kind, name) for name in dir(kind) if name[0] != "_"}
    free = {name for name, it in methods.items() if isfunction(it) and not hasattr(it, "__wrapped__")}
    assert free <= _CALL_OTHERS | _IN_TURNS
