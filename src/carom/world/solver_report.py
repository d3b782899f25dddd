"""Statistics of the constraint solver."""

from __future__ import annotations

from typing import TYPE_CHECKING

from carom.scene.joint_constraints import island_links

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore
    from carom.scene.core.world_core import WorldCore


def solver_report(world: WorldCore) -> list[dict[str, float]]:
    """Statistics of the last substep, as returned by `World.analytics`."""
    state = world.arrays.state.numpy
    bodies: dict[int, list[BodyCore]] = {}
    for body in world.bodies.values():
        if body.rows.tree < world.arrays.used["tree"]:
            bodies.setdefault(int(state["tree_island"][0, body.rows.tree]), []).append(body)
    return [
        {
            "islandId": root,
            "numBodies": sum(sum(island_links(body)) for body in members if not body.asleep),
            "numIterationsUsed": int(state["tree_iterations"][0, root]),
            "remainingResidual": float(state["tree_residual"][0, root]),
        }
        for root, members in sorted(bodies.items())
        if state["tree_iterations"][0, root]
    ]
