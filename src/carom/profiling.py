"""Where the time of a step is spent."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from carom.scene.core.world_core import WorldCore


def profile(world: WorldCore, count: int = 100) -> dict[str, float]:
    """Advance a world by `count` time steps, as `World.step` does, and return the time of each stage.

    The step is split into more launches than usual, so the sum is a little more than the time of a usual
    step.

    Args:
        world: The world.
        count: Number of steps.

    Returns:
        Seconds per step by stage: "link poses", "broad phase" (pairs of shapes whose bounds meet),
            "narrow phase" (their contacts), "islands" (groups of bodies that touch or are tied together),
            "free motion" (kinematics, mass matrices, velocities without constraints), "constraints" (rows of
            motors, limits, constraints and contacts, and their solution) and "integration"; where there are
            any, "soft bodies" as well.

    Raises:
        carom.errors.SimulationError: As from `World.step`.
    """
    return world._profiled(count)
