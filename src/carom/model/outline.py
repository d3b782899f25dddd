"""A body's tree of links as readable text, for URDF_PRINT_URDF_INFO."""

from __future__ import annotations

from carom.model.body_spec import BASE, BodySpec


def outline(body: BodySpec) -> str:
    """One line for each link, indented by its depth: name, mass, type and name of the joint."""
    depth = {BASE: 0}
    children: dict[int, list[int]] = {}
    for index, link in enumerate(body.links):
        depth[index] = depth[link.parent] + 1
        children.setdefault(link.parent, []).append(index)
    lines = [f"{body.base.name} (mass {body.base.mass:g})"]
    pending = children.get(BASE, [])[::-1]
    while pending:
        index = pending.pop()
        link = body.links[index]
        lines.append(
            f"{'  ' * depth[index]}{link.name}"
            f" (mass {link.mass:g}, {link.joint_type.value} joint {link.joint_name})"
        )
        pending.extend(children.get(index, [])[::-1])
    return "\n".join(lines)
