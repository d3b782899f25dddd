"""Buffers and kernel launches for the views of a scene and for images of one size."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from carom.layouts.images import Picture, View
from carom.native.kernels import depth_kernel, image_kernel, project_kernel
from carom.native.launch import Launch
from carom.native.products import product
from carom.native.tables import put_zeros
from carom.record import record
from carom.render.lights import Light
from carom.render.parallel import run_all, worker_count
from carom.render.projection import Matrix, facing_sign, to_pixels, unit_vector
from carom.render.scene import SceneArrays
from carom.render.shadows import ShadowCamera, shadow_camera

BANDS_PER_WORKER = 4
"""Bands of image rows for each thread: several, because some bands take longer than others."""

Task = Callable[[], None]


@record(eq=False)
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


@record(frozen=False, eq=False)
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
        self._image_tasks = self._make_image_tasks(self._view)

    def draw(
        self, link_to_world: Matrix, view: Matrix, projection: Matrix, light: Light, projector: Matrix | None
    ) -> RawImage:
        """Draw an image, with (links, 4, 4) poses of the links of the scene; see `Renderer.draw`."""
        self._view.look(product(projection, view), link_to_world)
        self._link_rotation[:] = link_to_world[:, :3, :3]
        if projector is not None:
            self._link_to_projector[:] = product(projector, link_to_world)
        self._set_lighting(light, projector is not None)
        image_tasks = self._image_tasks
        if light.shadow:
            camera = shadow_camera(light, self._scene, link_to_world, projection, *self._size)
            shadows = self._shadows_of_size(camera.width, camera.height)
            self._set_bias(camera)
            shadows.view.look(product(camera.projection, camera.view), link_to_world, two_sided=True)
            run_all(self._view.project + shadows.view.project)
            run_all(shadows.depth_tasks)
            image_tasks = shadows.image_tasks
        else:
            run_all(self._view.project)
        run_all(image_tasks)
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

    def _set_lighting(self, light: Light, projected: bool) -> None:
        lighting = self._lighting[0]
        lighting["direction"] = unit_vector(np.array(light.direction))
        for name in ("colour", "ambient", "diffuse", "specular", "shadow", "shade"):
            lighting[name] = getattr(light, name)
        lighting["projected"] = projected

    def _set_bias(self, camera: ShadowCamera) -> None:
        lighting = self._lighting[0]
        # Change of (depth w, w) when a point moves towards the light by the bias.
        lighting["bias_depth"] = -camera.bias * camera.projection[2, 2]
        lighting["bias_w"] = -camera.bias * camera.projection[3, 2]
