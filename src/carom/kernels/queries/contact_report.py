"""Lists of contacts for users: contacts of selected bodies, with forces instead of impulses."""

from carom.kernels.structs import ContactReport, Contacts, Places
from carom.kernels.types import Int32, func, kernel, real
from carom.layouts.queries import ANY_LINK


@func
def fits(places: Places, row: Int32, body: Int32, link: Int32) -> bool:
    """Whether a link row is a link of a body; `body` < 0 and `link` <= `ANY_LINK` match any."""
    return (body < 0 or places.place_body[row] == body) and (
        link <= ANY_LINK or places.place_link[row] == link
    )


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
    """
    listed = Int32(0)
    for row in range(count):
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
            listed += 1
    report.report_count[0] = listed
