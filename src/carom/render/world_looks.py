"""Colours and textures that differ between worlds."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from carom.native.tables import fields_of, put_array
from carom.render.appearance import appearance_of
from carom.render.images import Texels
from carom.render.textures import NO_TEXTURE

if TYPE_CHECKING:
    from carom.render.scene import SceneArrays
    from carom.scene.core.body_core import BodyCore
    from carom.scene.core.world_core import WorldCore

Place = tuple[int, int, int]
"""Number of a body, index of its link, and number of the visible shape there."""


class WorldLooks:
    """The looks of visible shapes that are not the same in all worlds; get it from `looks_of`.

    Args:
        scene: The world that all are copies of.
        count: Number of worlds.
    """

    def __init__(self, scene: WorldCore, count: int) -> None:
        self._count = count
        self._appearance = appearance_of(scene)
        self._colours: dict[Place, NDArray[np.float64]] = {}
        self._textures: dict[Place, NDArray[np.int32]] = {}
        self._bodies = dict(scene.bodies)
        self._changes = 0
        self._made: tuple[tuple[object, ...], Any] | None = None

    def __bool__(self) -> bool:
        return bool(self._colours or self._textures)

    def colours(self, body: BodyCore, link: int, look: int) -> NDArray[np.float64]:
        """Colour of a visible shape in each world, a copy (count, 4)."""
        known = self._colours.get((body.id, link, look))
        if known is not None:
            return known.copy()
        return np.tile(self._appearance.shapes(body, link)[look].rgba, (self._count, 1))

    def set_colours(
        self, body: BodyCore, link: int, look: int, worlds: Any, rgba: NDArray[np.float64]
    ) -> None:
        """Set the colour of a visible shape in some worlds: (n, 4), or (4,) for all of them."""
        values = self.colours(body, link, look)
        values[worlds] = rgba
        self._colours[body.id, link, look] = values
        self._changes += 1

    def texture_numbers(self, body: BodyCore, link: int, look: int) -> NDArray[np.int32]:
        """Number of the texture of a visible shape in each world, a copy (count,); -1 for none."""
        known = self._textures.get((body.id, link, look))
        if known is not None:
            return known.copy()
        return np.full(self._count, self._appearance.shapes(body, link)[look].texture, dtype=np.int32)

    def set_textures(
        self, body: BodyCore, link: int, looks: list[int], worlds: Any, images: list[Texels | None]
    ) -> None:
        """Set the texture of visible shapes in some worlds: one image for each, or one for all of them."""
        known: dict[int, int] = {}
        for image in images:
            if image is not None and id(image) not in known:
                known[id(image)] = self._appearance.add_texture(image, [*self._bodies.values()])
        numbers = [NO_TEXTURE if image is None else known[id(image)] for image in images]
        for look in looks:
            values = self.texture_numbers(body, link, look)
            values[worlds] = numbers if len(numbers) > 1 else numbers[0]
            self._textures[body.id, link, look] = values
        self._changes += 1

    def image(self, number: int) -> Texels | None:
        """The image of a texture, None for none."""
        return None if number == NO_TEXTURE else self._appearance.textures.image(number)

    def apply(self, number: int, world: WorldCore) -> None:
        """Give a copy of the scene the looks of one of the worlds."""
        looks = appearance_of(world)
        for (body, link, look), colours in self._colours.items():
            r, g, b, a = colours[number].tolist()
            looks.change(world.bodies[body], link, look, rgba=(r, g, b, a))
        for (body, link, look), textures in self._textures.items():
            looks.change(world.bodies[body], link, look, texture=int(textures[number]))

    def kept(self) -> dict[str, Any]:
        """All of it, for files: images, and the colours and numbers of images by place."""
        numbers = sorted({int(n) for values in self._textures.values() for n in values} - {NO_TEXTURE})
        places = {NO_TEXTURE: NO_TEXTURE, **{number: place for place, number in enumerate(numbers)}}
        return {
            "images": [self.image(number) for number in numbers],
            "colours": [[[*place], values] for place, values in self._colours.items()],
            "textures": [
                [[*place], np.array([places[number] for number in values.tolist()], dtype=np.int32)]
                for place, values in self._textures.items()
            ],
        }

    def take(self, kept: Mapping[str, Any]) -> None:
        """Have what `kept` has returned of other worlds with the same bodies."""
        everybody = [*self._bodies.values()]
        numbers = [self._appearance.add_texture(image, everybody) for image in kept["images"]]
        found = np.array([*numbers, NO_TEXTURE], dtype=np.int32)
        self._colours = {tuple(place): values for place, values in kept["colours"]}
        self._textures = {tuple(place): found[values] for place, values in kept["textures"]}
        self._changes += 1

    def struct_for(self, scene: SceneArrays) -> Any:
        """The arrays of a scene as kernels take them, with the looks of all worlds behind those of the scene.

        The looks of world w begin at row (w + 1) times the number of parts.
        """
        numbers = {int(number) for values in self._textures.values() for number in values}
        scene.have_textures(numbers - {NO_TEXTURE}, self._appearance.textures)
        key = (self._changes, scene, scene.struct.__dict__["memory"]["texel"])
        if (
            self._made is None
            or any(a is not b for a, b in zip(self._made[0][1:], key[1:], strict=True))
            or (self._made[0][0] != self._changes)
        ):
            self._made = key, self._with_looks(scene)
        return self._made[1]

    def _with_looks(self, scene: SceneArrays) -> Any:
        memory, parts = scene.struct.__dict__["memory"], len(scene.part_shapes)
        rgba = np.tile(memory["part_rgba"], (self._count + 1, 1)).reshape(self._count + 1, parts, 4)
        textures = np.tile(memory["part_texture"], self._count + 1).reshape(self._count + 1, parts)
        for part, place in enumerate(scene.part_shapes):
            if place in self._colours:
                rgba[1:, part] = self._colours[place]
            if place in self._textures:
                textures[1:, part] = [scene.slot_of(int(number)) for number in self._textures[place]]
        made = type(scene.struct)()
        for name in fields_of(type(scene.struct)):
            setattr(made, name, getattr(scene.struct, name))
        made.__dict__["memory"] = dict(memory)
        put_array(made, "part_rgba", rgba.reshape(-1, 4))
        put_array(made, "part_texture", textures.reshape(-1))
        return made


_looks: WeakKeyDictionary[WorldCore, WorldLooks] = WeakKeyDictionary()


def looks_of(scene: WorldCore, count: int) -> WorldLooks:
    """The looks of the worlds that are copies of a scene."""
    found = _looks.get(scene)
    if found is None:
        found = _looks[scene] = WorldLooks(scene, count)
    return found
