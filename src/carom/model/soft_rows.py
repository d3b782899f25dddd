"""Where a soft body is in the arrays, and what its nodes are attached to.

Apart from `soft_arrays`, because worlds of rigid bodies have no use for them: data classes take long to make.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from carom.description.pose import Vector3
from carom.model.body_rows import TreeRows

if TYPE_CHECKING:
    from carom.model.soft_spec import SoftSpec


@dataclass(repr=False, eq=False, slots=True)
class SoftRows:
    """The rows of a soft body.

    Attributes:
        rows: Rows of the tree that represents it, which are updated elsewhere.
        spec: Its specification.
        first: First row on each axis.
        count: Rows on each axis.
    """

    rows: TreeRows
    spec: SoftSpec
    first: dict[str, int] = field(default_factory=dict)
    count: dict[str, int] = field(default_factory=dict)


@dataclass(repr=False, eq=False, slots=True)
class Anchor:
    """A node that is attached to a link or to the world.

    Attributes:
        id: Its number among the constraints of the world.
        soft: The soft body.
        node: Index of the node in the soft body, from 0.
        body: Rows of the body it is attached to; None for the world.
        link: Link of that body; -1 is the base.
        pivot: Point of attachment in the inertial frame of the link [m].
        damped: Whether damping within the soft body acts on the link, too.
        late_force: Share of the external force on a body without joints that acts after the node has
            followed it.
    """

    id: int
    soft: SoftRows
    node: int
    body: TreeRows | None
    link: int
    pivot: Vector3
    damped: bool = True
    late_force: float = 0.0
