"""Frames of a world whose bodies come and go, and what making one costs."""

from __future__ import annotations

import sys
from collections.abc import Callable
from itertools import count
from threading import Event, RLock, Thread
from time import monotonic
from types import FrameType

import numpy as np
import pytest

import pybullet_data
from carom import Camera, World
from carom.viewer.details import DetailRequest
from carom.viewer.history.frames import Frames
from carom.viewer.latest_messages import LatestMessages
from carom.viewer.messages import decoded
from carom.viewer.readings import CONTACT_COLUMNS, JOINT_COLUMNS, LINK_COLUMNS

MEMORY = 2**24
# How long a busy machine may take for twenty frames [s].
_PATIENCE = 60.0
PANDA = f"{pybullet_data.getDataPath()}/franka_panda/panda.urdf"


def blocks_of(message: bytes | None) -> dict[str, int]:
    """Names and numbers of rows of what a frame tells besides poses."""
    assert message is not None
    return dict(decoded(message)[0].get("blocks", []))


def test_frames_are_made_while_bodies_come_and_go():
    world, lock = World(), RLock()
    frames = Frames.of_world(world, lock, LatestMessages(), MEMORY)
    frames.details.want(1, DetailRequest(contacts=True, joints="all", dynamics=True, constraints=True))
    ended, problems = Event(), list[BaseException]()

    def script() -> None:
        try:
            while not ended.is_set():
                with lock:
                    bodies = [world.add_box([0.1] * 3, mass=1.0, position=[n, 0, 1]) for n in range(20)]
                    frames.lenses.follow(
                        "on a body", Camera.with_field_of_view(64, 48, 60.0).mount(bodies[0].links[-1])
                    )
                # As in a viewer, whose `StepLock` is held during steps.
                with lock:
                    world.step()
                for body in bodies:
                    with lock:
                        world.remove(body.id)
        except BaseException as problem:
            problems.append(problem)

    thread = Thread(target=script)
    interval = sys.getswitchinterval()
    sys.setswitchinterval(1e-5)
    try:
        thread.start()
        give_up = monotonic() + _PATIENCE
        for picture in count():
            frames.take(picture)
            if picture >= 400 and (frames.past.next_number > 20 or monotonic() > give_up):
                break
    finally:
        ended.set()
        thread.join()
        sys.setswitchinterval(interval)
    assert problems == []
    assert frames.past.next_number > 20


def test_the_past_of_a_body_has_its_readings_from_the_first_frame_on():
    world = World()
    frames = Frames.of_world(world, RLock(), LatestMessages(), MEMORY)
    world.add_plane()
    frames.take(0)
    world.add_sphere(0.1, mass=1.0, position=[0, 0, 1])
    world.step()
    assert blocks_of(frames.take(0)) == {"links": 1}
    world.add_sphere(0.1, mass=1.0, position=[1, 0, 1])
    world.step()
    assert blocks_of(frames.take(0)) == {"links": 2}


@pytest.mark.parametrize("lasting", [False, True])
def test_a_frame_takes_as_many_calls_with_a_thousand_bodies_as_with_a_hundred(lasting: bool):
    calls = []
    for bodies in (100, 1000):
        world = World()
        for n in range(bodies):
            world.add_sphere(0.1, mass=1.0, position=[n, 0, 1])
        frames = Frames.of_world(world, RLock(), LatestMessages(), MEMORY if lasting else 0)
        for _ in range(3):
            frames.take(0)
        world.link_pose[:, 2] += 1.0
        calls.append(calls_of(lambda frames=frames: frames.take(0)))
    assert calls[1] < calls[0] + 100


def calls_of(work: Callable[[], object]) -> int:
    """Number of calls of Python functions that a function makes."""
    count = 0

    def seen(frame: FrameType, event: str, argument: object) -> None:
        nonlocal count
        count += event == "call"

    sys.setprofile(seen)
    try:
        assert work() is not None
    finally:
        sys.setprofile(None)
    return count


def test_the_numbers_of_joints_are_those_of_the_present_bodies():
    world = World()
    frames = Frames.of_world(world, RLock(), LatestMessages(), MEMORY)
    arms = [world.load_urdf(PANDA, [n, 0, 0], fixed_base=True) for n in range(2)]
    for n, arm in enumerate(arms):
        arm.set_joint_state(1, [0.25 * (n + 1)], [0.0])
    angles = joints_of(frames.take(0))
    assert (angles[arms[0].id, 1], angles[arms[1].id, 1]) == (0.25, 0.5)
    # The rows of the second one move to where the first ones were.
    world.remove(arms[0].id)
    angles = joints_of(frames.take(0))
    assert {body for body, _ in angles} == {arms[1].id}
    assert angles[arms[1].id, 1] == 0.5


def joints_of(message: bytes | None) -> dict[tuple[int, int], float]:
    """Positions by body and joint."""
    assert message is not None
    header, payload = decoded(message)
    numbers = np.frombuffer(payload, "<f4")[7 * header["poses"] :]
    for name, rows in header["blocks"]:
        columns = {"contacts": CONTACT_COLUMNS, "joints": JOINT_COLUMNS, "links": LINK_COLUMNS}[name]
        block, numbers = numbers[: rows * columns].reshape(rows, columns), numbers[rows * columns :]
        if name == "joints":
            return {(int(row[0]), int(row[1])): float(row[2]) for row in block}
    return {}


def test_what_a_frame_tells_is_never_older_than_its_time(monkeypatch: pytest.MonkeyPatch):
    """Steps end while it is made: who has seen the time of a step has seen its poses."""
    world = World()
    world.gravity = (0, 0, -10)
    world.add_box((0.1, 0.1, 0.1), (0.0, 0.0, 1.0))
    frames = Frames.of_world(world, RLock(), LatestMessages(), MEMORY)
    heights = [world.link_pose[0, 2]]
    blocks = frames.details.blocks

    def blocks_after_a_step() -> object:
        world.step()
        heights.append(world.link_pose[0, 2])
        return blocks()

    monkeypatch.setattr(frames.details, "blocks", blocks_after_a_step)
    for step in range(3):
        message = frames.take(0)
        assert message is not None
        header, payload = decoded(message)
        assert header["time"] == pytest.approx(step / 240)
        assert np.frombuffer(payload[:12], "<f4")[2] == np.float32(heights[step + 1])
