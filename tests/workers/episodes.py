"""Workers of reinforcement learning: `python -m tests.workers.episodes --workers 8 --episodes 10000`.

Each is a process of its own, forked from one that has a world already, or spawned, and plays the same
episodes in an environment of its own, which it closes and makes anew now and then. All see the same bits as a
process that is alone, and none grows.
"""

from __future__ import annotations

import argparse
import gc
import importlib
import multiprocessing
import sys
import time
import warnings
from dataclasses import dataclass
from hashlib import sha256
from pathlib import Path
from typing import Any

import numpy as np

ENVIRONMENT = "HopperBulletEnv-v0"
METHODS = ("fork", "spawn") if sys.platform != "win32" else ("spawn",)
MAX_GROWTH = 4_000_000
"""The resident size wobbles by what the allocators hold back [bytes]."""
_STEPS = 10
_LASTS = 250
"""Episodes after which an environment is closed and another made."""


@dataclass(frozen=True)
class Played:
    """What a worker saw.

    Attributes:
        digest: Of all observations and rewards.
        growth: By how much its memory grew after its first fifth [bytes]; 0 where it cannot be known.
        files: How many more files are open in the end than after that.
    """

    digest: str
    growth: int
    files: int


def play(episodes: int) -> Played:
    """Plays so many episodes, seeded by their numbers."""
    digest, environment = sha256(), _make()
    before = _resident(), _open_files()
    for number in range(episodes):
        if number % _LASTS == _LASTS - 1:
            environment.close()
            environment = _make()
        if number == episodes // 5:
            before = _resident(), _open_files()
        observation, _ = environment.reset(seed=number)
        digest.update(np.asarray(observation).tobytes())
        random = np.random.default_rng(number)
        for _ in range(_STEPS):
            observation, reward, *_ = environment.step(
                random.uniform(-1.0, 1.0, environment.action_space.shape)
            )
            digest.update(np.asarray(observation).tobytes())
            digest.update(np.float64(reward).tobytes())
    after = _resident(), _open_files()
    environment.close()
    return Played(digest.hexdigest(), after[0] - before[0], after[1] - before[1])


def play_beside(method: str, workers: int, episodes: int) -> list[Played]:
    """The same in so many processes at once, while this one holds an environment, too."""
    # That forking with threads is dangerous is what is tested.
    warnings.simplefilter("ignore", DeprecationWarning)
    held = _make()
    held.reset(seed=0)
    held.step(np.zeros(held.action_space.shape))
    context = multiprocessing.get_context(method)
    with context.Pool(workers) as pool:
        played = pool.map(play, [episodes] * workers, chunksize=1)
    held.step(np.zeros(held.action_space.shape))
    held.close()
    return played


def _make() -> Any:
    importlib.import_module("pybullet_envs")
    return importlib.import_module("gymnasium").make(ENVIRONMENT)


def _resident() -> int:
    # What closed environments leave is in circles, and may wait long.
    gc.collect()
    try:
        pages = int(Path("/proc/self/statm").read_text().split()[1])
    except OSError:
        return 0
    return pages * 4096


def _open_files() -> int:
    try:
        return len(list(Path("/proc/self/fd").iterdir()))
    except OSError:
        return 0


def main() -> None:
    """Plays alone and beside others; the exit code tells whether all saw the same and none grew."""
    parser = argparse.ArgumentParser(description="Workers of reinforcement learning, forked and spawned.")
    parser.add_argument("--workers", type=int, default=8)
    parser.add_argument("--episodes", type=int, default=10_000)
    parser.add_argument("--methods", nargs="*", default=METHODS)
    asked = parser.parse_args()
    alone = play(asked.episodes)
    print(f"alone: {alone}", flush=True)
    holds = alone.growth <= MAX_GROWTH
    for method in asked.methods:
        start = time.perf_counter()
        played = play_beside(method, asked.workers, asked.episodes)
        same = all(it.digest == alone.digest for it in played)
        growth = max(it.growth for it in played)
        files = max(it.files for it in played)
        holds = holds and same and growth <= MAX_GROWTH and files <= 0
        print(
            f"{method}: {asked.workers} workers, {asked.episodes} episodes each in "
            f"{time.perf_counter() - start:.0f} s: {'the same bits' if same else 'OTHER BITS'}, "
            f"memory {growth / 1024:+.0f} KiB, open files {files:+d}",
            flush=True,
        )
    sys.exit(0 if holds else 1)


if __name__ == "__main__":
    main()
