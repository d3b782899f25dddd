"""Patches: the up to four contacts of two small trees, most often free bodies, relaxed together.

What a row of a patch does to the velocities of those after it is known beforehand. So all velocities
are computed at once, from then on only the impulses depend on each other, and the trees' velocities
are brought up to date once per patch: the same steps of Gauss-Seidel, without waiting for memory.

Vectors run over the contacts of a patch. Places beyond its last contact have no effective mass.
"""

import warp as wp

from carom.model.codes import (
    LATERAL_ROW,
    NORMAL_ROW,
    ROLLING_ROW,
    ROW_EFFECTIVE_MASS,
    ROW_FRICTION,
    ROW_IMPULSE,
    ROW_INVERSE_MASS,
    ROW_SHARE,
    ROW_SOFTNESS,
    SPINNING_ROW,
)
from carom.model.contact_structs import Contacts, Couplings
from carom.model.real import (
    Index4,
    Index4Rows,
    Int32,
    IntRows,
    Matrix4,
    Matrix48,
    Matrix84,
    Vector4,
    Vector4Rows,
    Vector8,
    Vector8Rows,
    func,
    real,
    shared_func,
)
from carom.model.structs import Scratch, Settings

# Blocks of a small tree at most.
SMALL = 2
_GREATEST_IMPULSE = real(1e10)


@func
def tree_change(scratch: Scratch, world: Int32, delta: Int32, blocks: Int32) -> Vector8:
    """What the solver has changed so far about the velocity of a small tree."""
    first = scratch.delta_velocity[world, delta]
    second = Vector4(0.0, 0.0, 0.0, 0.0)
    if blocks > 1:
        second = scratch.delta_velocity[world, delta + 1]
    return Vector8(first[0], first[1], first[2], first[3], second[0], second[1], second[2], second[3])


@func
def velocities(jacobian: Matrix84, change: Vector8) -> Vector4:
    """Velocities of the contacts of a patch along one direction."""
    return (
        (change[0] * jacobian[0] + change[1] * jacobian[1])
        + (change[2] * jacobian[2] + change[3] * jacobian[3])
    ) + (
        (change[4] * jacobian[4] + change[5] * jacobian[5])
        + (change[6] * jacobian[6] + change[7] * jacobian[7])
    )


@func
def push(response: Matrix48, impulse: Vector4) -> Vector8:
    """How impulses of the contacts of a patch change the velocity of a tree."""
    return (impulse[0] * response[0] + impulse[1] * response[1]) + (
        impulse[2] * response[2] + impulse[3] * response[3]
    )


@func
def add_change(scratch: Scratch, world: Int32, delta: Int32, blocks: Int32, change: Vector8):
    """Change the velocity of a small tree."""
    scratch.delta_velocity[world, delta] += Vector4(change[0], change[1], change[2], change[3])
    if blocks > 1:
        scratch.delta_velocity[world, delta + 1] += Vector4(change[4], change[5], change[6], change[7])


@func
def greatest_square(change: Vector4) -> real:
    """The greatest of the squares."""
    square = wp.cw_mul(change, change)
    return wp.max(wp.max(square[0], square[1]), wp.max(square[2], square[3]))


@func
def relax_normals(scratch: Scratch, couplings: Couplings, world: Int32, patch: Int32) -> real:
    """Relax the normal rows of a patch; returns the greatest change of velocity squared."""
    place = couplings.patch[world, patch].place
    before = couplings.patch[world, patch].impulse0
    velocity = Vector4(0.0, 0.0, 0.0, 0.0)
    if place[1] > 0:
        moved = tree_change(scratch, world, place[0], place[1])
        velocity = velocities(couplings.patch[world, patch].jacobian0_a, moved)
    if place[3] > 0:
        moved = tree_change(scratch, world, place[2], place[3])
        velocity += velocities(couplings.patch[world, patch].jacobian0_b, moved)
    wanted = (
        (before - wp.cw_mul(before, couplings.patch[world, patch].softness0))
        + couplings.patch[world, patch].share0
        - wp.cw_mul(velocity, couplings.patch[world, patch].effective_mass0)
    )
    gain = couplings.patch[world, patch].gain00
    change = Vector4(0.0, 0.0, 0.0, 0.0)
    for i in range(4):
        change[i] = wp.min(wp.max(wanted[i], 0.0), _GREATEST_IMPULSE) - before[i]
        wanted -= change[i] * gain[i]
    couplings.patch[world, patch].impulse0 = before + change
    if place[1] > 0:
        moved = push(couplings.patch[world, patch].response0_a, change)
        add_change(scratch, world, place[0], place[1], moved)
    if place[3] > 0:
        moved = push(couplings.patch[world, patch].response0_b, change)
        add_change(scratch, world, place[2], place[3], moved)
    return greatest_square(wp.cw_mul(change, couplings.patch[world, patch].inverse_mass0))


