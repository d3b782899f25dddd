"""Ranges from which `MinitaurEnvRandomizerFromConfig` draws; each function here is a configuration."""

from __future__ import annotations

PARAM_RANGE: dict[str, tuple[float, float]] = {
    # Shares of what the robot has.
    "mass": (0.8, 1.2),
    "inertia": (0.5, 1.5),
    "motor strength": (0.8, 1.2),
    # V s/rad, seconds, seconds, a coefficient, volts and N m.
    "motor friction": (0, 0.05),
    "control step": (0.003, 0.02),
    "latency": (0.0, 0.04),
    "lateral friction": (0.5, 1.25),
    "battery": (14.0, 16.8),
    "joint friction": (0, 0.05),
}


def all_params() -> dict[str, tuple[float, float]]:
    """Everything is drawn."""
    return PARAM_RANGE
