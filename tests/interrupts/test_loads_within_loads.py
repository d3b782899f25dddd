"""A load within a load: signal handlers, finalizers and tracers may load files at any point of one."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

# A key whose comparison is interrupted, which is while the cache is locked.
_WITHIN_THE_CACHE = """
import signal, sys
from pathlib import Path
from carom.files.bounded import FileCache, FileStamp

file = Path(sys.argv[1])
cache = FileCache(1)


class Key:
    quiet = True

    def __hash__(self):
        return 1

    def __eq__(self, other):
        if not Key.quiet:
            Key.quiet = True
            signal.raise_signal(signal.SIGINT)
        return isinstance(other, Key)


def handle(*_):
    cache.put("another", FileStamp.of(file), "inner")
    print(cache.get("another", file))


signal.signal(signal.SIGINT, handle)
cache.put(Key(), FileStamp.of(file), "outer")
Key.quiet = False
print(cache.get(Key(), file))
Key.quiet = False
cache.put(Key(), FileStamp.of(file), "outer")
"""

_WITHIN_LOADS = """
import signal, sys
import pybullet as p
from pybullet_data import getDataPath

p.connect(p.DIRECT)
other = p.connect(p.DIRECT)
robot = getDataPath() + "/r2d2.urdf"
seen = []


def handle(*_):
    seen.append(p.loadURDF(getDataPath() + "/cube_small.urdf", physicsClientId=other))
    p.removeBody(seen[-1], other)


signal.signal(signal.SIGALRM, handle)
for number in range(300):
    signal.setitimer(signal.ITIMER_REAL, 1e-5 * (1 + number % 100))
    p.removeBody(p.loadURDF(robot))
signal.setitimer(signal.ITIMER_REAL, 0)
print(len(seen) > 10)
"""


def _run(code: str, *arguments: str) -> list[str]:
    command = [sys.executable, "-c", code, *arguments]
    return subprocess.run(command, capture_output=True, text=True, timeout=90, check=True).stdout.splitlines()


def test_a_signal_handler_uses_the_cache_that_is_in_use(tmp_path: Path) -> None:
    file = tmp_path / "robot.urdf"
    file.touch()
    os.utime(file, (1e9, 1e9))
    assert "inner" in _run(_WITHIN_THE_CACHE, str(file))


@pytest.mark.skipif(os.name == "nt", reason="there are no timers that send signals")
def test_a_signal_handler_loads_while_a_robot_is_loaded() -> None:
    assert _run(_WITHIN_LOADS) == ["True"]
