"""Camera images of many worlds."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from carom.camera_image import bodies_and_links
from carom.checks import Array
from carom.description.pose import Pose
from carom.description.transform import compose, inverse
from carom.engine.engine import Engine
from carom.engine.presence import absent_links
from carom.engine.task import Task
from carom.engine.threads import WORLDS_PER_THREAD
from carom.native.cpu import core_count
from carom.native.kernels import link_poses_kernel
from carom.native.launch import KernelStructs, Launch
from carom.render.image_batch import RawImages
from carom.render.renderer import renderer_of
from carom.world.world import World
from carom.worlds.lone import copy_coordinates

if TYPE_CHECKING:
    from carom.camera import Camera
    from carom.scene.link import Link


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


class ImageTaker:
    """Takes images of the worlds of an engine, as copies of a scene.

    Args:
        scene: The scene.
        engine: The engine.
        threads: Number of threads; None for the number of cores available.
    """

    def __init__(self, scene: World, engine: Engine, threads: int | None) -> None:
        self._scene = scene
        self._engine = engine
        self._threads = threads or core_count()
        self._place: Task = engine.task(_launches, WORLDS_PER_THREAD)

    def __call__(self, camera: Camera, worlds: np.ndarray) -> Images:
        """Images of some worlds, by index.

        A camera that is mounted on a link of the original world follows that link in each world.
        """
        if self._scene.contact_arrays.soft.bodies or not len(worlds):
            raw = self._one_by_one(camera, worlds)
        else:
            raw = self._at_once(camera, worlds)
        return Images(np.ascontiguousarray(raw.rgba[..., :3]), raw.distance, *bodies_and_links(raw.label))

    def _at_once(self, camera: Camera, worlds: np.ndarray) -> RawImages:
        """One native call on each thread."""
        self._place(worlds)
        link_poses = np.asarray(self._engine.arrays.state.numpy["link_pose"])[worlds]
        return renderer_of(self._scene).draw_worlds(
            self._scene,
            link_poses,
            camera.views(self._camera_poses(camera, link_poses)),
            camera.projection,
            camera.width,
            camera.height,
            camera.light,
            self._threads,
            absent_links(self._engine.arrays, np.arange(link_poses.shape[1]), worlds),
        )

    def _camera_poses(self, camera: Camera, link_poses: Array) -> Array:
        """World poses of the camera in each world, (n, 7)."""
        if camera.link is None and camera.following is None:
            return np.repeat(np.concatenate(camera.pose)[None], len(link_poses), axis=0)
        poses = np.empty((len(link_poses), 7))
        for pose, of_world in zip(poses, link_poses, strict=True):

            def frame_of(link: Link, own: Array = of_world) -> Pose:
                x, y, z, qx, qy, qz, qw = own[link.body.first_link + 1 + link.index].tolist()
                return compose(Pose((x, y, z), (qx, qy, qz, qw)), inverse(link.inertial_frame))

            pose[:3], pose[3:] = camera.pose_where(lambda link, of=frame_of: of(self._own(link)))
        return poses

    def _own(self, link: Link) -> Link:
        """The link of the scene that stands for one of the original world."""
        return self._scene.bodies[link.body.id].links[link.index]

    def _one_by_one(self, camera: Camera, worlds: np.ndarray) -> RawImages:
        """The same with soft bodies: the vertices of their surfaces differ between worlds."""
        size = (len(worlds), camera.height, camera.width)
        images = RawImages(
            np.empty((*size, 4), np.uint8), np.empty(size, np.float32), np.empty(size, np.int32)
        )
        for place, world in enumerate(worlds.tolist()):
            copy_coordinates(self._engine, world, self._scene)
            pose = camera.pose_where(lambda link: _frame(self._own(link)))
            image = renderer_of(self._scene).draw(
                self._scene,
                camera.views(np.concatenate(pose)[None])[0],
                camera.projection,
                camera.width,
                camera.height,
                camera.light,
            )
            images.rgba[place], images.distance[place] = image.rgba, image.distance
            images.label[place] = image.label
        return images


def _frame(link: Link) -> Pose:
    """World pose of the frame of a link."""
    (x, y, z), (i, j, k, w) = (part.tolist() for part in link.pose)
    return Pose((x, y, z), (i, j, k, w))


def _launches(structs: KernelStructs) -> list[Launch]:
    return [structs.launch(link_poses_kernel, first_world=0)]
