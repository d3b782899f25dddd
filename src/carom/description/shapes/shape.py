"""What can be asked of any shape, and the answers for shapes that have no better one."""

from __future__ import annotations

from enum import Enum
from math import isclose
from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple

from carom.description.pose import Quaternion, Vector3
from carom.description.shapes.bounds import Bounds
from carom.description.shapes.moments import TWELFTH, MassShape, MassTerms, box_terms
from carom.description.transform import Matrix3
from carom.layouts.codes import PathKind, ShapeKind
from carom.layouts.contacts import MARGIN

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray
    from typing_extensions import Self

    from carom.description.shapes.surface import Surface

UNKNOWN_FILE = b"unknown_file"
"""What PyBullet reports as the file of a mesh that has none."""
GEOM_MESH = 5
UPRIGHT: Quaternion = (0.0, 0.0, 0.0, 1.0)
ORIGIN: Vector3 = (0.0, 0.0, 0.0)
_ONES: Vector3 = (1.0, 1.0, 1.0)


class Measure(Enum):
    """What a number, or three, of a shape mean."""

    LENGTH = 1
    LENGTHS = 3
    DIRECTION = 0


class Parameter(NamedTuple):
    """A number of a shape, or three, that files and calls state.

    Attributes:
        field: Its field in the shape.
        measure: What it is.
        stated: Its name in URDF and SDF files.
        call: Its argument of `createCollisionShape`.
        usd: Its attribute in USD stages, and the value where a stage has none.
        per_field: What files state is so many times the field.
    """

    field: str
    measure: Measure
    stated: str
    call: str
    usd: tuple[str, float] = ("", 0.0)
    per_field: float = 1.0


class Core(NamedTuple):
    """A shape that the engine has a kind for; `carom.layouts.codes.ShapeKind` says what its size is."""

    kind: ShapeKind
    size: Vector3
    margin: float


class Facets(NamedTuple):
    """A convex shape by its corners and faces, rounded by a margin.

    Attributes:
        points: (n, 3) corners [m].
        faces: Corners of each face, counter-clockwise seen from outside.
        margin: Distance of the surface from the polyhedron [m].
        on_grid: Its corners are on the grid, and in the order, of PyBullet's hulls, and its margin is theirs;
            otherwise the margin is a part of it, the radius by which it is rounded.
        half_axes: Of the ellipsoid whose facets they are, which shapes touch in their place [m].
    """

    points: NDArray[np.float64]
    faces: list[list[int]]
    margin: float
    on_grid: bool
    half_axes: Vector3 | None = None


class Stretch(NamedTuple):
    """How the surface of a shape becomes that of others of its kind, in its frame; normals stay as they are.

    Attributes:
        factors: Along x, y and z, (..., 3).
        shift: Then along z [m], (...).
    """

    factors: NDArray[np.float64]
    shift: NDArray[np.float64]


class TextureRule(Enum):
    """How a texture of an MJCF file lies on a shape."""

    FROM_ABOVE_OR_OWN = 0
    FROM_ABOVE = 1
    SIDES = 2
    OWN = 3
    OWN_UPWARDS = 4


