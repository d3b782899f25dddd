"""Collision shapes of a body in many worlds: how each of them touches others."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from carom.checks import Array
from carom.description import Collision
from carom.layouts.dynamics_parameters import PARAMETERS
from carom.native.gates import gated
from carom.scene.common.shape import COEFFICIENTS, LOOKS, MOTIONS, SIZE, CommonShape, check_name
from carom.scene.dynamics.places import write
from carom.scene.shapes import BodyShape
from carom.worlds.batch import Batch
from carom.worlds.chosen import Chosen, Where
from carom.worlds.dynamics import with_dimensions
from carom.worlds.parts.looks import LinkLooks
from carom.worlds.parts.part import Parts
from carom.worlds.parts.sizes import ShapeSizes
from carom.worlds.writing import to_the_end

if TYPE_CHECKING:
    from carom.worlds.parts.links import LinkBatch

_FIELDS = {name: PARAMETERS[COEFFICIENTS.get(name, name)].field for name in (*COEFFICIENTS, *MOTIONS)}


class ShapeBatch(CommonShape[Array, "ArrayLike"]):
    """A collision shape of a body in all worlds; get it from `BodyBatch.shapes`.

    What it has is that of this shape alone; `BodyBatch.change_dynamics` sets it for all shapes of a link.
    Each is a copy (count,), and can be set to one number for all worlds, or one for each.

    Attributes:
        name: Its name in the file; empty if it has none.
        index: Its number among the shapes of the body.
    """

    __slots__ = ("_batch", "_engine", "_one", "_rows", "_scene", "index", "name")

    def __init__(self, batch: Batch, shape: BodyShape) -> None:
        self.name: str = shape.name
        self.index: int = shape.index
        self._batch, self._scene, self._engine, self._one = batch, batch._scene, batch._engine, shape
        rows = self._engine.contact_arrays.shapes.rows_of_collisions(shape.body.first_link + 1 + shape._link)
        # One that is made of several parts has several.
        self._rows = [row for number, row in rows if number == shape.number]

    def __repr__(self) -> str:
        return f"<ShapeBatch {self.index} {self.name!r} in {self._engine.arrays.world_count} worlds>"

    @property
    def link(self) -> LinkBatch:
        """The link that it belongs to."""
        return self._batch._parts_of_it.link(self._batch, self._one._link)

    @property
    def _spec(self) -> Collision:
        return self._one._spec

    @property
    def number(self) -> int:
        """Its number among those of its link."""
        return self._one.number

    @property
    def size(self) -> Array:
        """Lengths of its sides along its own axes [m], a copy (count, 3): of a sphere three diameters.

        It can be set, to one for all worlds or one for each; of spheres and cubes also to (count, 1) or to
        one length. Masses and inertias stay as they are, and contacts of these worlds are found anew. Visible
        shapes of the same size follow in images. Sizes are no state: `reset` and `restore` keep them.

        Raises:
            ValueError: A length is not greater than 0 or not finite; there are not as many as worlds; a
                sphere would not stay round, or a capsule or cylinder about its axis.
            NotImplementedError: The shape is a hull, a mesh, a plane or a height field, or a box with round
                edges, whose corners all worlds share; so is a cylinder of a URDF file, if it is not loaded
                with `LoadFlags.USE_IMPLICIT_CYLINDER`.
        """
        sizes = self._sizes
        return sizes.sides() if sizes.can_differ else np.tile(self._one.size, (self._count, 1))

    @size.setter
    def size(self, value: ArrayLike) -> None:
        self.change(size=value)

    @property
    def _sizes(self) -> ShapeSizes:
        return ShapeSizes(self._scene, self._engine, self._one.body, self._one._link, self._one.number)

    @property
    def _count(self) -> int:
        return self._engine.arrays.world_count

    def _resized(self, value: ArrayLike, worlds: Chosen) -> Callable[[], None]:
        """What sets its size in some worlds."""
        sizes = self._sizes
        if not sizes.can_differ:
            round_one = ""
            if self.geometry.sides() is not None and self.geometry.core(implicit_cylinder=True) is not None:
                round_one = (
                    "load its file with flags=LoadFlags.USE_IMPLICIT_CYLINDER, as it is a hull else; or "
                )
            raise NotImplementedError(
                f"the size of {self.name or 'a shape'!r}, {type(self.geometry).__name__}, can't differ "
                "between worlds, as that of boxes, spheres, capsules and round cylinders can: "
                f"{round_one}load a body of each size, and let each be present in some worlds, "
                "worlds[body].present = mask"
            )
        return sizes.prepared(np.asarray(worlds.values(self._engine.take(value), (3,), "size")), worlds)

    @property
    def colour(self) -> Array:
        """Red, green, blue and alpha with which it is seen in each world, a copy (count, 4) from 0 to 1.

        It can be set, to one for all worlds or one for each, also by three numbers.

        Raises:
            ValueError: What is set is no colour, or there are not as many as worlds.
        """
        return self._looks.colour(self._one.number)

    @colour.setter
    def colour(self, value: ArrayLike) -> None:
        self._looks.set_colour(self._one.number, value, None)

    @property
    def texture(self) -> list[NDArray[np.uint8] | None]:
        """Its texture in each world, copies (height, width, 3), None where it has none.

        It can be set as that of a shape of one world; to a list of one for each world; or to an array (count,
        height, width, 3).

        Raises:
            ValueError: What is set is no image, or there are not as many as worlds.
        """
        return self._looks.texture(self._one.number)

    @texture.setter
    def texture(self, value: Any) -> None:
        self._looks.set_texture(self._one.number, value, None)

    @property
    def _looks(self) -> LinkLooks:
        return LinkLooks(self._scene, self._engine, self._one.body, self._one._link)

    @gated("_scene.call_lock", section=True)
    def change(self, *, where: Where | None = None, **values: Any) -> None:
        """Set some of these in some worlds.

        Args:
            where: Which worlds: a mask (count,), their indices or a slice; None for all.
            **values: `friction`, `rolling_friction`, `spinning_friction`, `restitution`: one number for all
                of the n worlds, or one for each (n,); `size`, `surface_velocity`, `surface_spin` and
                `colour`, likewise (3,) or (n, 3), of colours also (4,) or (n, 4); `texture`, an image or a
                list of n.

        Raises:
            ValueError: A number is negative or not finite, or there are not as many as worlds chosen.
            TypeError: There is no such parameter.
            NotImplementedError: The size of such a shape cannot differ between worlds, see `size`.
        """
        for name in values:
            check_name(name)
        looks = {name: values.pop(name) for name in LOOKS if name in values}
        worlds = Chosen(self._engine.take(where), self._count)
        resize = self._resized(values.pop(SIZE), worlds) if SIZE in values else None
        numbers = {
            name: worlds.values(np.asarray(self._engine.take(value)), (3,) if name in MOTIONS else (), name)
            for name, value in values.items()
        }
        for name, own in numbers.items():
            if name in COEFFICIENTS and (own < 0.0).any():
                raise ValueError(f"{name} must not be negative")

        if "colour" in looks:
            self._looks.set_colour(self._one.number, looks["colour"], where)
        if "texture" in looks:
            self._looks.set_texture(self._one.number, looks["texture"], where)

        values_of_link = {COEFFICIENTS.get(name, name): own for name, own in numbers.items()}
        dimensions = [
            change
            for row in self._rows
            for change in with_dimensions(self._engine, row, values_of_link, worlds)
        ]

        def write_all() -> None:
            if resize is not None:
                resize()
            for place, own in dimensions:
                write(self._engine, place, own, worlds.rows)
            for name, own in numbers.items():
                for row in self._rows:
                    write(self._engine, ("shapes", _FIELDS[name], row), own, worlds.rows)

        to_the_end(write_all)

    @gated("_scene.call_lock")
    def _read(self, name: str) -> Array:
        return self._engine.parameter("shapes", _FIELDS[name], self._rows[0])

    _motion = _read


class ShapeBatches(Parts[ShapeBatch]):
    """All collision shapes of a body in all worlds, those of the base first: `shapes["foot"].friction`."""

    def __init__(self, batch: Batch) -> None:
        super().__init__("shape", [ShapeBatch(batch, shape) for shape in batch._body.shapes])
        self._batch = batch
