"""Soft bodies of a world, made from parameters or from mesh files."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from carom.model.body_spec import BodySpec
from carom.scene.populated import Populated

if TYPE_CHECKING:
    from carom.scene.soft_body import SoftBody

_ORIGIN, _UPRIGHT = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0)


class SoftLoading(Populated):
    """Loading of soft bodies into a world."""

    def load_cloth(
        self,
        size: Sequence[float] = (1.0, 1.0),
        cells: Sequence[int] = (20, 20),
        position: Sequence[float] = _ORIGIN,
        orientation: Sequence[float] = _UPRIGHT,
        *,
        mesh: str | Path | None = None,
        mass: float = 1.0,
        stiffness: float = 100.0,
        bending: float = 1.0,
        damping: float = 0.1,
        friction: float = 0.5,
        margin: float = 0.01,
        self_collision: bool = False,
    ) -> SoftBody:
        """Add cloth: springs along the edges of triangles, and bending springs across the edges.

        Args:
            size: Of a rectangle along x and y [m].
            cells: Number of cells along each axis; there is one node more along each.
            position: Of its middle [m].
            orientation: Quaternion (x, y, z, w).
            mesh: An OBJ file whose surface is the cloth, instead of a rectangle.
            mass: Of all of it [kg]; every node has the same.
            stiffness: Of springs along edges [N/m].
            bending: Of springs between nodes that have a neighbour in common [N/m].
            damping: Of all springs [N s/m].
            friction: Coulomb coefficient, multiplied by that of the other surface.
            margin: Distance at which it rests on other surfaces [m].
            self_collision: Whether it collides with itself.

        Raises:
            carom.errors.DescriptionError: A number is out of range, or the file cannot be used; the world is
                as before.
        """
        from carom.soft.build import soft_body
        from carom.soft.files import soft_body_from_file
        from carom.soft.materials import Springs
        from carom.soft.shapes import grid
        from carom.soft.texture_mapping import stretched

        kind = Springs(stiffness, damping, bending)
        common: dict[str, Any] = {
            "mass": mass, "springs": kind, "margin": margin, "friction": friction,
            "self_collision": self_collision,
        }  # fmt: skip
        if mesh is not None:
            return self._soft(soft_body_from_file(Path(mesh), **common), position, orientation)
        nodes, triangles = grid(_lengths(size, 2), _counts(cells, 2))
        textured = stretched(nodes, triangles)
        return self._soft(
            soft_body("cloth", nodes, triangles, textured=textured, **common), position, orientation
        )

    def load_rope(
        self,
        length: float = 1.0,
        cells: int = 20,
        position: Sequence[float] = _ORIGIN,
        orientation: Sequence[float] = _UPRIGHT,
        *,
        mass: float = 0.1,
        stiffness: float = 1000.0,
        bending: float = 0.0,
        damping: float = 0.05,
        friction: float = 0.5,
        radius: float = 0.01,
    ) -> SoftBody:
        """Add a rope along x: nodes in a row, tied by springs.

        Args:
            length: [m].
            cells: Number of springs; there is one node more.
            position: Of its middle [m].
            orientation: Quaternion (x, y, z, w).
            mass: Of all of it [kg]; every node has the same.
            stiffness: Of each spring [N/m].
            bending: Of springs from each node to the next but one [N/m].
            damping: Of all springs [N s/m].
            friction: Coulomb coefficient, multiplied by that of the other surface.
            radius: Distance at which its nodes rest on other surfaces [m].

        Raises:
            carom.errors.DescriptionError: A number is out of range; the world is as before.
        """
        import numpy as np

        from carom.soft.build import soft_body
        from carom.soft.materials import Springs

        ((extent,), (count,)) = _lengths((length,), 1), _counts((cells,), 1)
        nodes = np.zeros((count + 1, 3))
        nodes[:, 0] = np.linspace(-0.5, 0.5, count + 1) * extent
        pairs = np.stack([np.arange(count), np.arange(1, count + 1)], axis=1).astype(np.int32)
        kind = Springs(stiffness, damping, bending)
        spec = soft_body("rope", nodes, pairs, mass=mass, springs=kind, margin=radius, friction=friction)
        return self._soft(spec, position, orientation)

    def load_soft_solid(
        self,
        size: Sequence[float] | float = (0.2, 0.2, 0.2),
        cells: Sequence[int] | int = (4, 4, 4),
        position: Sequence[float] = _ORIGIN,
        orientation: Sequence[float] = _UPRIGHT,
        *,
        mesh: str | Path | None = None,
        youngs_modulus: float = 1e4,
        poissons_ratio: float = 0.3,
        damping: float = 0.01,
        mass: float = 1.0,
        friction: float = 0.5,
        margin: float = 0.005,
    ) -> SoftBody:
        """Add a solid of tetrahedra: a cuboid, a ball, or the mesh of a VTK file.

        Args:
            size: Along x, y and z [m]; one number is the radius of a ball.
            cells: Number of cells along each axis; for a ball, along its diameter.
            position: Of its middle, or of the origin of the file's mesh [m].
            orientation: Quaternion (x, y, z, w).
            mesh: A VTK file with tetrahedra.
            youngs_modulus: For small strains [Pa].
            poissons_ratio: For small strains; less than 0.5.
            damping: Viscosity as a share of the elastic parameters [s].
            mass: Of all of it [kg]; every node has the same.
            friction: Coulomb coefficient, multiplied by that of the other surface.
            margin: Distance at which it rests on other surfaces [m].

        Raises:
            carom.errors.DescriptionError: A number is out of range, or the file cannot be used; the world is
                as before.
        """
        from carom.errors import DescriptionError
        from carom.soft.build import soft_body
        from carom.soft.files import soft_body_from_file
        from carom.soft.materials import NeoHookean
        from carom.soft.shapes import ball, box

        if not 0.0 <= poissons_ratio < 0.5 or not youngs_modulus > 0.0:
            raise DescriptionError(
                f"Young's modulus is {youngs_modulus} and Poisson's ratio {poissons_ratio}; the first has to "
                "be greater than 0, the second from 0 to less than 0.5"
            )
        common: dict[str, Any] = {
            "mass": mass, "solid": NeoHookean.of(youngs_modulus, poissons_ratio, damping), "margin": margin,
            "friction": friction,
        }  # fmt: skip
        if mesh is not None:
            return self._soft(soft_body_from_file(Path(mesh), **common), position, orientation)
        if isinstance(size, (int, float)):
            across = cells if isinstance(cells, int) else max(cells)
            nodes, tetras = ball(*_lengths((size,), 1), *_counts((across,), 1))
        else:
            counts = (cells, cells, cells) if isinstance(cells, int) else cells
            nodes, tetras = box(_lengths(size, 3), _counts(counts, 3))
        return self._soft(soft_body("soft solid", nodes, tetras, **common), position, orientation)

    def _soft(self, spec: BodySpec, position: Sequence[float], orientation: Sequence[float]) -> SoftBody:
        body = self._add(spec, position, orientation)
        from carom.scene.soft_body import SoftBody

        assert isinstance(body, SoftBody)
        return body


def _lengths(values: Sequence[float], count: int) -> Any:
    from carom.checks import positive

    return tuple(_as_many(positive(values, "size").tolist(), count))


def _counts(values: Sequence[int], count: int) -> Any:
    if any(int(value) != value or value < 1 for value in values):
        raise ValueError(f"cells must be whole numbers of at least 1, not {values!r}")
    return tuple(int(value) for value in _as_many(values, count))


def _as_many(values: Sequence[Any], count: int) -> Sequence[Any]:
    if len(values) != count:
        raise ValueError(f"{count} numbers are needed, not {len(values)}: {values!r}")
    return values
