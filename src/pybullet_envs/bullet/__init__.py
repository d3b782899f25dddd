"""Environments with one robot from a URDF or SDF file."""

from pybullet_envs.bullet.cartpole_bullet import CartPoleBulletEnv, CartPoleContinuousBulletEnv
from pybullet_envs.bullet.kuka_diverse_object_gym_env import KukaDiverseObjectEnv
from pybullet_envs.bullet.kukaCamGymEnv import KukaCamGymEnv
from pybullet_envs.bullet.kukaGymEnv import KukaGymEnv
from pybullet_envs.bullet.minitaur_duck_gym_env import MinitaurBulletDuckEnv
from pybullet_envs.bullet.minitaur_gym_env import MinitaurBulletEnv
from pybullet_envs.bullet.racecarGymEnv import RacecarGymEnv
from pybullet_envs.bullet.racecarZEDGymEnv import RacecarZEDGymEnv

__all__ = [
    "CartPoleBulletEnv",
    "CartPoleContinuousBulletEnv",
    "KukaCamGymEnv",
    "KukaDiverseObjectEnv",
    "KukaGymEnv",
    "MinitaurBulletDuckEnv",
    "MinitaurBulletEnv",
    "RacecarGymEnv",
    "RacecarZEDGymEnv",
]
