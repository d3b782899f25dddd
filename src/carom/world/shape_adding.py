"""Bodies of one shape, made from its sizes: boxes, balls, floors, terrain, meshes."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from carom.checks import finite, not_negative, positive, vector
from carom.description import (
    Box,
    Capsule,
    Collision,
    ContactParameters,
    Cylinder,
    Ellipsoid,
    Geometry,
    Heightfield,
    Inertial,
    Material,
    Mesh,
    Plane,
    RoundedBox,
    Sphere,
    Visual,
)
from carom.description.link import Rgba
from carom.description.pose import IDENTITY
from carom.layouts.flags import LoadFlags
from carom.model.body_spec import BodySpec, LinkSpec
from carom.scene.body import Body
from carom.scene.populated import Populated

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

_ORIGIN, _UPRIGHT = (0.0, 0.0, 0.0), (0.0, 0.0, 0.0, 1.0)
_FRICTION = 0.5


class ShapeAdding(Populated):
    """Adding bodies of one shape. Their mass is spread evenly, and no air damps them."""

    def add_box(
        self,
        half_extents: Sequence[float] = (0.5, 0.5, 0.5),
        position: Sequence[float] = _ORIGIN,
        orientation: Sequence[float] = _UPRIGHT,
        *,
        mass: float = 1.0,
        colour: Sequence[float] | None = None,
        friction: float = _FRICTION,
        restitution: float = 0.0,
        name: str = "box",
        radius: float = 0.0,
    ) -> Body:
        """Add a box, maybe with round edges.

        Args:
            half_extents: Half of its size along x, y and z [m].
            position: Of its centre [m], world axes.
            orientation: Quaternion (x, y, z, w).
            mass: [kg]; 0 fixes it in the world.
            colour: Red, green, blue and, if it is not opaque, alpha, from 0 to 1; None for white.
            friction: Coulomb coefficient, multiplied by that of the other surface.
            restitution: Coefficient of restitution, multiplied likewise.
            name: Name of the body.
            radius: Of its edges and corners, which are round within its size; at most the least half extent
                [m]. 0 for sharp ones.

        Raises:
            ValueError: A number is out of range.
        """
        x, y, z = positive(vector(half_extents, 3, "half_extents"), "half_extents").tolist()
        rounding = float(not_negative(finite(radius, "radius"), "radius"))
        if rounding > min(x, y, z):
            raise ValueError(
                f"radius must be at most the least half extent, {min(x, y, z):g}, not {radius!r}"
            )
        shape = RoundedBox((x, y, z), rounding) if rounding else Box((x, y, z))
        surface = _Surface(colour, friction, restitution, name)
        return self._add_shape(shape, position, orientation, mass, surface)

    def add_ellipsoid(
        self,
        half_axes: Sequence[float] = (0.5, 0.4, 0.3),
        position: Sequence[float] = _ORIGIN,
        orientation: Sequence[float] = _UPRIGHT,
        *,
        mass: float = 1.0,
        colour: Sequence[float] | None = None,
        friction: float = _FRICTION,
        restitution: float = 0.0,
        name: str = "ellipsoid",
    ) -> Body:
        """Add an ellipsoid.

        Args:
            half_axes: Half of its size along x, y and z [m].
            position: Of its centre [m], world axes.
            orientation: Quaternion (x, y, z, w).
            mass: [kg]; 0 fixes it in the world.
            colour: As that of `add_box`.
            friction: As that of `add_box`.
            restitution: As that of `add_box`.
            name: Name of the body.

        Raises:
            ValueError: A number is out of range.
        """
        x, y, z = positive(vector(half_axes, 3, "half_axes"), "half_axes").tolist()
        surface = _Surface(colour, friction, restitution, name)
        return self._add_shape(Ellipsoid((x, y, z)), position, orientation, mass, surface)

    def add_sphere(
        self,
        radius: float = 0.5,
        position: Sequence[float] = _ORIGIN,
        *,
        mass: float = 1.0,
        colour: Sequence[float] | None = None,
        friction: float = _FRICTION,
        restitution: float = 0.0,
        name: str = "sphere",
    ) -> Body:
        """Add a sphere.

        Args:
            radius: [m].
            position: Of its centre [m], world axes.
            mass: [kg]; 0 fixes it in the world.
            colour: As that of `add_box`.
            friction: As that of `add_box`.
            restitution: As that of `add_box`.
            name: Name of the body.

        Raises:
            ValueError: A number is out of range.
        """
        shape = Sphere(_length(radius, "radius"))
        return self._add_shape(shape, position, _UPRIGHT, mass, _Surface(colour, friction, restitution, name))

    def add_cylinder(
        self,
        radius: float = 0.5,
        length: float = 1.0,
        position: Sequence[float] = _ORIGIN,
        orientation: Sequence[float] = _UPRIGHT,
        *,
        mass: float = 1.0,
        colour: Sequence[float] | None = None,
        friction: float = _FRICTION,
        restitution: float = 0.0,
        name: str = "cylinder",
    ) -> Body:
        """Add a cylinder whose axis is the z axis.

        Args:
            radius: [m].
            length: Along the axis [m].
            position: Of its centre [m], world axes.
            orientation: Quaternion (x, y, z, w).
            mass: [kg]; 0 fixes it in the world.
            colour: As that of `add_box`.
            friction: As that of `add_box`.
            restitution: As that of `add_box`.
            name: Name of the body.

        Raises:
            ValueError: A number is out of range.
        """
        shape = Cylinder(_length(radius, "radius"), _length(length, "length"))
        surface = _Surface(colour, friction, restitution, name)
        return self._add_shape(shape, position, orientation, mass, surface)

    def add_capsule(
        self,
        radius: float = 0.5,
        length: float = 1.0,
        position: Sequence[float] = _ORIGIN,
        orientation: Sequence[float] = _UPRIGHT,
        *,
        mass: float = 1.0,
        colour: Sequence[float] | None = None,
        friction: float = _FRICTION,
        restitution: float = 0.0,
        name: str = "capsule",
    ) -> Body:
        """Add a capsule, a cylinder along the z axis with a half ball on each end.

        Args:
            radius: [m].
            length: Of the cylinder, without the half balls [m].
            position: Of its centre [m], world axes.
            orientation: Quaternion (x, y, z, w).
            mass: [kg]; 0 fixes it in the world.
            colour: As that of `add_box`.
            friction: As that of `add_box`.
            restitution: As that of `add_box`.
            name: Name of the body.

        Raises:
            ValueError: A number is out of range.
        """
        shape = Capsule(_length(radius, "radius"), _length(length, "length"))
        surface = _Surface(colour, friction, restitution, name)
        return self._add_shape(shape, position, orientation, mass, surface)

    def add_plane(
        self,
        position: Sequence[float] = _ORIGIN,
        normal: Sequence[float] = (0.0, 0.0, 1.0),
        *,
        colour: Sequence[float] | None = None,
        friction: float = _FRICTION,
        restitution: float = 0.0,
        name: str = "plane",
    ) -> Body:
        """Add an unbounded plane, fixed in the world, such as a floor; below it everything is solid.

        Args:
            position: A point on it [m], world axes.
            normal: Direction out of it, of any length but 0.
            colour: As that of `add_box`.
            friction: As that of `add_box`.
            restitution: As that of `add_box`.
            name: Name of the body.

        Raises:
            ValueError: A number is out of range.
        """
        direction = vector(normal, 3, "normal")
        size = float(positive(np.sqrt((direction * direction).sum()), "the length of normal"))
        x, y, z = (direction / size).tolist()
        surface = _Surface(colour, friction, restitution, name)
        return self._add_shape(Plane((x, y, z)), position, _UPRIGHT, 0.0, surface)

    def add_heightfield(
        self,
        heights: ArrayLike,
        spacing: Sequence[float] = (1.0, 1.0),
        position: Sequence[float] = _ORIGIN,
        orientation: Sequence[float] = _UPRIGHT,
        *,
        colour: Sequence[float] | None = None,
        friction: float = _FRICTION,
        restitution: float = 0.0,
        name: str = "heightfield",
    ) -> Body:
        """Add terrain, fixed in the world: heights above the points of a grid.

        Args:
            heights: Along z [m], shape (points along y, points along x).
            spacing: Distance between neighbouring points along x and y [m].
            position: Of the middle of the grid, at height 0 [m], world axes.
            orientation: Quaternion (x, y, z, w).
            colour: As that of `add_box`.
            friction: As that of `add_box`.
            restitution: As that of `add_box`.
            name: Name of the body.

        Raises:
            ValueError: There are less than 2 x 2 points, or a number is out of range.
        """
        grid = finite(heights, "heights")
        if grid.ndim != 2 or min(grid.shape) < 2:
            raise ValueError(f"heights must have shape (2 or more, 2 or more), not {grid.shape}")
        x, y = positive(vector(spacing, 2, "spacing"), "spacing").tolist()
        surface = _Surface(colour, friction, restitution, name)
        return self._add_shape(Heightfield(grid, (x, y, 1.0), 0.0), position, orientation, 0.0, surface)

    def add_mesh(
        self,
        path: str | Path,
        position: Sequence[float] = _ORIGIN,
        orientation: Sequence[float] = _UPRIGHT,
        *,
        scale: float | Sequence[float] = 1.0,
        mass: float = 1.0,
        concave: bool = False,
        colour: Sequence[float] | None = None,
        friction: float = _FRICTION,
        restitution: float = 0.0,
        name: str = "",
    ) -> Body:
        """Add a body of the shape of a mesh, which collides with its convex hull.

        Of an OBJ file with several groups, each has a hull of its own.

        Args:
            path: OBJ, STL, DAE, GLB, glTF or PLY file; one that comes with `pybullet_data` is found by its
                name.
            position: Of the origin of the file [m], world axes.
            orientation: Quaternion (x, y, z, w).
            scale: Factor on lengths, or one for each of x, y and z.
            mass: [kg], spread evenly in the convex hull of the whole mesh; 0 fixes it in the world.
            concave: Its triangles collide, and not their hull; for a body without mass only.
            colour: As that of `add_box`; None for the colours of the file.
            friction: As that of `add_box`.
            restitution: As that of `add_box`.
            name: Name of the body; that of the file if it is empty.

        Raises:
            carom.errors.DescriptionError: The file cannot be used; the world is as before.
            ValueError: A number is out of range, or a body with mass is concave.
        """
        sx, sy, sz = positive(np.broadcast_to(finite(scale, "scale"), 3), "scale").tolist()
        if concave and mass:
            raise ValueError(f"a concave mesh must have mass 0, not {mass!r}: its triangles do not move")
        from carom.formats.search import AssetSearch
        from carom.formats.shipped import shipped_folder

        # One that is not there is named as it was given.
        file = Path(AssetSearch(shipped_folder()).find(path) or path)
        surface = _Surface(colour, friction, restitution, name or file.stem)
        mesh = Mesh(file, (sx, sy, sz), concave, margin=0.0)
        return self._add_shape(mesh, position, orientation, mass, surface)

    def _add_shape(
        self,
        geometry: Geometry,
        position: Sequence[float],
        orientation: Sequence[float],
        mass: float,
        surface: _Surface,
    ) -> Body:
        kilograms = float(not_negative(finite(mass, "mass"), "mass"))
        positive(np.abs(vector(orientation, 4, "orientation")).max(), "the length of orientation")
        inertial = Inertial(0.0)
        if kilograms > 0.0:
            from carom.world.shape_inertia import mesh_inertial, primitive_inertial

            make = mesh_inertial if isinstance(geometry, Mesh) else primitive_inertial
            inertial = make(geometry, kilograms)
        xx, _, _, yy, _, zz = inertial.tensor
        base = LinkSpec(
            "base",
            mass=kilograms,
            inertia=(xx, yy, zz),
            inertial_frame=inertial.frame,
            collisions=(Collision(geometry, IDENTITY),),
            visuals=(Visual(geometry, IDENTITY, material=surface.material),),
            contact=surface.contact,
        )
        spec = BodySpec(
            surface.name,
            base,
            fixed_base=kilograms == 0.0,
            flags=int(LoadFlags.USE_IMPLICIT_CYLINDER),
            link_damping=0.0,
            max_velocity=np.inf,
            is_held=False,
        )
        return self._add(spec, position, orientation)


class _Surface:
    """Colour, surface and name of a body."""

    def __init__(
        self, colour: Sequence[float] | None, friction: float, restitution: float, name: str
    ) -> None:
        self.material = None if colour is None else Material(rgba=_rgba(colour))
        self.contact = ContactParameters(
            lateral_friction=float(not_negative(finite(friction, "friction"), "friction")),
            restitution=float(not_negative(finite(restitution, "restitution"), "restitution")),
        )
        self.name = name


def _rgba(colour: Sequence[float]) -> Rgba:
    numbers = finite(colour, "colour")
    if numbers.shape not in ((3,), (4,)) or not ((numbers >= 0.0) & (numbers <= 1.0)).all():
        raise ValueError(f"colour must be 3 or 4 numbers from 0 to 1, not {colour!r}")
    red, green, blue, alpha = [*numbers.tolist(), 1.0][:4]
    return red, green, blue, alpha


def _length(value: float, name: str) -> float:
    return float(positive(vector([value], 1, name), name)[0])
