"""Questions about where the bodies of a world are: rays, nearest points, overlaps, images."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple, cast

import numpy as np

from carom.checks import Array, finite, vector
from carom.native.gates import alone
from carom.queries.ray_hits import RayHits

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from carom.camera import Camera
    from carom.camera_image import CameraImage
    from carom.scene.body import Body
    from carom.scene.link import Link
    from carom.world.world import World


class RayHit(NamedTuple):
    """What a ray has hit.

    Attributes:
        link: The link.
        position: The point in world axes [m], shape (3,).
        normal: Unit normal of the surface there, shape (3,).
        distance: From the start of the ray [m].
    """

    link: Link
    position: Array
    normal: Array
    distance: float

    @property
    def body(self) -> Body:
        """The body that the link belongs to."""
        return self.link.body


class Nearness(NamedTuple):
    """The nearest points of two shapes.

    Attributes:
        a: A link of what was asked for first.
        b: A link of what was asked for second.
        point_on_a: In world axes [m], shape (3,).
        point_on_b: Likewise.
        normal: Unit normal on `b` towards `a`.
        distance: [m]; negative where they overlap.
    """

    a: Link
    b: Link
    point_on_a: Array
    point_on_b: Array
    normal: Array
    distance: float


class Asking:
    """Questions about where the bodies of a world are now; nothing moves."""

    @alone("call_lock")
    def ray(self, start: ArrayLike, end: ArrayLike, *, mask: int = -1) -> RayHit | None:
        """The first thing that a ray hits, None if it hits nothing.

        Args:
            start: In world axes [m], shape (3,).
            end: Likewise.
            mask: Mask of the collision groups that it can hit.
        """
        first, last = vector(start, 3, "start"), vector(end, 3, "end")
        world = cast("World", self)
        (sx, sy, sz), (ex, ey, ez) = first.tolist(), last.tolist()
        body, link, fraction, position, normal = world.queries().ray_tuple(
            (sx, sy, sz), (ex, ey, ez), mask=mask
        )
        if body < 0:
            return None
        distance = fraction * float(np.sqrt(np.square(last - first).sum()))
        return RayHit(world.bodies[body].links[link], np.array(position), np.array(normal), distance)

    @alone("call_lock")
    def rays(self, starts: ArrayLike, ends: ArrayLike, *, mask: int = -1) -> RayHits:
        """What n rays hit first, as arrays.

        Args:
            starts: In world axes [m], (n, 3), or (3,) for all.
            ends: Likewise.
            mask: Mask of the collision groups that they can hit.

        Raises:
            ValueError: The shapes do not fit, or a number is not finite.
        """
        first, last = finite(starts, "starts"), finite(ends, "ends")
        if not (first.shape[-1:] == last.shape[-1:] == (3,) and max(first.ndim, last.ndim) == 2):
            raise ValueError(f"starts and ends must be (n, 3), not {first.shape} and {last.shape}")
        first, last = np.broadcast_arrays(first, last)
        found = cast("World", self).queries().ray_tuples(first.tolist(), last.tolist(), mask=mask)
        bodies, links, fractions, positions, normals = zip(*found, strict=True) if found else ((),) * 5
        return RayHits(
            np.array(bodies, dtype=np.int32),
            np.array(links, dtype=np.int32),
            np.array(fractions, dtype=np.float64),
            np.array(positions, dtype=np.float64).reshape(-1, 3),
            np.array(normals, dtype=np.float64).reshape(-1, 3),
        )

    @alone("call_lock")
    def nearest(
        self, a: Body | Link | int | str, b: Body | Link | int | str, max_distance: float = np.inf
    ) -> list[Nearness]:
        """The nearest points of all pairs of shapes of two bodies or links, the nearest pair first.

        Args:
            a: A body, its name or number, or a link.
            b: Likewise.
            max_distance: Pairs that are further apart are left out [m].

        Raises:
            KeyError: There is no such body.
        """
        world = cast("World", self)
        found = world.queries().nearest(world._rows_of(a), world._rows_of(b), max_distance)
        places = world.link_places
        answers = [
            Nearness(
                world.bodies[places[first][0]].links[places[first][1]],
                world.bodies[places[second][0]].links[places[second][1]],
                np.array(on_first),
                np.array(on_second),
                np.array(normal),
                distance,
            )
            for first, second, on_first, on_second, normal, distance in found
        ]
        return sorted(answers, key=lambda nearness: nearness.distance)

    @alone("call_lock")
    def overlapping(self, lower: ArrayLike, upper: ArrayLike) -> list[Link]:
        """The links whose bounds overlap a box.

        Args:
            lower: Least corner in world axes [m], shape (3,).
            upper: Greatest corner.
        """
        world = cast("World", self)
        (a, b, c), (d, e, f) = vector(lower, 3, "lower").tolist(), vector(upper, 3, "upper").tolist()
        places = [world.link_places[row] for row in world.queries().overlapping((a, b, c), (d, e, f))]
        return [world.bodies[body].links[link] for body, link in places]

    def image(self, camera: Camera) -> CameraImage:
        """An image of the world by a camera, as `camera.capture(world)`."""
        return camera.capture(cast("World", self))

    def _rows_of(self, it: Body | Link | int | str) -> tuple[int, ...]:
        """Rows of a link, or of all links of a body, in the world's arrays."""
        from carom.scene.link import Link

        world = cast("World", self)
        if isinstance(it, Link):
            return (world[it.body].first_link + 1 + it.index,)
        body = world[it]
        return tuple(range(body.first_link, body.first_link + 1 + body.joint_count))
