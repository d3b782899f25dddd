"""Sums of the contacts between selected links and other links, in each of many worlds."""

import warp as wp

from carom.kernels.solver.contact_terms import impulse_on_a
from carom.kernels.structs import Contacts, Touching
from carom.kernels.types import Int32, Vector3, func, kernel, real
from carom.layouts.contacts import THERE


@func
def is_between(touching: Touching, link: Int32, other: Int32, anything: Int32) -> bool:
    """Whether a link is selected, and the link it touches is one of the others or `anything` is set."""
    return touching.link_place[link] >= 0 and (anything != 0 or touching.link_other[other] != 0)


@kernel
def touching_kernel(
    contacts: Contacts, touching: Touching, links: Int32, anything: Int32, first_world: Int32
):
    """Sum up the contacts of the `links` selected links with the other links, in each world.

    If `anything` is 1, not 0, contacts with any link are included.
    """
    world = first_world + wp.tid()
    touching.world_number[world] = 0
    touching.world_touching[world] = wp.uint8(0)
    touching.world_distance[world] = real(wp.inf)
    nowhere = real(wp.nan)
    deepest = Vector3(nowhere, nowhere, nowhere)
    impulse = Vector3(0.0, 0.0, 0.0)
    for place in range(links * world, links * (world + 1)):
        touching.place_touching[place] = wp.uint8(0)
        touching.place_impulse[place] = Vector3(0.0, 0.0, 0.0)
    for contact in range(contacts.count_contacts[world, THERE]):
        a = contacts.contact_shapes[world, contact][2]
        b = contacts.contact_shapes[world, contact][3]
        is_a, is_b = is_between(touching, a, b, anything), is_between(touching, b, a, anything)
        if is_a or is_b:
            # Normals point from b to a, so the impulses along them push a away from b.
            push = impulse_on_a(contacts, world, contact)
            if is_a:
                place = links * world + touching.link_place[a]
                touching.place_touching[place] = wp.uint8(1)
                touching.place_impulse[place] += push
            if is_b:
                place = links * world + touching.link_place[b]
                touching.place_touching[place] = wp.uint8(1)
                touching.place_impulse[place] -= push
            touching.world_number[world] += 1
            if contacts.contact_impulse[world, contact][0] > 0.0:
                touching.world_touching[world] = wp.uint8(1)
            # If both links of a contact are selected, as within a body, the impulse and the deepest point of
            # the world are those of link a.
            nearer = contacts.contact_distance[world, contact] < touching.world_distance[world]
            if nearer:
                touching.world_distance[world] = contacts.contact_distance[world, contact]
            if is_a:
                impulse += push
                if nearer:
                    deepest = contacts.contact_point_a[world, contact]
            else:
                impulse -= push
                if nearer:
                    deepest = contacts.contact_point_b[world, contact]
    touching.world_impulse[world] = impulse
    touching.world_deepest[world] = deepest
