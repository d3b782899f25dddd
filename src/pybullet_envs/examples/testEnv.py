"""Random actions in an environment: `python -m pybullet_envs.examples.testEnv --env AntBulletEnv-v0`."""

from __future__ import annotations

import argparse

import pybullet_envs
from pybullet_envs._gymnasium import gymnasium, require_gymnasium


def test(args: argparse.Namespace) -> None:
    """Runs `args.steps` random actions, seeded by `args.seed`, in `args.env`, and prints the rewards."""
    require_gymnasium()
    env = gymnasium.make(args.env, render_mode="human" if args.render else None)
    env.reset(seed=args.seed)
    env.action_space.seed(args.seed)
    reward, total = 0.0, 0.0
    for step in range(args.steps):
        _, reward, terminated, truncated, _ = env.step(env.action_space.sample())
        total += float(reward)
        if terminated or truncated:
            print(f"step {step}: the episode is over, return {total:.3f}")
            env.reset()
            total = 0.0
    print(f"last reward {float(reward):.6f}")
    env.close()


def main() -> None:
    """Runs the environment that the command line names."""
    parser = argparse.ArgumentParser(description="Random actions in an environment.")
    names = ", ".join(pybullet_envs.getList())
    parser.add_argument("--env", default="AntBulletEnv-v0", help=f"one of: {names}")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--render", type=int, default=0, help="1 opens a window")
    parser.add_argument("--steps", type=int, default=1000)
    test(parser.parse_args())


if __name__ == "__main__":
    main()
