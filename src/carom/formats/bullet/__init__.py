"""Files that Bullet writes (`.bullet`): structures from memory, with their own description at the end."""

from carom.formats.bullet.state import (
    BulletState,
    LinkState,
    MultiBodyState,
    RigidBodyState,
    is_bullet,
    read_bullet_state,
)

__all__ = [
    "BulletState",
    "LinkState",
    "MultiBodyState",
    "RigidBodyState",
    "is_bullet",
    "read_bullet_state",
]
