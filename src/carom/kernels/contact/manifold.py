"""Contact matching: contacts inherit impulses and friction anchors from contacts of the last substep."""

import math

import warp as wp

from carom.kernels.contact.candidates import candidate_on_a
from carom.kernels.contact.overlaps import restore_overlaps
from carom.kernels.maths.min_max import minimum
from carom.kernels.structs import Contacts, Pairs, Shapes, State
from carom.kernels.types import Index2, Index4, Int32, Transform, Vector3, func, real
from carom.layouts.contacts import NONE_KEPT, START_CONTACTS, THERE

_HALF_ROOT = real(math.sqrt(0.5))


@wp.struct
class Sides:
    """The two sides of all contacts of a pair of shapes."""

    shapes: Index4  # as `Contacts.contact_shapes`: the two shapes, and their links
    to_a: Transform  # from world axes to the frame of the link of shape a
    to_b: Transform


@func
def friction_direction(normal: Vector3) -> Vector3:
    """Unit vector perpendicular to `normal`, a function of the normal alone."""
    if wp.abs(normal[2]) > _HALF_ROOT:
        scale = 1.0 / wp.sqrt(normal[1] * normal[1] + normal[2] * normal[2])
        return Vector3(0.0, -normal[2] * scale, normal[1] * scale)
    scale = 1.0 / wp.sqrt(normal[0] * normal[0] + normal[1] * normal[1])
    return Vector3(-normal[1] * scale, normal[0] * scale, 0.0)


@func
def keep_previous(contacts: Contacts, pairs: Pairs, world: Int32) -> Int32:
    """Copy the contacts of the last substep, so that new contacts can be matched with them.

    The copies made at the start of a step are kept until the step ends. They are restored if the step is
    abandoned.

    Returns:
        Row of the first copy.
    """
    count = contacts.count_contacts[world, THERE]
    first = Int32(0)
    if pairs.count_pairs[world, START_CONTACTS] == NONE_KEPT:
        pairs.count_pairs[world, START_CONTACTS] = count
    else:
        first = contacts.contact_shapes.shape[1]
    for row in range(count):
        kept = first + row
        pairs.previous_shapes[world, kept] = contacts.contact_shapes[world, row]
        pairs.previous_normal[world, kept] = contacts.contact_normal[world, row]
        pairs.previous_direction1[world, kept] = contacts.contact_direction1[world, row]
        pairs.previous_direction2[world, kept] = contacts.contact_direction2[world, row]
        pairs.previous_distance[world, kept] = contacts.contact_distance[world, row]
        pairs.previous_local_a[world, kept] = contacts.contact_local_a[world, row]
        pairs.previous_local_b[world, kept] = contacts.contact_local_b[world, row]
        pairs.previous_point_a[world, kept] = contacts.contact_point_a[world, row]
        pairs.previous_point_b[world, kept] = contacts.contact_point_b[world, row]
        pairs.previous_anchor_a[world, kept] = contacts.contact_anchor_a[world, row]
        pairs.previous_anchor_b[world, kept] = contacts.contact_anchor_b[world, row]
        pairs.previous_impulse[world, kept] = contacts.contact_impulse[world, row]
        pairs.previous_warm_start[world, kept] = contacts.contact_warm_start[world, row]
        pairs.previous_taken[world, kept] = 0
    return first


@func
def restore_contacts(contacts: Contacts, pairs: Pairs, world: Int32):
    """Restore the contacts and overlaps of the start of a step, if they were saved."""
    restore_overlaps(contacts, pairs, world)
    count = pairs.count_pairs[world, START_CONTACTS]
    if count == NONE_KEPT:
        return
    for row in range(count):
        contacts.contact_shapes[world, row] = pairs.previous_shapes[world, row]
        contacts.contact_normal[world, row] = pairs.previous_normal[world, row]
        contacts.contact_direction1[world, row] = pairs.previous_direction1[world, row]
        contacts.contact_direction2[world, row] = pairs.previous_direction2[world, row]
        contacts.contact_distance[world, row] = pairs.previous_distance[world, row]
        contacts.contact_local_a[world, row] = pairs.previous_local_a[world, row]
        contacts.contact_local_b[world, row] = pairs.previous_local_b[world, row]
        contacts.contact_point_a[world, row] = pairs.previous_point_a[world, row]
        contacts.contact_point_b[world, row] = pairs.previous_point_b[world, row]
        contacts.contact_anchor_a[world, row] = pairs.previous_anchor_a[world, row]
        contacts.contact_anchor_b[world, row] = pairs.previous_anchor_b[world, row]
        contacts.contact_impulse[world, row] = pairs.previous_impulse[world, row]
        contacts.contact_warm_start[world, row] = pairs.previous_warm_start[world, row]
    contacts.count_contacts[world, THERE] = count


@func
def skip_contacts(pairs: Pairs, world: Int32, first: Int32, end: Int32, pair: Index2, equal: Int32) -> Int32:
    """Skip previous contacts, which are sorted by pair, from row `first` on; returns the row reached.

    Contacts of pairs before `pair` are skipped, and if `equal` is 1, not 0, those of this pair as well.
    """
    row = first
    skipping = row < end
    while skipping:
        skipping = comes_before(pairs, world, row, pair, equal)
        if skipping:
            row += 1
            skipping = row < end
    return row


@func
def comes_before(pairs: Pairs, world: Int32, row: Int32, pair: Index2, equal: Int32) -> bool:
    """Whether `skip_contacts` skips a previous contact."""
    shapes = pairs.previous_shapes[world, row]
    lower = wp.min(shapes[0], shapes[1])
    return lower < pair[0] or (lower == pair[0] and wp.max(shapes[0], shapes[1]) < pair[1] + equal)


