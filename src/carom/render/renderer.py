"""Images of a world."""

from __future__ import annotations

from collections import OrderedDict
from dataclasses import dataclass
from typing import TYPE_CHECKING
from weakref import WeakKeyDictionary

import numpy as np
import warp as wp
from numpy.typing import NDArray

from carom.model.launch import Launch
from carom.model.real import Matrix3
from carom.render.appearance import appearance_of
from carom.render.kernels import image_kernel
from carom.render.lights import Light
from carom.render.parallel import run_all
from carom.render.projection import Matrix, is_singular, look_at, poses_to_matrices
from carom.render.scene import SceneArrays
from carom.render.structs import Lighting, Matrix4, Picture
from carom.render.view_buffers import Task, ViewBuffers

if TYPE_CHECKING:
    from carom.world import World

MAX_SIDE = 16384
MAX_PIXELS = 64 << 20
"""Largest image: width and height, and their product."""

KEPT_SIZES = 4
"""For so many sizes of images the memory is kept between images."""

_SHADOW_BIAS = 0.05
"""A surface this far behind what the light sees is still lit [m]."""


@dataclass(frozen=True, slots=True, eq=False)
class RawImage:
    """What one image shows; row 0 is the top.

    Attributes:
        rgba: (height, width, 4) uint8 red, green, blue and 255.
        depth: (height, width) float32 depth as in OpenGL's buffer: 0 at the near plane, 1 at the far one.
        label: (height, width) int32: body id + (link + 1) << 24; -1 where there is nothing.
    """

    rgba: NDArray[np.uint8]
    depth: NDArray[np.float32]
    label: NDArray[np.int32]


class Renderer:
    """Draws one world; get it from `renderer_of`. Not to be used by several threads at once."""

    def __init__(self) -> None:
        self._scene: SceneArrays | None = None
        self._targets: OrderedDict[tuple[int, int], _Target] = OrderedDict()

    def draw(
        self,
        world: World,
        view: Matrix,
        projection: Matrix,
        width: int,
        height: int,
        light: Light,
        projector: Matrix | None = None,
    ) -> RawImage:
        """Draws an image of the world as it is now.

        Args:
            world: The world.
            view: (4, 4) world to eye; the eye looks along -z, y is up.
            projection: (4, 4) eye to clip coordinates, as OpenGL has them.
            width: Number of columns.
            height: Number of rows.
            light: The light.
            projector: (4, 4) world to homogeneous texture coordinates, where textures are cast by a
                projector; None where they stick to the shapes.

        Raises:
            ValueError: The size is out of range, or a matrix is not finite or singular.
        """
        if not (1 <= width <= MAX_SIDE and 1 <= height <= MAX_SIDE and width * height <= MAX_PIXELS):
            raise ValueError(
                f"an image of {width} x {height} pixels cannot be drawn: sides go from 1 to {MAX_SIDE} and "
                f"all pixels up to {MAX_PIXELS}"
            )
        for matrix, name in ((view, "view"), (projection, "projection")):
            if not np.isfinite(matrix).all():
                raise ValueError(f"the {name} matrix is not finite")
            if is_singular(matrix):
                raise ValueError(f"the {name} matrix is singular")
        scene = self._present_scene(world)
        target = self._target(scene, width, height)
        link_to_world = poses_to_matrices(_present_poses(world, scene))
        return target.draw(link_to_world, view, projection, light, projector)

    def _present_scene(self, world: World) -> SceneArrays:
        appearance = appearance_of(world)
        scene = self._scene
        if scene is None or not scene.shows(world, appearance):
            self._scene = scene = SceneArrays(world, appearance)
            self._targets.clear()
        elif scene.update_textures(appearance.textures):
            self._targets.clear()
        return scene

    def _target(self, scene: SceneArrays, width: int, height: int) -> _Target:
        size = (width, height)
        target = self._targets.get(size)
        if target is None:
            self._targets[size] = target = _Target(scene, width, height)
            while len(self._targets) > KEPT_SIZES:
                self._targets.popitem(last=False)
        self._targets.move_to_end(size)
        return target


