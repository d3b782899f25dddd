"""How long PPO takes to a score: Stable-Baselines3's on Carom's environments or on real PyBullet's.

    python benchmarks/time_to_score.py carom AntBulletEnv-v0 2000 curve.csv
    .learning/bin/python benchmarks/time_to_score.py pybullet AntBulletEnv-v0 2000 curve.csv

Both train with the same hyperparameters and the same seed on as many environments; PyBullet has a process for
each. It ends when the mean return of the last hundred episodes is at least the score, or after `--steps`. The
curve has a line for each update: seconds, environment steps, mean return.
"""

from __future__ import annotations

import argparse
import csv
import time
from pathlib import Path
from typing import Any

import torch
from stable_baselines3 import PPO
from stable_baselines3.common.callbacks import BaseCallback
from stable_baselines3.common.vec_env import VecMonitor, VecNormalize

COUNT = 16
THREADS = 2
# Those of RL Baselines3 Zoo for these environments, but larger batches at a higher rate, and half or a
# quarter of the epochs: learning costs both engines the same, and should not hide what is compared.
HYPERPARAMETERS: dict[str, Any] = {
    "n_steps": 512,
    "batch_size": 1024,
    "n_epochs": 10,
    "gamma": 0.99,
    "gae_lambda": 0.92,
    "learning_rate": 2e-4,
    "clip_range": 0.4,
    "max_grad_norm": 0.5,
    "use_sde": True,
    "sde_sample_freq": 4,
    "policy_kwargs": {
        "log_std_init": -2.0,
        "ortho_init": False,
        "activation_fn": torch.nn.ReLU,
        "net_arch": [256, 256],
    },
}
OWN: dict[str, dict[str, Any]] = {"HopperBulletEnv-v0": {"n_epochs": 5, "learning_rate": 3e-4}}
EPISODES = 100


def environments(engine: str, name: str) -> Any:
    """Sixteen environments of an engine."""
    if engine == "pybullet":
        from environments_pybullet import many
    else:
        from environments import many
    return many(name, COUNT)


class Score(BaseCallback):
    """Writes the learning curve, and ends training at a score."""

    def __init__(self, wanted: float, curve: Path) -> None:
        super().__init__()
        self.wanted, self.curve = wanted, curve
        self.rows: list[tuple[float, int, float]] = []
        self.start = time.perf_counter()

    @property
    def reached(self) -> bool:
        """Whether the score has been reached."""
        return bool(self.rows) and self.rows[-1][2] >= self.wanted

    def _on_rollout_start(self) -> None:
        returns = [episode["r"] for episode in self.model.ep_info_buffer or ()]
        if len(returns) < EPISODES:
            return
        mean = sum(returns) / len(returns)
        self.rows.append((time.perf_counter() - self.start, self.num_timesteps, mean))
        with open(self.curve, "w", newline="", encoding="utf-8") as file:
            csv.writer(file).writerows([("seconds", "steps", "mean_return"), *self.rows])

    def _on_step(self) -> bool:
        return not self.reached


def main() -> None:
    """Train, and print how long it took."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("engine", choices=["carom", "pybullet"])
    parser.add_argument("env")
    parser.add_argument("score", type=float)
    parser.add_argument("curve", type=Path)
    parser.add_argument("--steps", type=int, default=4_000_000)
    parser.add_argument("--seed", type=int, default=1)
    asked = parser.parse_args()
    torch.set_num_threads(THREADS)
    env = VecNormalize(VecMonitor(environments(asked.engine, asked.env)))
    score = Score(asked.score, asked.curve)
    hyperparameters = HYPERPARAMETERS | OWN.get(asked.env, {})
    PPO("MlpPolicy", env, seed=asked.seed, device="cpu", **hyperparameters).learn(asked.steps, callback=score)
    seconds, steps, mean = score.rows[-1]
    said = "reached" if score.reached else "not reached"
    print(f"{asked.env}, {asked.engine}: {said}: {mean:.0f} after {seconds:.0f} s and {steps:,} steps")
    env.close()


if __name__ == "__main__":
    main()
