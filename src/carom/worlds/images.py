"""Camera images of many worlds."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from carom.engine.engine import Engine
from carom.world.world import World
from carom.worlds.lone import copy_coordinates

if TYPE_CHECKING:
    from carom.camera import Camera


class Images(NamedTuple):
    """Images of a camera in each world; row 0 is the top.

    Attributes:
        colour: (n, height, width, 3) uint8 red, green and blue.
        depth: (n, height, width) float32 distance along the optical axis [m]; infinite for the background.
        body_ids: (n, height, width) int32 ids of bodies; -1 for the background.
        link_indices: (n, height, width) int32 links of those bodies; -1 is the base, and the background.
    """

    colour: NDArray[np.uint8]
    depth: NDArray[np.float32]
    body_ids: NDArray[np.int32]
    link_indices: NDArray[np.int32]

    def __repr__(self) -> str:
        count, height, width = self.depth.shape
        return f"<Images of {count} worlds, {width} x {height}>"


def take_images(scene: World, engine: Engine, camera: Camera, worlds: np.ndarray) -> Images:
    """Images of some worlds: the coordinates of each are copied to a scene, which is drawn.

    A camera that is mounted on a link of the original world follows that link in each world.
    """
    mounted = camera.link
    if mounted is not None:
        own = scene.bodies[mounted.body.id].links[mounted.index]
        camera.mount(own)
    try:
        images = []
        for world in worlds:
            copy_coordinates(engine, int(world), scene)
            images.append(camera.capture(scene))
    finally:
        camera.mount(mounted)
    if not images:
        size = (0, camera.height, camera.width)
        numbers = np.zeros(size, np.int32)
        return Images(np.zeros((*size, 3), np.uint8), np.zeros(size, np.float32), numbers, numbers.copy())
    return Images(*(np.stack([getattr(image, name) for image in images]) for name in Images._fields))
