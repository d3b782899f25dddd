"""Tasks for the Minitaur: walking, trotting, stepping, standing, walking to a ball."""

from pybullet_envs.minitaur.envs.minitaur_alternating_legs_env import MinitaurAlternatingLegsEnv
from pybullet_envs.minitaur.envs.minitaur_ball_gym_env import MinitaurBallGymEnv
from pybullet_envs.minitaur.envs.minitaur_extended_env import MinitaurExtendedEnv
from pybullet_envs.minitaur.envs.minitaur_four_leg_stand_env import MinitaurFourLegStandEnv
from pybullet_envs.minitaur.envs.minitaur_reactive_env import MinitaurReactiveEnv
from pybullet_envs.minitaur.envs.minitaur_stand_gym_env import MinitaurStandGymEnv
from pybullet_envs.minitaur.envs.minitaur_trotting_env import MinitaurTrottingEnv

__all__ = [
    "MinitaurAlternatingLegsEnv",
    "MinitaurBallGymEnv",
    "MinitaurExtendedEnv",
    "MinitaurFourLegStandEnv",
    "MinitaurReactiveEnv",
    "MinitaurStandGymEnv",
    "MinitaurTrottingEnv",
]
