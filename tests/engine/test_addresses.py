"""What native code is told: which memory it may write, and what it runs without Python."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
import pytest

import pybullet as p
from carom import World
from carom.engine import world_calls
from carom.engine.interpreter import Interpreter
from carom.engine.world_calls import WorldCalls
from carom.layouts.status import CONTACTS_WANTED, PAIRS_WANTED, STATUS, STEPS_DONE
from carom.scene.core.profile import StagedStepper, staged_program
from pybullet._clients.clients import client_of


@pytest.fixture
def connected() -> Iterator[None]:
    p.connect(p.DIRECT)
    yield
    p.disconnect()


def test_detection_by_itself_leaves_all_poses_as_they_were(connected: None) -> None:
    shape = p.createCollisionShape(p.GEOM_SPHERE, radius=0.1)
    balls = [p.createMultiBody(1.0, shape, basePosition=[0.0, 0.0, float(k)]) for k in range(3)]
    for ball in balls:
        p.resetBaseVelocity(ball, [0.0, 0.0, 1.0])
    p.stepSimulation()
    world = client_of(0).world
    poses = world.arrays.state.numpy["link_pose"]
    poses_of_step = poses.copy()
    # The first is by Python, which tells the native library how others are made.
    for _ in range(2):
        p.performCollisionDetection()
        np.testing.assert_array_equal(poses, poses_of_step)
    detection = world.quick.record.detection
    assert detection.run and detection.pose_count == poses.size


def test_steps_that_python_makes_have_no_address() -> None:
    engine = World().engine
    assert engine.step_addresses()[0] != 0
    engine.step_by(staged_program, [StagedStepper(engine)])
    assert engine.step_addresses()[0] == 0


def test_calls_have_room_for_the_whole_status_of_each_world(monkeypatch: pytest.MonkeyPatch) -> None:
    shapes = []

    class Watched(Interpreter):
        def __init__(self, status: np.ndarray, *others: np.ndarray | int) -> None:
            shapes.append(status.shape)
            super().__init__(status, *others)  # pyright: ignore[reportArgumentType]

    monkeypatch.setattr(world_calls, "Interpreter", Watched)
    WorldCalls(2).run(5, [[], []])
    assert shapes == [(5, 1 + max(STATUS, PAIRS_WANTED, CONTACTS_WANTED, STEPS_DONE))] * 2
