"""Compare two policies on the same episodes, played on all machines of a Ray cluster or on this one alone.

    python examples/cluster_rollout.py --episodes 64

Needs `pip install 'carom[ray]'`. Nothing in it says how many machines there are: `ray.init()` finds out.
"""

import argparse
from pathlib import Path

import gymnasium
import numpy as np
import ray
from gymnasium.vector import AutoresetMode

from carom.cluster import Rollouts


def make_env(num_envs):
    import pybullet_envs  # noqa: F401  # registers the environments, on every node

    return gymnasium.make_vec(
        "CartPoleBulletEnv-v1", num_envs=num_envs, autoreset_mode=AutoresetMode.DISABLED
    )


def lean(observations):
    """Push towards the side on which the pole falls."""
    return (observations[:, 0] + observations[:, 1] > 0).astype(int)


class Guess:
    """Push anywhere: a policy that draws random numbers, from a generator of its own for each episode."""

    def __init__(self, num_envs):
        self.dice = [np.random.default_rng()] * num_envs

    def begin_episodes(self, rows, seeds):
        for row, seed in zip(rows, seeds, strict=True):
            self.dice[row] = np.random.default_rng([seed, 1])

    def __call__(self, observations):
        return np.array([die.integers(2) for die in self.dice])


def draw(returns, path):
    """Every episode under both policies."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, axes = pyplot.subplots(figsize=(7, 4))
    for name, values in returns.items():
        axes.plot(values, ".", label=name)
    axes.set(xlabel="episode", ylabel="return", yscale="log")
    axes.legend()
    figure.tight_layout()
    figure.savefig(path)
    pyplot.close(figure)


def main(arguments=None):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--episodes", type=int, default=64)
    parser.add_argument("--envs", type=int, default=16, help="environments on each node")
    parser.add_argument("--plot", type=Path, help="where to draw the returns")
    asked = parser.parse_args(arguments)

    # A cluster that runs here, or that RAY_ADDRESS names; otherwise one of this machine alone.
    ray.init(ignore_reinit_error=True)
    returns = {}
    with Rollouts(make_env, num_envs_per_node=asked.envs) as rollouts:
        for name, policy in (("lean", lean), ("guess", Guess(asked.envs))):
            found = rollouts.collect(policy, episodes=asked.episodes, first=0)
            returns[name] = found.returns
            print(f"{name}: return {found.returns.mean():.1f} in {found.step_count} steps")
            for node, count in found.report.episodes_of_nodes.items():
                print(f"    {count} episodes on {node}")
            for lost in found.report.lost_nodes:
                print(f"    lost {lost}")
    if asked.plot:
        draw(returns, asked.plot)
    return returns


if __name__ == "__main__":
    main()
