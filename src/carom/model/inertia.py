"""Rotational inertia and collision margin of a link: from its shapes; inertia also from its file."""

from __future__ import annotations

from collections.abc import Sequence
from functools import reduce
from struct import pack, unpack

from carom.description import Collision, Inertial, Pose
from carom.description.eigen import diagonalize
from carom.description.pose import IDENTITY, Vector3
from carom.description.shapes.bounds import Bounds
from carom.description.shapes.moments import MassTerms, box_terms, squares
from carom.description.transform import (
    NO_ROTATION,
    Matrix3,
    matrix_product,
    matrix_vector,
    quaternion_from_matrix,
    rotation_matrix,
    transposed,
)
from carom.layouts.contacts import MARGIN
from carom.logger import Logger
from carom.model.body_spec import LinkSpec
from carom.model.bounds import placed_bounds, shape_bounds
from carom.model.shape_pieces import ShapePiece
from carom.model.swept_spheres import FIRST_MARGIN, as_given, bounds_between_ends

_log = Logger(__name__)

# Bullet's default margin, as a share of the least half extent; a float32 in its source.
_MARGIN_SHARE = unpack("f", pack("f", 0.1))[0]
_IN_PLACE = (NO_ROTATION, (0.0, 0.0, 0.0))


def inertia_from_shapes(link: LinkSpec, *, implicit_cylinder: bool) -> Vector3:
    """Moments of inertia [kg m²] about the axes of the inertial frame, from the collision shapes.

    A single shape that lies exactly in the inertial frame has its own moments. In all other cases, also
    without shapes, the moments are those of the bounding box of all shapes, widened by `compound_margin`.
    Unless cylinders are implicit, they are hulls of 32 sides.

    Raises:
        DescriptionError: The file of a mesh cannot be used.
    """
    return moments_at(link.mass, mass_terms(link, implicit_cylinder=implicit_cylinder))


def moments_at(mass: float, terms: MassTerms) -> Vector3:
    """Moments of inertia [kg m²] at a mass [kg]."""
    x, y, z = (first.at(mass) + second.at(mass) for first, second in terms)
    return (x, y, z)


def mass_terms(link: LinkSpec, *, implicit_cylinder: bool, margin: float = MARGIN) -> MassTerms:
    """The moments of `inertia_from_shapes`, which has the same arguments, as functions of the mass.

    `margin` is that of a single hull, or of the hulls of an OBJ file together [m].
    """
    if is_in_place(link.collisions, link.inertial_frame):
        (only,) = link.collisions
        if only.ends_frame is not None:
            return box_terms(12.0, 1.0, bounds_between_ends(only, 0.0))
        bounds = shape_bounds(only.geometry, implicit_cylinder=implicit_cylinder)
        return only.geometry.mass_terms(bounds, margin, implicit_cylinder=implicit_cylinder)
    return box_terms(12.0, 1.0, link_bounds(link, implicit_cylinder=implicit_cylinder))


