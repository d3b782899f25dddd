"""One world of many islands on one thread and on several: piles of balls that move independently.

Prints the table of docs/scaling.md. Before it is measured, all numbers of threads have to give the same bits.
"""

from __future__ import annotations

import argparse
import time

import numpy as np

from carom import World

_PER_PILE = 8
_SETTLING = 120
_SECONDS = 1.0
_ROUNDS = 5


def piles(balls: int, law: str, threads: int) -> World:
    """Piles of balls on a floor, with a law of contacts."""
    world = World(gravity=(0.0, 0.0, -9.81), contact=law, threads=threads)
    world.add_plane()
    random, side = np.random.default_rng(1), int(np.ceil(np.sqrt(balls / _PER_PILE)))
    for ball in range(balls):
        pile, layer = divmod(ball, _PER_PILE)
        x, y = random.uniform(-0.12, 0.12, 2) + 3.0 * np.array([pile % side, pile // side])
        world.add_sphere(0.1, position=(x, y, 0.15 + 0.22 * layer))
    return world


def measured(balls: int, law: str, most: int) -> list[float]:
    """Wall time of a step with 1, 2... threads [s]: the median of rounds in turns."""
    worlds = [piles(balls, law, threads) for threads in range(1, most + 1)]
    for world in worlds:
        world.step(_SETTLING)
    first = worlds[0].state.position.tobytes()
    assert all(world.state.position.tobytes() == first for world in worlds), "bits depend on threads"
    start = time.perf_counter()
    worlds[0].step(3)
    count = max(1, int(3 * _SECONDS / _ROUNDS / (time.perf_counter() - start)))
    for world in worlds[1:]:
        world.step(3)
    taken: list[list[float]] = [[] for _ in worlds]
    for _ in range(_ROUNDS):
        for world, times in zip(worlds, taken, strict=True):
            start = time.perf_counter()
            world.step(count)
            times.append((time.perf_counter() - start) / count)
    return [float(np.median(times)) for times in taken]


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--threads", type=int, default=2, help="greatest number of threads")
    parser.add_argument("--balls", type=int, nargs="*", default=[100, 400, 2000, 10000], help="their numbers")
    asked = parser.parse_args()
    header = [f"{count} thread{'s' * (count > 1)}" for count in range(1, asked.threads + 1)]
    print("| a step of piles of 8 balls |", " | ".join(["contacts", *header, "threads pay"]), "|")
    print("| --- | --- |", " | ".join(["---:"] * (asked.threads + 1)), "|")
    for balls in asked.balls:
        for law, name in (("compliant", "Newton"), ("bullet", "sweeps")):
            times = measured(balls, law, asked.threads)
            shown = [f"{1e3 * seconds:.2f} ms" for seconds in times]
            print(f"| {balls:,} balls | {name} |", " | ".join([*shown, f"{times[0] / times[-1]:.2f}×"]), "|")


if __name__ == "__main__":
    main()
