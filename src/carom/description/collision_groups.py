"""Collision groups of bodies whose files name none, and the groups each collides with; as in PyBullet."""

from __future__ import annotations

MOVING_GROUP, MOVING_MASK = 1, -1
FIXED_GROUP, FIXED_MASK = 2, -1 ^ 2
