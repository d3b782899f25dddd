"""Make 64 quadrupeds an environment that rewards walking forwards."""

import numpy as np

import carom
from carom.examples import robot_file
from carom.vector import SceneEnv


class Walk(SceneEnv):
    def reward(self, actions: np.ndarray) -> np.ndarray:
        return self.worlds["trunk"].velocity.linear[:, 0]

    def terminated(self) -> np.ndarray:
        return self.worlds["trunk"].pose.position[:, 2] < 0.2


scene = carom.World().load(robot_file("quadruped.xml"))
env = Walk(scene, 64, keyframe="stand", steps=10, max_episode_steps=100)
observations, infos = env.reset(seed=0)
total = np.zeros(64)
for _ in range(100):
    observations, rewards, terminations, truncations, infos = env.step(env.action_space.sample())
    total += rewards
print(observations.shape, total.mean())
