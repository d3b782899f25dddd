"""Tasks in all worlds: how many threads share them, with the same results."""

from __future__ import annotations

import numpy as np
import pytest

import pybullet_data
from carom import World, Worlds
from carom.engine.threads import WORLDS_PER_THREAD, Threads


@pytest.mark.parametrize(("count", "threads"), [(2 * WORLDS_PER_THREAD - 1, 1), (2 * WORLDS_PER_THREAD, 2)])
def test_kinematics_of_few_worlds_wake_up_no_thread(
    monkeypatch: pytest.MonkeyPatch, count: int, threads: int
) -> None:
    world = World()
    panda = world.load_urdf(f"{pybullet_data.getDataPath()}/franka_panda/panda.urdf", fixed_base=True)
    worlds = Worlds(world, count, threads=3)
    used: list[int] = []
    run = Threads.run
    monkeypatch.setattr(Threads, "run", lambda self, tasks: (used.append(len(tasks)), run(self, tasks)))
    batch = worlds[panda]
    batch.joints.positions[:, 1] = np.linspace(-1.0, 1.0, count)
    poses = batch.links.poses.copy()
    assert set(used) == {threads}
    alone = Worlds(world, 1)[panda]
    alone.joints.positions[:] = batch.joints.positions[-1]
    assert np.array_equal(poses[-1], alone.links.poses[0])
    worlds.step()
    assert used[-1] == 3