@func
def relax_friction(
    settings: Settings, scratch: Scratch, couplings: Couplings, world: Int32, patch: Int32
) -> real:
    """Relax the lateral rows of a patch within its normal impulses; returns as `relax_normals`."""
    place = couplings.patch[world, patch].place
    before1 = couplings.patch[world, patch].impulse1
    before2 = couplings.patch[world, patch].impulse2
    velocity1 = Vector4(0.0, 0.0, 0.0, 0.0)
    velocity2 = Vector4(0.0, 0.0, 0.0, 0.0)
    if place[1] > 0:
        moved = tree_change(scratch, world, place[0], place[1])
        velocity1 = velocities(couplings.patch[world, patch].jacobian1_a, moved)
        velocity2 = velocities(couplings.patch[world, patch].jacobian2_a, moved)
    if place[3] > 0:
        moved = tree_change(scratch, world, place[2], place[3])
        velocity1 += velocities(couplings.patch[world, patch].jacobian1_b, moved)
        velocity2 += velocities(couplings.patch[world, patch].jacobian2_b, moved)
    wanted1 = (before1 + couplings.patch[world, patch].share1) - wp.cw_mul(
        velocity1, couplings.patch[world, patch].effective_mass1
    )
    wanted2 = (before2 + couplings.patch[world, patch].share2) - wp.cw_mul(
        velocity2, couplings.patch[world, patch].effective_mass2
    )
    bounds = wp.cw_mul(couplings.patch[world, patch].friction, couplings.patch[world, patch].impulse0)
    gain11 = couplings.patch[world, patch].gain11
    gain12 = couplings.patch[world, patch].gain12
    gain21 = couplings.patch[world, patch].gain21
    gain22 = couplings.patch[world, patch].gain22
    change1 = Vector4(0.0, 0.0, 0.0, 0.0)
    change2 = Vector4(0.0, 0.0, 0.0, 0.0)
    for i in range(4):
        first = wanted1[i]
        second = wanted2[i]
        bound = bounds[i]
        if settings.cone_friction != 0:
            square = first * first + second * second
            if square > bound * bound:
                scale = bound / wp.sqrt(square)
                first = first * scale
                second = second * scale
        elif bound > 0.0:
            first = wp.clamp(first, -bound, bound)
            second = wp.clamp(second - (first - before1[i]) * gain12[i, i], -bound, bound)
        else:
            first = before1[i]
            second = before2[i]
        change1[i] = first - before1[i]
        change2[i] = second - before2[i]
        wanted1 -= change1[i] * gain11[i] + change2[i] * gain21[i]
        wanted2 -= change1[i] * gain12[i] + change2[i] * gain22[i]
    couplings.patch[world, patch].impulse1 = before1 + change1
    couplings.patch[world, patch].impulse2 = before2 + change2
    if place[1] > 0:
        moved = push(couplings.patch[world, patch].response1_a, change1)
        moved += push(couplings.patch[world, patch].response2_a, change2)
        add_change(scratch, world, place[0], place[1], moved)
    if place[3] > 0:
        moved = push(couplings.patch[world, patch].response1_b, change1)
        moved += push(couplings.patch[world, patch].response2_b, change2)
        add_change(scratch, world, place[2], place[3], moved)
    return greatest_square(
        wp.cw_mul(change1, couplings.patch[world, patch].inverse_mass1)
        + wp.cw_mul(change2, couplings.patch[world, patch].inverse_mass2)
    )


@func
def direction_row(contact_rows: Index4Rows, world: Int32, contact: Int32, direction: Int32) -> Int32:
    """Row of a contact along its normal, 0, or a friction direction, 1 or 2."""
    rows = contact_rows[world, contact]
    if direction == 0:
        return rows[NORMAL_ROW]
    return rows[LATERAL_ROW] + direction - 1


@shared_func
def gather_blocks(
    rows: Vector4Rows,
    starts: IntRows,
    contact_rows: Index4Rows,
    world: Int32,
    first: Int32,
    count: Int32,
    direction: Int32,
    blocks: Int32,
    offset: Int32,
) -> Matrix84:
    """Jacobians of contacts along a direction, or the responses to them, as columns.

    Args:
        rows: `Couplings.jacobian_row` or `Couplings.jacobian_response`.
        starts: `Couplings.coupling_start`.
        contact_rows: `Couplings.contact_rows`.
        world: The world.
        first: First contact.
        count: Number of contacts.
        direction: 0 for the normal, 1 or 2 for a friction direction.
        blocks: Number of blocks of the tree.
        offset: Where its blocks start in a row.
    """
    result = Matrix84()
    for i in range(4):
        if i < count:
            start = starts[world, direction_row(contact_rows, world, first + i, direction)]
            for block in range(SMALL):
                if block < blocks:
                    entries = rows[world, start + offset + block]
                    for j in range(4):
                        result[4 * block + j, i] = entries[j]
    return result


