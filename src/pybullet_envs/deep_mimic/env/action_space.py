"""Kinds of actions."""

from __future__ import annotations

from enum import Enum


class ActionSpace(Enum):
    """What kind of actions an agent has."""

    Null = 0
    Continuous = 1
    Discrete = 2
