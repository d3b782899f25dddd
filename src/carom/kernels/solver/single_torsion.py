"""Rolling and spinning friction of single contacts of rigid bodies.

A contact with either of them has two places among the single contacts, one after the other. The first has
its normal and lateral rows, like that of any single contact; the second has its spinning row in
`single_normal` and both rolling rows in `single_lateral`. These are rows of the angular velocity of a
relative to b, and the steps are those of `single_contacts`. Both kinds of rows are always there; a
coefficient of 0 turns them off.
"""

import warp as wp

from carom.kernels.solver.contact_terms import friction_change
from carom.kernels.solver.pair_rows import tree_blocks
from carom.kernels.solver.single_contacts import (
    own_product,
    relax_in_cone,
    relax_in_pyramid,
    relax_single_row,
    response_of_body,
    write_numbers_of_single,
    write_row_of_body,
    write_single_contact,
)
from carom.kernels.structs import ContactTerms, Model, PairRows, Scratch, Settings, Shapes, State
from carom.kernels.types import Int32, Vector3, Vector4, Vector6, func, real
from carom.layouts.codes import SPINNING_ROW


@func
def relax_single_torsion(
    settings: Settings, scratch: Scratch, pair_rows: PairRows, world: Int32, single: Int32, kind: Int32
) -> real:
    """Relax the spinning or the rolling rows of a contact, whose first place is `single`.

    Returns the change of their velocities.
    """
    normal = pair_rows.single_impulse[world, single][0]
    second = single + 1
    change = real(0.0)
    if kind == SPINNING_ROW:
        bound = pair_rows.single_normal[world, second].friction * normal
        if bound > 0.0:
            change = relax_single_row(scratch, pair_rows, world, second, -bound, bound)
    else:
        bound = pair_rows.single_impulse[world, second][3] * normal
        if bound > 0.0:
            if settings.cone_friction != 0:
                change = relax_in_cone(settings, scratch, pair_rows, world, second, bound)
            else:
                change = relax_in_pyramid(scratch, pair_rows, world, second, bound)
    return change


@func
def torsion_axis(terms: ContactTerms, row: Int32) -> Vector3:
    """Axis of a row of torsional friction: row 0 is spinning, rows 1 and 2 are rolling friction."""
    return terms.normal if row == 0 else terms.rolling1 if row == 1 else terms.rolling2


@func
def write_torsion_row(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    pair_rows: PairRows,
    terms: ContactTerms,
    world: Int32,
    second: Int32,
    row: Int32,
):
    """Write a row of torsional friction at the second place of a contact; `row` as for `torsion_axis`."""
    inverse_mass, velocity = real(0.0), real(0.0)
    tree = terms.ends[0]
    axis = torsion_axis(terms, row)
    carried = wp.dot(terms.carried_spin, axis)
    body = Int32(0)
    while body < 2:
        jacobian = Vector6(0.0)
        response = Vector6(0.0)
        velocity_of_body = real(0.0)
        if tree_blocks(model, tree) > 0:
            jacobian = Vector6(axis[0], axis[1], axis[2], 0.0, 0.0, 0.0)
            response, velocity_of_body = response_of_body(model, state, scratch, world, tree, jacobian)
        write_row_of_body(pair_rows, world, second, row, body, jacobian, response)
        inverse_mass += own_product(jacobian, response)
        velocity += velocity_of_body
        tree = terms.ends[2]
        axis = -axis
        body += 1
    if terms.ignored != 0:
        inverse_mass = real(0.0)
    # A drift is along the surface, so there is none about an axis.
    change = friction_change(settings, velocity + carried, terms.drift, Vector3(0.0, 0.0, 0.0))
    write_numbers_of_single(pair_rows, world, second, row, inverse_mass, 0.0, change)


@func
def write_twisting_contact(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    shapes: Shapes,
    pair_rows: PairRows,
    terms: ContactTerms,
    world: Int32,
    contact: Int32,
    single: Int32,
):
    """Write the rows of a contact with rolling or spinning friction at `single` and the place after it."""
    write_single_contact(settings, model, state, scratch, shapes, pair_rows, terms, world, contact, single)
    second = single + 1
    pair_rows.single_contact[world, second] = contact
    pair_rows.single_place[world, second] = pair_rows.single_place[world, single]
    pair_rows.single_impulse[world, second] = Vector4(0.0, 0.0, 0.0, terms.friction[1])
    pair_rows.single_normal[world, second].friction = terms.friction[2]
    row = Int32(0)
    while row < 3:
        write_torsion_row(settings, model, state, scratch, pair_rows, terms, world, second, row)
        row += 1
