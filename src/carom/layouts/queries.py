"""What questions about a world work on: rays, nearest points, lists of contacts."""

from typing import TYPE_CHECKING, Any

from carom.layouts.types import (
    ArrayType,
    IntRows,
    Ints,
    Reals,
    Type,
    Vector8Rows,
    Vectors3,
    struct,
)

if TYPE_CHECKING:
    Truths = Any
else:
    # 0 or 1: what NumPy has as booleans.
    Truths = ArrayType(Type("uint8"))

# Links from this one down stand for any link.
ANY_LINK = -2


@struct
class Places:
    """The body and the link of each row, by the numbers that users know them by."""

    place_body: Ints
    place_link: Ints  # -1: the base


@struct
class ContactReport:
    """The contacts that were asked for."""

    report_body_a: Ints
    report_body_b: Ints
    report_link_a: Ints
    report_link_b: Ints
    report_point_a: Vectors3  # in world axes
    report_point_b: Vectors3
    report_normal: Vectors3  # on b, towards a
    report_distance: Reals
    report_force: Reals  # along the normal
    report_force1: Reals  # along the friction directions
    report_force2: Reals
    report_direction1: Vectors3
    report_direction2: Vectors3
    report_count: Ints  # the first one: how many there are


@struct
class Touching:
    """How some links touch some others in each world."""

    link_place: Ints  # by row of link: its place among those that are asked for, or -1
    link_other: Ints  # 1: one of the others
    world_number: Ints  # contact points
    world_touching: Truths  # whether one of them pushes
    world_impulse: Vectors3  # on the links that are asked for, in world axes
    world_distance: Reals  # of the deepest point
    world_deepest: Vectors3  # that point on those links, in world axes
    place_touching: Truths  # world after world: which of the links have a contact point


@struct
class Searches:
    """Pairs of shapes, and the nearest points of those within reach."""

    search_first: IntRows
    search_second: IntRows
    search_count: IntRows  # the first one: how many were found
    search_pair: IntRows  # which pair each of them is
    search_found: Vector8Rows  # as `Pairs.candidate_terms`


@struct
class Rays:
    """Rays, and what they hit."""

    ray_start: Vectors3
    ray_end: Vectors3
    ray_shape: Ints  # -1: nothing
    ray_body: Ints  # -1: nothing
    ray_link: Ints  # -1: the base, or nothing
    ray_fraction: Reals  # 1: nothing
    ray_position: Vectors3  # 0: nothing
    ray_normal: Vectors3  # in world axes; 0: nothing
    # Hits that do not come after these do not count; shape -1 for none.
    ray_last_shape: Ints
    ray_last_fraction: Reals
