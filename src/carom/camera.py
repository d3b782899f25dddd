"""Cameras: colour, depth in metres, labels and point clouds of a world."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from io import BytesIO
from math import inf, radians
from typing import TYPE_CHECKING, Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from carom.checks import Array, positive, vector
from carom.description.pose import IDENTITY, Pose
from carom.description.transform import compose, quaternion_from_matrix
from carom.native.products import length, product
from carom.native.trigonometry import tan
from carom.render.lights import Light
from carom.render.projection import look_at, pinhole_projection, poses_to_matrices
from carom.render.renderer import renderer_of
from carom.render.scene import LINK_SHIFT
from carom.scene.link import LinkPose

if TYPE_CHECKING:
    from carom.scene.body import Body
    from carom.scene.link import Link
    from carom.world.world import World

NOTHING = -1
"""Body id of background pixels."""

DAYLIGHT = Light(ambient=0.5, diffuse=0.5, distance=inf, shadow=True, shade=0.4)
"""Default light of a camera: parallel, with shadows."""

# OpenGL's camera looks along -z, and its y axis points up; a `Camera` looks along z, and y points down.
_EYE_FROM_CAMERA = np.diag([1.0, -1.0, -1.0, 1.0])


class PointCloud(NamedTuple):
    """Points of the surfaces in view.

    Attributes:
        points: (n, 3) positions [m].
        colours: (n, 3) uint8 red, green and blue.
        bodies: (n,) ids of the bodies that the points lie on.
    """

    points: NDArray[np.float64]
    colours: NDArray[np.uint8]
    bodies: NDArray[np.int32]


class CameraImage:
    """The image of a camera at one time. Row 0 is the top; no other image shares its arrays.

    Attributes:
        colour: (height, width, 3) uint8 red, green and blue; white for the background.
        depth: (height, width) float32 distance along the optical axis [m]; infinite for the background.
        body_ids: (height, width) int32 ids of bodies; -1 for the background.
        link_indices: (height, width) int32 links of those bodies; -1 is the base, and the background.
        camera_pose: World pose of the camera at that time.
    """

    def __init__(
        self,
        colour: NDArray[np.uint8],
        depth: NDArray[np.float32],
        label: NDArray[np.int32],
        camera_pose: LinkPose,
        intrinsics: Array,
        bodies: dict[int, Body],
    ) -> None:
        self.colour = colour
        self.depth = depth
        nothing = label == NOTHING
        self.body_ids: np.ndarray = np.where(nothing, NOTHING, label & ((1 << LINK_SHIFT) - 1)).astype(
            np.int32
        )
        self.link_indices: np.ndarray = np.where(nothing, 0, label >> LINK_SHIFT).astype(np.int32) - 1
        self.camera_pose = camera_pose
        self._intrinsics = intrinsics
        # Bodies may be removed after the image is taken; their names are kept.
        self._names = {
            body.id: (body.name, [link.name for link in (body.spec.base, *body.spec.links)])
            for body in bodies.values()
        }

    def __repr__(self) -> str:
        height, width = self.depth.shape
        seen = np.count_nonzero(np.unique(self.body_ids) != NOTHING)
        return f"<CameraImage {width} x {height}, {seen} bodies in view>"

    def _repr_png_(self) -> bytes:
        """The colours as a PNG file, for notebooks."""
        from PIL import Image

        file = BytesIO()
        Image.fromarray(self.colour).save(file, "png")
        return file.getvalue()

    def mask(self, body: Body | int | str, link: Link | int | str | None = None) -> NDArray[np.bool_]:
        """The pixels in which a body, or one link of it, is visible.

        Args:
            body: Handle, id or name; a name stands for all bodies of that name.
            link: Handle, index (-1 is the base) or name; None for the whole body.

        Returns:
            (height, width) booleans, true where the body or link is visible.

        Raises:
            KeyError: No such body or link existed when the image was taken.
        """
        found = np.zeros(self.body_ids.shape, dtype=bool)
        for identifier in self._matching(body):
            seen = self.body_ids == identifier
            if link is not None:
                seen &= self.link_indices == self._link_index(identifier, link)
            found |= seen
        return found

    def names(self) -> dict[str, int]:
        """Number of pixels of each visible link, by its name as `body/link`."""
        labels, counts = np.unique(
            np.stack([self.body_ids, self.link_indices], axis=-1).reshape(-1, 2), axis=0, return_counts=True
        )
        result: dict[str, int] = {}
        for (identifier, link), count in zip(labels.tolist(), counts.tolist(), strict=True):
            if identifier != NOTHING:
                body, links = self._names[identifier]
                name = f"{body}/{links[link + 1]}"
                result[name] = result.get(name, 0) + count
        return result

    def point_cloud(self, *, frame: Literal["world", "camera"] = "world") -> PointCloud:
        """The points of all pixels except the background, row by row.

        Args:
            frame: Axes of the points: those of the world, or of the camera (x to the right, y down,
                z forwards).
        """
        if frame not in ("world", "camera"):
            raise ValueError(f"frame must be 'world' or 'camera', not {frame!r}")
        rows, columns = np.nonzero(self.body_ids != NOTHING)
        fx, fy, cx, cy = self._intrinsics
        z = self.depth[rows, columns].astype(np.float64)
        points = np.stack([(columns - cx) / fx * z, (rows - cy) / fy * z, z], axis=1)
        if frame == "world":
            position, orientation = self.camera_pose
            rotation = poses_to_matrices(np.concatenate([position, orientation])[None])[0, :3, :3]
            points = product(points, rotation.T) + position
        return PointCloud(points, self.colour[rows, columns], self.body_ids[rows, columns])

    def _matching(self, body: Body | int | str) -> list[int]:
        if isinstance(body, str):
            found = [identifier for identifier, (name, _) in self._names.items() if name == body]
        else:
            identifier = int(body) if isinstance(body, (int, np.integer)) else body.id
            found = [identifier] if identifier in self._names else []
        if not found:
            raise KeyError(f"there was no body {body!r} when the image was taken")
        return found

    def _link_index(self, identifier: int, link: Link | int | str) -> int:
        body, links = self._names[identifier]
        if isinstance(link, str):
            if link not in links:
                raise KeyError(f"body {body!r} has no link {link!r}")
            return links.index(link) - 1
        index = int(link) if isinstance(link, (int, np.integer)) else link.index
        if not -1 <= index < len(links) - 1:
            raise KeyError(f"body {body!r} has no link {index}")
        return index


class Camera:
    """A pinhole camera. It looks along z, its x axis points to the right of the image, its y axis down.

    A point (x, y, z) of the camera's frame is projected to column fx x / z + cx and row fy y / z + cy;
    (0, 0) is the centre of the top left pixel.

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
        self.width = width
        self.height = height
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
        self.light = light
        self.link = link
        self._local = IDENTITY
        self.place(position, orientation)

    @classmethod
    def with_field_of_view(
        cls, width: int, height: int, degrees: float, *, near: float = 0.01, far: float = 100.0
    ) -> Camera:
        """A camera with a given vertical field of view, at the origin of the world.

        Args:
            width: Number of columns.
            height: Number of rows.
            degrees: Angle from the lower to the upper edge of the image.
            near: Near plane: nothing closer is visible [m].
            far: Far plane: nothing farther is visible [m].

        Raises:
            ValueError: The angle is not between 0 and 180 degrees, or a number is out of range.
        """
        if not 0.0 < degrees < 180.0:
            raise ValueError(f"degrees must be between 0 and 180, not {degrees!r}")
        return cls(width, height, fx=0.5 * height / tan(radians(0.5 * degrees)), near=near, far=far)

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
    def pose(self) -> LinkPose:
        """World pose of the camera now."""
        pose = self._local
        if self.link is not None:
            position, orientation = self.link.pose
            px, py, pz = position.tolist()
            qx, qy, qz, qw = orientation.tolist()
            pose = compose(Pose((px, py, pz), (qx, qy, qz, qw)), pose)
        return LinkPose(np.array(pose.position), np.array(pose.orientation))

    @property
    def view(self) -> Array:
        """The matrix from the world to OpenGL's eye now, shape (4, 4): it looks along -z, and y points up."""
        return _EYE_FROM_CAMERA @ _inverse(poses_to_matrices(np.concatenate(self.pose)[None])[0])

    @property
    def projection(self) -> Array:
        """The matrix from OpenGL's eye to clip coordinates, shape (4, 4)."""
        fx, fy, cx, cy = self._intrinsics.tolist()
        return pinhole_projection(self.width, self.height, fx, fy, cx, cy, self._near, self._far)

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
        pose = self.pose
        image = renderer_of(world).draw(
            world, self.view, self.projection, self.width, self.height, self.light
        )
        return CameraImage(
            np.ascontiguousarray(image.rgba[:, :, :3]),
            image.distance,
            image.label,
            pose,
            self._intrinsics,
            world.bodies,
        )


def _inverse(matrix: Array) -> Array:
    """Inverse of a homogeneous transformation (rotation and translation), shape (4, 4)."""
    inverse = np.eye(4)
    inverse[:3, :3] = matrix[:3, :3].T
    inverse[:3, 3:] = -product(matrix[:3, :3].T, matrix[:3, 3:])
    return inverse
