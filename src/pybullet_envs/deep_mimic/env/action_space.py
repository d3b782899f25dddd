"""Types of action spaces."""

from __future__ import annotations

from enum import Enum


class ActionSpace(Enum):
    """Type of an agent's action space."""

    Null = 0
    Continuous = 1
    Discrete = 2
