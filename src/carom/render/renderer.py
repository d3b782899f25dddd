"""The renderer of a world, which draws its images."""

from __future__ import annotations

from collections import OrderedDict
from typing import TYPE_CHECKING
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from carom.engine.presence import absent_links
from carom.render.appearance import appearance_of
from carom.render.image_target import ImageTarget, RawImage
from carom.render.lights import Light
from carom.render.projection import Matrix, is_singular, poses_to_matrices
from carom.render.scene import SceneArrays, stretch_parts

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from carom.render.image_batch import ImageBatch, RawImages
    from carom.render.world_looks import WorldLooks
    from carom.scene.core.world_core import WorldCore

MAX_SIDE = 16384
MAX_PIXELS = 64 << 20
"""Largest number of pixels of an image; its width and height are at most `MAX_SIDE`."""

KEPT_SIZES = 4
"""Number of image sizes whose memory is kept between images."""

_ONLY_WORLD = np.zeros(1, dtype=np.int64)


class Renderer:
    """Draw images of one world, whose lock it takes; get it from `renderer_of`."""

    def __init__(self, as_pybullet: bool = False) -> None:
        self._as_pybullet = as_pybullet
        self._scene: SceneArrays | None = None
        self._targets: OrderedDict[tuple[int, int], ImageTarget] = OrderedDict()
        # The last one, by its size and its number of threads.
        self._batch: tuple[tuple[int, int, int], ImageBatch] | None = None

    def draw(
        self,
        world: WorldCore,
        view: Matrix,
        projection: Matrix,
        width: int,
        height: int,
        light: Light,
        projector: Matrix | None = None,
    ) -> RawImage:
        """Draw an image of the present state of the world.

        Args:
            world: The world.
            view: (4, 4) world to eye coordinates; the camera looks along -z, y is up.
            projection: (4, 4) eye to clip coordinates, as in OpenGL.
            width: Number of columns.
            height: Number of rows.
            light: The light.
            projector: (4, 4) world to homogeneous texture coordinates, if textures come from a projector;
                None if they are fixed to the shapes.

        Raises:
            ValueError: The size is out of range, or a matrix is not finite.
        """
        _check_size(width, height)
        for matrix, name in ((view, "view"), (projection, "projection")):
            if not np.isfinite(matrix).all():
                raise ValueError(f"the {name} matrix is not finite")
        if is_singular(view) or is_singular(projection):
            # A singular matrix projects no triangle. Without a window, for instance, matrices are all zeros.
            return RawImage.blank(width, height)
        with world.call_lock:
            scene = self._present_scene(world)
            target = self._target(scene, width, height)
            with world.present_poses():
                scene.follow_nodes()
                link_to_world = poses_to_matrices(world.link_pose[scene.link_rows])
            absent = absent_links(world.arrays, scene.link_rows, _ONLY_WORLD)
            if absent is not None:
                link_to_world[absent[0]] = 0.0
            return target.draw(link_to_world, view, projection, light, projector)

    def draw_worlds(
        self,
        world: WorldCore,
        link_poses: NDArray[np.float64],
        views: Matrix,
        projection: Matrix,
        width: int,
        height: int,
        light: Light | Sequence[Light],
        threads: int,
        absent: NDArray[np.bool_] | None = None,
        looks: WorldLooks | None = None,
        numbers: NDArray[np.int64] | None = None,
        sizes: Mapping[tuple[int, int, int], NDArray[np.float64]] | None = None,
    ) -> RawImages:
        """Draw images of many worlds with the bodies of this one, none of them soft.

        Args:
            world: The world.
            link_poses: (n, links, 7) `World.link_pose` in each world.
            views: (n, 4, 4) world to eye coordinates in each world.
            projection: (4, 4) eye to clip coordinates, or (n, 4, 4) in each world.
            width: Number of columns.
            height: Number of rows.
            light: The light, or one for each world.
            threads: Number of threads.
            absent: Links of bodies that are absent, (n, links); None for none.
            looks: What differs between worlds of colours and textures; None for nothing.
            numbers: Which of the worlds of `looks` these are, (n,).
            sizes: Lengths of the sides of visible shapes in each world [m], (n, 3), by number of the body,
                link and number of the visible shape; None for nothing.

        Raises:
            ValueError: The size is out of range.
        """
        from carom.render.image_batch import ImageBatch

        _check_size(width, height)
        sizes = sizes or {}
        scene = self._present_scene(world, with_skins=False, own=frozenset(sizes))
        key = (width, height, threads)
        if self._batch is None or self._batch[0] != key:
            self._batch = key, ImageBatch(scene, width, height, threads)
        poses = link_poses[:, scene.link_rows]
        matrices = poses_to_matrices(poses.reshape(-1, 7)).reshape(*poses.shape[:2], 4, 4)
        if absent is not None:
            matrices[absent[:, scene.link_rows]] = 0.0
        turns, growth = matrices[..., :3, :3], None
        if sizes:
            turns, growth = turns.copy(), stretch_parts(matrices, scene, sizes)
        struct, first_looks = scene.struct, None
        if looks and numbers is not None:
            old = scene.struct.__dict__["memory"]["texel"]
            struct = looks.struct_for(scene)
            if scene.struct.__dict__["memory"]["texel"] is not old:
                self._targets.clear()
            first_looks = (numbers + 1) * len(scene.part_shapes)
        return self._batch[1].draw(matrices, views, projection, light, struct, first_looks, turns, growth)

    def _present_scene(
        self, world: WorldCore, *, with_skins: bool = True, own: frozenset[tuple[int, int, int]] = frozenset()
    ) -> SceneArrays:
        appearance = appearance_of(world)
        scene = self._scene
        is_other = scene is not None and scene.with_skins != with_skins and bool(appearance.skins)
        if scene is None or is_other or scene.own != own or not scene.shows(world, appearance):
            self._scene = scene = SceneArrays(
                world, appearance, self._as_pybullet, with_skins=with_skins, own=own
            )
            self._forget_targets()
        elif scene.update_textures(appearance.textures):
            self._forget_targets()
        return scene

    def _forget_targets(self) -> None:
        self._targets.clear()
        self._batch = None

    def _target(self, scene: SceneArrays, width: int, height: int) -> ImageTarget:
        size = (width, height)
        target = self._targets.get(size)
        if target is None:
            self._targets[size] = target = ImageTarget(scene, width, height)
            while len(self._targets) > KEPT_SIZES:
                self._targets.popitem(last=False)
        self._targets.move_to_end(size)
        return target


def renderer_of(world: WorldCore, *, as_pybullet: bool = False) -> Renderer:
    """The renderer of a world; with `as_pybullet` the one that shows round shapes as PyBullet's images do."""
    renderers = _as_pybullet if as_pybullet else _renderers
    renderer = renderers.get(world)
    if renderer is None:
        renderer = renderers[world] = Renderer(as_pybullet)
    return renderer


_renderers: WeakKeyDictionary[WorldCore, Renderer] = WeakKeyDictionary()
_as_pybullet: WeakKeyDictionary[WorldCore, Renderer] = WeakKeyDictionary()


def _check_size(width: int, height: int) -> None:
    if not (1 <= width <= MAX_SIDE and 1 <= height <= MAX_SIDE and width * height <= MAX_PIXELS):
        raise ValueError(
            f"an image of {width} x {height} pixels cannot be drawn: sides go from 1 to {MAX_SIDE} and "
            f"all pixels up to {MAX_PIXELS}"
        )
