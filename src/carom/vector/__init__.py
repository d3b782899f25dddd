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

from carom.vector.scene_env import SceneEnv
from carom.vector.single import SingleEnv
from carom.vector.worlds_env import WorldsEnv
from carom.vector.wrapped import restore, save

__all__ = ["SceneEnv", "SingleEnv", "WorldsEnv", "restore", "save"]

# Name, module in carom.vector, class in it, steps of an episode.
_TASKS = (
    ("carom/PandaReach-v0", "panda", "PandaReach", 100),
    ("carom/PandaPush-v0", "panda", "PandaPush", 150),
    ("carom/PandaPick-v0", "panda", "PandaPick", 150),
    ("carom/QuadrupedWalk-v0", "quadruped.quadruped", "Quadruped", 500),
)

for _name, _module, _task, _steps in _TASKS:
    if _name not in gymnasium.registry:
        gymnasium.register(
            _name,
            entry_point=f"carom.vector.{_module}:single_{_task}",
            vector_entry_point=f"carom.vector.{_module}:{_task}",
            max_episode_steps=_steps,
        )
