"""Teach a quadruped to follow velocity commands on random terrain, by PPO; draw its learning curve.

    python examples/train_quadruped.py --out quadruped-output

Needs `pip install 'carom[train]'`. Run again with the same folder, it continues where it was. PPO itself is
in `train_ppo.py`.
"""

import argparse
import csv
import os
import time
from collections import deque
from pathlib import Path

import numpy as np
import torch
from train_ppo import Agent, Rewards, advantages, collect, improve, show

from carom.vector.quadruped.quadruped import Quadruped

EPISODE = 500
GAMMA, EPOCHS, BATCH, WIDTH, ENTROPY = 0.97, 5, 1536, 128, 0.002
RATE, MIN_RATE, MAX_RATE = 5e-4, 1e-5, 1e-3
WANTED_MOVE = 0.01
"""KL divergence of an improvement, to which the learning rate is adapted."""
EVERY = 20
"""Rounds between two checkpoints."""
POINTS = 400
"""Most points of a drawn line."""
COLUMNS = (
    "steps", "wall_seconds", "cpu_seconds", "return", "episode_seconds", "falls_per_minute",
    "velocity_error", "turn_error", "level", "move", "rate", "spread",
)  # fmt: skip


class Unscaled:
    """Observations as they are: the task scales them, and noise on what never changes stays small."""

    def learn(self, values):
        pass

    def __call__(self, values):
        return torch.as_tensor(values, dtype=torch.float32)


class Watched:
    """The environment; notes how well the robots do."""

    def __init__(self, env):
        self.env = env
        self.single_observation_space = env.single_observation_space
        self.lengths = deque(maxlen=400)
        self.forget()

    def forget(self):
        self.errors, self.turn_errors, self.falls, self.steps = [], [], 0, 0

    def step(self, actions):
        told = self.env.step(actions)
        env, over = self.env, told[2] | told[3]
        # Those that have just begun stand still, whatever is commanded.
        going = ~over
        off = env.velocities[going, :2] - env.commands["velocity"][going, :2]
        self.errors.append(np.sqrt(np.square(off).sum(axis=1)).mean())
        self.turn_errors.append(np.abs(env.rates[going, 2] - env.commands["velocity"][going, 2]).mean())
        self.falls += int(told[2].sum())
        self.steps += len(over)
        return told


class Learner:
    """Everything that learns, and what it takes to continue."""

    def __init__(self, folder, envs, seed):
        torch.manual_seed(seed)
        torch.set_num_threads(1)
        self.folder = folder
        self.env = Quadruped(envs, max_episode_steps=EPISODE, autoreset_mode="SameStep")
        self.watched = Watched(self.env)
        spaces = self.env.single_observation_space, self.env.single_action_space
        self.agent = Agent(*spaces, width=WIDTH)
        self.optimiser = torch.optim.Adam(self.agent.parameters(), lr=RATE, eps=1e-5)
        self.scale, self.rewards = Unscaled(), Rewards(envs, GAMMA)
        self.finished = deque(maxlen=400)
        self.steps, self.wall, self.cpu = 0, 0.0, 0.0
        self.observations, _ = self.env.reset(seed=seed)
        # Episodes end at different times from the beginning.
        self.env.episode_steps[:] = np.random.default_rng(seed).integers(0, EPISODE, envs)
        self.rows = []
        if (folder / "learner.pt").exists():
            self.load()

    def save(self):
        """Write the state of the worlds, then that of the learner, which names it."""
        name = f"worlds-{self.steps}.npz"
        self.env.save(self.folder / name)
        content = {
            "worlds": name,
            "steps": self.steps,
            "wall": self.wall,
            "cpu": self.cpu,
            "agent": self.agent.state_dict(),
            "optimiser": self.optimiser.state_dict(),
            "random": torch.get_rng_state(),
            "scale": tensors(self.rewards.scale),
            "true": torch.as_tensor(self.rewards.true),
            "discounted": torch.as_tensor(self.rewards.discounted),
            "finished": [float(value) for value in self.finished],
            "observations": torch.as_tensor(self.observations),
        }
        torch.save(content, self.folder / "learner.new")
        os.replace(self.folder / "learner.new", self.folder / "learner.pt")
        for old in self.folder.glob("worlds-*.npz"):
            if old.name != name:
                old.unlink()
        write_rows(self.folder / "learning-curve.csv", self.rows)

    def load(self):
        content = torch.load(self.folder / "learner.pt", weights_only=True)
        self.env.restore(self.folder / content["worlds"])
        self.steps, self.wall, self.cpu = content["steps"], content["wall"], content["cpu"]
        self.agent.load_state_dict(content["agent"])
        self.optimiser.load_state_dict(content["optimiser"])
        torch.set_rng_state(content["random"])
        mean, variance, count = content["scale"]
        scale = self.rewards.scale
        scale.mean, scale.variance, scale.count = mean.numpy(), variance.numpy(), float(count)
        self.rewards.true[:], self.rewards.discounted[:] = content["true"], content["discounted"]
        self.finished.extend(content["finished"])
        self.observations = content["observations"].numpy()
        self.rows = [row for row in read_rows(self.folder / "learning-curve.csv") if row[0] <= self.steps]

    def round(self, length):
        """Play, improve, and note a row of the curve."""
        wall, cpu = time.perf_counter(), time.process_time()
        self.watched.forget()
        learned = self.agent, self.scale
        self.observations, played = collect(
            self.watched, *learned, self.observations, length, self.finished, self.rewards, GAMMA
        )
        with torch.no_grad():
            last_value = self.agent.worth(self.scale(self.observations))
        found = advantages(played, last_value, GAMMA)
        move = improve(self.agent, self.optimiser, played, found, ENTROPY, EPOCHS, BATCH)
        self.adapt_rate(move)
        self.steps += self.watched.steps
        self.wall += time.perf_counter() - wall
        self.cpu += time.process_time() - cpu
        seconds = self.watched.steps * self.env.duration
        self.rows.append((
            self.steps, self.wall, self.cpu,
            float(np.mean(self.finished)) if self.finished else float("nan"),
            seconds / max(1, int(played["over"].sum())),
            60.0 * self.watched.falls / seconds,
            float(np.mean(self.watched.errors)), float(np.mean(self.watched.turn_errors)),
            float(self.env.levels.mean()), move, self.optimiser.param_groups[0]["lr"],
            float(self.agent.log_spread.detach().exp().mean()),
        ))  # fmt: skip

    def adapt_rate(self, move):
        rate = self.optimiser.param_groups[0]["lr"]
        if move > 2.0 * WANTED_MOVE:
            rate /= 1.5
        elif move < 0.5 * WANTED_MOVE:
            rate *= 1.2
        self.optimiser.param_groups[0]["lr"] = min(max(rate, MIN_RATE), MAX_RATE)


