"""Environments put together from named functions: observations, rewards, events, commands, terminations."""

from carom.vector.managers.manager_env import ManagerEnv
from carom.vector.managers.terms import (
    Command,
    Curriculum,
    Event,
    ImageGroup,
    Observation,
    Reward,
    Task,
    Termination,
)

__all__ = [
    "Command",
    "Curriculum",
    "Event",
    "ImageGroup",
    "ManagerEnv",
    "Observation",
    "Reward",
    "Task",
    "Termination",
]
