"""The list arguments of `createCollisionShapeArray` and `createVisualShapeArray`."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, TypeVar

from pybullet._calls.arguments import integer, sequence
from pybullet._calls.errors import error, fail, logger
from pybullet._calls.optional_vectors import optional_pose
from pybullet._shapes.shape_arguments import primitive

if TYPE_CHECKING:
    from carom.description import Geometry, Pose

Made = TypeVar("Made")


class Column:
    """One list argument; `words` name its items in PyBullet's error message for one that is no sequence."""

    def __init__(self, values: Any, name: str, words: str) -> None:
        self.is_given = values is not None
        self._items: Sequence[Any] = (
            () if values is None else sequence(values, f"expected a sequence of {words}", name)
        )

    def item(self, index: int, default: Any = None) -> Any:
        """An item of the list; the default if the list is too short or not given."""
        return self._items[index] if index < len(self._items) else default


# Names of the items of each argument in PyBullet's error messages for arguments that are not sequences.
_ITEMS = {
    "radii": "radii",
    "halfExtents": "half extents",
    "lengths": "lengths",
    "fileNames": "filename",
    "meshScales": "mesh scale",
    "planeNormals": "plane normal",
    "flags": "flags",
}
_MISSING = -1.0
"""Length of what the list has no item for; PyBullet leaves it out."""


class ShapeColumns:
    """The list arguments that both functions have; `frame_of` is `collision` or `visual`.

    Attributes:
        problem: PyBullet's error message if no shape can be created.
        kinds: `GEOM_*` of each shape.
        files: Name of the mesh file of each shape.
        scales: Scale factors of the mesh of each shape.
        flags: Flags of each shape.

    Raises:
        pybullet.error: An argument is not a sequence.
        TypeError: A shape type is not an integer.
    """

    def __init__(self, function: str, frame_of: str, given: Mapping[str, Any]) -> None:
        self.problem = f"{function} failed."
        self._function = function
        self._frame = f"{frame_of}Frame"
        self.kinds = [
            integer(kind, "shapeTypes")
            for kind in sequence(given["shapeTypes"], "expected a sequence of shape types", "shapeTypes")
        ]
        items = {
            **_ITEMS,
            f"{self._frame}Positions": f"{frame_of} frame positions",
            f"{self._frame}Orientations": f"{frame_of} frame orientations",
        }
        columns = [Column(given[name], name, words) for name, words in items.items()]
        self._radii, self._half_extents, self._lengths, self.files, self.scales, *rest = columns
        self._normals, self.flags, self._positions, self._orientations = rest

    @property
    def is_framed(self) -> bool:
        """Whether the positions or the orientations of the shapes in the link frame are given."""
        return self._positions.is_given or self._orientations.is_given

    def frame(self, index: int) -> Pose:
        """The frame of a shape in the link frame."""
        return optional_pose(
            self._positions.item(index), self._orientations.item(index), self.problem, self._frame
        )

    def primitive(self, index: int) -> Geometry:
        """The geometry of a shape whose type is that of a primitive."""
        return primitive(
            self.kinds[index],
            self.problem,
            self._radii.item(index, 0.0),
            self._lengths.item(index, _MISSING),
            self._half_extents.item(index, (1.0, 1.0, 1.0)),
            self._normals.item(index),
            length_name="lengths",
        )

    def each(self, make: Callable[[int, int], Made]) -> list[Made]:
        """Create all shapes by `make(index, type)`; those that cannot be made are left out, with a warning.

        Raises `pybullet.error` if no shape can be created.
        """
        made, reasons = [], []
        for index, kind in enumerate(self.kinds):
            try:
                made.append(make(index, kind))
            except error as reason:
                reasons.append(f"shape {index}: {str(reason).removeprefix(self.problem).strip()}")
        if not made:
            fail(self.problem, "; ".join(reasons) or "shapeTypes is empty.")
        for reason in reasons:
            logger.warning("%s: %s It is left out.", self._function, reason)
        return made
