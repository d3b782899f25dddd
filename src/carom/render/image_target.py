"""Buffers and kernel launches for images of one size."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from carom.layouts.images import Picture
from carom.native.kernels import image_kernel
from carom.native.launch import Launch
from carom.native.products import product
from carom.native.tables import put_zeros
from carom.render.lights import Light
from carom.render.parallel import Task, run_all, run_in_turn
from carom.render.projection import Matrix
from carom.render.scene import SceneArrays
from carom.render.views import ViewBuffers, write_bias, write_lighting

_SMALL = 1 << 15
"""Pixels and triangles together up to which one thread is done before others have woken up."""


@dataclass(frozen=True, repr=False, eq=False, slots=True)
class RawImage:
    """The results of one image; row 0 is the top.

    Attributes:
        rgba: (height, width, 4) uint8 red, green, blue and 255.
        depth: (height, width) float32 depth as in OpenGL's depth buffer: 0 at the near plane, 1 at the far
            plane.
        distance: (height, width) float32 distance from the camera along its viewing direction [m]; infinite
            for the background. Meaningful for perspective projections only.
        label: (height, width) int32: body id + (link + 1) << 24; -1 for the background.
    """

    rgba: NDArray[np.uint8]
    depth: NDArray[np.float32]
    distance: NDArray[np.float32]
    label: NDArray[np.int32]

    @classmethod
    def blank(cls, width: int, height: int) -> RawImage:
        """An image of the background only."""
        size = (height, width)
        return cls(
            np.full((*size, 4), 255, np.uint8),
            np.ones(size, np.float32),
            np.full(size, np.inf, np.float32),
            np.full(size, -1, np.int32),
        )


@dataclass(repr=False, eq=False, slots=True)
class _Shadows:
    """The view from the light, and the tasks that depend on it."""

    view: ViewBuffers
    depth_tasks: list[Task]
    image_tasks: list[Task]


class ImageTarget:
    """Draw images of one size of one scene."""

    def __init__(self, scene: SceneArrays, width: int, height: int) -> None:
        self._scene = scene
        self._size = (width, height)
        self._view = ViewBuffers(scene, width, height)
        # Created when first needed, because most images are drawn without shadows.
        self._shadows: dict[tuple[int, int], _Shadows] = {}
        picture = Picture()
        links = len(scene.link_rows)
        self._lighting = put_zeros(picture, "lighting", 1)
        self._link_rotation = put_zeros(picture, "link_rotation", links)
        self._link_to_projector = put_zeros(picture, "link_to_projector", links)
        pixels = width * height
        self._rgba = put_zeros(picture, "rgba", pixels).view(np.uint8).reshape(height, width, 4)
        self._depth = put_zeros(picture, "depth", pixels).reshape(height, width)
        self._distance = put_zeros(picture, "distance", pixels).reshape(height, width)
        self._label = put_zeros(picture, "label", pixels).reshape(height, width)
        self._picture = picture
        self._run = run_all if pixels + scene.triangle_count > _SMALL else run_in_turn
        self._image_tasks = self._make_image_tasks(self._view)

    def draw(
        self, link_to_world: Matrix, view: Matrix, projection: Matrix, light: Light, projector: Matrix | None
    ) -> RawImage:
        """Draw an image, with (links, 4, 4) poses of the links of the scene; see `Renderer.draw`."""
        self._view.look(product(projection, view)[None], link_to_world[None])
        self._link_rotation[:] = link_to_world[:, :3, :3]
        if projector is not None:
            self._link_to_projector[:] = product(projector, link_to_world)
        write_lighting(self._lighting, light, projected=projector is not None)
        image_tasks = self._image_tasks
        if light.shadow:
            from carom.render.shadows import shadow_cameras

            cameras = shadow_cameras(light, self._scene, link_to_world[None], projection, *self._size)
            shadows = self._shadows_of_size(cameras.width, cameras.height)
            write_bias(self._lighting, cameras)
            shadows.view.look(cameras.world_to_clip, link_to_world[None], two_sided=True)
            self._run(self._view.project + shadows.view.project)
            self._run(shadows.depth_tasks)
            image_tasks = shadows.image_tasks
        else:
            self._run(self._view.project)
        self._run(image_tasks)
        return RawImage(self._rgba.copy(), self._depth.copy(), self._distance.copy(), self._label.copy())

    def _shadows_of_size(self, width: int, height: int) -> _Shadows:
        shadows = self._shadows.get((width, height))
        if shadows is None:
            view = ViewBuffers(self._scene, width, height)
            shadows = _Shadows(view, view.depth_tasks(self._scene), self._make_image_tasks(view))
            self._shadows[width, height] = shadows
        return shadows

    def _make_image_tasks(self, light_view: ViewBuffers) -> list[Task]:
        structs = [self._scene.struct, self._view.struct, light_view.struct, self._picture]
        bands = self._view.bands
        return [Launch(image_kernel, 1, [*structs, first, end]).function for first, end in pairwise(bands)]
