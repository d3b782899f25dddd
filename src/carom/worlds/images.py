"""Camera images of many worlds."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple, Protocol, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from carom.checks import Array, finite
from carom.description.pose import Pose
from carom.description.transform import compose, inverse
from carom.engine.engine import Engine
from carom.engine.presence import absent_links
from carom.engine.task import Task
from carom.engine.threads import WORLDS_PER_THREAD
from carom.model.body_spec import BodySpec
from carom.native.cpu import core_count
from carom.native.kernels import link_poses_kernel
from carom.native.launch import KernelStructs, Launch
from carom.pose import Pose as WorldPose
from carom.pose import numbers_of
from carom.render.appearance import appearance_of
from carom.render.camera_image import bodies_and_links
from carom.render.image_batch import RawImages
from carom.render.lights import Light
from carom.render.renderer import renderer_of
from carom.render.world_looks import looks_of
from carom.world.world import World
from carom.worlds.batch import AnyLink
from carom.worlds.chosen import choose
from carom.worlds.lone import copy_coordinates
from carom.worlds.parts.sizes import visible_sizes

if TYPE_CHECKING:
    from carom.camera import Camera
    from carom.scene.link import Link


class HasId(Protocol):
    """A body, in one world or in many."""

    @property
    def id(self) -> int:
        """Its number."""
        ...


class _Arrays(NamedTuple):
    colour: NDArray[np.uint8]
    depth: NDArray[np.float32]
    body_ids: NDArray[np.int32]
    link_indices: NDArray[np.int32]


class Images(_Arrays):
    """Images of a camera in each world; row 0 is the top.

    Attributes:
        colour: (n, height, width, 3) uint8 red, green and blue.
        depth: (n, height, width) float32 distance along the optical axis [m]; infinite for the background.
        body_ids: (n, height, width) int32 ids of bodies; -1 for the background.
        link_indices: (n, height, width) int32 links of those bodies; -1 is the base, and the background.
    """

    _specs: Mapping[int, BodySpec]

    def __repr__(self) -> str:
        count, height, width = self.depth.shape
        return f"<Images of {count} worlds, {width} x {height}>"

    @classmethod
    def of(cls, raw: RawImages, scene: World) -> Images:
        """Images of worlds that are copies of a scene."""
        images = cls(np.ascontiguousarray(raw.rgba[..., :3]), raw.distance, *bodies_and_links(raw.label))
        # Bodies may be gone when their pixels are asked for.
        images._specs = {number: body.spec for number, body in scene.bodies.items()}
        return images

    def mask(self, body: HasId | int | str, link: AnyLink | None = None) -> NDArray[np.bool_]:
        """The pixels in which a body, or one link of it, is visible in each world.

        Args:
            body: The body, its number or its name; of several with one name the first.
            link: The link, its index (-1 is the base) or its name; None for the whole body.

        Returns:
            (n, height, width) booleans.

        Raises:
            IndexError, KeyError: There is no such body or link.
        """
        numbers = {spec.name: number for number, spec in reversed([*self._specs.items()])}
        number = numbers.get(body) if isinstance(body, str) else getattr(body, "id", body)
        spec = self._specs.get(cast("int", number))
        if spec is None:
            raise KeyError(f"there is no body {body!r}; there are {', '.join(numbers)}")
        seen: NDArray[np.bool_] = self.body_ids == number
        if link is not None:
            names = [each.name for each in spec.links]
            sought = link if isinstance(link, int | str) else link.index
            index = -1 if sought in (-1, spec.base.name) else choose("link", names, sought)
            seen &= self.link_indices == index
        return seen


class OfWorlds(NamedTuple):
    """What differs between n worlds of which images are taken; None for what doesn't.

    Attributes:
        poses: Of the camera, where it is placed: in the world, or in the frame of its link, (n, 7).
        projections: From eye to clip coordinates, (n, 4, 4).
        lights: The light of each.
    """

    poses: Array | None = None
    projections: Array | None = None
    lights: Sequence[Light] | None = None


NOTHING = OfWorlds()


def of_worlds(
    camera: Camera,
    count: int,
    poses: ArrayLike | WorldPose | None,
    fields_of_view: ArrayLike | None,
    lights: Sequence[Light] | None,
) -> OfWorlds:
    """What users give for each of `count` worlds, checked.

    Raises:
        ValueError: There are not as many, or a number is out of range.
    """
    placed = lenses = None
    if poses is not None:
        place, turn = numbers_of(poses)
        sizes = np.sqrt(np.square(turn).sum(axis=-1, keepdims=True))
        if (sizes == 0.0).any():
            raise ValueError("the quaternion of a camera must not be 0")
        alike = np.broadcast_shapes(place.shape[:-1], turn.shape[:-1])
        parts = np.broadcast_to(place, (*alike, 3)), np.broadcast_to(turn / sizes, (*alike, 4))
        placed = np.concatenate(parts, axis=-1)
        placed = _for_each(placed, count, 7, "poses")
    if fields_of_view is not None:
        degrees = finite(fields_of_view, "fields_of_view")
        lenses = camera.projections(_for_each(degrees[..., np.newaxis], count, 1, "fields_of_view")[:, 0])
    if lights is not None:
        lights = [*lights]
        if len(lights) != count or not all(isinstance(light, Light) for light in lights):
            raise ValueError(f"lights must be {count} carom.camera.Light, one for each world chosen")
    return OfWorlds(placed, lenses, lights)


def _for_each(values: Array, count: int, length: int, name: str) -> Array:
    if values.shape not in ((length,), (count, length)):
        raise ValueError(f"{name} must be one for each of the {count} worlds chosen, or one for all")
    return np.broadcast_to(values, (count, length))


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

    def __call__(self, camera: Camera, worlds: np.ndarray, own: OfWorlds = NOTHING) -> Images:
        """Images of some worlds, by index, with what differs between them.

        A camera that is mounted on a link of the original world follows that link in each world.
        """
        shaped = bool(self._scene.contact_arrays.soft.bodies or appearance_of(self._scene).skins)
        alone = shaped or camera.is_orthographic
        if alone or not len(worlds):
            if looks_of(self._scene, self._engine.arrays.world_count) or self._sizes(worlds):
                raise NotImplementedError(
                    "colours, textures and sizes in worlds with soft bodies or skins, or for orthographic "
                    "cameras, cannot differ between them yet: take images of worlds.extract(number)"
                )
            raw = self._one_by_one(camera, worlds, own)
        else:
            raw = self._at_once(camera, worlds, own)
        return Images.of(raw, self._scene)

    def _at_once(self, camera: Camera, worlds: np.ndarray, own: OfWorlds) -> RawImages:
        """One native call on each thread."""
        self._place(worlds)
        link_poses = np.asarray(self._engine.arrays.state.numpy["link_pose"])[worlds]
        return renderer_of(self._scene).draw_worlds(
            self._scene,
            link_poses,
            camera.views(self._camera_poses(camera, link_poses, own.poses)),
            camera.projection if own.projections is None else own.projections,
            camera.width,
            camera.height,
            camera.light if own.lights is None else own.lights,
            self._threads,
            absent_links(self._engine.arrays, np.arange(link_poses.shape[1]), worlds),
            looks_of(self._scene, self._engine.arrays.world_count),
            np.asarray(worlds, dtype=np.int64),
            self._sizes(worlds),
        )

    def _sizes(self, worlds: np.ndarray) -> dict[tuple[int, int, int], Array]:
        return visible_sizes(self._scene, self._engine, worlds)

    def _camera_poses(self, camera: Camera, link_poses: Array, local: Array | None) -> Array:
        """World poses of the camera in each world, (n, 7), as it is placed, or as `local` says (n, 7)."""
        if camera.link is None and camera.following is None:
            if local is not None:
                return local
            return np.repeat(np.concatenate(camera.pose)[None], len(link_poses), axis=0)
        poses = np.empty((len(link_poses), 7))
        for number, (pose, of_world) in enumerate(zip(poses, link_poses, strict=True)):

            def frame_of(link: Link, own: Array = of_world) -> Pose:
                x, y, z, qx, qy, qz, qw = own[link.body.first_link + 1 + link.index].tolist()
                return compose(Pose((x, y, z), (qx, qy, qz, qw)), inverse(link.inertial_frame))

            placed = None if local is None else _pose_of(local[number])
            pose[:3], pose[3:] = camera.pose_where(lambda link, of=frame_of: of(self._own(link)), placed)
        return poses

    def _own(self, link: Link) -> Link:
        """The link of the scene that stands for one of the original world."""
        return self._scene.bodies[link.body.id].links[link.index]

    def _one_by_one(self, camera: Camera, worlds: np.ndarray, own: OfWorlds) -> RawImages:
        """The same with soft bodies and skins, whose vertices differ, and for orthographic cameras."""
        size = (len(worlds), camera.height, camera.width)
        images = RawImages(
            np.empty((*size, 4), np.uint8), np.empty(size, np.float32), np.empty(size, np.int32)
        )
        for place, world in enumerate(worlds.tolist()):
            copy_coordinates(self._engine, world, self._scene)
            placed = None if own.poses is None else _pose_of(own.poses[place])
            pose = camera.pose_where(lambda link: _frame(self._own(link)), placed)
            image = renderer_of(self._scene).draw(
                self._scene,
                camera.views(np.concatenate(pose)[None])[0],
                camera.projection if own.projections is None else own.projections[place],
                camera.width,
                camera.height,
                camera.light if own.lights is None else own.lights[place],
            )
            images.rgba[place], images.distance[place] = image.rgba, camera.distances(image)
            images.label[place] = image.label
        return images


def _pose_of(numbers: Array) -> Pose:
    x, y, z, qx, qy, qz, qw = numbers.tolist()
    return Pose((x, y, z), (qx, qy, qz, qw))


def _frame(link: Link) -> Pose:
    """World pose of the frame of a link."""
    (x, y, z), (i, j, k, w) = (part.tolist() for part in link.pose)
    return Pose((x, y, z), (i, j, k, w))


def _launches(structs: KernelStructs) -> list[Launch]:
    return [structs.launch(link_poses_kernel, first_world=0)]
