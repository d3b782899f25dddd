"""An environment of one's own, as many times as wanted: an arm with one joint that is to point somewhere."""

import gymnasium
import numpy as np

from carom import World
from carom.examples import robot_file
from carom.vector import WorldsEnv

ARM = robot_file("one_joint_arm.urdf")
LARGEST_TORQUE = 30.0


class Pointing(WorldsEnv):
    def __init__(self, num_envs=1, **options):
        world = World(time_step=1 / 240)
        world.gravity = (0, 0, -9.81)
        arm = world.load_urdf(ARM, fixed_base=True)
        arm.joints["shoulder"].free()
        observation = gymnasium.spaces.Box(-np.inf, np.inf, (4,), np.float32)
        action = gymnasium.spaces.Box(-1.0, 1.0, (1,), np.float32)
        super().__init__(world, num_envs, observation, action, steps=8, **options)
        self.arm = self.worlds[arm]
        self.targets = np.zeros((num_envs, 1))

    def begin(self, worlds):
        self.targets[worlds] = self.random.uniform(worlds, -2.0, 2.0, 1)
        self.arm.joints.positions[worlds] = self.random.uniform(worlds, -0.5, 0.5, 1)

    def act(self, actions):
        # A torque acts for one step of the world, a motor until it is told otherwise.
        self.torques = LARGEST_TORQUE * np.clip(actions, -1.0, 1.0)

    def simulate(self):
        for _ in range(self.steps):
            self.arm.joints.set_torques(self.torques)
            self.worlds.step()

    def observe(self):
        angles, rates = self.arm.joints.positions, self.arm.joints.velocities
        self.error = angles - self.targets
        return np.hstack([np.sin(self.error), np.cos(self.error), angles, rates]).astype(np.float32)

    def reward(self, actions):
        return np.cos(self.error[:, 0]) - 0.01 * np.square(actions[:, 0])

    def terminated(self):
        return np.abs(self.arm.joints.velocities[:, 0]) > 50.0


gymnasium.register("Pointing-v0", vector_entry_point=Pointing, max_episode_steps=150)


def main(count=64):
    """A controller that knows how to do it, in `count` environments for one episode."""
    env = gymnasium.make_vec("Pointing-v0", num_envs=count)
    observations, _ = env.reset(seed=0)
    total = np.zeros(count)
    for _ in range(150):
        sine, _, angle, rate = observations.T
        # Against gravity, then towards the target.
        torque = 9.81 * np.sin(angle) - 60.0 * sine - 12.0 * rate
        observations, rewards, _, truncations, _ = env.step(torque[:, None] / LARGEST_TORQUE)
        total += rewards
    print(f"return {total.mean():.1f} of 150, arms off by {np.abs(observations[:, 0]).max():.3f} at most")
    assert truncations.all()
    return {"return": total, "off": np.abs(observations[:, 0])}


if __name__ == "__main__":
    main()
