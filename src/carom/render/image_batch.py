"""Images of many worlds at once: one native call on each thread, which draws one world after the other."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from carom.engine.world_calls import WorldCalls
from carom.layouts.images import Picture
from carom.native.kernels import shadow_map_kernel, whole_image_kernel
from carom.native.launch import Launch
from carom.native.products import product
from carom.native.tables import put_array, put_zeros
from carom.render.lights import Light
from carom.render.projection import Matrix
from carom.render.scene import SceneArrays
from carom.render.shadows import ShadowCameras, shadows_of
from carom.render.views import ViewBuffers, write_bias, write_lighting


@dataclass(frozen=True, repr=False, eq=False, slots=True)
class RawImages:
    """The results of `RawImage` for n worlds, but for the depth; row 0 is the top.

    Attributes:
        rgba: (n, height, width, 4) uint8 red, green, blue and 255.
        distance: (n, height, width) float32 distance from the camera along its viewing direction [m];
            infinite for the background.
        label: (n, height, width) int32: body id + (link + 1) << 24; -1 for the background.
    """

    rgba: NDArray[np.uint8]
    distance: NDArray[np.float32]
    label: NDArray[np.int32]


class _Thread:
    """The workspace of a thread: the view of the camera, and that from the light once shadows were drawn."""

    def __init__(self, scene: SceneArrays, width: int, height: int) -> None:
        self._scene = scene
        self.view = ViewBuffers(scene, width, height)
        self._light: tuple[tuple[int, int], ViewBuffers] | None = None

    def light_view(self, width: int, height: int) -> ViewBuffers:
        if self._light is None or self._light[0] != (width, height):
            light = ViewBuffers(self._scene, width, height)
            # A shadow map is ready before the camera's facets are found.
            light.share_facets(self.view)
            self._light = (width, height), light
        return self._light[1]


class ImageBatch:
    """Draw images of one size of one scene in many worlds, on all threads.

    Args:
        scene: What is visible; none of it soft, because all worlds share the vertices.
        width: Number of columns.
        height: Number of rows.
        threads: Number of threads.
    """

    def __init__(self, scene: SceneArrays, width: int, height: int, threads: int) -> None:
        self._scene = scene
        self._size = (width, height)
        self._calls = WorldCalls(threads)
        self._workspaces = [_Thread(scene, width, height) for _ in range(threads)]

    def draw(
        self,
        link_to_world: Matrix,
        views: Matrix,
        projection: Matrix,
        light: Light | Sequence[Light],
        scene: Any = None,
        first_looks: NDArray[np.int64] | None = None,
        turns: Matrix | None = None,
        growth: Matrix | None = None,
    ) -> RawImages:
        """Draw an image of each world.

        Args:
            link_to_world: (n, links, 4, 4) poses of the links of the scene in each world.
            views: (n, 4, 4) world to eye coordinates in each world.
            projection: (4, 4) eye to clip coordinates, or (n, 4, 4) in each world.
            light: The light, or one for each world.
            scene: The arrays of the scene with the looks of many worlds; None for its own.
            first_looks: (n,) where the looks of the parts begin in them.
            turns: (n, links, 3, 3) rotations of the links; None for those of `link_to_world`.
            growth: (n, links) factors on the radii of bounding spheres; None for none.

        Raises:
            ValueError: Some of the lights that cast shadows are lamps, and some are parallel.
        """
        width, height = self._size
        count = len(link_to_world)
        picture = Picture()
        lighting = put_zeros(picture, "lighting", count)
        turns = link_to_world[..., :3, :3] if turns is None else turns
        put_array(picture, "link_rotation", turns.reshape(-1, 3, 3))
        put_zeros(picture, "link_to_projector", 0)
        rgba, _, distance, label = (
            put_zeros(picture, name, count * width * height)
            for name in ("rgba", "depth", "distance", "label")
        )
        lights = [light] if isinstance(light, Light) else [*light]
        if len(lights) == 1:
            write_lighting(lighting, lights[0])
        else:
            for row, own in enumerate(lights):
                write_lighting(lighting[row : row + 1], own)
        if first_looks is not None:
            lighting["first_look"] = first_looks
        cameras, shadow = None, any(own.shadow for own in lights)
        if shadow:
            cameras = shadows_of(lights, self._scene, link_to_world, projection, width, height, growth)
            write_bias(lighting, cameras)
        world_to_clip = product(projection, views)
        links = len(self._scene.link_rows)
        scene = self._scene.struct if scene is None else scene
        launches: list[list[Launch]] = []
        for view, lamp in self._look(world_to_clip, link_to_world, cameras)[:count]:
            own = [Launch(whole_image_kernel, 1, [scene, view, lamp, picture, links, 0])]
            if shadow:
                own.insert(0, Launch(shadow_map_kernel, 1, [scene, lamp, links, 0]))
            launches.append(own)
        self._calls.run(count, launches, chunk=1)
        shape = (count, height, width)
        return RawImages(
            rgba.view(np.uint8).reshape(*shape, 4), distance.reshape(shape), label.reshape(shape)
        )

    def _look(
        self, world_to_clip: Matrix, link_to_world: Matrix, cameras: ShadowCameras | None
    ) -> list[tuple[Any, Any]]:
        """The views of each thread, from the camera and from the light."""
        views = [workspace.view for workspace in self._workspaces]
        views[0].look(world_to_clip, link_to_world)
        lights = views
        if cameras is not None:
            size = cameras.width, cameras.height
            lights = [workspace.light_view(*size) for workspace in self._workspaces]
            lights[0].look(cameras.world_to_clip, link_to_world, two_sided=True)
        for others in (views, lights):
            for other in others[1:]:
                other.share_cameras(others[0])
        return [(view.struct, light.struct) for view, light in zip(views, lights, strict=True)]
