"""Exceptions that come at any moment, as those of signal handlers do, and what they may leave."""
