"""A window whose port another program has: one error, with its cure, and nothing left behind."""

from __future__ import annotations

import socket
import subprocess
import sys
from collections.abc import Iterator

import pytest

from carom import World
from carom.viewer import Viewer


@pytest.fixture
def taken() -> Iterator[int]:
    with socket.socket() as other:
        other.bind(("127.0.0.1", 0))
        other.listen()
        yield other.getsockname()[1]


def test_a_script_ends_with_one_error(taken: int):
    script = f"import pybullet as p; p.connect(p.GUI, options='--port={taken}')"
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert done.stderr.rstrip().endswith("name another one, or none for any that is free.")
    assert "Exception ignored" not in done.stderr
    assert done.stderr.count("pybullet.error: ") == 1


def test_nothing_of_a_viewer_that_could_not_listen_is_left(taken: int):
    world = World()
    with pytest.raises(OSError, match="in use"):
        Viewer(world, port=taken)
    assert world.observers == []
    world.step()


def test_what_is_no_world_is_refused():
    with pytest.raises(TypeError, match=r"a viewer shows a World or Worlds, not str$"):
        Viewer("world")  # pyright: ignore[reportArgumentType]
