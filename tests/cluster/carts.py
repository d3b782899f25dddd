"""Carts with poles in Carom's worlds, and policies for them; nodes import this too."""

import time
from pathlib import Path

import gymnasium
import numpy as np
import ray  # pyright: ignore[reportMissingImports]
from gymnasium.vector import AutoresetMode, VectorEnv

import pybullet_envs  # noqa: F401  # registers the environments

ENVS, SEED, EPISODES = 4, 7, 40


def make_env(count: int) -> VectorEnv:
    disabled = AutoresetMode.DISABLED
    return gymnasium.make_vec("CartPoleBulletEnv-v1", num_envs=count, autoreset_mode=disabled, threads=1)


def lean(observations: np.ndarray) -> np.ndarray:
    return (observations[:, 0] + observations[:, 1] > 0).astype(int)


class Diary:
    """A policy that takes its time, and writes down on which node it is asked."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder

    def __call__(self, observations: np.ndarray) -> np.ndarray:
        with (self.folder / ray.get_runtime_context().get_node_id()).open("a") as page:
            page.write("x")
        time.sleep(0.01)
        return lean(observations)
