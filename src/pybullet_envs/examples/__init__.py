"""Those of PyBullet's examples of environments and arms that Carom includes."""
