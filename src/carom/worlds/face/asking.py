"""Questions about where the bodies of many worlds are now: rays, overlaps, images, the window."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from carom.checks import Array, finite
from carom.engine.engine import Engine
from carom.engine.queries.ray_hits import RayHits
from carom.native.gates import gated
from carom.scene.bodies import Bodies
from carom.world.face.looking import window
from carom.world.world import World
from carom.worlds.body import BodyBatch
from carom.worlds.chosen import Mask, Where, world_numbers
from carom.worlds.glimpse import Glimpses
from carom.worlds.images import Images, ImageTaker, of_worlds
from carom.worlds.lone import copy_coordinates
from carom.worlds.parts.links import LinkBatch
from carom.worlds.parts.sizes import SizesOfWorlds
from carom.worlds.rays import RayCaster

if TYPE_CHECKING:
    from carom.camera import Camera
    from carom.pose import Pose
    from carom.render.lights import Light
    from carom.viewer.viewer import Viewer
    from carom.worlds.worlds import Worlds


class RayHitBatch(NamedTuple):
    """What one ray has hit in each world.

    Attributes:
        found: Whether it has hit something, (count,).
        bodies: Number of the body, -1 where nothing is hit, (count,).
        links: Index of its link, -1 for the base, likewise.
        position: The point in world axes [m], (count, 3); NaN where nothing is hit.
        normal: Unit normal of the surface there, likewise.
        distance: From the start of the ray [m], (count,); inf where nothing is hit.
    """

    found: Mask
    bodies: NDArray[np.int32]
    links: NDArray[np.int32]
    position: Array
    normal: Array
    distance: Array


class WorldsAsking:
    """Base class of `Worlds`: questions about what is where, and pictures of it; nothing moves."""

    count: int
    call_lock: Any
    _glimpses: Glimpses | None = None
    _scene: World
    _engine: Engine
    _bodies: Bodies[BodyBatch]
    _thread_count: int | None

    @gated("call_lock")
    def ray(self, start: ArrayLike, end: ArrayLike, *, mask: int = -1) -> RayHitBatch:
        """The first thing that a ray hits in each world.

        Args:
            start: In world axes [m], shape (3,) for all worlds, or (count, 3).
            end: Likewise.
            mask: Mask of the collision groups that it can hit.

        Raises:
            ValueError: The shapes do not fit, or a number is not finite.
        """
        first, last = self._point(start, "start"), self._point(end, "end")
        hits = self._ray_caster(first[:, np.newaxis], last[:, np.newaxis], mask)
        found = hits.bodies[:, 0] >= 0
        length = np.sqrt(np.square(last - first).sum(axis=1))
        missed = ~found[:, np.newaxis]
        return RayHitBatch(
            found,
            hits.bodies[:, 0],
            hits.links[:, 0],
            np.where(missed, np.nan, hits.positions[:, 0]),
            np.where(missed, np.nan, hits.normals[:, 0]),
            np.where(found, hits.fractions[:, 0] * length, np.inf),
        )

    @gated("call_lock")
    def rays(self, starts: ArrayLike, ends: ArrayLike, *, mask: int = -1) -> RayHits:
        """Results of rays in each world.

        Args:
            starts: Start points in world axes [m], shape (n, 3) for the same rays in all worlds, or (count,
                n, 3).
            ends: End points, likewise.
            mask: Mask of the collision groups that the rays can hit.
        """
        return self._ray_caster(starts, ends, mask)

    @gated("call_lock")
    def overlapping(self, lower: ArrayLike, upper: ArrayLike) -> list[list[LinkBatch]]:
        """The links whose bounds overlap a box, for each world, as `World.overlapping` finds them.

        Worlds are asked one after the other, which takes some 20 µs for each.

        Args:
            lower: Least corner in world axes [m], shape (3,) for all worlds, or (count, 3).
            upper: Greatest corner, likewise.

        Raises:
            ValueError: The shapes do not fit, or a number is not finite.
        """
        least, greatest = self._point(lower, "lower").tolist(), self._point(upper, "upper").tolist()
        known: dict[int, LinkBatch] = {}
        found: list[list[LinkBatch]] = []
        with SizesOfWorlds(self._scene, self._engine) as sizes:
            for number, ((a, b, c), (d, e, f)) in enumerate(zip(least, greatest, strict=True)):
                copy_coordinates(self._engine, number, self._scene)
                sizes.take(number)
                rows = self._scene.queries().overlapping((a, b, c), (d, e, f))
                for row in rows:
                    if row not in known:
                        body, link = self._scene.link_places[row]
                        known[row] = self._bodies.find(body).links[link]
                found.append([known[row] for row in rows])
        return found

    def _point(self, value: ArrayLike, name: str) -> Array:
        """A point in each world, (count, 3)."""
        given = finite(self._engine.take(value), name)
        if given.shape not in ((3,), (self.count, 3)):
            raise ValueError(f"{name} must have shape (3,) or ({self.count}, 3), not {given.shape}")
        return np.broadcast_to(given, (self.count, 3))

    @cached_property
    def _ray_caster(self) -> RayCaster:
        return RayCaster(self._engine, self._scene.link_places)

    @gated("call_lock")
    def images(
        self,
        camera: Camera,
        where: Where | None = None,
        *,
        poses: ArrayLike | Pose | None = None,
        fields_of_view: ArrayLike | None = None,
        lights: Sequence[Light] | None = None,
    ) -> Images:
        """Camera images of each world, drawn on all threads; with soft bodies or skins one after the other.

        Args:
            camera: A `Camera`, mounted on a link of the original world or fixed in the world.
            where: Which worlds: a mask (count,), their indices or a slice; None for all.
            poses: Where the camera is placed in each of the n worlds chosen, in the frame in which it is
                placed otherwise: a `Pose` of n, n of them, or (n, 7). As `camera` says if left out.
            fields_of_view: Vertical fields of view [degrees], (n,).
            lights: The light of each, n of them.

        Raises:
            ValueError: There are not n, a number is out of range, or lamps and parallel lights are mixed.
        """
        numbers = world_numbers(self._engine.take(where), self.count)
        own = of_worlds(camera, len(numbers), poses, fields_of_view, lights)
        return self._take_images(camera, numbers, own)

    def view(
        self,
        *,
        speed: float | None = None,
        title: str = "Carom",
        port: int | None = None,
        host: str = "127.0.0.1",
        **choice: Any,
    ) -> Viewer:
        """Open a window on some of the worlds: a page in the browser, as `World.view`.

        Args:
            speed: Simulated time / real time, which steps wait for; None for as fast as they go.
            title: Title of the page.
            port: Port to listen on; None for any.
            host: Address to listen on; by default only for this machine.
            **choice: `shown`, how many worlds or which ones; `chosen`, the one that is looked at first;
                `arrangement`, "grid" or "overlay"; `spacing` of the grid [m].

        Returns:
            The window, of which `shown` says and sets which worlds are shown.

        Raises:
            OSError: It cannot listen on the address.
            ValueError: There are no such worlds.
            NotImplementedError: They have soft bodies.
        """
        return window(cast("Worlds", self), speed, title=title, port=port, host=host, **choice)

    @property
    def glimpses(self) -> Glimpses:
        """What a viewer sees of some of the worlds."""
        if self._glimpses is None:
            self._glimpses = Glimpses(self._engine)
        return self._glimpses

    @cached_property
    def _take_images(self) -> ImageTaker:
        return ImageTaker(self._scene, self._engine, self._thread_count)
