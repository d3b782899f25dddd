"""Memory of one eye's view of a scene, and the runs of the kernels that fill it."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from typing import Any

import numpy as np
import warp as wp

from carom.model.launch import Launch
from carom.model.real import Index4, Int32, Vector3, Vector4, real
from carom.render.kernels.draw import depth_kernel, project_kernel
from carom.render.kernels.structs import Matrix4, View
from carom.render.parallel import worker_count
from carom.render.projection import Matrix, facing_sign, to_pixels
from carom.render.scene import SceneArrays

BANDS_PER_WORKER = 4
"""Rows are shared out in more bands than there are threads: some show more than others."""

Task = Callable[[], None]


class ViewBuffers:
    """One view of a scene at one size.

    Attributes:
        struct: The arrays, for kernels.
        project: Tasks that find the triangles in view.
        bands: First row of each band, and the height.
    """

    def __init__(self, scene: SceneArrays, width: int, height: int) -> None:
        links = len(scene.link_rows)
        triangles = scene.triangle_count
        view = View()
        view.width = width
        view.height = height
        view.facing = zeros(1, real)
        view.link_to_pixel = zeros(links, Matrix4)
        view.vertex_pixel = zeros(scene.vertex_count, Vector4)
        for name in ("facet_first", "facet_second", "facet_third", "facet_depth"):
            setattr(view, name, zeros(triangles, Vector3))
        view.facet_box = zeros(triangles, Index4)
        view.facet_triangle = zeros(triangles, Int32)
        view.chunk_facet_count = zeros(scene.chunk_count, Int32)
        view.pixel_depth = zeros(width * height, real)
        view.pixel_facet = zeros(width * height, Int32)
        self.struct = view
        self._to_pixels = to_pixels(width, height)
        self._facing = view.facing.numpy()
        self._link_to_pixel = view.link_to_pixel.numpy()
        self.project: list[Task] = [
            Launch(project_kernel, 1, [scene.struct, view, chunk]).function
            for chunk in range(scene.chunk_count)
        ]
        count = min(BANDS_PER_WORKER * worker_count(), height)
        self.bands: list[int] = [height * band // count for band in range(count + 1)]

    def depth_tasks(self, scene: SceneArrays) -> list[Task]:
        """Tasks that find what is nearest in each pixel, to be run after those of `project`."""
        return [
            Launch(depth_kernel, 1, [scene.struct, self.struct, first, end]).function
            for first, end in pairwise(self.bands)
        ]

    def look(self, world_to_clip: Matrix, link_to_world: Matrix, *, two_sided: bool = False) -> None:
        """Sets where the eye is.

        Args:
            world_to_clip: (4, 4) product of projection and view matrix.
            link_to_world: (links, 4, 4) poses of the links.
            two_sided: Triangles are seen from behind, too.
        """
        world_to_pixel = self._to_pixels @ world_to_clip
        self._facing[0] = 0.0 if two_sided else facing_sign(world_to_pixel)
        np.matmul(world_to_pixel, link_to_world, out=self._link_to_pixel, casting="same_kind")


def zeros(count: int, dtype: Any) -> Any:
    """An array of zeros for kernels."""
    return wp.zeros(count, dtype=dtype, device="cpu")
