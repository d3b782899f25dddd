"""Environment steps a second of EnvPool's Ant, which is MuJoCo's: another robot, with as many joints.

python benchmarks/environments_envpool.py 64 2 2.0     # environments, threads, seconds
"""

from __future__ import annotations

import sys
import time

import envpool  # pyright: ignore[reportMissingImports]
import numpy as np

SEED = 1
ROUNDS = 64


def main() -> None:
    """Print environment steps a second of random actions."""
    count, threads, seconds = int(sys.argv[1]), int(sys.argv[2]), float(sys.argv[3])
    env = envpool.make_gymnasium("Ant-v4", num_envs=count, num_threads=threads, seed=SEED)
    env.reset()
    random = np.random.default_rng(SEED)
    actions = random.uniform(-1.0, 1.0, (ROUNDS, count, *env.action_space.shape))
    env.step(actions[0])
    start, rounds = time.perf_counter(), 0
    while time.perf_counter() - start < seconds:
        env.step(actions[rounds % ROUNDS])
        rounds += 1
    print(rounds * count / (time.perf_counter() - start))


if __name__ == "__main__":
    main()
