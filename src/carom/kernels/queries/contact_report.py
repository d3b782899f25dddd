"""Lists of contacts for users: contacts of selected bodies, with forces instead of impulses."""

import warp as wp

from carom.kernels.structs import ContactReport, Contacts, Places
from carom.kernels.types import Index2, Int32, func, kernel, real
from carom.layouts.contacts import NO_MANIFOLD, OVERLAPS
from carom.layouts.queries import ANY_LINK


@func
def fits(places: Places, row: Int32, body: Int32, link: Int32) -> bool:
    """Whether a link row is a link of a body; `body` < 0 and `link` <= `ANY_LINK` match any."""
    return (body < 0 or places.place_body[row] == body) and (
        link <= ANY_LINK or places.place_link[row] == link
    )


@func
def are_of(contacts: Contacts, world: Int32, row: Int32, pair: Index2) -> bool:
    """Whether a contact is one of two shapes, the lower and the higher row."""
    shapes = contacts.contact_shapes[world, row]
    return wp.min(shapes[0], shapes[1]) == pair[0] and wp.max(shapes[0], shapes[1]) == pair[1]


@func
def comes_before(contacts: Contacts, world: Int32, row: Int32, pair: Index2) -> bool:
    """Whether a contact is sorted before those of two shapes, the lower and the higher row."""
    shapes = contacts.contact_shapes[world, row]
    lower = wp.min(shapes[0], shapes[1])
    return lower < pair[0] or (lower == pair[0] and wp.max(shapes[0], shapes[1]) < pair[1])


@func
def find_manifolds(contacts: Contacts, report: ContactReport, world: Int32, count: Int32) -> Int32:
    """Write the first contact of each manifold to `report_first`; returns the number of manifolds.

    Both overlaps and contacts are sorted by shapes.
    """
    manifolds = Int32(0)
    row = Int32(0)
    for overlap in range(contacts.count_contacts[world, OVERLAPS]):
        place = contacts.overlap_manifold[world, overlap]
        if place != NO_MANIFOLD:
            pair = contacts.overlap_shapes[world, overlap]
            searching = row < count
            while searching:
                searching = comes_before(contacts, world, row, pair)
                if searching:
                    row += 1
                    searching = row < count
            first = Int32(-1)
            if row < count:
                if are_of(contacts, world, row, pair):
                    first = row + 0
            report.report_first[place] = first
            manifolds += 1
    return manifolds


@func
def add_contact(
    contacts: Contacts,
    places: Places,
    report: ContactReport,
    world: Int32,
    row: Int32,
    listed: Int32,
    body_a: Int32,
    link_a: Int32,
    body_b: Int32,
    link_b: Int32,
    time_step: real,
) -> Int32:
    """List a contact after `listed` others if it is asked for; returns the number with it."""
    shapes = contacts.contact_shapes[world, row]
    first, second = shapes[2], shapes[3]
    as_is = fits(places, first, body_a, link_a) and fits(places, second, body_b, link_b)
    swapped = body_a >= 0 and fits(places, second, body_a, link_a) and fits(places, first, body_b, link_b)
    if as_is or swapped:
        point_a = contacts.contact_point_a[world, row]
        point_b = contacts.contact_point_b[world, row]
        normal = contacts.contact_normal[world, row]
        if not as_is:
            first, second = shapes[3], shapes[2]
            point_a = contacts.contact_point_b[world, row]
            point_b = contacts.contact_point_a[world, row]
            normal = -normal
        impulse = contacts.contact_impulse[world, row]
        report.report_body_a[listed] = places.place_body[first]
        report.report_body_b[listed] = places.place_body[second]
        report.report_link_a[listed] = places.place_link[first]
        report.report_link_b[listed] = places.place_link[second]
        report.report_point_a[listed] = point_a
        report.report_point_b[listed] = point_b
        report.report_normal[listed] = normal
        report.report_distance[listed] = contacts.contact_distance[world, row]
        report.report_force[listed] = impulse[0] / time_step
        report.report_force1[listed] = impulse[1] / time_step
        report.report_force2[listed] = impulse[2] / time_step
        report.report_direction1[listed] = contacts.contact_direction1[world, row]
        report.report_direction2[listed] = contacts.contact_direction2[world, row]
        return listed + 1
    return listed


@kernel
def report_contacts_kernel(
    contacts: Contacts,
    places: Places,
    report: ContactReport,
    world: Int32,
    count: Int32,
    body_a: Int32,
    link_a: Int32,
    body_b: Int32,
    link_b: Int32,
    time_step: real,
):
    """List the contacts between two bodies or two of their links; either side may be any body.

    If body a is negative it is any body, and no sides are exchanged; otherwise every contact listed is
    between this body as a and the other as b. For links see `fits`. Impulses become forces by `time_step`
    [s].

    As in Bullet, they are in the order of manifolds. Those from a file of an older version, which has no
    overlaps, are in the order of shapes until the next step.
    """
    listed = Int32(0)
    manifolds = find_manifolds(contacts, report, world, count)
    if manifolds == 0:
        for row in range(count):
            listed = add_contact(
                contacts, places, report, world, row, listed, body_a, link_a, body_b, link_b, time_step
            )
    for place in range(manifolds):
        row = report.report_first[place] + 0
        if row >= 0:
            shapes = contacts.contact_shapes[world, row]
            pair = Index2(wp.min(shapes[0], shapes[1]), wp.max(shapes[0], shapes[1]))
            listing = row < count
            while listing:
                listed = add_contact(
                    contacts, places, report, world, row, listed, body_a, link_a, body_b, link_b, time_step
                )
                row += 1
                listing = row < count
                if listing:
                    listing = are_of(contacts, world, row, pair)
    report.report_count[0] = listed
