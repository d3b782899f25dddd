"""The environments of PyBullet as Gymnasium's vector environments, all worlds stepped together.

`gymnasium.make_vec("AntBulletEnv-v0", num_envs=64)` makes one. Environment k gives what the single one gives
that was given its seed: the scene is that of a single environment, copied.
"""