def link_bounds(link: LinkSpec, *, implicit_cylinder: bool) -> Bounds:
    """Bounds of a link's collision shapes along the axes of its inertial frame, margins included.

    The margin of compounds widens them, except those of a single shape exactly in the inertial frame. The
    arguments and errors are those of `inertia_from_shapes`.
    """
    collisions, inertial_frame = link.collisions, link.inertial_frame
    if is_in_place(collisions, inertial_frame):
        if collisions[0].ends_frame is not None:
            return bounds_between_ends(collisions[0], FIRST_MARGIN)
        return shape_bounds(collisions[0].geometry, implicit_cylinder=implicit_cylinder)
    boxes = [bounds_in(inertial_frame, collision, implicit_cylinder) for collision in collisions]
    nothing = Bounds((0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
    return (reduce(Bounds.joined, boxes) if boxes else nothing).grown(link.compound_margin)


def bounds_in(inertial_frame: Pose, collision: Collision, implicit_cylinder: bool) -> Bounds:
    """Bounds of one of several shapes along the axes of an inertial frame."""
    place = placement(inertial_frame, as_given(collision).frame)
    if collision.ends_frame is not None:
        return bounds_between_ends(collision, FIRST_MARGIN).placed(*place)
    return placed_bounds(collision.geometry, *place, implicit_cylinder=implicit_cylinder)


def is_in_place(collisions: Sequence[Collision], inertial_frame: Pose) -> bool:
    """Whether there is a single shape and its frame, or that of its ends, is exactly the inertial frame."""
    return len(collisions) == 1 and placement(inertial_frame, as_given(collisions[0]).frame) == _IN_PLACE


def shape_margin(link: LinkSpec, collision: Collision) -> float | None:
    """Margin of a box, cylinder or plane whose link has `default_margins` [m]; None for all other shapes.

    That of a box or cylinder whose link has `exact_edges` is 0.
    """
    if link.exact_edges and collision.geometry.has_edges:
        return 0.0
    extent = collision.geometry.least_extent()
    if not link.default_margins or extent is None:
        return None
    return min(FIRST_MARGIN, _MARGIN_SHARE * extent)


def is_compound(link: LinkSpec) -> bool:
    """Whether the shapes of a link are a compound in Bullet, as one given by its ends is, unless swept."""
    if not is_in_place(link.collisions, link.inertial_frame):
        return True
    only = link.collisions[0]
    return only.ends_frame is not None and not only.swept


def collision_margin(link: LinkSpec) -> float:
    """Collision margin of a link's shapes [m].

    That of a single sphere or capsule exactly in the inertial frame is its radius.
    """
    if is_compound(link):
        return link.compound_margin
    only = link.collisions[0]
    if only.swept:
        return FIRST_MARGIN
    default = shape_margin(link, only)
    if default is not None:
        return default
    return only.geometry.bullet_margin()


def margin_is_radius(link: LinkSpec) -> bool:
    """Whether a link's margin is the radius of its only shape, a ball or capsule; it never changes then."""
    if is_compound(link) or link.collisions[0].swept:
        return False
    return link.collisions[0].geometry.margin_is_radius


def widens_bounds(link: LinkSpec, pieces: Sequence[ShapePiece]) -> bool:
    """Whether the margin of a link, with these pieces, is around its shapes and not within them.

    One without any is a compound of nothing, which its margin is around.
    """
    return is_compound(link) or link.collisions[0].swept or pieces[0].polyhedron is not None


def placement(inertial_frame: Pose, shape_frame: Pose) -> tuple[Matrix3, Vector3]:
    """Rotation and position of a shape in the inertial frame.

    The order of operations matters: it decides whether a shape with the same pose as the inertial frame is
    placed exactly at its origin, and so which rule its inertia follows.
    """
    if inertial_frame == IDENTITY:
        return rotation_matrix(shape_frame.orientation), shape_frame.position
    back = transposed(rotation_matrix(inertial_frame.orientation))
    x, y, z = inertial_frame.position
    ox, oy, oz = matrix_vector(back, (-x, -y, -z))
    px, py, pz = matrix_vector(back, shape_frame.position)
    return matrix_product(back, rotation_matrix(shape_frame.orientation)), (px + ox, py + oy, pz + oz)


def box_moments(twelfth_mass: float, bounds: Bounds) -> Vector3:
    """Moments of a box about the axes of its frame, from a twelfth of its mass."""
    xx, yy, zz = squares(bounds)
    return (twelfth_mass * xx, twelfth_mass * yy, twelfth_mass * zz)


def inertia_from_file(inertial: Inertial, link_name: str) -> tuple[Vector3, Pose]:
    """Principal moments from the tensor of a link, and the inertial frame rotated to its principal axes.

    An impossible tensor (a negative moment, or one larger than the sum of the others) counts as zero, with a
    warning.

    Returns:
        Moments [kg m²] along the axes of the returned frame, and that frame in the link frame.
    """
    ixx, ixy, ixz, iyy, iyz, izz = inertial.tensor
    axes = NO_ROTATION
    moments = (ixx, iyy, izz)
    if ixy != 0.0 or ixz != 0.0 or iyz != 0.0:
        moments, axes = diagonalize(((ixx, ixy, ixz), (ixy, iyy, iyz), (ixz, iyz, izz)), 1e-6, 30)
    x, y, z = moments
    if min(moments) < 0.0 or x > y + z or y > x + z or z > x + y:
        _log.warning("link %r: no body has the inertia tensor %s; zero is used", link_name, inertial.tensor)
        return (0.0, 0.0, 0.0), inertial.frame
    if axes is NO_ROTATION:
        return moments, inertial.frame
    turned = matrix_product(rotation_matrix(inertial.frame.orientation), axes)
    return moments, Pose(inertial.frame.position, quaternion_from_matrix(turned))
