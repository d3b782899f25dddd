"""Environments around a single URDF robot."""

from pybullet_envs.bullet.cartpole_bullet import CartPoleBulletEnv, CartPoleContinuousBulletEnv

__all__ = ["CartPoleBulletEnv", "CartPoleContinuousBulletEnv"]
