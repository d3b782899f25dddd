"""Buffers and kernel launches for the views of a scene: those of cameras, and those from the light."""

from __future__ import annotations

from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from carom.layouts.images import View
from carom.native.kernels import depth_kernel, project_kernel
from carom.native.launch import Launch
from carom.native.products import product
from carom.native.tables import put_array, put_zeros
from carom.render.lights import Light
from carom.render.parallel import Task, worker_count
from carom.render.projection import Matrix, facing_sign, to_pixels, unit_vector
from carom.render.scene import SceneArrays

if TYPE_CHECKING:
    from carom.render.shadows import ShadowCameras

BANDS_PER_WORKER = 4
"""Bands of image rows for each thread: several, because some bands take longer than others."""

_FACET_FIELDS = (
    "vertex_pixel",
    "facet_first",
    "facet_second",
    "facet_third",
    "facet_depth",
    "facet_box",
    "facet_triangle",
    "chunk_facet_count",
)


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
        """Set the cameras (n, 4, 4), world to clip coordinates, and the poses of the links (n, links, 4, 4).

        The first axis is that of the worlds; all cameras have the same lens.
        """
        world_to_pixel = product(self._to_pixels, world_to_clip)
        self._facing[0] = 0.0 if two_sided else facing_sign(world_to_pixel[0])
        matrices = product(world_to_pixel[:, None], link_to_world).reshape(-1, 4, 4)
        if len(matrices) == len(self._link_to_pixel):
            self._link_to_pixel[:] = matrices
        else:
            # Launches that were made before still have the matrices of another number of worlds.
            self._link_to_pixel = put_array(self.struct, "link_to_pixel", matrices)

    def share_cameras(self, other: ViewBuffers) -> None:
        """Have the same cameras and poses as other buffers of the same size, for launches that follow."""
        self._facing = put_array(self.struct, "facing", other._facing)
        self._link_to_pixel = put_array(self.struct, "link_to_pixel", other._link_to_pixel)

    def share_facets(self, other: ViewBuffers) -> None:
        """Have the same memory for facets as other buffers of the same scene, for launches that follow."""
        for name in _FACET_FIELDS:
            put_array(self.struct, name, other.struct.__dict__["memory"][name])


def write_lighting(rows: np.ndarray, light: Light, *, projected: bool = False) -> None:
    """Write a light to rows of `Picture.lighting`, but for the bias of its shadows."""
    rows["direction"] = unit_vector(np.array(light.direction))
    for name in ("colour", "ambient", "diffuse", "specular", "shadow", "shade"):
        rows[name] = getattr(light, name)
    rows["projected"] = projected


def write_bias(rows: np.ndarray, cameras: ShadowCameras) -> None:
    """Write the bias of the shadows to rows of `Picture.lighting`."""
    # Change of (depth w, w) when a point moves towards the light by the bias.
    rows["bias_depth"] = -cameras.biases * cameras.projections[:, 2, 2]
    rows["bias_w"] = -cameras.biases * cameras.projections[:, 3, 2]
