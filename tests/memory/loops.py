"""Loops whose memory must not grow: connections, worlds, environments, states, shapes, bodies come and go.

.venv/bin/python -m tests.memory.loops [--cycles N] [--loops NAME...]

For each loop it says by how many kilobytes the process has grown in a cycle, after the first quarter, which
fills caches. Garbage is collected as usual.
"""

from __future__ import annotations

import argparse
import contextlib
import io
import subprocess
import sys
import time
from collections.abc import Callable

from tests.conformance.memory import resident_bytes
from tests.memory import LOOPS, kinds

import pybullet as p

ALLOWED = 1.0
"""Growth [KB per cycle]; resident memory wobbles by what the allocators hold back."""
WOBBLE = 1 << 20
"""Growth that says nothing, however short a loop is [bytes]."""


def states() -> Callable[[], None]:
    """States that are saved and removed."""
    _connect_with_robots()

    def cycle() -> None:
        state = p.saveState()
        p.stepSimulation()
        p.restoreState(state)
        p.removeState(state)

    return cycle


def shapes() -> Callable[[], None]:
    """Shapes that are made and removed, and bodies of them."""
    _connect_with_robots()

    def cycle() -> None:
        shape = p.createCollisionShape(p.GEOM_BOX, halfExtents=[0.1, 0.1, 0.1])
        seen = p.createVisualShape(p.GEOM_SPHERE, radius=0.1)
        body = p.createMultiBody(1.0, shape, seen, [0.0, 0.0, 3.0])
        p.stepSimulation()
        p.removeBody(body)
        p.removeCollisionShape(p.createCollisionShape(p.GEOM_SPHERE, radius=0.2))

    return cycle


def bodies() -> Callable[[], None]:
    """Robots that are loaded and removed."""
    _connect_with_robots()

    def cycle() -> None:
        body = p.loadURDF(kinds.ARM, [3.0, 0.0, 0.0])
        p.stepSimulation()
        p.getJointStates(body, range(7))
        p.removeBody(body)

    return cycle


def _connect_with_robots() -> None:
    p.connect(p.DIRECT)
    p.setGravity(*kinds.GROUND)
    p.loadURDF(kinds.PLANE)
    p.loadURDF(kinds.DROID, [0.0, 0.0, 1.0])


_WITHIN_A_WORLD = {loop.__name__: loop for loop in (states, shapes, bodies)}


def _cycle(name: str) -> Callable[[], object]:
    return _WITHIN_A_WORLD[name]() if name in _WITHIN_A_WORLD else kinds.KINDS[name]


def growth(cycle: Callable[[], object], cycles: int) -> int:
    """Bytes by which the process grows in so many cycles, after a quarter of them."""
    for _ in range(cycles // 4):
        cycle()
    before = resident_bytes()
    for _ in range(cycles):
        cycle()
    after = resident_bytes()
    if before is None or after is None:
        sys.exit("this system does not tell how much memory a process holds")
    return after - before


def run(name: str, cycles: int) -> bool:
    """Run a loop in this process, say how memory fared, and whether it stayed."""
    start = time.process_time()
    # Windows say where they are shown.
    with contextlib.redirect_stdout(io.StringIO()):
        grown = growth(_cycle(name), cycles)
    holds = grown <= max(WOBBLE, ALLOWED * 1024 * cycles)
    print(
        f"{name}: {cycles} cycles in {time.process_time() - start:.0f} s of the processor, "
        f"{grown / 1024 / cycles:.2f} KB a cycle: {'ok' if holds else 'GROWS'}",
        flush=True,
    )
    return holds


def main() -> None:
    """Run loops, each in a process of its own; the exit code tells whether memory stayed."""
    parser = argparse.ArgumentParser(description="Check that memory does not grow in loops.")
    parser.add_argument("--cycles", type=int, default=2_000)
    parser.add_argument("--loops", nargs="+", choices=LOOPS, default=LOOPS)
    arguments = parser.parse_args()
    if len(arguments.loops) == 1:
        sys.exit(0 if run(arguments.loops[0], arguments.cycles) else 1)
    own = sys.executable, "-m", "tests.memory.loops", "--cycles", str(arguments.cycles), "--loops"
    sys.exit(max([subprocess.run([*own, name], check=False).returncode for name in arguments.loops]))


if __name__ == "__main__":
    main()
