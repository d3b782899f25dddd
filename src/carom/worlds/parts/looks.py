"""Colours and textures of a link in many worlds."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from carom.checks import Array
from carom.native.gates import gated
from carom.render.appearance import appearance_of
from carom.render.world_looks import WorldLooks, looks_of
from carom.world.face.looking import colour_from, texture_from
from carom.worlds.chosen import Chosen, Where

if TYPE_CHECKING:
    from carom.engine.engine import Engine
    from carom.scene.body import Body
    from carom.world.world import World


class LinkLooks:
    """How a link, or one of its shapes by number, is seen in each world; of None all that is seen of it."""

    def __init__(self, scene: World, engine: Engine, body: Body, link: int) -> None:
        self._scene, self._engine, self._link = scene, engine, link
        self._body = scene.bodies[body.id]

    @gated("_scene.call_lock")
    def colour(self, shape: int | None) -> Array:
        """Colours, (count, 4)."""
        shown = self._shown(shape)
        if not shown:
            return np.ones((self._engine.arrays.world_count, 4))
        return self._looks.colours(self._body, self._link, shown[0])

    @gated("_scene.call_lock")
    def set_colour(self, shape: int | None, value: ArrayLike, where: Where | None) -> None:
        """Set colours in some worlds."""
        worlds, rgba = self._chosen(where), colour_from(value)
        numbers = worlds.values(rgba, (4,), "colour")
        for look in self._shown(shape):
            self._looks.set_colours(self._body, self._link, look, worlds.numbers, numbers)

    @gated("_scene.call_lock")
    def texture(self, shape: int | None) -> list[NDArray[np.uint8] | None]:
        """Textures, copies."""
        shown = self._shown(shape)
        if not shown:
            return [None] * self._engine.arrays.world_count
        looks = self._looks
        images = map(looks.image, looks.texture_numbers(self._body, self._link, shown[0]).tolist())
        return [None if image is None else image.copy() for image in images]

    @gated("_scene.call_lock")
    def set_texture(self, shape: int | None, value: Any, where: Where | None) -> None:
        """Set textures in some worlds."""
        worlds = self._chosen(where)
        given: list[Any] = [value]
        if isinstance(value, list | tuple) or np.ndim(value) == 4:
            given = [*value]
            if len(given) != len(worlds):
                raise ValueError(
                    f"texture has {len(given)} images; there are {len(worlds)} worlds to set it in"
                )
        # One image that several worlds have is one texture.
        known: dict[Any, Any] = {}
        images = []
        for each in given:
            key = each if isinstance(each, str) else id(each)
            if key not in known:
                known[key] = texture_from(each)
            images.append(known[key])
        self._looks.set_textures(self._body, self._link, self._shown(shape), worlds.numbers, images)

    @property
    def _looks(self) -> WorldLooks:
        return looks_of(self._scene, self._engine.arrays.world_count)

    def _shown(self, shape: int | None) -> list[int]:
        return appearance_of(self._scene).shown_by(self._body, self._link, shape)

    def _chosen(self, where: Where | None) -> Chosen:
        return Chosen(self._engine.take(where), self._engine.arrays.world_count)
