"""Collision shapes of a body, as handles: what they are, and how they touch others."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from carom.checks import Array, finite, not_negative, vector
from carom.description import Collision
from carom.description import Pose as FramePose
from carom.native.change import Change
from carom.native.uninterrupted import uninterrupted
from carom.pose import Pose
from carom.scene.common.shape import COEFFICIENTS, MOTIONS, SIZE, CommonShape, check_name
from carom.scene.dynamics.changes import note_dynamics, note_surface_of_shape
from carom.scene.handles import world_of
from carom.scene.named import Named

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    from carom.model.link_dynamics import ShapeSurface
    from carom.scene.body import Body
    from carom.scene.link import Link


class BodyShape(CommonShape[float, float]):
    """A collision shape of a link.

    Friction and restitution are those of this shape alone. `Body.change_dynamics` sets them for all shapes of
    a link. Those of two shapes that touch are combined as the formats of their files say: docs/contact.md.

    Attributes:
        body: The body.
        index: Its number among the shapes of the body.
        number: Its number among those of its link.
    """

    __slots__ = ("_link", "body", "index", "number")

    def __init__(self, body: Body, index: int, link: int, number: int) -> None:
        self.body: Body = body
        self.index: int = index
        self._link = link
        self.number: int = number

    def __repr__(self) -> str:
        return f"<Shape {self.index} {self.name!r} of {self.body.name!r}: link {self.link.name!r}>"

    @property
    def _spec(self) -> Collision:
        return self.body.link_spec(self._link).collisions[self.number]

    @property
    def name(self) -> str:
        """Its name in the file; empty if it has none."""
        return self._spec.name

    @property
    def link(self) -> Link:
        """The link that it belongs to."""
        return self.body.links[self._link]

    @property
    def size(self) -> Array:
        """Lengths of its sides along its own axes [m], shape (3,): of a sphere three diameters.

        It can be set, also to one length for a sphere or a cube; masses and inertias stay as they are.
        Infinite of a plane.

        Raises:
            ValueError: A length is not greater than 0 or not finite; a sphere would not stay round, or a
                capsule or cylinder about its axis; or the shape is a mesh, a hull or a plane: load it with
                another scale.
        """
        from carom.engine.queries.extents import extent_of

        world = world_of(self.body)
        if self.geometry.is_unbounded:
            return np.full(3, np.inf)
        row = self.body.first_link + 1 + self._link
        shapes = world.contact_arrays.shapes
        parts = [place for number, place in shapes.rows_of_collisions(row) if number == self.number]
        if not parts:
            # Of soft bodies.
            return np.full(3, np.nan)
        sides = self.geometry.sides()
        if sides is not None:
            return np.array(sides)
        inertial = Pose(*_numbers(self.body.link_inertial_frame(self._link)))
        back = (inertial.inverse() * self.frame).inverse()
        return extent_of(shapes, [row], back.array[np.newaxis], parts).size

    @size.setter
    def size(self, value: ArrayLike) -> None:
        self.body.world._set_size(self.body, self._link, self.number, value)

    @property
    def colour(self) -> Array:
        """Red, green, blue and alpha with which it is seen, (4,) from 0 to 1; settable, also by three.

        It is that of the visible shape that shows it, which is multiplied with the texture; of links whose
        files have other shapes to be seen, that of all these. An alpha of 0 hides it.

        Raises:
            ValueError: What is set is no colour.
        """
        return self.body.world._colour(self.body, self._link, self.number)

    @colour.setter
    def colour(self, value: ArrayLike) -> None:
        self.body.world._set_colour(self.body, self._link, self.number, value)

    @property
    def texture(self) -> NDArray[np.uint8] | None:
        """Its texture, a copy (height, width, 3), the top row first; None if it has none.

        It can be set to such an array, to floats from 0 to 1, to an image file, and to None.

        Raises:
            ValueError: What is set is no image.
            carom.errors.DescriptionError: A file cannot be read.
        """
        return self.body.world._texture(self.body, self._link, self.number)

    @texture.setter
    def texture(self, value: ArrayLike | str | Path | None) -> None:
        self.body.world._set_texture(self.body, self._link, self.number, value)

    @property
    def _surface(self) -> ShapeSurface:
        world_of(self.body)
        return self.body.dynamics(self._link).surface_of(self.number)

    def change(self, **values: Any) -> None:
        """Set several of these at once: all of them, or none if one is wrong.

        Args:
            **values: `friction`, `rolling_friction`, `spinning_friction`, `restitution`, `surface_velocity`,
                `surface_spin`, `size`, `colour` and `texture`.

        Raises:
            ValueError: A number is negative or not finite, or what is given has no meaning.
            TypeError: There is no such parameter.
        """
        changes: dict[str, Any] = {}
        looks: dict[str, Any] = {}
        for name, value in values.items():
            if name in COEFFICIENTS:
                changes[COEFFICIENTS[name]] = float(not_negative(finite(value, name), name))
            elif name in MOTIONS:
                changes[name] = tuple(vector(value, 3, name).tolist())
            else:
                check_name(name)
                looks[name] = value
        world = world_of(self.body)
        if SIZE in looks:
            self.size = looks.pop(SIZE)
        if changes:
            with world.call_lock, uninterrupted:
                world.refuse_in_step()
                change = Change()
                if len(self.body.link_spec(self._link).collisions) == 1:
                    note_dynamics(change, self.body, self._link, changes)
                else:
                    note_surface_of_shape(change, self.body, self._link, self.number, changes)
                change.commit()
        for name, value in looks.items():
            setattr(self, name, value)

    def _read(self, name: str) -> float:
        return float(getattr(self._surface, COEFFICIENTS[name]))

    def _motion(self, name: str) -> Array:
        return np.array(getattr(self._surface, name))


def _numbers(frame: FramePose) -> tuple[tuple[float, ...], tuple[float, ...]]:
    return frame.position, frame.orientation


class BodyShapes(Named[BodyShape]):
    """All collision shapes of a body, those of the base first: `shapes["foot"]`, `shapes[0]`."""

    def __init__(self, body: Body) -> None:
        places = [
            (link - 1, number)
            for link, spec in enumerate((body.spec.base, *body.spec.links))
            for number in range(len(spec.collisions))
        ]
        super().__init__("shape", [BodyShape(body, index, *place) for index, place in enumerate(places)])
        self._body = body

    def __repr__(self) -> str:
        return f"<Shapes of {self._body.name!r}: {', '.join(map(repr, self.names)) or 'none'}>"
