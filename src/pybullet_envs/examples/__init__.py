"""PyBullet's examples of environments and arms, as far as they are here."""
