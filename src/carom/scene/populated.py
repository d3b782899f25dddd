"""A world of bodies: a world as everything knows it that gives users handles of what is in it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

from carom.checks import vector
from carom.description.pose import Pose
from carom.model.body_spec import BodySpec
from carom.native.change import Change
from carom.scene.bodies import Bodies
from carom.scene.body import Body
from carom.scene.changes import add_bodies
from carom.scene.core.restorable import Restorable


class Populated(Restorable):
    """What a world and its bodies are together, and how bodies come; `World` describes the attributes."""

    # A base class declares these for any bodies; all that are added to a world are of this class.
    bodies: Bodies[Body]  # pyright: ignore[reportIncompatibleVariableOverride]
    listing: dict[int, Body]  # pyright: ignore[reportIncompatibleVariableOverride]

    def __getitem__(self, key: Body | int | str) -> Body:
        """A body by its name or number; a handle gives itself. Of several of one name it is the first.

        Raises:
            KeyError: There is no such body; the message says which there are.
        """
        return self.bodies.find(key)

    def __iter__(self) -> Iterator[Body]:
        """The bodies, in the order they were added."""
        return iter([*self.bodies.values()])

    def __contains__(self, key: object) -> bool:
        """Whether there is a body of this name or number, or this very one."""
        return isinstance(key, Body | int | str) and self.bodies.has(key)

    def _add(self, spec: BodySpec, position: Sequence[float], orientation: Sequence[float]) -> Body:
        """Add a body at rest."""
        px, py, pz = vector(position, 3, "position").tolist()
        qx, qy, qz, qw = vector(orientation, 4, "orientation").tolist()
        return add_bodies(self, [(spec, Pose((px, py, pz), (qx, qy, qz, qw)))])[0]

    def _add_all(
        self,
        bodies: Sequence[tuple[BodySpec, Pose]],
        also: Callable[[list[Body]], None] | None,
        note: Callable[[Change, list[Body]], None] | None,
    ) -> list[Body]:
        return add_bodies(self, bodies, also, note)
