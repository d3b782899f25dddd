"""Buffers of one view of a scene, and the kernel launches that fill them."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

from carom.layouts.images import View
from carom.native.kernels import depth_kernel, project_kernel
from carom.native.launch import Launch
from carom.native.products import product
from carom.native.tables import put_zeros
from carom.render.parallel import worker_count
from carom.render.projection import Matrix, facing_sign, to_pixels
from carom.render.scene import SceneArrays

BANDS_PER_WORKER = 4
"""Bands of image rows for each thread: several, because some bands take longer than others."""

Task = Callable[[], None]


class ViewBuffers:
    """Buffers of one view of a scene at one image size.

    Attributes:
        struct: The arrays, as the kernels take them.
        project: Tasks that find the triangles in view, one for each chunk of the scene.
        bands: First row of each band, followed by the image height.
    """

    def __init__(self, scene: SceneArrays, width: int, height: int) -> None:
        links = len(scene.link_rows)
        triangles = scene.triangle_count
        view = View()
        view.width = width
        view.height = height
        self._facing = put_zeros(view, "facing", 1)
        self._link_to_pixel = put_zeros(view, "link_to_pixel", links)
        put_zeros(view, "vertex_pixel", scene.vertex_count)
        for name in ("facet_first", "facet_second", "facet_third", "facet_depth"):
            put_zeros(view, name, triangles)
        put_zeros(view, "facet_box", triangles)
        put_zeros(view, "facet_triangle", triangles)
        put_zeros(view, "chunk_facet_count", scene.chunk_count)
        put_zeros(view, "pixel_depth", width * height)
        put_zeros(view, "pixel_facet", width * height)
        self.struct = view
        self._to_pixels = to_pixels(width, height)
        self.project: list[Task] = [
            Launch(project_kernel, 1, [scene.struct, view, chunk]).function
            for chunk in range(scene.chunk_count)
        ]
        count = min(BANDS_PER_WORKER * worker_count(), height)
        self.bands: list[int] = [height * band // count for band in range(count + 1)]

    def depth_tasks(self, scene: SceneArrays) -> list[Task]:
        """Tasks that find the smallest depth in each pixel; run them after those of `project`."""
        return [
            Launch(depth_kernel, 1, [scene.struct, self.struct, first, end]).function
            for first, end in pairwise(self.bands)
        ]

    def look(self, world_to_clip: Matrix, link_to_world: Matrix, *, two_sided: bool = False) -> None:
        """Set the camera (4, 4), world to clip coordinates, and the poses of the links (links, 4, 4)."""
        world_to_pixel = product(self._to_pixels, world_to_clip)
        self._facing[0] = 0.0 if two_sided else facing_sign(world_to_pixel)
        self._link_to_pixel[:] = product(world_to_pixel, link_to_world)
