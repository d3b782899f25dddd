"""What can happen in a world, which decides what its steps need not look for."""

from __future__ import annotations

from typing import TYPE_CHECKING

from carom.model.flags import LoadFlags
from carom.model.shape_arrays import FIXED_GROUP, FIXED_MASK

if TYPE_CHECKING:
    from carom.body import Body
    from carom.world import World


def can_touch(world: World) -> bool:
    """Whether two shapes could ever touch: of two bodies that are not both scenery, or of one body."""
    solid = scenery = 0
    for body in world.bodies.values():
        links = [body.spec.base, *body.spec.links]
        if not any(link.collisions for link in links):
            continue
        if body.spec.flags & LoadFlags.ANY_SELF_COLLISION:
            return True
        solid += 1
        scenery += _is_scenery(world, body)
    return solid > 1 and (solid > scenery or bool(world.touch.shapes.filters.all))


def can_sleep(world: World) -> bool:
    """Whether a body may fall asleep, or has to be woken up."""
    arrays = world.arrays
    model, state, count = arrays.model.numpy, arrays.state.numpy, arrays.used["tree"]
    return bool(model["tree_can_sleep"][:count].any() or state["tree_activity"][0, :count].any())


def _is_scenery(world: World, body: Body) -> bool:
    """Whether a body has shapes on its fixed base alone, in the group of fixed bases."""
    shapes, base = world.touch.shapes.table.numpy, body.first_link
    return (
        body.fixed_base
        and not any(link.collisions for link in body.spec.links)
        and (shapes["link_group"][base], shapes["link_mask"][base]) == (FIXED_GROUP, FIXED_MASK)
    )
