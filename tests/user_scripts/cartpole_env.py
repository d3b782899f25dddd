"""An environment in the style of Gym: reset, step, reward."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

import pybullet as p
import pybullet_data

Observation = NDArray[np.float32]


class CartPole:
    """A pole on a cart; actions push the cart."""

    def __init__(self, render: bool = False) -> None:
        self.client = p.connect(p.GUI if render else p.DIRECT)
        p.setAdditionalSearchPath(pybullet_data.getDataPath(), physicsClientId=self.client)
        self.generator = np.random.default_rng(0)
        self.cart = -1
        self.parameters: dict[str, int | float] = {}

    def reset(self) -> tuple[Observation, dict[str, Any]]:
        p.resetSimulation(physicsClientId=self.client)
        p.setGravity(0, 0, -9.8, physicsClientId=self.client)
        p.setPhysicsEngineParameter(fixedTimeStep=0.02, numSubSteps=4, physicsClientId=self.client)
        self.parameters = p.getPhysicsEngineParameters(self.client)
        self.cart = p.loadURDF("cartpole.urdf", physicsClientId=self.client)
        for joint in (0, 1):
            p.setJointMotorControl2(
                self.cart, joint, p.VELOCITY_CONTROL, force=0, physicsClientId=self.client
            )
            start = self.generator.uniform(-0.05, 0.05)
            p.resetJointState(self.cart, joint, start, physicsClientId=self.client)
        return self._observe(), {}

    def step(self, action: int) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        force = 10.0 if action else -10.0
        p.setJointMotorControl2(self.cart, 0, p.TORQUE_CONTROL, force=force, physicsClientId=self.client)
        p.stepSimulation(physicsClientId=self.client)
        observation = self._observe()
        fallen = bool(abs(observation[0]) > 2.4 or abs(observation[2]) > 0.2)
        return observation, 1.0, fallen, False, {}

    def close(self) -> None:
        p.disconnect(self.client)

    def _observe(self) -> Observation:
        states = p.getJointStates(self.cart, [0, 1], physicsClientId=self.client)
        assert states is not None
        return np.array([value for state in states for value in state[:2]], dtype=np.float32)


def main(episodes: int = 2) -> list[float]:
    environment = CartPole()
    returns: list[float] = []
    for _ in range(episodes):
        observation, _ = environment.reset()
        total, done = 0.0, False
        while not done and total < 200:
            observation, reward, done, _truncated, _ = environment.step(int(observation[2] > 0))
            total += reward
        returns.append(total)
    environment.close()
    return returns


if __name__ == "__main__":
    print(main())
