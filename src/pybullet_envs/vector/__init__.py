"""PyBullet's environments as Gymnasium's vector environments, with all worlds stepped together.

`gymnasium.make_vec("AntBulletEnv-v0", num_envs=64)` makes one. Environment k gives the same results as a
single environment with the same seed, because its world is a copy of that environment's world.
"""
