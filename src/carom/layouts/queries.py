"""Data of the kernels of queries: rays, nearest points, lists of contacts."""

from carom.layouts.contacts import Candidate
from carom.layouts.types import Array, IntRows, Ints, Reals, Rows, Truth, Vectors3, struct

# Link indices up to this one mean any link.
ANY_LINK = -2


@struct
class Places:
    """Body id and link index of each link row, as users have them."""

    place_body: Ints
    place_link: Ints  # -1: the base


@struct
class ContactReport:
    """Result of a query for contacts."""

    report_body_a: Ints
    report_body_b: Ints
    report_link_a: Ints
    report_link_b: Ints
    report_point_a: Vectors3  # in world axes
    report_point_b: Vectors3
    report_normal: Vectors3  # on b, towards a
    report_distance: Reals
    report_force: Reals  # along the normal [N]
    report_force1: Reals  # along the friction directions [N]
    report_force2: Reals
    report_direction1: Vectors3
    report_direction2: Vectors3
    report_count: Ints  # in the first entry: number of contacts
    report_first: Ints  # by place among manifolds: row of the first contact, -1 for none


@struct
class Touching:
    """Contacts between chosen links and some other links, summarised for each world."""

    link_place: Ints  # by link row: its index among the chosen links, or -1
    link_other: Ints  # by link row: 1 for one of the other links, else 0
    world_number: Ints  # number of contact points
    world_touching: Array[Truth]  # whether one of them has a normal impulse
    world_impulse: Vectors3  # total impulse on the chosen links, in world axes
    world_distance: Reals  # of the deepest point
    world_deepest: Vectors3  # that point on the chosen link, in world axes
    place_touching: Array[Truth]  # by world, then chosen link: whether the link has a contact point
    place_impulse: Vectors3  # likewise: total impulse on the link, in world axes


@struct
class Searches:
    """Pairs of shapes, and the nearest points of pairs within the maximum distance."""

    search_first: IntRows
    search_second: IntRows
    search_count: IntRows  # in the first entry: number of pairs found
    search_pair: IntRows  # index of each pair found
    search_found: Rows[Candidate]  # shape b is the second


@struct
class Rays:
    """Rays and their hits."""

    ray_start: Vectors3
    ray_end: Vectors3
    ray_shape: Ints  # -1: no hit
    ray_body: Ints  # -1: no hit
    ray_link: Ints  # -1: the base, or no hit
    ray_fraction: Reals  # 1: no hit
    ray_position: Vectors3  # 0: no hit
    ray_normal: Vectors3  # in world axes; 0: no hit
    # The last hit found so far: only hits after it count. Shape -1 for none.
    ray_last_shape: Ints
    ray_last_fraction: Reals
