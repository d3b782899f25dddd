"""What rollouts on a cluster cost besides the simulation: python -m benchmarks.cluster. Needs Ray.

The nodes are processes of this machine. Their environment has no physics and hardly takes any time: measured
is the way of batches, results and weights through Ray and through the process that collects.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from typing import Any

import gymnasium
import numpy as np
import ray  # pyright: ignore[reportMissingImports]
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space
from ray.cluster_utils import Cluster  # pyright: ignore[reportMissingImports]

from carom.cluster import Episode, Rollouts

ENVS = 64
STEPS = 1000
NUMBERS = 20
"""Numbers of an observation: an episode is 1,000 steps of 20 numbers, 160 kB, and a batch 10 MB."""
STORE = 400_000_000
ATTEMPTS = 4
MEGABYTE = 1e6


class Blank(VectorEnv[np.ndarray, np.ndarray, np.ndarray]):
    """Observations of zeros for a number of steps."""

    def __init__(self, num_envs: int, steps: int) -> None:
        self.num_envs = num_envs
        endless = np.full(NUMBERS, np.inf)
        self.single_observation_space = gymnasium.spaces.Box(-endless, endless, dtype=np.float64)
        self.single_action_space = gymnasium.spaces.Box(-1.0, 1.0, (1,), np.float64)
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self.metadata = {"autoreset_mode": AutoresetMode.DISABLED}
        self._seen, self._rewards = np.zeros((num_envs, NUMBERS)), np.ones(num_envs)
        self._never = np.zeros(num_envs, dtype=bool)
        self._steps, self._longest = 0, steps

    def reset(self, *, seed: Any = None, options: Any = None) -> tuple[np.ndarray, dict[str, Any]]:
        """Begin all episodes."""
        self._steps = 0
        return self._seen, {}

    def step(self, actions: Any) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, dict[str, Any]]:
        """All episodes end with the same step."""
        self._steps += 1
        over = np.full(self.num_envs, self._steps >= self._longest)
        return self._seen, self._rewards, over, self._never, {}


class Weights:
    """A policy with so many bytes."""

    def __init__(self, size: int) -> None:
        self.weights = np.zeros(size, np.uint8)

    def __call__(self, observations: np.ndarray) -> np.ndarray:
        """No action."""
        return np.zeros((len(observations), 1))


def total(episodes: list[Episode]) -> np.ndarray:
    """A sum over all steps, as small as a policy's statistics."""
    return sum((episode.observations.sum(axis=0) for episode in episodes), np.zeros(NUMBERS))


def timed(run: Callable[[], Any]) -> tuple[float, float]:
    """Seconds that pass, and seconds of this process, after one run that does not count."""
    run()
    wall, own = time.perf_counter(), time.process_time()
    run()
    return time.perf_counter() - wall, time.process_time() - own


def rollouts(steps: int) -> Rollouts:
    """Rollouts of blank episodes on all nodes."""
    return Rollouts(lambda count: Blank(count, steps), ENVS, batch_size=ENVS)


def measure(nodes: int) -> None:
    """Measure with so many nodes, and print a line for each thing."""
    began = time.perf_counter()
    with rollouts(1) as short:
        short.reduce(Weights(0), total, episodes=ENVS * nodes)
        print(f"{nodes} nodes: {time.perf_counter() - began:.1f} s until the first values are there")
        batches = 50 * nodes
        wall, own = timed(lambda: short.reduce(Weights(0), total, episodes=ENVS * batches))
        print(
            f"  a batch of one step, reduced: {wall / batches * 1e3:.2f} ms, "
            f"of it here {own / batches * 1e3:.2f} ms"
        )
        base, _ = timed(lambda: short.reduce(Weights(0), total, episodes=ENVS * nodes))
        for size in (1, 10, 100):
            wall, _ = timed(
                lambda size=size: short.reduce(Weights(size * 1_000_000), total, episodes=ENVS * nodes)
            )
            print(f"  weights of {size} MB: {(wall - base) * 1e3:.0f} ms more for a batch on each node")
    with rollouts(STEPS) as long:
        batches = 3 * nodes
        for name, run in (
            ("collected", lambda: long.collect(Weights(0), episodes=ENVS * batches)),
            ("reduced", lambda: long.reduce(Weights(0), total, episodes=ENVS * batches)),
        ):
            wall, own = timed(run)
            size = ENVS * STEPS * (NUMBERS + 2) * 8 / MEGABYTE if name == "collected" else 0.0
            print(
                f"  a batch of {STEPS} steps, {name}: {wall / batches * 1e3:.0f} ms, of it here "
                f"{own / batches * 1e3:.2f} ms, {size:.1f} MB"
            )


def add_node(cluster: Any) -> None:
    """Another node; on a busy machine Ray's processes give each other up too soon."""
    for attempt in range(ATTEMPTS):
        try:
            cluster.add_node(num_cpus=1, object_store_memory=STORE, include_dashboard=False)
        except Exception:
            if attempt == ATTEMPTS - 1:
                raise
        else:
            return


def main() -> None:
    """Measure with one node, and with more."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--nodes", type=int, nargs="+", default=[1, 2, 4])
    for nodes in parser.parse_args().nodes:
        cluster = Cluster()
        for _ in range(nodes):
            add_node(cluster)
        ray.init(address=cluster.address, log_to_driver=False)
        measure(nodes)
        ray.shutdown()
        cluster.shutdown()


if __name__ == "__main__":
    main()
