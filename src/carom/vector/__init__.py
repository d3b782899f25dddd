"""Vector environments for reinforcement learning: Gymnasium's vector interface over `carom.Worlds`.

Importing this package registers Carom's own tasks with Gymnasium.
"""

from __future__ import annotations

try:
    import gymnasium
except ImportError as missing:
    raise ImportError(
        "carom.vector needs Gymnasium; install it with: pip install 'carom[envs]'", name="gymnasium"
    ) from missing

from carom.vector.single import SingleEnv
from carom.vector.worlds_env import WorldsEnv

__all__ = ["SingleEnv", "WorldsEnv"]

# Name, class in carom.vector.panda, steps of an episode.
_TASKS = (
    ("carom/PandaReach-v0", "PandaReach", 100),
    ("carom/PandaPush-v0", "PandaPush", 150),
    ("carom/PandaPick-v0", "PandaPick", 150),
)

for _name, _task, _steps in _TASKS:
    if _name not in gymnasium.registry:
        gymnasium.register(
            _name,
            entry_point=f"carom.vector.panda:single_{_task}",
            vector_entry_point=f"carom.vector.panda:{_task}",
            max_episode_steps=_steps,
        )
