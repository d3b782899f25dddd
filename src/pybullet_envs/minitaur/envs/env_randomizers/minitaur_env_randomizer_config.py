"""Ranges for `MinitaurEnvRandomizerFromConfig`; each function here is a configuration."""

from __future__ import annotations

PARAM_RANGE: dict[str, tuple[float, float]] = {
    # Factors on the robot's own values.
    "mass": (0.8, 1.2),
    "inertia": (0.5, 1.5),
    "motor strength": (0.8, 1.2),
    # Units in this order: V s/rad, s, s, none (a coefficient), V, N m.
    "motor friction": (0, 0.05),
    "control step": (0.003, 0.02),
    "latency": (0.0, 0.04),
    "lateral friction": (0.5, 1.25),
    "battery": (14.0, 16.8),
    "joint friction": (0, 0.05),
}


def all_params() -> dict[str, tuple[float, float]]:
    """All parameters."""
    return PARAM_RANGE
