"""Processes that fork while they hold worlds, as workers of learning libraries do."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest
from tests.patience import PATIENCE

SCRIPT = """
import os, sys, warnings
from carom import World, Worlds
from carom.description import Box
from carom.description.link import Collision
from carom.model.body_spec import BodySpec, LinkSpec

# That forking with threads is dangerous is what is tested.
warnings.simplefilter("ignore", DeprecationWarning)
world = World()
world.gravity = (0.0, 0.0, -9.81)
shape = Collision(Box((1.0, 1.0, 1.0)))
box = LinkSpec(name="box", mass=1.0, inertia=(1.0, 1.0, 1.0), collisions=(shape,))
body = world.load(BodySpec("box", box))
worlds = Worlds(world, 8, threads=2)
worlds.step(5)
child = os.fork()
worlds.step(5)
height = float(worlds[body].base_inertial_poses[0, 2])
if child == 0:
    os._exit(0 if height < 0.0 else 1)
_, status = os.waitpid(child, 0)
print(os.waitstatus_to_exitcode(status), height == worlds[body].base_inertial_poses[7, 2])
"""


@pytest.mark.skipif(not hasattr(os, "fork"), reason="there is no fork on this system")
def test_worlds_go_on_in_both_processes() -> None:
    done = subprocess.run(
        [sys.executable, "-c", SCRIPT], capture_output=True, text=True, timeout=300, check=True
    )
    assert done.stdout.split() == ["0", "True"]


OTHER_THREADS = """
import os, sys, warnings
from threading import Thread
from carom import World

warnings.simplefilter("ignore", DeprecationWarning)
world = World()
world.step()
child = os.fork()
thread = Thread(target=world.step, daemon=True)
thread.start()
# It waits for ever if the fork has kept the lock of the world.
thread.join(PATIENCE)
if child == 0:
    os._exit(thread.is_alive())
_, status = os.waitpid(child, 0)
print(os.waitstatus_to_exitcode(status), thread.is_alive())
"""


@pytest.mark.skipif(not hasattr(os, "fork"), reason="there is no fork on this system")
def test_other_threads_go_on_in_both_processes() -> None:
    script = OTHER_THREADS.replace("PATIENCE", repr(PATIENCE))
    done = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, timeout=300, check=True
    )
    assert done.stdout.split() == ["0", "False"]
