"""Bodies of a world from the files that describe robots: URDF, SDF and MJCF."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from carom.description.pose import Pose
from carom.model.body_spec import BodySpec
from carom.scene.body import Body

if TYPE_CHECKING:
    from carom.formats.search import AssetSearch


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


class DescriptionLoading(BodyAdding):
    """Loading of robot files into a world; file readers are imported when needed."""

    def load_urdf(
        self,
        path: str | Path,
        position: Sequence[float] = (0.0, 0.0, 0.0),
        orientation: Sequence[float] = (0.0, 0.0, 0.0, 1.0),
        *,
        fixed_base: bool = False,
        scale: float = 1.0,
        flags: int = 0,
    ) -> Body:
        """Add the robot that a URDF file describes.

        Args:
            path: The file; one that comes with `pybullet_data` is found by its name.
            position: Of the base's link frame [m].
            orientation: Of the base's link frame, quaternion (x, y, z, w).
            fixed_base: Fix the base in the world.
            scale: Factor on all lengths.
            flags: Loading flags, see `carom.layouts.flags.LoadFlags`.

        Raises:
            carom.errors.DescriptionError: The file cannot be used; the world is as before.
        """
        from carom.soft.from_urdf import urdf_body

        spec = urdf_body(Path(path), _search(), scale=scale, flags=flags, fixed_base=fixed_base)
        return self._add(spec, position, orientation)

    def load_sdf(self, path: str | Path, *, scale: float = 1.0) -> list[Body]:
        """Add the models that an SDF file describes, at their poses in the file.

        Args:
            path: The file; one that comes with `pybullet_data` is found by its name.
            scale: Factor on lengths.

        Returns:
            Their bodies, in the order of the file.

        Raises:
            carom.errors.DescriptionError: The file cannot be used; the world is as before.
        """
        from carom.model.from_files import sdf_bodies

        return self.load_all(sdf_bodies(Path(path), _search(), scale=scale))

    def load_mjcf(self, path: str | Path, *, flags: int = 0) -> list[Body]:
        """Add the bodies that an MJCF file describes, at their poses in the file.

        Args:
            path: The file; one that comes with `pybullet_data` is found by its name.
            flags: Loading flags, see `carom.layouts.flags.LoadFlags`.

        Returns:
            The bodies, in the order of the file.

        Raises:
            carom.errors.DescriptionError: The file cannot be used; the world is as before.
        """
        from carom.model.from_files import mjcf_bodies

        return self.load_all(mjcf_bodies(Path(path), _search(), flags=flags))

    def load_all(
        self, bodies: Sequence[tuple[BodySpec, Pose]], also: Callable[[list[Body]], None] | None = None
    ) -> list[Body]:
        """Add bodies at rest, all or none.

        Args:
            bodies: Specification of each body, and the world pose of its base's link frame.
            also: Called with the new bodies; if it raises an exception they are removed again.

        Raises:
            carom.errors.DescriptionError: The file of a mesh cannot be used; the world is as before.
        """
        from carom.model.from_files import make_shapes

        make_shapes(bodies)
        return self._add_all(bodies, also)


def _search() -> AssetSearch:
    """A search for files: by the path as given, and then in the folder of `pybullet_data`."""
    from carom.formats.search import AssetSearch
    from carom.formats.shipped import shipped_folder

    return AssetSearch(shipped_folder())
