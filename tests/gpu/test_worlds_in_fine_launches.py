"""All that holds for worlds on the processor holds, bit for bit, for those that are stepped as on a GPU.

The tests of `tests/worlds` run once more, with kernels that are compiled as those of the native library are.
"""

from __future__ import annotations

import numpy as np
import pytest

pytest.importorskip("warp", reason="launches the kernels")

from tests.face import test_sizes as sizes
from tests.gpu.native_device import NativeDevice
from tests.physics.contact_scenes import add_ball, add_floor, earth
from tests.physics.test_contact_worlds import heap
from tests.worlds.same_bits import assert_as_stirred, assert_same_bits, stirred_worlds
from tests.worlds.test_parameters import *  # noqa: F403
from tests.worlds.test_same_bits import (
    test_256_worlds_of_which_few_have_contacts,  # noqa: F401
    test_bodies_that_fall_asleep_and_are_woken,  # noqa: F401
    test_resets_of_some_worlds_in_between,  # noqa: F401
)
from tests.worlds.test_set_velocities import *  # noqa: F403
from tests.worlds.test_touching_links import *  # noqa: F403
from tests.worlds.test_worlds import *  # noqa: F403

from carom import World, Worlds
from carom.engine.engine import Engine
from carom.gpu.engine import DeviceEngine
from carom.layouts.contacts import THERE
from carom.worlds import devices
from carom.worlds import worlds as module

# What these are about is the memory of the host.
test_too_many_worlds_are_refused_before_memory_runs_out = None
test_worlds_of_arms_and_boxes_take_little_memory = None


@pytest.fixture(autouse=True)
def device(monkeypatch: pytest.MonkeyPatch) -> NativeDevice:
    """Every `Worlds` on the processor is on this device instead."""
    made, make = NativeDevice(), devices.make_engine

    def make_other(scene: World, count: int, device: object, threads: int | None) -> Engine:
        if device == devices.CPU:
            device, threads = made, None
        return make(scene, count, device, threads)  # type: ignore[arg-type]

    monkeypatch.setattr(module, "make_engine", make_other)
    return made


@pytest.mark.parametrize("count", [1, 5])
def test_a_heap_that_outgrows_its_arrays(count: int) -> None:
    scene = earth()
    heap(scene, 24)
    worlds = stirred_worlds(scene, count, 1)
    engine = worlds._engine
    assert isinstance(engine, DeviceEngine)
    room = engine.contact_arrays.contacts.capacity["contact"]
    for _ in range(10):
        worlds.step(6)
    assert engine.contact_arrays.contacts.capacity["contact"] > room
    assert engine.growths > 1
    assert_as_stirred(worlds, scene, 60)


def test_a_world_that_overflows_alone_catches_up_in_a_run_of_steps(device: NativeDevice) -> None:
    scene = earth(substeps=3)
    add_floor(scene)
    balls = [add_ball(scene, (0.5 * i, 0.0, 3.0)) for i in range(6)]
    worlds = Worlds(scene, 3)
    # Contacts that there is no room for come in one world at once, in another one by one.
    for number, ball in enumerate(balls):
        worlds[ball].set_base_inertial_poses((0.5 * number, 0.0, 0.12), where=[1])
        worlds[ball].set_base_inertial_poses((0.5 * number, 0.0, 0.15 + 0.02 * number), where=[2])
    starts = [worlds.extract(number) for number in range(3)]
    worlds.step(50)
    counts = np.asarray(worlds._engine.contact_arrays.contacts.numpy["count_contacts"])[:, THERE]
    assert counts.tolist() == [0, 6, 6]
    assert worlds._engine.growths > 0
    for number, lone in enumerate(starts):
        lone.step(50)
        assert_same_bits(worlds, number, lone)
        assert worlds.time[number] == pytest.approx(lone.time)


def test_launches_are_captured_once_until_they_change(device: NativeDevice) -> None:
    scene = earth()
    add_floor(scene)
    ball = add_ball(scene, (0.0, 0.0, 0.3))
    worlds = Worlds(scene, 2)
    worlds.step(3)
    assert device.captured == 1
    worlds[ball].set_base_inertial_poses((0.0, 0.0, 0.4), where=[1])
    worlds.step(3, where=[1])
    worlds.restore(worlds.snapshot(), where=[0])
    assert device.captured == 1
    # Parameters that so far all have shared lie elsewhere from now on; then they are only written.
    worlds[ball].change_dynamics(-1, mass=[1.0, 2.0])
    worlds.step()
    assert device.captured == 2
    worlds[ball].change_dynamics(-1, mass=[3.0, 2.0])
    worlds.step()
    assert device.captured == 2


def test_too_many_worlds_are_refused_before_there_is_any(arm) -> None:
    world, _ = arm
    with pytest.raises(
        MemoryError, match=r"5000 worlds of \d+\.\d kB need .* GB are free on native: ask for"
    ):
        Worlds(world, 5000, device=NativeDevice(room=10_000_000))
    Worlds(world, 130, device=NativeDevice(room=10_000_000))


def test_threads_are_of_the_processor_only(arm) -> None:
    with pytest.raises(ValueError, match="threads can be set for the device 'cpu' only"):
        Worlds(arm[0], 2, device=NativeDevice(), threads=2)


@pytest.mark.parametrize("count", [1, 5])
def test_sizes_that_differ_between_worlds(count: int) -> None:
    sizes.test_worlds_move_as_lone_worlds_that_were_made_so("bullet", count, 1)
    sizes.test_sizes_are_set_between_steps_in_one_world_and_in_many("bullet")
    sizes.test_a_box_that_became_smaller_comes_to_rest_lower("bullet")
