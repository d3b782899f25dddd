"""Setters of many worlds that write more than once: an error at any line leaves all of it, or nothing."""

from __future__ import annotations

import os
import signal
from collections.abc import Callable
from contextlib import suppress
from typing import Any

import numpy as np
import pytest
from tests.interrupts.faults import Fault
from tests.interrupts.test_prepared_changes import at_lines
from tests.rings import few

from carom import World, Worlds
from carom.description.keyframe import BodyKeyframe
from carom.description.pose import Pose

# Of the lines of a call, about so many are tried.
_TRIED = 10
_SOME = [0, 2]


def _made(*, pulled: bool = False) -> Worlds:
    world = World()
    world.load_urdf("plane.urdf")
    body = world.load_urdf("r2d2.urdf", (0.0, 0.0, 0.4), as_pybullet=True)
    pose = Pose((0.0, 0.0, 1.0), (0.0, 0.6, 0.0, 0.8))
    body.add_keyframe(BodyKeyframe("up", pose=pose, velocities=(1.0,) * sum(body.velocity_count)))
    world.gravity = (0.0, 0.0, -9.81)
    worlds = Worlds(world, 3)
    worlds.step(40)
    if pulled:
        worlds[1].joints.set_springs(0.2, stiffness=1.0, damping=0.5)
    return worlds


def _seen(worlds: Worlds) -> list[tuple[str, bytes]]:
    arrays, contacts = worlds._engine.arrays, worlds._engine.contact_arrays
    tables = arrays.model.numpy, arrays.state.numpy, contacts.contacts.numpy, contacts.shapes.table.numpy
    # A parameter that was the same in all worlds may be stored once for each.
    shapes = [
        np.unique(array, axis=0) if len(array) else array for table in tables for array in table.values()
    ]
    names = [name for table in tables for name in table]
    clock = ("times", worlds.time.tobytes()), ("status", worlds._engine.status.tobytes())
    return [*clock, *((name, array.tobytes()) for name, array in zip(names, shapes, strict=True))]


SETTERS: dict[str, Callable[[Worlds], Any]] = {
    "set_base_inertial_poses": lambda worlds: worlds[1].set_base_inertial_poses((0.0, 0.0, 2.0)),
    "set_pose of some": lambda worlds: worlds[1].set_pose(((0.0, 0.0, 2.0), (0, 0, 0, 1)), where=_SOME),
    "set_base_velocities": lambda worlds: worlds[1].set_base_velocities((1, 2, 3, 4, 5, 6), where=_SOME),
    "apply_force": lambda worlds: worlds[1].links[3].apply_force((1, 2, 3), where=_SOME),
    "apply_torque": lambda worlds: worlds[1].links[3].apply_torque((4, 5, 6), where=_SOME),
    "set_position_targets": lambda worlds: worlds[1].joints.set_position_targets(0.3),
    "set_velocity_targets": lambda worlds: worlds[1].joints.set_velocity_targets(0.3, where=_SOME),
    "set_springs": lambda worlds: worlds[1].joints.set_springs(0.3, stiffness=2.0, damping=1.0),
    "servo": lambda worlds: worlds[1].joints.servo(0.3, kp=2.0, kd=1.0),
    "servo of some": lambda worlds: worlds[1].joints[[2, 4]].servo(0.3, kp=2.0, kd=1.0, where=_SOME),
    "set_torques": lambda worlds: worlds[1].joints.set_torques(0.3),
    "set_torques of some": lambda worlds: worlds[1].joints[[2, 3]].set_torques(0.3),
    "reset to a keyframe": lambda worlds: worlds.reset("up", where=_SOME),
    "free motors": lambda worlds: worlds[1].joints.free(),
    "free motors of some": lambda worlds: worlds[1].joints.free(where=_SOME),
    "enable_sensors": lambda worlds: worlds[1].joints[[1, 3]].enable_sensors(),
    "change_dynamics": lambda worlds: worlds[1].change_dynamics(
        3, mass=2.0, lateral_friction=0.3, linear_damping=0.2, where=_SOME
    ),
}


@pytest.mark.parametrize("name", few(SETTERS, 4))
def test_an_exception_at_any_line_leaves_before_or_after(name: str) -> None:
    call = SETTERS[name]
    worlds, lines = _made(pulled="motors" in name), 0

    def count() -> None:
        nonlocal lines
        lines += 1

    before = _seen(worlds)
    at_lines(lambda: call(worlds), count)
    after = _seen(worlds)
    assert before != after
    worlds = _made(pulled="motors" in name)
    assert _seen(worlds) == before
    for place in range(1, lines + 1, 1 + lines // _TRIED):
        left = place

        def blow() -> None:
            nonlocal left
            left -= 1
            if left == 0:
                raise Fault

        # The first call has more lines than later ones.
        with suppress(Fault):
            at_lines(lambda: call(worlds), blow)  # noqa: B023 (it is called at once)
        now = _seen(worlds)
        assert now in (before, after), (place, [a[0] for a, b in zip(now, before, strict=True) if a != b])
        if now == after:
            worlds = _made(pulled="motors" in name)


@pytest.mark.skipif(os.name != "posix", reason="needs signals of POSIX")
def test_torques_that_a_handler_sets_in_the_middle_stay() -> None:
    worlds, lines = _made(), 0
    batch = worlds[1]
    columns = batch.joints[[2]].columns, batch.joints[[3]].columns

    def count() -> None:
        nonlocal lines
        lines += 1

    at_lines(lambda: batch.joints[[2]].set_torques(0.3), count)
    before = signal.signal(signal.SIGUSR1, lambda *_: batch.joints[[3]].set_torques(0.5, where=_SOME))
    try:
        for place in range(1, lines + 1):
            batch.joints.torques[:] = 0.0
            left = place

            def come() -> None:
                nonlocal left
                left -= 1
                if left == 0:
                    signal.raise_signal(signal.SIGUSR1)

            at_lines(lambda: batch.joints[[2]].set_torques(0.3), come)
            found = [batch.joints.torques[_SOME, column].ravel().tolist() for column in columns]
            assert found == [[0.3, 0.3], [0.5, 0.5]], place
    finally:
        signal.signal(signal.SIGUSR1, before)
