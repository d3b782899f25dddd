"""The interface through which loading functions add bodies to a world."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence

from carom.description.pose import Pose
from carom.model.body_spec import BodySpec
from carom.scene.body import Body


class BodyAdding(ABC):
    """Interface of classes that add bodies, such as a world."""

    @abstractmethod
    def _add(self, spec: BodySpec, position: Sequence[float], orientation: Sequence[float]) -> Body:
        """Add a body at rest."""

    @abstractmethod
    def _add_all(
        self, bodies: Sequence[tuple[BodySpec, Pose]], also: Callable[[list[Body]], None] | None
    ) -> list[Body]:
        """Add bodies at rest, all or none."""
