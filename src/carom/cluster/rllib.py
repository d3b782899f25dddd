"""Training with RLlib on vector environments, one in each environment runner."""

from __future__ import annotations

from typing import Any, TypeVar

from gymnasium.vector import AutoresetMode, VectorEnv

try:
    from ray.rllib.algorithms.algorithm_config import AlgorithmConfig  # pyright: ignore[reportMissingImports]
    from ray.tune.registry import register_env  # pyright: ignore[reportMissingImports]
except ImportError as missing:
    raise ImportError(
        "carom.cluster.rllib needs RLlib; install it with: pip install 'ray[rllib]' torch", name=missing.name
    ) from missing

from carom.cluster.nodes import MakeEnv

Config = TypeVar("Config", bound=AlgorithmConfig)

_NAME = "carom"


def train_on(config: Config, make_env: MakeEnv, num_envs_per_runner: int, *, name: str = _NAME) -> Config:
    """Let an algorithm of RLlib train on a vector environment.

    RLlib's runners are spread over the nodes. If a node is lost, RLlib samples again, as set by
    `config.fault_tolerance(...)`; its episodes have no ids.

    Args:
        config: The algorithm's settings, of the new API stack. `env_runners(num_env_runners=...)` sets the
            number of runners, for example one for each node, since each uses all CPUs it is given.
        make_env: Makes a vector environment with a given number of environments. It has to reset the
            environments of ended episodes at the next step, as is Gymnasium's default
            (`AutoresetMode.NEXT_STEP`).
        num_envs_per_runner: Number of environments of each runner.
        name: Name under which RLlib registers the environment.

    Returns:
        `config`, changed.
    """

    def made(context: Any) -> VectorEnv:
        env = make_env(context.get("num_envs", num_envs_per_runner))
        mode = env.metadata.get("autoreset_mode")
        if mode != AutoresetMode.NEXT_STEP:
            raise ValueError(
                "RLlib needs environments that are reset by the step after an episode: make the environment "
                f"with autoreset_mode=AutoresetMode.NEXT_STEP, not {mode}"
            )
        return env

    register_env(name, made)
    config.environment(name)
    config.env_runners(
        num_envs_per_env_runner=num_envs_per_runner, gym_env_vectorize_mode="vector_entry_point"
    )
    config.resources(placement_strategy="SPREAD")
    return config