@shared_func
def gather_numbers(
    terms: Vector8Rows,
    contact_rows: Index4Rows,
    world: Int32,
    first: Int32,
    count: Int32,
    direction: Int32,
    column: Int32,
) -> Vector4:
    """A column of `coupling_terms` over contacts, along a direction."""
    result = Vector4(0.0, 0.0, 0.0, 0.0)
    for i in range(4):
        if i < count:
            row = direction_row(contact_rows, world, first + i, direction)
            result[i] = terms[world, row][column]
    return result


@shared_func
def gains(
    response_a: Matrix48, jacobian_a: Matrix84, response_b: Matrix48, jacobian_b: Matrix84, mass: Vector4
) -> Matrix4:
    """By how much impulses with these responses lower the impulses wanted along these Jacobians."""
    result = Matrix4()
    for i in range(4):
        result[i] = wp.cw_mul(
            velocities(jacobian_a, response_a[i]) + velocities(jacobian_b, response_b[i]), mass
        )
    return result


@func
def gather_patch(couplings: Couplings, world: Int32, patch: Int32, first: Int32, count: Int32, place: Index4):
    """Make a patch of `count` contacts, from `first` on, whose rows have been written."""
    a = place[1]
    b = place[3]
    terms = couplings.coupling_terms
    starts = couplings.coupling_start
    rows = couplings.contact_rows
    couplings.patch[world, patch].place = place
    couplings.patch[world, patch].first_contact = first
    couplings.patch[world, patch].count = count

    mass0 = gather_numbers(terms, rows, world, first, count, 0, ROW_EFFECTIVE_MASS)
    couplings.patch[world, patch].share0 = gather_numbers(terms, rows, world, first, count, 0, ROW_SHARE)
    couplings.patch[world, patch].softness0 = gather_numbers(
        terms, rows, world, first, count, 0, ROW_SOFTNESS
    )
    couplings.patch[world, patch].inverse_mass0 = gather_numbers(
        terms, rows, world, first, count, 0, ROW_INVERSE_MASS
    )
    couplings.patch[world, patch].effective_mass0 = mass0
    couplings.patch[world, patch].impulse0 = gather_numbers(terms, rows, world, first, count, 0, ROW_IMPULSE)
    jacobian0_a = gather_blocks(couplings.jacobian_row, starts, rows, world, first, count, 0, a, 0)
    jacobian0_b = gather_blocks(couplings.jacobian_row, starts, rows, world, first, count, 0, b, a)
    response0_a = wp.transpose(
        gather_blocks(couplings.jacobian_response, starts, rows, world, first, count, 0, a, 0)
    )
    response0_b = wp.transpose(
        gather_blocks(couplings.jacobian_response, starts, rows, world, first, count, 0, b, a)
    )
    couplings.patch[world, patch].jacobian0_a = jacobian0_a
    couplings.patch[world, patch].jacobian0_b = jacobian0_b
    couplings.patch[world, patch].response0_a = response0_a
    couplings.patch[world, patch].response0_b = response0_b
    couplings.patch[world, patch].gain00 = gains(response0_a, jacobian0_a, response0_b, jacobian0_b, mass0)

    mass1 = gather_numbers(terms, rows, world, first, count, 1, ROW_EFFECTIVE_MASS)
    mass2 = gather_numbers(terms, rows, world, first, count, 2, ROW_EFFECTIVE_MASS)
    couplings.patch[world, patch].friction = gather_numbers(terms, rows, world, first, count, 1, ROW_FRICTION)
    couplings.patch[world, patch].share1 = gather_numbers(terms, rows, world, first, count, 1, ROW_SHARE)
    couplings.patch[world, patch].share2 = gather_numbers(terms, rows, world, first, count, 2, ROW_SHARE)
    couplings.patch[world, patch].inverse_mass1 = gather_numbers(
        terms, rows, world, first, count, 1, ROW_INVERSE_MASS
    )
    couplings.patch[world, patch].inverse_mass2 = gather_numbers(
        terms, rows, world, first, count, 2, ROW_INVERSE_MASS
    )
    couplings.patch[world, patch].effective_mass1 = mass1
    couplings.patch[world, patch].effective_mass2 = mass2
    couplings.patch[world, patch].impulse1 = gather_numbers(terms, rows, world, first, count, 1, ROW_IMPULSE)
    couplings.patch[world, patch].impulse2 = gather_numbers(terms, rows, world, first, count, 2, ROW_IMPULSE)
    jacobian1_a = gather_blocks(couplings.jacobian_row, starts, rows, world, first, count, 1, a, 0)
    jacobian1_b = gather_blocks(couplings.jacobian_row, starts, rows, world, first, count, 1, b, a)
    jacobian2_a = gather_blocks(couplings.jacobian_row, starts, rows, world, first, count, 2, a, 0)
    jacobian2_b = gather_blocks(couplings.jacobian_row, starts, rows, world, first, count, 2, b, a)
    response1_a = wp.transpose(
        gather_blocks(couplings.jacobian_response, starts, rows, world, first, count, 1, a, 0)
    )
    response1_b = wp.transpose(
        gather_blocks(couplings.jacobian_response, starts, rows, world, first, count, 1, b, a)
    )
    response2_a = wp.transpose(
        gather_blocks(couplings.jacobian_response, starts, rows, world, first, count, 2, a, 0)
    )
    response2_b = wp.transpose(
        gather_blocks(couplings.jacobian_response, starts, rows, world, first, count, 2, b, a)
    )
    couplings.patch[world, patch].jacobian1_a = jacobian1_a
    couplings.patch[world, patch].jacobian1_b = jacobian1_b
    couplings.patch[world, patch].jacobian2_a = jacobian2_a
    couplings.patch[world, patch].jacobian2_b = jacobian2_b
    couplings.patch[world, patch].response1_a = response1_a
    couplings.patch[world, patch].response1_b = response1_b
    couplings.patch[world, patch].response2_a = response2_a
    couplings.patch[world, patch].response2_b = response2_b
    couplings.patch[world, patch].gain11 = gains(response1_a, jacobian1_a, response1_b, jacobian1_b, mass1)
    couplings.patch[world, patch].gain12 = gains(response1_a, jacobian2_a, response1_b, jacobian2_b, mass2)
    couplings.patch[world, patch].gain21 = gains(response2_a, jacobian1_a, response2_b, jacobian1_b, mass1)
    couplings.patch[world, patch].gain22 = gains(response2_a, jacobian2_a, response2_b, jacobian2_b, mass2)