class _Target:
    """Memory and kernel runs for images of one size of one scene."""

    def __init__(self, scene: SceneArrays, width: int, height: int) -> None:
        self._scene = scene
        self._size = (width, height)
        self._view = ViewBuffers(scene, width, height)
        # Made when first needed: most images go without shadows.
        self._light_view: ViewBuffers | None = None
        self._light_tasks: list[Task] = []
        picture = Picture()
        links = len(scene.link_rows)
        picture.lighting = wp.zeros(1, dtype=Lighting, device="cpu")
        picture.link_rotation = wp.zeros(links, dtype=Matrix3, device="cpu")
        picture.link_to_projector = wp.zeros(links, dtype=Matrix4, device="cpu")
        picture.rgba = wp.zeros(width * height, dtype=wp.uint32, device="cpu")
        picture.depth = wp.zeros(width * height, dtype=wp.float32, device="cpu")
        picture.label = wp.zeros(width * height, dtype=wp.int32, device="cpu")
        self._picture = picture
        self._lighting = picture.lighting.numpy()
        self._link_rotation = picture.link_rotation.numpy()
        self._link_to_projector = picture.link_to_projector.numpy()
        self._rgba = picture.rgba.numpy().view(np.uint8).reshape(height, width, 4)
        self._depth = picture.depth.numpy().reshape(height, width)
        self._label = picture.label.numpy().reshape(height, width)
        self._image_tasks = self._make_image_tasks(self._view)

    def draw(
        self,
        link_to_world: Matrix,
        view: Matrix,
        projection: Matrix,
        light: Light,
        projector: Matrix | None,
    ) -> RawImage:
        self._view.look(projection @ view, link_to_world)
        self._link_rotation[:] = link_to_world[:, :3, :3]
        if projector is not None:
            np.matmul(projector, link_to_world, out=self._link_to_projector, casting="same_kind")
        self._set_lighting(light, projector is not None, projection)
        tasks = list(self._view.project)
        if light.shadow:
            light_view = self._light_view or self._make_light_view()
            direction = np.array(light.direction) / np.linalg.norm(light.direction)
            towards_origin = look_at(light.distance * direction, (0.0, 0.0, 0.0))
            light_view.look(projection @ towards_origin, link_to_world, two_sided=True)
            run_all(tasks + light_view.project)
            run_all(self._light_tasks)
        else:
            run_all(tasks)
        run_all(self._image_tasks)
        return RawImage(self._rgba.copy(), self._depth.copy(), self._label.copy())

    def _make_light_view(self) -> ViewBuffers:
        self._light_view = light_view = ViewBuffers(self._scene, *self._size)
        self._light_tasks = light_view.depth_tasks(self._scene)
        self._image_tasks = self._make_image_tasks(light_view)
        return light_view

    def _make_image_tasks(self, light_view: ViewBuffers) -> list[Task]:
        structs = [self._scene.struct, self._view.struct, light_view.struct, self._picture]
        bands = self._view.bands
        return [
            Launch(image_kernel, 1, [*structs, first, end]).function
            for first, end in zip(bands, bands[1:], strict=False)
        ]

    def _set_lighting(self, light: Light, projected: bool, projection: Matrix) -> None:
        lighting = self._lighting[0]
        direction = np.array(light.direction)
        lighting["direction"] = direction / np.linalg.norm(direction)
        lighting["colour"] = light.colour
        lighting["ambient"] = light.ambient
        lighting["diffuse"] = light.diffuse
        lighting["specular"] = light.specular
        lighting["shadow"] = light.shadow
        lighting["shade"] = light.shade
        # What (depth w, w) change by where a point comes nearer to the light.
        lighting["bias_depth"] = -_SHADOW_BIAS * projection[2, 2]
        lighting["bias_w"] = -_SHADOW_BIAS * projection[3, 2]
        lighting["projected"] = projected


def _present_poses(world: World, scene: SceneArrays) -> Matrix:
    """Poses (links, 7) of what is shown.

    After a step the rows of the poses in the world are those of its start, and getters count on that: so
    they are put back.
    """
    before = world.link_pose.copy()
    for body in world.bodies.values():
        body.update_link_poses()
    present = world.link_pose[scene.link_rows]
    world.link_pose[:] = before
    return present


def renderer_of(world: World) -> Renderer:
    """The renderer of a world."""
    renderer = _renderers.get(world)
    if renderer is None:
        renderer = _renderers[world] = Renderer()
    return renderer


_renderers: WeakKeyDictionary[World, Renderer] = WeakKeyDictionary()
