"""Loops whose memory must not grow: connections, worlds, environments, states, shapes, bodies come and go.

.venv/bin/python -m tests.memory.loops [--cycles N] [--loops NAME...]

For each loop it says by how many kilobytes the process grows in a cycle. The first half fills caches; the
second half is measured in ten parts, and their median counts: what is taken once makes one of them larger,
and what leaks makes all of them larger.
"""

from __future__ import annotations

import argparse
import contextlib
import gc
import io
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import dataclass
from itertools import pairwise

from tests.conformance.memory import resident_bytes
from tests.memory import LOOPS, kinds

import pybullet as p

ALLOWED = 1.0
"""Growth [KB per cycle]. The loop `shapes` keeps two shapes a cycle, as PyBullet does."""
ONCE = 512.0
"""What the allocators may take at once in the second half of a loop [KB]."""
PARTS = 10
"""Parts of the second half."""


@dataclass(frozen=True)
class Growth:
    """How the memory of the process has grown in the second half of a loop.

    Attributes:
        cycles: The number of cycles in each part.
        parts: Growth in each part [KB].
    """

    cycles: int
    parts: tuple[float, ...]

    @property
    def rate(self) -> float:
        """Growth in a usual part [KB per cycle]."""
        return statistics.median(self.parts) / self.cycles

    @property
    def holds(self) -> bool:
        """Whether memory stays: neither does each part take some, nor one part very much."""
        allowed = ALLOWED * self.cycles * len(self.parts)
        return self.rate <= ALLOWED and sum(self.parts) <= allowed + ONCE


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


def growth(
    cycle: Callable[[], object], cycles: int, measured: Callable[[], int | None] = resident_bytes
) -> Growth:
    """How memory grows in the second half of so many cycles, at least twenty; `measured` tells its bytes."""
    size = max(cycles // (2 * PARTS), 1)
    for _ in range(max(cycles - size * PARTS, 0)):
        cycle()
    held = [_kilobytes(measured)]
    for _ in range(PARTS):
        for _ in range(size):
            cycle()
        held.append(_kilobytes(measured))
    return Growth(size, tuple(after - before for before, after in pairwise(held)))


def _kilobytes(measured: Callable[[], int | None]) -> float:
    gc.collect()
    held = measured()
    if held is None:
        sys.exit("this system does not tell how much memory a process holds")
    return held / 1024


def run(name: str, cycles: int) -> bool:
    """Run a loop in this process, say how memory fared, and whether it stayed."""
    start = time.process_time()
    # Windows say where they are shown.
    with contextlib.redirect_stdout(io.StringIO()):
        grown = growth(_cycle(name), cycles)
    print(
        f"{name}: {cycles} cycles in {time.process_time() - start:.0f} s of the processor, "
        f"{grown.rate:.2f} KB a cycle, {sum(grown.parts):.0f} KB in the second half: "
        f"{'ok' if grown.holds else 'GROWS'}",
        flush=True,
    )
    return grown.holds


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