class Shape:
    """Base of all shapes. Lengths are in metres, in the frame of the shape.

    Attributes:
        tag: Its element in URDF and SDF files; empty for none, here and below.
        mjcf: Its type in MJCF files.
        size_count: How many sizes an MJCF file states of it; 0 where it is read in its own way.
        usd: Its type in USD stages.
        geom: PyBullet's number of it, `GEOM_...`.
        geom_name: The name of this constant.
        parameters: What is stated of it in files and calls.
        bullet_sdf_length: What PyBullet takes for lengths that an SDF file does not state, unscaled [m].
        bullet_scales_sdf: PyBullet scales what SDF files state of it.
        tendon_path: What tendons have that go around it.
        is_unbounded: It has no bounds: a plane.
        is_ground: It is coloured like a floor.
        bounds_turn: Its bounds turn with it: those of all but balls do.
        sweeps: If a file states its ends, it is a swept sphere in PyBullet.
        margin_is_radius: Its margin in PyBullet is its radius, which never changes.
        has_edges: It has edges that are sharp where files are read as written.
        texture_rule: How textures of MJCF files lie on it.
    """

    __slots__ = ()

    tag: ClassVar[str] = ""
    mjcf: ClassVar[str] = ""
    size_count: ClassVar[int] = 0
    usd: ClassVar[str] = ""
    geom: ClassVar[int] = GEOM_MESH
    geom_name: ClassVar[str] = ""
    parameters: ClassVar[tuple[Parameter, ...]] = ()
    bullet_sdf_length: ClassVar[float | None] = None
    bullet_scales_sdf: ClassVar[bool] = True
    tendon_path: ClassVar[PathKind | None] = None
    is_unbounded: ClassVar[bool] = False
    is_ground: ClassVar[bool] = False
    bounds_turn: ClassVar[bool] = True
    sweeps: ClassVar[bool] = False
    margin_is_radius: ClassVar[bool] = False
    has_edges: ClassVar[bool] = False
    texture_rule: ClassVar[TextureRule] = TextureRule.FROM_ABOVE_OR_OWN

    # Sizes.

    def bounds(self, *, implicit_cylinder: bool) -> Bounds:
        """Bounds in its own frame, widened by its own margin as in PyBullet.

        The margin of a hull counts twice: once in the bounds of its points and once around them. Unless
        cylinders are implicit, they are hulls of their rims.
        """
        raise NotImplementedError(f"the bounds of a {type(self).__name__} are in its file")

    def scaled(self, factors: Vector3) -> Self:
        """The shape, scaled along its axes by the rules of Bullet's `setLocalScaling`.

        Raises:
            ValueError: It cannot be scaled so.
        """
        raise ValueError(f"a {type(self).__name__} cannot be scaled")

    def lengths(self) -> tuple[float, ...]:
        """Its lengths [m]; of meshes and hulls, which have any, the scale."""
        return ()

    def sides(self) -> Vector3 | None:
        """Lengths of its sides along its own axes [m], of a ball three diameters; None if it can have any."""
        return None

    def with_sides(self, x: float, y: float, z: float) -> Self:
        """The same with sides of these lengths along its own axes [m].

        Raises:
            ValueError: There is no such shape: a ball has three equal sides, for example.
        """
        raise ValueError(f"{type(self).__name__} has no sides that can be set: load it with another scale")

    def stretch(self, sides: NDArray[np.float64], end: int) -> Stretch:
        """How its surface becomes that of shapes with other sides (..., 3) [m], at one of its `ends_at`."""
        import numpy as np

        return Stretch(sides / np.array(self.sides()), np.zeros(sides.shape[:-1]))

    def ends_at(self, heights: NDArray[np.floating]) -> NDArray[np.int64]:
        """At which end along z points of its surface at some heights are, -1 or 1, (n,); 0 for none."""
        import numpy as np

        return np.zeros(len(heights), np.int64)

    def with_shaft(self) -> Self:
        """It, or one of its kind with something between its ends."""
        return self

    def own_turn(self) -> Quaternion:
        """What turns a shape of its kind as formats without directions have it, along z, to this one."""
        return UPRIGHT

    def is_floor(self, least: float) -> bool:
        """Whether it is as large as a floor, of which two sides have at least this length [m]."""
        return False

    # Contact.

    def core(self, *, implicit_cylinder: bool) -> Core | None:
        """What it is in the engine; None for what consists of corners and faces."""
        return None

    def facets(self) -> Facets | None:
        """Its corners and faces, if it is a convex shape that has no core."""
        return None

    def bullet_margin(self) -> float:
        """Its collision margin in PyBullet [m]."""
        return MARGIN

    def least_extent(self) -> float | None:
        """Length [m] of which Bullet's default margin is a share; None where the margin is another one."""
        return None

    def swept_half(self, rotation: Matrix3) -> Vector3:
        """Half sizes of the bounds of a swept sphere that is turned so, without a margin [m]."""
        raise NotImplementedError(f"a {type(self).__name__} is no swept sphere")

    # Mass.

    def volume(self) -> float:
        """Its volume [m³]; 0 where that is not known without its file."""
        return 0.0

    def solid(self) -> MassShape | None:
        """The distribution of mass in it, evenly filled; None if it has no closed form."""
        return None

    def shell(self) -> MassShape | None:
        """The same with all mass evenly on its surface."""
        return None

    def mass_terms(self, bounds: Bounds, margin: float, *, implicit_cylinder: bool) -> MassTerms:
        """PyBullet's moments of it about its own axes, by its bounds, with a margin if it is of hulls [m]."""
        # The bounds of the points keep the margin they were found with.
        return box_terms(1.0, TWELFTH, bounds.grown(margin - MARGIN).grown(margin))

    def controller_moments(self, mass: float) -> Vector3 | None:
        """Moments [kg m²] that PyBullet's stable PD controller takes; None for those of its bounds."""
        return None

    # Files and calls.

    def stated(self) -> dict[Parameter, tuple[float, ...]]:
        """What files state of it."""
        found = {}
        for it in self.parameters:
            value = getattr(self, it.field)
            numbers = value if isinstance(value, tuple) else (value,)
            found[it] = tuple(it.per_field * number for number in numbers)
        return found

    @classmethod
    def of_sizes(cls, x: float, y: float, z: float) -> Self:
        """The shape that an MJCF file states by these sizes, of which it uses `size_count`."""
        raise NotImplementedError(f"MJCF has no sizes of a {cls.__name__}")

    def sizes(self) -> tuple[float, ...]:
        """Its sizes in MJCF files."""
        raise NotImplementedError(f"MJCF has no sizes of a {type(self).__name__}")

    @classmethod
    def fitted(cls, half: Vector3, *, by_bounds: bool) -> Vector3:
        """The MJCF sizes of the shape that MuJoCo fits to a box with these half extents, of a mesh [m]."""
        return half

    def visual_dimensions(self) -> Vector3:
        """The dimensions that `getVisualShapeData` reports."""
        return ORIGIN

    def visual_data(self) -> tuple[int, Vector3, bytes]:
        """Type, dimensions and file that `getVisualShapeData` reports."""
        return self.geom, self.visual_dimensions(), b""

    def collision_data(self, *, implicit_cylinder: bool) -> tuple[int, Vector3, bytes] | None:
        """Type, dimensions and file that `getCollisionShapeData` reports; None for what it leaves out."""
        return self.visual_data()

    def call_arguments(self) -> dict[str, Any]:
        """The arguments of `createCollisionShape` but for its type; none if it cannot make the shape."""
        return {it.call: getattr(self, it.field) for it in self.parameters if it.call}

    # Pictures.

    def surface(self, segments: int) -> Surface:
        """Its surface; circles have so many sides, a multiple of 4."""
        raise NotImplementedError(f"the surface of a {type(self).__name__} are made from its content")

    def scaled_unit(self) -> tuple[Shape, Vector3] | None:
        """A shape that many of its kind are scaled copies of, and its own scale; None for none."""
        return None

    def in_bullets_images(self) -> float | NDArray[np.float64] | None:
        """Of a shape that PyBullet's images show less round: corners (n, 3), or the radius of a ball."""
        return None


def are_equal(a: float, b: float) -> bool:
    """Whether two lengths are the same but for rounding."""
    return isclose(a, b, rel_tol=1e-9)


def as_unknown_mesh() -> tuple[int, Vector3, bytes]:
    """What PyBullet reports for meshes whose file it does not store."""
    return GEOM_MESH, _ONES, UNKNOWN_FILE
