"""Many worlds at once: the same bodies in all of them, each world with a state of its own."""
