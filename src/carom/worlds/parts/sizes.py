"""Sizes of shapes that differ between worlds."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from carom.checks import Array
from carom.description import Geometry
from carom.layouts.flags import LoadFlags
from carom.model.body_spec import BASE
from carom.native.gates import gated
from carom.render.appearance import appearance_of
from carom.scene.dynamics.sizes import OF_LINKS, OF_SHAPES, rows_with, sides_from
from carom.worlds.chosen import Chosen
from carom.worlds.writing import to_the_end

if TYPE_CHECKING:
    from carom.engine.engine import Engine
    from carom.scene.body import Body
    from carom.world.world import World


class ShapeSizes:
    """The size of a collision shape of a link in each world.

    Args:
        scene: The world that all are copies of.
        engine: The engine of the worlds.
        body: A body of the scene.
        link: The link; -1 is the base.
        number: Number of the shape among those of the link.
    """

    def __init__(self, scene: World, engine: Engine, body: Body, link: int, number: int) -> None:
        self._scene, self._engine = scene, engine
        self._body, self._link, self._number = scene.bodies[body.id], link, number
        self._row = body.first_link + 1 + link
        self._shapes = scene.contact_arrays.shapes

    @property
    def can_differ(self) -> bool:
        """Whether it may have another size in each world."""
        return self._number in self._rows

    @property
    def _rows(self) -> dict[int, int]:
        """Rows of the shapes of the link whose sizes may differ, by their numbers: those without vertices."""
        implicit = bool(self._body.spec.flags & LoadFlags.USE_IMPLICIT_CYLINDER)
        own = [it.geometry for it in self._body.link_spec(self._link).collisions]
        return {
            number: row
            for number, row in self._shapes.rows_of_collisions(self._row)
            if own[number].sides() is not None and own[number].core(implicit_cylinder=implicit) is not None
        }

    @gated("_scene.call_lock")
    def sides(self) -> Array:
        """Lengths of the sides [m], (count, 3), a copy."""
        sizes = self._engine.parameter("shapes", "shape_size", self._rows[self._number])
        geometry = self._body.link_spec(self._link).collisions[self._number].geometry
        return np.array([of_core(geometry, size).sides() for size in sizes.tolist()]).reshape(-1, 3)

    def prepared(self, sides: Array, worlds: Chosen) -> Callable[[], None]:
        """Check lengths of sides [m], (n, 3), for these n worlds.

        Returns:
            What sets them; it can be repeated.

        Raises:
            ValueError: There is no such shape.
        """
        engine = self._engine
        which, several = self._geometries(sides_from(sides), worlds)
        found = rows_with(self._body, self._link, several)
        shapes = self._shapes.shapes_of(self._row)
        writes = [
            *((name, shapes, found[name][which]) for name in OF_SHAPES),
            *((name, self._row, found[name][which]) for name in OF_LINKS),
        ]

        def write() -> None:
            for name, rows, numbers in writes:
                present = engine.table_of("shapes").numpy[name]
                # Most of it is the same for all sizes: worlds may go on sharing it.
                if name == "shape_size" or len(present) > 1 or (numbers != present[:, rows]).any():
                    engine.set_parameter("shapes", name, rows, numbers, worlds.rows)
            engine.contact_arrays.drop_contacts_in(worlds.rows)
            engine.forget_neighbours()

        return write

    def _geometries(self, sides: Array, worlds: Chosen) -> tuple[NDArray[np.intp], list[Sequence[Geometry]]]:
        """The different lists of geometries of the link in n worlds, and which of them each has, (n,)."""
        own = [it.geometry for it in self._body.link_spec(self._link).collisions]
        others = [(number, row) for number, row in self._rows.items() if number != self._number]
        present = [self._engine.parameter("shapes", "shape_size", row)[worlds.rows] for _, row in others]
        keys = np.concatenate([sides, *present], axis=1)
        distinct, which = np.unique(keys, axis=0, return_inverse=True)
        several: list[Sequence[Geometry]] = []
        for x, y, z, *rest in distinct.tolist():
            geometries = [*own]
            geometries[self._number] = own[self._number].with_sides(x, y, z)
            for place, (number, _) in enumerate(others):
                geometries[number] = of_core(own[number], rest[3 * place : 3 * place + 3])
            several.append(geometries)
        return which.reshape(-1), several


def of_core(geometry: Geometry, size: Sequence[float]) -> Geometry:
    """A shape of the same kind whose row of `Shapes.shape_size` is this (3,)."""
    kind: type[Geometry] = type(geometry)
    found = kind.of_sizes(*size)
    return geometry if found == geometry else found


class SizesOfWorlds:
    """Gives the shapes of a scene the sizes of one of its copies after the other, while it is entered.

    For questions that the scene answers in the place of each world.

    Args:
        scene: The scene.
        engine: The engine of its copies.
    """

    def __init__(self, scene: World, engine: Engine) -> None:
        self._shapes = scene.contact_arrays.shapes
        own, table = self._shapes.table.numpy, engine.contact_arrays.shapes.table.numpy
        # In each world as many rows as there are, or one for all worlds.
        self._pairs = [
            (own[name][0, : table[name].shape[1]], table[name])
            for name in (*OF_SHAPES, *OF_LINKS)
            if (table[name] != own[name][:, : table[name].shape[1]]).any()
        ]
        self._before = [rows.copy() for rows, _ in self._pairs]

    def __enter__(self) -> SizesOfWorlds:
        return self

    def __exit__(self, *_: object) -> None:
        to_the_end(lambda: self._write(self._before))

    def take(self, number: int) -> None:
        """Give the scene the sizes of a world, by its number."""
        self._write([table[number if len(table) > 1 else 0] for _, table in self._pairs])

    def _write(self, numbers: Sequence[NDArray[np.floating]]) -> None:
        for (rows, _), own in zip(self._pairs, numbers, strict=True):
            rows[:] = own
        if self._pairs:
            self._shapes.changes += 1


def visible_sizes(scene: World, engine: Engine, worlds: np.ndarray) -> dict[tuple[int, int, int], Array]:
    """Lengths of the sides of visible shapes that have another size in some world than in the scene.

    Args:
        scene: The scene.
        engine: The engine of its copies.
        worlds: Which of them, n.

    Returns:
        (n, 3) [m] by the number of the body, the link and the number of the visible shape.
    """
    sizes = engine.contact_arrays.shapes.table.numpy["shape_size"]
    differs = (sizes != scene.contact_arrays.shapes.table.numpy["shape_size"][:, : sizes.shape[1]]).any(
        axis=(0, 2)
    )
    found: dict[tuple[int, int, int], Array] = {}
    if not differs.any():
        return found
    appearance = appearance_of(scene)
    for body in scene.bodies.values():
        for link in range(BASE, body.joint_count):
            row = body.first_link + 1 + link
            for number, shape in scene.contact_arrays.shapes.rows_of_collisions(row):
                own = ShapeSizes(scene, engine, body, link, number)
                if differs[shape] and own.can_differ:
                    sides = own.sides()[worlds]
                    for look in appearance.shown_by(body, link, number, alike=True):
                        found[body.id, link, look] = sides
    return found
