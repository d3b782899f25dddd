"""Train a policy by PPO on many environments at once, and draw its learning curve.

    python examples/train_ppo.py --env AntBulletEnv-v0 --envs 64 --steps 2_000_000

Needs `pip install 'carom[train]'`. One file, in the manner of CleanRL: everything PPO does is here.
"""

import argparse
import time
from collections import deque
from pathlib import Path

import gymnasium
import numpy as np
import torch
from gymnasium.vector import AutoresetMode
from torch import nn

import pybullet_envs  # noqa: F401  # registers the environments

GAMMA, LAMBDA, CLIP, VALUE_SHARE, LARGEST_GRADIENT = 0.99, 0.95, 0.2, 0.5, 0.5
EPOCHS, BATCH = 10, 512
RETURNS_SHOWN = 100


class Scale:
    """Mean and spread of numbers seen so far, by which others are scaled."""

    def __init__(self, shape):
        self.mean, self.variance, self.count = np.zeros(shape), np.ones(shape), 1e-4

    def learn(self, values):
        count, mean = len(values), values.mean(axis=0)
        total, off = self.count + count, mean - self.mean
        spread = self.variance * self.count + values.var(axis=0) * count
        self.variance = (spread + off**2 * self.count * count / total) / total
        self.mean, self.count = self.mean + off * count / total, total

    def __call__(self, values):
        scaled = (values - self.mean) / np.sqrt(self.variance + 1e-8)
        return torch.as_tensor(np.clip(scaled, -10.0, 10.0), dtype=torch.float32)


def layer(inputs, outputs, gain=1.414):
    made = nn.Linear(inputs, outputs)
    nn.init.orthogonal_(made.weight, gain)
    nn.init.zeros_(made.bias)
    return made


class Agent(nn.Module):
    """A policy, and what it thinks a situation is worth."""

    def __init__(self, observations, actions, width=64):
        super().__init__()
        numbers = observations.shape[0]
        self.discrete = isinstance(actions, gymnasium.spaces.Discrete)
        outputs = int(actions.n) if self.discrete else actions.shape[0]

        def network(last, gain):
            return nn.Sequential(
                layer(numbers, width), nn.Tanh(), layer(width, width), nn.Tanh(), layer(width, last, gain)
            )

        self.policy, self.value = network(outputs, 0.01), network(1, 1.0)
        self.log_spread = nn.Parameter(torch.full((outputs,), -0.5), requires_grad=not self.discrete)

    def distribution(self, observations):
        outputs = self.policy(observations)
        if self.discrete:
            return torch.distributions.Categorical(logits=outputs)
        normal = torch.distributions.Normal(outputs, self.log_spread.exp())
        return torch.distributions.Independent(normal, 1)

    def worth(self, observations):
        return self.value(observations).squeeze(-1)


def collect(env, agent, scale, observations, length, finished, rewards_scale, gamma=GAMMA):
    """Play `length` steps; episodes that end give their returns to `finished`."""
    played = {name: [] for name in ("observation", "action", "log", "value", "reward", "over")}
    for _ in range(length):
        scale.learn(observations)
        seen = scale(observations)
        with torch.no_grad():
            distribution = agent.distribution(seen)
            action = distribution.sample()
            value, log = agent.worth(seen), distribution.log_prob(action)
        observations, rewards, terminations, truncations, infos = env.step(action.numpy())
        over = terminations | truncations
        worth = rewards_scale(rewards, over, finished)
        # What was cut off would have gone on: it is worth what its last observation is.
        cut = np.flatnonzero(truncations & ~terminations)
        if len(cut):
            last = np.stack([infos["final_obs"][k] for k in cut])
            with torch.no_grad():
                worth[cut] += gamma * agent.worth(scale(last)).numpy()
        for name, values in (
            ("observation", seen),
            ("action", action),
            ("log", log),
            ("value", value),
            ("reward", torch.as_tensor(worth, dtype=torch.float32)),
            ("over", torch.as_tensor(over, dtype=torch.float32)),
        ):
            played[name].append(values)
    return observations, {name: torch.stack(values) for name, values in played.items()}


class Rewards:
    """Rewards scaled by the spread of discounted returns; keeps the true returns of episodes."""

    def __init__(self, count, gamma=GAMMA):
        self.gamma = gamma
        self.true, self.discounted, self.scale = np.zeros(count), np.zeros(count), Scale(())

    def __call__(self, rewards, over, finished):
        self.true += rewards
        self.discounted = self.gamma * self.discounted + rewards
        self.scale.learn(self.discounted)
        finished.extend(self.true[over])
        self.true[over] = self.discounted[over] = 0.0
        return np.clip(rewards / np.sqrt(self.scale.variance + 1e-8), -10.0, 10.0)


def advantages(played, last_value, gamma=GAMMA):
    """Generalised advantage estimates."""
    found, next_value, running = torch.zeros_like(played["reward"]), last_value, 0.0
    for step in reversed(range(len(found))):
        goes_on = 1.0 - played["over"][step]
        surprise = played["reward"][step] + gamma * goes_on * next_value - played["value"][step]
        running = surprise + gamma * LAMBDA * goes_on * running
        found[step], next_value = running, played["value"][step]
    return found


