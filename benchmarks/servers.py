"""What a call to a world in another process costs: `python benchmarks/servers.py`.

Prints the fastest of many calls: in the own process, and by SHARED_MEMORY, of Carom and of PyBullet.
"""

from __future__ import annotations

import argparse
import json
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

DATA = Path(__file__).parents[1] / "src" / "pybullet_data"
KEY = 4321
# They are run by either interpreter, so `pybullet` is whichever that one has.
SERVER = (
    f"import pybullet as p; p.connect(p.SHARED_MEMORY_SERVER, {KEY}); print('ready', flush=True); input()"
)
READY = "ready"


def calls(p: Any) -> dict[str, tuple[Callable[[], object], int]]:
    """What is timed, and how often."""
    panda = p.loadURDF(str(DATA / "franka_panda" / "panda.urdf"), useFixedBase=1)
    p.loadURDF(str(DATA / "cube_small.urdf"), [0.5, 0, 0.5])
    p.setGravity(0, 0, -9.8)
    joints, targets = list(range(9)), [0.0] * 9
    rays = [[0, 0, 0.2 + number / 1000] for number in range(256)], [[2, 0, 0.3]] * 256
    return {
        "getJointState": (lambda: p.getJointState(panda, 0), 2000),
        "getJointStates, 9 joints": (lambda: p.getJointStates(panda, joints), 2000),
        "setJointMotorControlArray, 9 targets": (
            lambda: p.setJointMotorControlArray(panda, joints, p.POSITION_CONTROL, targetPositions=targets),
            2000,
        ),
        "stepSimulation, Panda": (p.stepSimulation, 2000),
        "rayTestBatch, 256 rays": (lambda: p.rayTestBatch(*rays), 200),
        "getCameraImage, 320 x 240": (lambda: p.getCameraImage(320, 240), 20),
        "getCameraImage, 640 x 480": (lambda: p.getCameraImage(640, 480), 20),
    }


def fastest(call: Callable[[], object], count: int) -> float:
    """The time of the fastest call [s]."""
    best = float("inf")
    for _ in range(count):
        began = time.perf_counter()
        call()
        best = min(best, time.perf_counter() - began)
    return best


def measure(method: str) -> dict[str, float]:
    """Times of all calls [s] in a world of this process, or in that of a server."""
    import pybullet as p

    if p.connect(getattr(p, method), KEY) < 0:
        raise SystemExit("There is no server.")
    return {name: fastest(*case) for name, case in calls(p).items()}


def measured(python: str, method: str) -> dict[str, float]:
    """The same by another interpreter."""
    server = subprocess.Popen(
        [python, "-c", SERVER],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        text=True,
    )
    assert server.stdout is not None
    try:
        # PyBullet prints what it does.
        while server.stdout.readline().strip() != READY:
            pass
        done = subprocess.run(
            [python, __file__, "--measure", method], check=True, capture_output=True, text=True
        )
    finally:
        server.communicate("\n")
    return json.loads(next(line for line in done.stdout.splitlines() if line.startswith("{")))


def _unit(seconds: float) -> str:
    return f"{seconds * 1e3:.3g} ms" if seconds >= 1e-3 else f"{seconds * 1e6:.3g} µs"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--oracle", default=".oracle/bin/python", help="the Python that has PyBullet")
    # How this file calls itself.
    parser.add_argument("--measure", help=argparse.SUPPRESS)
    options = parser.parse_args()
    if options.measure:
        print(json.dumps(measure(options.measure)))
        return
    oracle = options.oracle
    columns = [
        measured(sys.executable, "DIRECT"),
        measured(sys.executable, "SHARED_MEMORY"),
        measured(oracle, "SHARED_MEMORY"),
    ]
    print("| call | Carom, own process | Carom, `SHARED_MEMORY` | PyBullet, `SHARED_MEMORY` |")
    print("|---|---:|---:|---:|")
    for name in columns[0]:
        print(f"| {name} | {' | '.join(_unit(column[name]) for column in columns)} |")


if __name__ == "__main__":
    main()
