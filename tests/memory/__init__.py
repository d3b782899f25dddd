"""Memory that must not grow: of closed worlds, and in loops of connect and disconnect."""