def tensors(scale):
    """What a scale has learned, with all its digits."""
    return [torch.as_tensor(part, dtype=torch.float64) for part in (scale.mean, scale.variance, scale.count)]


def write_rows(path, rows):
    with path.open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(COLUMNS)
        writer.writerows([[row[0], *(f"{value:.6g}" for value in row[1:])] for row in rows])


def read_rows(path):
    with path.open(newline="") as file:
        return [(int(row[0]), *map(float, row[1:])) for row in list(csv.reader(file))[1:]]


def smoothed(values, share=0.02):
    """Running means over a share of the curve."""
    width = max(1, round(share * len(values)))
    sums = np.cumsum(np.concatenate([[0.0], np.nan_to_num(values)]))
    ends = np.arange(1, len(values) + 1)
    starts = np.maximum(0, ends - width)
    return (sums[ends] - sums[starts]) / (ends - starts)


def draw(rows, path):
    """The learning curve as a picture: return, error of velocity, level of the terrain."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    columns = dict(zip(COLUMNS, np.array(rows).T, strict=True))
    millions = columns["steps"] / 1e6
    shown = np.unique(np.linspace(0, len(rows) - 1, POINTS).astype(int))
    figure, axes = pyplot.subplots(1, 3, figsize=(10, 3.2))
    for part, name, label in (
        (axes[0], "return", "return of an episode"),
        (axes[1], "velocity_error", "error of velocity [m/s]"),
        (axes[2], "level", "level of the terrain"),
    ):
        part.plot(millions[shown], smoothed(columns[name])[shown])
        lowest = min(0.0, np.nan_to_num(columns[name]).min())
        part.set(xlabel="million steps", ylabel=label, ylim=(lowest, None))
        part.grid(alpha=0.3)
    minutes = columns["cpu_seconds"][-1] / 60.0
    figure.suptitle(f"A1 follows velocities on random terrain: {minutes:.0f} minutes of processor time")
    figure.tight_layout()
    figure.savefig(path)
    pyplot.close(figure)


def train(folder, *, envs=256, steps=16_000_000, length=24, seed=0, quiet=False):
    """Train, or continue; returns the rows of the curve."""
    folder.mkdir(parents=True, exist_ok=True)
    learner = Learner(folder, envs, seed)
    begun, started = learner.steps, time.perf_counter()
    rounds = 0
    while learner.steps < steps:
        learner.round(length)
        rounds += 1
        if rounds % EVERY == 0 or learner.steps >= steps:
            learner.save()
        if not quiet:
            show(learner.steps - begun, steps - begun, learner.finished, started)
    return learner.rows


def main(arguments=None):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--envs", type=int, default=256, help="how many at once")
    parser.add_argument("--steps", type=int, default=16_000_000, help="steps of all environments together")
    parser.add_argument("--length", type=int, default=24, help="steps between improvements")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--quiet", action="store_true", help="no progress bar")
    parser.add_argument("--draw", action="store_true", help="only draw the curve of the folder")
    parser.add_argument(
        "--out", type=Path, default=Path("quadruped-output"), help="folder of what is written"
    )
    asked = vars(parser.parse_args(arguments))
    folder, only_draw = asked.pop("out"), asked.pop("draw")
    rows = read_rows(folder / "learning-curve.csv") if only_draw else train(folder, **asked)
    draw(rows, folder / "learning-curve.svg")
    print(f"\n{folder}/learning-curve.svg: return {rows[-1][3]:.1f} after {rows[-1][0]:,} steps")
    return rows


if __name__ == "__main__":
    main()
