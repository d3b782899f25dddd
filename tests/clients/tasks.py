"""Plays a scripted policy of `roboverse` in one of its environments, and prints what came of each trial.

    PYTHON tests/clients/tasks.py SOURCE ASSETS TASK TRIALS

Run by `run.py` with PyBullet and with Carom; `TASK` is a `Task` of the catalogue as JSON, `SOURCE` the
repository, and `ASSETS` PyBullet's own files, for both.
"""

from __future__ import annotations

import importlib
import json
import sys
import warnings

MAX_ACTION = 0.9
"""Actions are clipped to this, as by the scripts of the repository."""


def play(task: dict, seed: int) -> tuple[bool, float]:
    """Whether a trial succeeds at its end, and the sum of its rewards."""
    import numpy as np
    from roboverse.envs import registration  # pyright: ignore[reportMissingImports]
    from roboverse.policies import policies  # pyright: ignore[reportMissingImports]

    import pybullet as p

    entry = next(spec for spec in registration.ENVIRONMENT_SPECS if spec["id"] == task["environment"])
    module, _, name = entry["entry_point"].partition(":")
    np.random.seed(seed)
    made = getattr(importlib.import_module(module), name)
    env = made(
        **{**entry["kwargs"], **task["changes"], "transpose_image": False, "observation_mode": "pixels"}
    )
    np.random.seed(seed)
    env.reset()
    policy = policies[task["policy"]](env)
    total, info = 0.0, {}
    for _ in range(task["steps"]):
        action, _ = policy.get_action()
        # Some environments have one more number, which those who imitate pad with zeros.
        action = np.append(action, np.zeros(env.action_space.shape[0] - len(action)))
        _, reward, _, info = env.step(np.clip(action, -MAX_ACTION, MAX_ACTION))
        total += float(reward)
    p.disconnect()
    return bool(info[task["success"]]), total


def main() -> None:
    source, assets, task, trials = sys.argv[1:]
    warnings.filterwarnings("ignore")
    sys.path.insert(0, source)
    import pybullet_data

    pybullet_data.getDataPath = lambda: assets
    for seed in range(int(trials)):
        print("trial", json.dumps(play(json.loads(task), seed)), flush=True)


if __name__ == "__main__":
    main()
