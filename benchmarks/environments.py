"""Environment steps a second of many environments for learning, beside those of others on the same cores.

    python benchmarks/environments.py [--learning .learning/bin/python] [--envpool .envpool/bin/python]

`make learning` sets up what the others need: real PyBullet under Stable-Baselines3's `SubprocVecEnv`, and
EnvPool. The engines take turns, and a figure is the median over the turns; `SubprocVecEnv` is given the
number of processes with which it is quickest.
"""

from __future__ import annotations

import argparse
import os
import statistics
import subprocess
from collections import defaultdict
from pathlib import Path

import gymnasium
from environments_pybullet import steps_per_second
from gymnasium.vector import AutoresetMode
from run import put_between_marks

import pybullet_envs  # noqa: F401  # registers the environments
from carom.vector.stable_baselines import StableBaselinesEnv

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent
NAMES = ("AntBulletEnv-v0", "HopperBulletEnv-v0")
COUNT = 64
PROCESSES = (2, 4, 8)
WANTED = 8.0
MARKS = ("<!-- environments -->", "<!-- end of environments -->")


def many(name: str, count: int) -> StableBaselinesEnv:
    """So many environments of ours, as Stable-Baselines3 has them."""
    env = gymnasium.make_vec(name, num_envs=count, autoreset_mode=AutoresetMode.SAME_STEP)
    return StableBaselinesEnv(env)


def elsewhere(interpreter: Path, script: str, *arguments: object) -> float:
    """What a script prints that another interpreter runs."""
    command = [str(interpreter), str(HERE / script), *map(str, arguments)]
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    found = subprocess.run(command, cwd=HERE, env=environment, text=True, check=True, stdout=subprocess.PIPE)
    return float(found.stdout.split()[-1])


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--learning", type=Path, default=ROOT / ".learning" / "bin" / "python")
    parser.add_argument("--envpool", type=Path, default=ROOT / ".envpool" / "bin" / "python")
    parser.add_argument("--turns", type=int, default=3)
    parser.add_argument("--seconds", type=float, default=4.0)
    parser.add_argument("--page", type=Path, help="put the table into this page, between its marks, as well")
    asked = parser.parse_args()
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    samples: dict[tuple[str, str], list[float]] = defaultdict(list)
    for _ in range(asked.turns):
        for name in NAMES:
            samples[name, "ours"].append(steps_per_second(many(name, COUNT), COUNT, asked.seconds))
            for count in PROCESSES:
                rate = elsewhere(
                    asked.learning.absolute(), "environments_pybullet.py", name, count, asked.seconds
                )
                samples[name, f"{count} processes"].append(rate)
        rate = elsewhere(asked.envpool.absolute(), "environments_envpool.py", COUNT, cores, asked.seconds)
        samples[NAMES[0], "EnvPool"].append(rate)
    figures = table({key: statistics.median(values) for key, values in samples.items()}, cores)
    print(figures)
    if asked.page:
        put_between_marks(asked.page, figures, MARKS)


def table(rates: dict[tuple[str, str], float], cores: int) -> str:
    """Environment steps a second as a Markdown table."""
    lines = [
        f"| environment steps per second, {cores} cores | Carom, {COUNT} at once | PyBullet, SubprocVecEnv | "
        "Carom : PyBullet | wanted | EnvPool's Ant (MuJoCo) |",
        "| --- | ---: | ---: | ---: | ---: | ---: |",
    ]
    for name in NAMES:
        count = max(PROCESSES, key=lambda count: rates[name, f"{count} processes"])
        ours, theirs = rates[name, "ours"], rates[name, f"{count} processes"]
        others = rates.get((name, "EnvPool"))
        cells = [name, f"{ours:,.0f}", f"{theirs:,.0f} ({count} processes)", f"{ours / theirs:.1f}×"]
        cells += [f"≥ {WANTED:g}×" if others is not None else "", "–" if others is None else f"{others:,.0f}"]
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines)


if __name__ == "__main__":
    main()
