"""RLlib trains on the vector environments, and what it trains gets better."""

import pytest
from gymnasium.vector import AutoresetMode

pytest.importorskip("ray", reason="needs Ray: make cluster")
pytest.importorskip("torch", reason="RLlib's networks are PyTorch's")

pytestmark = [
    pytest.mark.usefixtures("laptop"),
    # Of RLlib's own calls.
    pytest.mark.filterwarnings("ignore::DeprecationWarning"),
]


def test_ppo_learns_to_balance_the_pole():
    from ray.rllib.algorithms.ppo import PPOConfig  # pyright: ignore[reportMissingImports]

    from carom.cluster.rllib import train_on

    # Sent by value: RLlib's processes do not have this file.
    def make(count):
        import gymnasium

        import pybullet_envs  # noqa: F401

        return gymnasium.make_vec("CartPoleBulletEnv-v1", num_envs=count, threads=1)

    config = train_on(PPOConfig(), make, 16)
    config.env_runners(num_env_runners=1, rollout_fragment_length=64)
    config.training(train_batch_size_per_learner=1024, minibatch_size=256, num_epochs=6, lr=1e-3)
    algorithm = config.debugging(seed=1).build_algo()
    try:
        returns = [algorithm.train()["env_runners"]["episode_return_mean"] for _ in range(6)]
    finally:
        algorithm.stop()
    assert returns[0] < 35.0
    assert returns[-1] > 2.0 * returns[0]


def test_an_environment_that_begins_episodes_otherwise_is_refused():
    from ray.rllib.algorithms.ppo import PPOConfig  # pyright: ignore[reportMissingImports]

    from carom.cluster.rllib import train_on

    def make(count):
        import gymnasium

        import pybullet_envs  # noqa: F401

        same_step = AutoresetMode.SAME_STEP
        return gymnasium.make_vec("CartPoleBulletEnv-v1", num_envs=count, autoreset_mode=same_step, threads=1)

    config = train_on(PPOConfig(), make, 2).env_runners(num_env_runners=0)
    with pytest.raises(ValueError, match=r"autoreset_mode=AutoresetMode\.NEXT_STEP"):
        config.build_algo()
