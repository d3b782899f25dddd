"""What `stepSimulation` returns about the solver."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from carom.layouts.codes import JointCode
from carom.scene.joint_constraints import island_links

if TYPE_CHECKING:
    from carom.world.world import World

_NO_ISLAND = -1


class _Group(NamedTuple):
    """Bodies that are solved together: PyBullet's number of their last link, and what solving took."""

    number: int
    links: int
    iterations: int
    residual: float
    has_joints: bool


def solver_analytics(world: World) -> tuple[dict[str, int | float], ...]:
    """Statistics of the last substep by island, in PyBullet's numbers and order.

    An island's number is that of its last link that can move, counted over all bodies. Those without a joint,
    a contact or a constraint go with the next one that has any; what is left then comes as island -1.
    """
    found: list[dict[str, int | float]] = []
    waiting = 0
    for group in sorted(_groups(world)):
        waiting += group.links
        if group.iterations or group.has_joints:
            found.append(_entry(group.number, waiting, group.iterations or 1, group.residual))
            waiting = 0
    if waiting:
        found.append(_entry(_NO_ISLAND, waiting, 1, 0.0))
    return tuple(found)


def _entry(island: int, bodies: int, iterations: int, residual: float) -> dict[str, int | float]:
    return {
        "islandId": island,
        "numBodies": bodies,
        "numIterationsUsed": iterations,
        "remainingResidual": residual,
    }


def _groups(world: World) -> list[_Group]:
    state = world.arrays.state.numpy
    iterations, residuals = state["tree_iterations"][0], state["tree_residual"][0]
    groups: dict[int, _Group] = {}
    counted = 0
    for body in world.bodies.values():
        links = sum(island_links(body))
        counted += links
        if not links or body.asleep or body.rows.tree >= world.arrays.used["tree"]:
            continue
        has_joints = any(code != JointCode.FIXED for code in body.joint_types)
        root = int(state["tree_island"][0, body.rows.tree])
        before = groups.get(root)
        groups[root] = _Group(
            counted - 1,
            links + (before.links if before else 0),
            int(iterations[root]),
            float(residuals[root]) if iterations[root] else 0.0,
            has_joints or (before is not None and before.has_joints),
        )
    return list(groups.values())