@func
def predecessor(
    pairs: Pairs, world: Int32, first: Int32, last: Int32, local_a: Vector3, local_b: Vector3, far: real
) -> Int32:
    """Nearest previous contact in [first, last) without a successor; -1 if none is nearer than `far`.

    The distance is the smaller of those measured in the two link frames, because the point of a sliding
    contact stays in place on at least one of the two bodies.
    """
    nearest = Int32(-1)
    least = far * far
    for row in range(first, last):
        if pairs.previous_taken[world, row] == 0:
            away = minimum(
                wp.length_sq(pairs.previous_local_a[world, row] - local_a),
                wp.length_sq(pairs.previous_local_b[world, row] - local_b),
            )
            if away < least:
                least = away
                nearest = row
    return nearest


@func
def keep_for_matching(contacts: Contacts, pairs: Pairs, world: Int32, before: Int32, row: Int32):
    """Copy impulses and friction anchors of the previous contact `before` (-1: none) to contact `row`."""
    if before >= 0:
        contacts.contact_anchor_a[world, row] = pairs.previous_anchor_a[world, before]
        contacts.contact_anchor_b[world, row] = pairs.previous_anchor_b[world, before]
        contacts.contact_impulse[world, row] = pairs.previous_impulse[world, before]
        contacts.contact_warm_start[world, row] = pairs.previous_warm_start[world, before]
        pairs.previous_taken[world, before] = 1
    else:
        contacts.contact_anchor_a[world, row] = contacts.contact_local_a[world, row]
        contacts.contact_anchor_b[world, row] = contacts.contact_local_b[world, row]
        contacts.contact_impulse[world, row] = Vector3(0.0, 0.0, 0.0)
        contacts.contact_warm_start[world, row] = 0.0


@func
def write_place(
    contacts: Contacts,
    world: Int32,
    row: Int32,
    shapes: Index4,
    local_a: Vector3,
    local_b: Vector3,
    point_a: Vector3,
    point_b: Vector3,
    normal: Vector3,
    distance: real,
):
    """Write a contact's shapes, points, distance, normal and friction directions."""
    contacts.contact_shapes[world, row] = shapes
    contacts.contact_local_a[world, row] = local_a
    contacts.contact_local_b[world, row] = local_b
    contacts.contact_point_a[world, row] = point_a
    contacts.contact_point_b[world, row] = point_b
    contacts.contact_distance[world, row] = distance
    direction = friction_direction(normal)
    contacts.contact_normal[world, row] = normal
    contacts.contact_direction1[world, row] = direction
    contacts.contact_direction2[world, row] = wp.cross(normal, direction)


@func
def sides_of(shapes: Shapes, state: State, world: Int32, pair: Index2) -> Sides:
    """The two sides of the contacts of a pair of shapes."""
    sides = Sides()
    sides.shapes = Index4(pair[0], pair[1], shapes.shape_link[pair[0]], shapes.shape_link[pair[1]])
    sides.to_a = wp.transform_inverse(state.link_pose[world, sides.shapes[2]])
    sides.to_b = wp.transform_inverse(state.link_pose[world, sides.shapes[3]])
    return sides


@func
def write_contact(contacts: Contacts, pairs: Pairs, world: Int32, row: Int32, sides: Sides, candidate: Int32):
    """Write the geometry of a candidate to contact `row`; `keep_for_matching` writes its impulses."""
    point_a = candidate_on_a(pairs.candidate, world, candidate)
    point_b = pairs.candidate[world, candidate].point
    write_place(
        contacts, world, row, sides.shapes, wp.transform_point(sides.to_a, point_a),
        wp.transform_point(sides.to_b, point_b), point_a, point_b, pairs.candidate[world, candidate].normal,
        pairs.candidate[world, candidate].distance,
    )  # fmt: skip


@func
def write_new_contact(
    contacts: Contacts,
    pairs: Pairs,
    world: Int32,
    row: Int32,
    sides: Sides,
    candidate: Int32,
    first: Int32,
    last: Int32,
    far: real,
):
    """Write a candidate as contact `row`, with the impulses of its predecessor in [first, last)."""
    write_contact(contacts, pairs, world, row, sides, candidate)
    before = predecessor(
        pairs, world, first, last, contacts.contact_local_a[world, row], contacts.contact_local_b[world, row],
        far,
    )  # fmt: skip
    keep_for_matching(contacts, pairs, world, before, row)
    if before < 0 and last > first:
        # A new point of an existing manifold does not end warm starting of the other points.
        contacts.contact_warm_start[world, row] = minimum(pairs.previous_warm_start[world, first], 1.0)


@func
def keep_contact(state: State, contacts: Contacts, pairs: Pairs, world: Int32, before: Int32, row: Int32):
    """Write the previous contact `before` as contact `row`, its points moved along with their links."""
    shapes = pairs.previous_shapes[world, before]
    normal = pairs.previous_normal[world, before]
    local_a = pairs.previous_local_a[world, before]
    local_b = pairs.previous_local_b[world, before]
    point_a = wp.transform_point(state.link_pose[world, shapes[2]], local_a)
    point_b = wp.transform_point(state.link_pose[world, shapes[3]], local_b)
    distance = wp.dot(point_a - point_b, normal)
    write_place(contacts, world, row, shapes, local_a, local_b, point_a, point_b, normal, distance)
    keep_for_matching(contacts, pairs, world, before, row)