def improve(agent, optimiser, played, found, entropy_share, epochs=EPOCHS, batch=BATCH):
    """Some epochs of gradient steps on what was played; returns how far the policy moved (KL divergence)."""
    flat = {name: values.flatten(0, 1) for name, values in played.items()}
    gains, targets = found.flatten(), (found + played["value"]).flatten()
    moved = []
    for _ in range(epochs):
        for rows in torch.randperm(len(gains)).split(batch):
            distribution = agent.distribution(flat["observation"][rows])
            ratio = (distribution.log_prob(flat["action"][rows]) - flat["log"][rows]).exp()
            gain = gains[rows]
            gain = (gain - gain.mean()) / (gain.std() + 1e-8)
            policy_loss = -torch.min(gain * ratio, gain * ratio.clamp(1.0 - CLIP, 1.0 + CLIP)).mean()
            value_loss = 0.5 * (agent.worth(flat["observation"][rows]) - targets[rows]).square().mean()
            loss = policy_loss + VALUE_SHARE * value_loss - entropy_share * distribution.entropy().mean()
            optimiser.zero_grad()
            loss.backward()
            nn.utils.clip_grad_norm_(agent.parameters(), LARGEST_GRADIENT)
            optimiser.step()
            moved.append((ratio - 1.0 - ratio.log()).mean().item())
    return float(np.mean(moved))


def show(done, total, finished, started):
    """A progress bar."""
    filled = round(30 * done / total)
    score = f"{np.mean(finished):9.1f}" if finished else "        -"
    rate = done / (time.perf_counter() - started)
    bar = "#" * filled + "-" * (30 - filled)
    print(f"\r[{bar}] {done:>10,} steps  return {score}  {rate:8,.0f} steps/s", end="", flush=True)


def train(name, *, envs=64, steps=1_000_000, length=128, rate=3e-4, entropy=0.0, seed=0, quiet=False):
    """Train; returns the agent, the scale of its observations, and the curve as (steps, seconds, return)."""
    torch.manual_seed(seed)
    # Networks as small as these gain nothing from threads, and the worlds can use the processors.
    torch.set_num_threads(1)
    env = gymnasium.make_vec(name, num_envs=envs, autoreset_mode=AutoresetMode.SAME_STEP)
    agent = Agent(env.single_observation_space, env.single_action_space)
    optimiser = torch.optim.Adam(agent.parameters(), lr=rate, eps=1e-5)
    scale, rewards = Scale(env.single_observation_space.shape), Rewards(envs)
    finished, curve, started = deque(maxlen=RETURNS_SHOWN), [], time.perf_counter()
    observations, _ = env.reset(seed=seed)
    rounds = max(1, steps // (envs * length))
    for number in range(rounds):
        optimiser.param_groups[0]["lr"] = rate * (1.0 - number / rounds)
        observations, played = collect(env, agent, scale, observations, length, finished, rewards)
        with torch.no_grad():
            last_value = agent.worth(scale(observations))
        improve(agent, optimiser, played, advantages(played, last_value), entropy)
        done = (number + 1) * envs * length
        if finished:
            curve.append((done, time.perf_counter() - started, float(np.mean(finished))))
        if not quiet:
            show(done, rounds * envs * length, finished, started)
    env.close()
    if not quiet:
        print()
    return agent, scale, curve


def draw(curve, title, path):
    """The learning curve as a picture."""
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    steps, _, returns = zip(*curve, strict=True)
    figure, axes = pyplot.subplots(figsize=(7, 4))
    axes.plot(steps, returns)
    axes.set(xlabel="steps of environments", ylabel=f"return, mean of {RETURNS_SHOWN}", title=title)
    axes.grid(alpha=0.3)
    figure.tight_layout()
    figure.savefig(path)
    pyplot.close(figure)


def main(arguments=None):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--env", default="AntBulletEnv-v0", help="name of the environment")
    parser.add_argument("--envs", type=int, default=64, help="how many at once")
    parser.add_argument("--steps", type=int, default=1_000_000, help="steps of all environments together")
    parser.add_argument("--length", type=int, default=128, help="steps between improvements")
    parser.add_argument("--rate", type=float, default=3e-4, help="learning rate at first")
    parser.add_argument("--entropy", type=float, default=0.0, help="reward of trying things out")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--out", type=Path, default=Path("ppo-output"), help="folder of what is written")
    asked = vars(parser.parse_args(arguments))
    folder, name = asked.pop("out"), asked.pop("env")
    agent, scale, curve = train(name, **asked)
    folder.mkdir(parents=True, exist_ok=True)
    torch.save(
        {"agent": agent.state_dict(), "mean": scale.mean, "variance": scale.variance}, folder / "policy.pt"
    )
    if curve:
        draw(curve, name, folder / "learning-curve.svg")
        print(f"return {curve[-1][2]:.1f} after {curve[-1][1]:.0f} s; {folder}/learning-curve.svg")
    return curve


if __name__ == "__main__":
    main()
