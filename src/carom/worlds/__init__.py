"""Many worlds at once: the same bodies in all of them, each world with its own state."""
