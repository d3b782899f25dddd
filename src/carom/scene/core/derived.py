"""What a world computes on demand from its bodies, constraints and arrays."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from carom.native.launch import TreeLaunch

if TYPE_CHECKING:
    from carom.engine.queries.present_poses import PresentPoses
    from carom.engine.queries.queries import Queries
    from carom.scene.snapshot import Shape
    from carom.scene.user_constraints import UserConstraint


class Derived:
    """Data derived from the bodies, constraints and arrays of a world, computed on demand."""

    def __init__(self) -> None:
        # A function of the class, for the world: a method would refer to it.
        self.step: Callable[[Any], bool] | None = None
        # The step before constraints changed, if nothing else has changed since.
        self.step_before: Callable[[Any], bool] | None = None
        # The constraint whose removal has set the step aside, if no other change has come since.
        self.removed: UserConstraint | None = None
        self.queries: Queries | None = None
        self.present_poses: PresentPoses | None = None
        self.pose_launch: TreeLaunch | None = None
        self.twist_launch: TreeLaunch | None = None
        self.load_launch: TreeLaunch | None = None
        self.shape: Shape | None = None
        self.link_places: list[tuple[int, int]] | None = None
        self.link_columns: tuple[list[int], list[int]] | None = None
