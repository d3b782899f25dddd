"""Tables of a world and its bodies, in HTML, for notebooks."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape
from typing import TYPE_CHECKING

from carom.model.body_spec import BASE

if TYPE_CHECKING:
    from carom.scene.body import Body
    from carom.scene.core.body_core import BodyCore
    from carom.scene.core.world_core import WorldCore
    from carom.scene.joint import Joint


def world_table(world: WorldCore) -> str:
    """The bodies of a world, and its time and gravity."""
    gravity = ", ".join(f"{value:g}" for value in world.parameters.gravity)
    count = len(world.bodies)
    bodies = "body" if count == 1 else "bodies"
    caption = f"World: {count} {bodies}, {world.time:.4f} s, gravity ({gravity}) m/s²"
    rows = [
        (body.id, body.name, body.joint_count, f"{_mass(body):.4g}", _numbers(_position(body)))
        for body in world.bodies.values()
    ]
    return table(caption, ["id", "name", "joints", "mass [kg]", "position [m]"], rows)


def body_table(body: Body) -> str:
    """The joints and links of a body."""
    base = "fixed" if body.fixed_base else "free"
    caption = (
        f"Body {body.id}: {body.name}, {_mass(body):.4g} kg, {base} base at {_numbers(_position(body))} m"
    )
    joints = joints_table(body.joints, "Joints")
    links = [
        (link, body.link_spec(link).name, f"{body.dynamics(link).mass:.4g}")
        for link in range(BASE, body.joint_count)
    ]
    return f"<b>{escape(caption)}</b>{joints}" + table("Links", ["index", "name", "mass [kg]"], links)


def joints_table(joints: Iterable[Joint], caption: str = "Joints") -> str:
    """Joints with their limits and present state."""
    header = ["index", "name", "type", "position", "velocity", "limits", "motor force"]
    rows = []
    for joint in joints:
        if joint.degrees_of_freedom == 0:
            rows.append((joint.index, joint.name, joint.type.value, "", "", "", ""))
            continue
        lower, upper = joint.limits
        force = f"{joint.motor_torque:.4g}" if joint.degrees_of_freedom == 1 else ""
        now = (_numbers(joint.coordinates), _numbers(joint.rates), f"{lower:.4g} .. {upper:.4g}", force)
        rows.append((joint.index, joint.name, joint.type.value, *now))
    return table(caption, header, rows)


def table(caption: str, header: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """A table with a caption."""
    head = "".join(f"<th>{escape(name)}</th>" for name in header)
    body = "".join(
        "<tr>" + "".join(f"<td>{escape(str(cell))}</td>" for cell in row) + "</tr>" for row in rows
    )
    return f"<table><caption>{escape(caption)}</caption><tr>{head}</tr>{body}</table>"


def _mass(body: BodyCore) -> float:
    return sum(body.dynamics(link).mass for link in range(BASE, body.joint_count))


def _position(body: BodyCore) -> Sequence[float]:
    return body.world.link_pose[body.first_link, :3].tolist()


def _numbers(values: Iterable[float]) -> str:
    # Adding 0 turns -0 into 0.
    return ", ".join(f"{value + 0.0:.4g}" for value in values)