@func
def gather_units(contacts: Contacts, couplings: Couplings, world: Int32, first_contact: Int32) -> Index4:
    """List what the sweeps of an island relax: patches, and contacts by themselves.

    Returns:
        Number of units; number of patches; 1 if there is rolling or spinning friction; 0.
    """
    units = Int32(0)
    patches = Int32(0)
    torsion = Int32(0)
    contact = first_contact + 0
    while contact >= 0:
        pair = contacts.contact_shapes[world, contact]
        rows = couplings.contact_rows[world, contact]
        place = couplings.coupling_place[world, rows[NORMAL_ROW]]
        count = Int32(1)
        following = couplings.contact_next[world, contact]
        while following == contact + count and same_shapes(contacts, world, following, pair):
            following = couplings.contact_next[world, following]
            count += 1
        twists = rows[ROLLING_ROW] >= 0 or rows[SPINNING_ROW] >= 0
        if twists:
            torsion = Int32(1)
        if count > 1 and not twists and place[1] <= SMALL and place[3] <= SMALL:
            gather_patch(couplings, world, patches, contact, count, place)
            couplings.unit_code[world, units] = -1 - patches
            patches += 1
            units += 1
        else:
            for i in range(count):
                couplings.unit_code[world, units + i] = contact + i
            units += count
        contact = following
    return Index4(units, patches, torsion, 0)


@func
def same_shapes(contacts: Contacts, world: Int32, contact: Int32, pair: Index4) -> bool:
    """Whether a contact, if it is one, is between the shapes of `pair`."""
    if contact < 0:
        return False
    other = contacts.contact_shapes[world, contact]
    return other[0] == pair[0] and other[1] == pair[1]


@func
def scatter_impulses(couplings: Couplings, world: Int32, patch: Int32):
    """Give the impulses of a patch to the rows of its contacts."""
    impulse0 = couplings.patch[world, patch].impulse0
    impulse1 = couplings.patch[world, patch].impulse1
    impulse2 = couplings.patch[world, patch].impulse2
    for i in range(couplings.patch[world, patch].count):
        rows = couplings.contact_rows[world, couplings.patch[world, patch].first_contact + i]
        couplings.coupling_terms[world, rows[NORMAL_ROW]][ROW_IMPULSE] = impulse0[i]
        couplings.coupling_terms[world, rows[LATERAL_ROW]][ROW_IMPULSE] = impulse1[i]
        couplings.coupling_terms[world, rows[LATERAL_ROW] + 1][ROW_IMPULSE] = impulse2[i]
