"""Cameras with intrinsics, on links or in the world."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from math import inf, radians
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from carom.checks import Array, positive, vector
from carom.closed import Closed
from carom.description.pose import IDENTITY, Pose
from carom.description.transform import compose, quaternion_from_matrix
from carom.native.products import length, product
from carom.native.trigonometry import tan
from carom.pose import Pose as WorldPose
from carom.render.camera_image import CameraImage, PointCloud
from carom.render.lights import Light
from carom.render.projection import look_at, orthographic_projection, pinhole_projection, poses_to_matrices
from carom.render.renderer import renderer_of

if TYPE_CHECKING:
    from carom.render.image_target import RawImage
    from carom.scene.following import Following, FrameOf
    from carom.scene.link import Link
    from carom.world.world import World

__all__ = ["DAYLIGHT", "Camera", "CameraImage", "PointCloud"]

DAYLIGHT = Light(ambient=0.5, diffuse=0.5, distance=inf, shadow=True, shade=0.4)
"""Default light of a camera: parallel, with shadows."""

# OpenGL's camera looks along -z, and its y axis points up; a `Camera` looks along z, and y points down.
_EYE_FROM_CAMERA = np.diag([1.0, -1.0, -1.0, 1.0])


class Camera(Closed):
    """A pinhole camera. It looks along z, its x axis points to the right of the image, its y axis down.

    A point (x, y, z) of the camera's frame is projected to column fx x / z + cx and row fy y / z + cy;
    (0, 0) is the centre of the top left pixel. One that is `orthographic` projects it to fx x + cx and
    fy y + cy, whatever z is.

    Attributes:
        width: Number of columns.
        height: Number of rows.
        light: The light of its images.
        link: Link it is mounted on; None for a camera fixed in the world.
        following: How it follows bodies, as cameras of MJCF files may; None if it does not.
        is_orthographic: Its rays are parallel, so far things are as large as near ones.

    Args:
        width: Number of columns.
        height: Number of rows.
        fx: Focal length in columns.
        fy: Focal length in rows; `fx` by default.
        cx: Column that the optical axis meets; the middle by default.
        cy: Row that the optical axis meets; the middle by default.
        near: Near plane: nothing closer is visible [m].
        far: Far plane: nothing farther is visible [m].
        position: Of the camera [m], in the world or, if it is mounted, in the frame of its link.
        orientation: Of the camera, quaternion (x, y, z, w), in the same frame.
        link: Link it is mounted on; None for a camera fixed in the world.
        light: The light of its images.

    Raises:
        ValueError: A number is not finite or out of range.
    """

    def __init__(
        self,
        width: int,
        height: int,
        *,
        fx: float,
        fy: float | None = None,
        cx: float | None = None,
        cy: float | None = None,
        near: float = 0.01,
        far: float = 100.0,
        position: ArrayLike = (0.0, 0.0, 0.0),
        orientation: ArrayLike = (0.0, 0.0, 0.0, 1.0),
        link: Link | None = None,
        light: Light = DAYLIGHT,
    ) -> None:
        if width < 1 or height < 1:
            raise ValueError(f"an image of {width} x {height} pixels cannot be taken")
        self.width: int = width
        self.height: int = height
        positive(fx, "fx")
        positive(fx if fy is None else fy, "fy")
        self._intrinsics = vector(
            [
                fx,
                fx if fy is None else fy,
                0.5 * (width - 1) if cx is None else cx,
                0.5 * (height - 1) if cy is None else cy,
            ],
            4,
            "intrinsics",
        )
        positive(near, "near")
        positive(far - near, "far - near")
        self._near = near
        self._far = far
        self.light: Light = light
        self.link: Link | None = link
        self.following: Following | None = None
        self.is_orthographic: bool = False
        self._local = IDENTITY
        self.place(position, orientation)
        self._close(Camera)

    @classmethod
    def with_field_of_view(
        cls,
        width: int,
        height: int,
        degrees: float,
        *,
        near: float = 0.01,
        far: float = 100.0,
        light: Light = DAYLIGHT,
    ) -> Camera:
        """A camera with a given vertical field of view, at the origin of the world.

        Args:
            width: Number of columns.
            height: Number of rows.
            degrees: Angle from the lower to the upper edge of the image.
            near: Near plane: nothing closer is visible [m].
            far: Far plane: nothing farther is visible [m].
            light: The light of its images.

        Raises:
            ValueError: The angle is not between 0 and 180 degrees, or a number is out of range.
        """
        if not 0.0 < degrees < 180.0:
            raise ValueError(f"degrees must be between 0 and 180, not {degrees!r}")
        return cls(
            width, height, fx=0.5 * height / tan(radians(0.5 * degrees)), near=near, far=far, light=light
        )

    @classmethod
    def orthographic(
        cls,
        width: int,
        height: int,
        extent: float,
        *,
        near: float = 0.01,
        far: float = 100.0,
        light: Light = DAYLIGHT,
    ) -> Camera:
        """A camera whose rays are parallel, at the origin of the world.

        Args:
            width: Number of columns.
            height: Number of rows.
            extent: Height of what it sees [m].
            near: Near plane: nothing closer is visible [m].
            far: Far plane: nothing farther is visible [m].
            light: The light of its images.

        Raises:
            ValueError: The extent is not positive, or a number is out of range.
        """
        positive(extent, "extent")
        camera = cls(width, height, fx=height / extent, near=near, far=far, light=light)
        camera.is_orthographic = True
        return camera

    def __repr__(self) -> str:
        place = "in the world" if self.link is None else f"on {self.link!r}"
        return f"<Camera {self.width} x {self.height} {place}>"

    def _repr_html_(self) -> str:
        """Its image size and position, for notebooks."""
        position = ", ".join(f"{value:.4g}" for value in self.pose.position)
        where = f"at ({position}) m" if self.link is None else f"on link {self.link.name}, at ({position}) m"
        return f"<b>Camera</b>: {self.width} x {self.height} pixels, {escape(where)}"

    @property
    def intrinsics(self) -> Array:
        """The matrix ((fx, 0, cx), (0, fy, cy), (0, 0, 1)), shape (3, 3)."""
        fx, fy, cx, cy = self._intrinsics
        return np.array([[fx, 0.0, cx], [0.0, fy, cy], [0.0, 0.0, 1.0]])

    def place(self, position: ArrayLike, orientation: ArrayLike) -> None:
        """Move the camera.

        Args:
            position: [m], in the world or, if it is mounted, in the frame of its link.
            orientation: Quaternion (x, y, z, w) in the same frame; normalised here.

        Raises:
            ValueError: They are not three and four finite numbers, or the quaternion has length 0.
        """
        x, y, z = vector(position, 3, "position").tolist()
        quaternion = vector(orientation, 4, "orientation")
        size = length(quaternion)
        positive(size, "the length of orientation")
        qx, qy, qz, qw = (quaternion / size).tolist()
        self._local = Pose((x, y, z), (qx, qy, qz, qw))

    def look_at(self, eye: ArrayLike, target: ArrayLike, up: Sequence[float] = (0.0, 0.0, 1.0)) -> Camera:
        """Move the camera so that it looks from one point at another.

        Args:
            eye: Position of the camera [m], in the world or, if it is mounted, in the frame of its link.
            target: The point in the middle of the image [m].
            up: Direction that is upwards in the image.

        Returns:
            The camera itself.

        Raises:
            ValueError: The points coincide or are not three finite numbers.
        """
        start, end = vector(eye, 3, "eye"), vector(target, 3, "target")
        positive(length(end - start), "the distance from eye to target")
        a, b, c = vector(up, 3, "up").tolist()
        rotation = (_EYE_FROM_CAMERA @ look_at(start, end, (a, b, c)))[:3, :3].T
        m = [(float(row[0]), float(row[1]), float(row[2])) for row in rotation]
        self.place(start, quaternion_from_matrix((m[0], m[1], m[2])))
        return self

    def mount(self, link: Link | None) -> Camera:
        """Mount the camera on a link, or fix it in the world (None); `place` and `look_at` set its pose.

        Returns:
            The camera itself.
        """
        self.link = link
        return self

    @property
    def pose(self) -> WorldPose:
        """World pose of the camera now."""
        return self.pose_where(_frame_of)

    def pose_where(self, frame_of: FrameOf, local: Pose | None = None) -> WorldPose:
        """World pose of the camera where the frames of links are these, or if it were placed at `local`."""
        pose = self._local if local is None else local
        if self.link is not None:
            pose = compose(frame_of(self.link), pose)
        if self.following is not None:
            pose = self.following.pose(pose, frame_of)
        return WorldPose(np.array(pose.position), np.array(pose.orientation))

    def views(self, poses: Array) -> Array:
        """(n, 4, 4) matrices from the world to eye coordinates as in OpenGL, for world poses (n, 7)."""
        return product(_EYE_FROM_CAMERA, _inverses(poses_to_matrices(poses)))

    @property
    def view(self) -> Array:
        """(4, 4) matrix from the world to the eye as in OpenGL: it looks along -z, and y points up."""
        return self.views(np.concatenate(self.pose)[None])[0]

    @property
    def projection(self) -> Array:
        """(4, 4) matrix from eye to clip coordinates as in OpenGL."""
        fx, fy, cx, cy = self._intrinsics.tolist()
        matrix = orthographic_projection if self.is_orthographic else pinhole_projection
        return matrix(self.width, self.height, fx, fy, cx, cy, self._near, self._far)

    def distances(self, image: RawImage) -> NDArray[np.float32]:
        """(height, width) distances along the optical axis in an image by `projection` [m]."""
        if not self.is_orthographic:
            return image.distance
        depth = self._near + image.depth.astype(np.float64) * (self._far - self._near)
        return np.where(np.isfinite(image.distance), depth, inf).astype(np.float32)

    def projections(self, degrees: Array) -> Array:
        """(n, 4, 4) matrices as `projection` for vertical fields of view (n,) [degrees].

        Raises:
            ValueError: One is not between 0 and 180, or the camera is orthographic.
        """
        if self.is_orthographic:
            raise ValueError("an orthographic camera has no field of view: make another one")
        if not ((degrees > 0.0) & (degrees < 180.0)).all():
            raise ValueError(f"fields of view must be between 0 and 180 degrees, not {degrees.tolist()}")
        fx, fy, cx, cy = self._intrinsics.tolist()
        focal = [0.5 * self.height / tan(radians(0.5 * angle)) for angle in degrees.tolist()]
        size, planes = (self.width, self.height), (self._near, self._far)
        return np.array([pinhole_projection(*size, fx / fy * own, own, cx, cy, *planes) for own in focal])

    def capture(self, world: World | None = None) -> CameraImage:
        """Take an image.

        Args:
            world: The world it looks at; by default that of the link it is mounted on.

        Raises:
            ValueError: No world is given and the camera is not mounted, the image is too large, or the
                link belongs to another world.
        """
        if self.link is not None:
            if world is not None and world is not self.link.body.world:
                raise ValueError("the camera is mounted on a link of another world")
            world = self.link.body.world
        if world is None:
            raise ValueError("a camera that is not mounted needs to be told which world to look at")
        with world.call_lock:
            pose = self.pose
            image = renderer_of(world).draw(
                world, self.view, self.projection, self.width, self.height, self.light
            )
            return CameraImage(
                np.ascontiguousarray(image.rgba[:, :, :3]),
                self.distances(image),
                image.label,
                pose,
                self._intrinsics,
                world.bodies,
                is_orthographic=self.is_orthographic,
            )


def _frame_of(link: Link) -> Pose:
    """World pose of the frame of a link now."""
    (px, py, pz), (qx, qy, qz, qw) = (part.tolist() for part in link.pose)
    return Pose((px, py, pz), (qx, qy, qz, qw))


def _inverses(matrices: Array) -> Array:
    """Inverses of homogeneous transformations (rotation and translation), shape (n, 4, 4)."""
    inverses = np.zeros_like(matrices)
    turns = matrices[:, :3, :3].transpose(0, 2, 1)
    inverses[:, :3, :3] = turns
    inverses[:, :3, 3:] = -product(turns, matrices[:, :3, 3:])
    inverses[:, 3, 3] = 1.0
    return inverses
