"""Memory that must not grow: of closed worlds, and in loops of connect and disconnect."""

LOOPS = (
    *("client", "full_client", "window", "world", "measured_world", "worlds", "saved_world", "vector"),
    *("environment", "states", "shapes", "bodies"),
)
"""The names of the loops; what they do is in `tests.memory.loops`."""
