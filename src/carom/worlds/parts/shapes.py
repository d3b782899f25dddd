"""Collision shapes of a body in many worlds: how each of them touches others."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from carom.checks import Array
from carom.engine.engine import Engine
from carom.layouts.dynamics_parameters import PARAMETERS
from carom.native.gates import alone, in_section
from carom.scene.dynamics.places import write
from carom.scene.named import Named
from carom.scene.shapes import BodyShape, BodyShapes
from carom.world.world import World
from carom.worlds.chosen import Chosen
from carom.worlds.dynamics import with_dimensions
from carom.worlds.parts.looks import LinkLooks
from carom.worlds.writing import to_the_end

_NAMES = {
    "friction": "lateral_friction",
    **{name: name for name in ("rolling_friction", "spinning_friction", "restitution")},
}
_FIELDS = {name: PARAMETERS[of_link].field for name, of_link in _NAMES.items()}


class ShapeBatch:
    """A collision shape of a body in all worlds; get it from `BodyBatch.shapes`.

    What it has is that of this shape alone; `BodyBatch.change_dynamics` sets it for all shapes of a link.
    Each is a copy (count,), and can be set to one number for all worlds, or one for each.

    Attributes:
        name: Its name in the file; empty if it has none.
        index: Its number among the shapes of the body.
        link: Index of its link; -1 is the base.
    """

    __slots__ = ("_engine", "_one", "_rows", "_scene", "index", "link", "name")

    def __init__(self, shape: BodyShape, scene: World, engine: Engine) -> None:
        self.name: str = shape.name
        self.index: int = shape.index
        self.link: int = shape.link.index
        self._scene, self._engine, self._one = scene, engine, shape
        rows = engine.contact_arrays.shapes.rows_of_collisions(shape.body.first_link + 1 + self.link)
        # One that is made of several parts has several.
        self._rows = [row for number, row in rows if number == shape.number]

    def __repr__(self) -> str:
        return f"<ShapeBatch {self.index} {self.name!r} in {self._engine.arrays.world_count} worlds>"

    @property
    def friction(self) -> Array:
        """Coefficient of sliding friction."""
        return self._read("friction")

    @friction.setter
    def friction(self, value: ArrayLike) -> None:
        self.change(friction=value)

    @property
    def rolling_friction(self) -> Array:
        """Torque about the tangents per normal force [m]."""
        return self._read("rolling_friction")

    @rolling_friction.setter
    def rolling_friction(self, value: ArrayLike) -> None:
        self.change(rolling_friction=value)

    @property
    def spinning_friction(self) -> Array:
        """Torque about the normal per normal force [m]."""
        return self._read("spinning_friction")

    @spinning_friction.setter
    def spinning_friction(self, value: ArrayLike) -> None:
        self.change(spinning_friction=value)

    @property
    def restitution(self) -> Array:
        """Coefficient of restitution."""
        return self._read("restitution")

    @restitution.setter
    def restitution(self, value: ArrayLike) -> None:
        self.change(restitution=value)

    @property
    def size(self) -> Array:
        """Lengths of its sides along its own axes [m], (count, 3), the same in all worlds.

        It can't be set: load a body of each size, and let each be present in some worlds,
        `worlds[body].present = mask`.
        """
        return np.tile(self._one.size, (self._engine.arrays.world_count, 1))

    @size.setter
    def size(self, value: ArrayLike) -> None:
        raise NotImplementedError(
            f"the size of {self.name or 'a shape'!r} can't differ between worlds: load a body of each size, "
            "and let each be present in some worlds, worlds[body].present = mask"
        )

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
        return LinkLooks(self._scene, self._engine, self._one.body, self.link)

    @in_section("_scene.call_lock")
    def change(self, *, where: ArrayLike | None = None, **values: Any) -> None:
        """Set some of these in some worlds.

        Args:
            where: Which worlds: a mask (count,) or their indices; None for all.
            **values: `friction`, `rolling_friction`, `spinning_friction`, `restitution`: one number for all
                of the n worlds, or one for each (n,); `colour`, likewise (3,), (4,), (n, 3) or (n, 4);
                `texture`, an image or a list of n.

        Raises:
            ValueError: A number is negative or not finite, or there are not as many as worlds chosen.
            TypeError: There is no such parameter.
        """
        looks = {name: values.pop(name) for name in ("colour", "texture") if name in values}
        unknown = [name for name in values if name not in _FIELDS]
        if unknown:
            raise TypeError(f"shapes have no parameter {unknown[0]!r}; they have {', '.join(_FIELDS)}")
        worlds = Chosen(self._engine.take(where), self._engine.arrays.world_count)
        numbers = {
            name: worlds.values(np.asarray(self._engine.take(value)), (), name)
            for name, value in values.items()
        }
        for name, own in numbers.items():
            if (own < 0.0).any():
                raise ValueError(f"{name} must not be negative")

        if "colour" in looks:
            self._looks.set_colour(self._one.number, looks["colour"], where)
        if "texture" in looks:
            self._looks.set_texture(self._one.number, looks["texture"], where)

        values_of_link = {_NAMES[name]: own for name, own in numbers.items()}
        dimensions = [
            change
            for row in self._rows
            for change in with_dimensions(self._engine, row, values_of_link, worlds)
        ]

        def write_all() -> None:
            for place, own in dimensions:
                write(self._engine, place, own, worlds.rows)
            for name, own in numbers.items():
                for row in self._rows:
                    write(self._engine, ("shapes", _FIELDS[name], row), own, worlds.rows)

        to_the_end(write_all)

    @alone("_scene.call_lock")
    def _read(self, name: str) -> Array:
        return self._engine.parameter("shapes", _FIELDS[name], self._rows[0])


class ShapeBatches(Named[ShapeBatch]):
    """All collision shapes of a body in all worlds, those of the base first: `shapes["foot"].friction`."""

    def __init__(self, shapes: BodyShapes, scene: World, engine: Engine) -> None:
        super().__init__("shape", [ShapeBatch(shape, scene, engine) for shape in shapes])
