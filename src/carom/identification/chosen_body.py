"""The robot of a world that is meant."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from carom.scene.body import Body
    from carom.world.world import World


def chosen_body(world: World, body: Body | str | None) -> Body:
    """A body that can move: by name, itself, or the only one.

    Raises:
        ValueError: There is no such body, or several.
    """
    moving = [it for it in world.bodies.values() if sum(it.velocity_count) or not it.fixed_base]
    if body is None:
        if len(moving) != 1:
            raise ValueError(f"the world has {len(moving)} bodies that can move: say which by `body`")
        return moving[0]
    if isinstance(body, str):
        named = [it for it in moving if it.name == body]
        if len(named) != 1:
            raise ValueError(f"{len(named)} bodies that can move have the name {body!r}")
        return named[0]
    if world.bodies.get(body.id) is not body:
        raise ValueError(f"{body.name!r} is a body of another world")
    return body


def moving_joints(body: Body) -> list[str]:
    """Names of the joints that can move, one for each velocity."""
    return [
        link.joint_name
        for link, count in zip(body.spec.links, body.velocity_count, strict=True)
        for _ in range(count)
    ]
