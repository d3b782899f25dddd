"""World-steps per second of real PyBullet in one process; `throughput.py` starts one for each core."""

from __future__ import annotations

import sys
import time

import crowds
from pybullet_cases import HOME, MOVABLE, _panda

import pybullet as p

BATCH = 100


def panda() -> None:
    """The arm, held by position motors."""
    body = _panda()
    p.setJointMotorControlArray(body, MOVABLE, p.POSITION_CONTROL, HOME, forces=[87.0] * len(MOVABLE))


def boxes() -> None:
    """Nine towers of three boxes."""
    p.connect(p.DIRECT)
    crowds.towers(3)


def main() -> None:
    """Step for some seconds, after a line from the other side, and print how many steps a second."""
    case, seconds = sys.argv[1], float(sys.argv[2])
    {"panda": panda, "boxes": boxes}[case]()
    for _ in range(BATCH):
        p.stepSimulation()
    print("ready", flush=True)
    sys.stdin.readline()
    start, steps = time.perf_counter(), 0
    while time.perf_counter() - start < seconds:
        for _ in range(BATCH):
            p.stepSimulation()
        steps += BATCH
    print(steps / (time.perf_counter() - start))


if __name__ == "__main__":
    main()
