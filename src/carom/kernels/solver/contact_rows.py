"""Rows over two trees of contacts that are neither in a manifold block nor single contacts of rigid bodies.

They are normal, and lateral, rolling and spinning friction.
"""

import warp as wp

from carom.kernels.solver.contact_terms import (
    friction_change,
    keep_contact_impulse,
    lateral_change,
    normal_change,
    torsion_softness,
)
from carom.kernels.solver.pair_rows import write_pair_jacobian, write_row
from carom.kernels.solver.warm_starting import NOT_RESTING
from carom.kernels.structs import Contacts, ContactTerms, Model, PairRows, Scratch, Settings, Shapes, State
from carom.kernels.types import Index4, Int32, Vector3, func, real
from carom.layouts.codes import LATERAL_ROW, NORMAL_ROW, ROLLING_ROW, SPINNING_ROW

_UNBOUNDED = real(1e10)


@func
def add_contact_rows(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    shapes: Shapes,
    pair_rows: PairRows,
    terms: ContactTerms,
    world: Int32,
    contact: Int32,
    row: Int32,
    block: Int32,
):
    """Write the rows of one contact: normal, two lateral; two rolling and one spinning if it has them.

    Returns:
        The next free row, and the next free block.
    """
    rows = Index4(row, row + 1, -1, -1)
    end = row + 3
    if terms.friction[1] > 0.0:
        rows[ROLLING_ROW] = end
        end += 2
    if terms.friction[2] > 0.0:
        rows[SPINNING_ROW] = end
        end += 1
    pair_rows.contact_rows[world, contact] = rows

    zero = Vector3(0.0, 0.0, 0.0)
    for place in range(row, end):
        linear = zero
        angular = zero
        coefficient = terms.friction[0]
        if place == row:
            linear = terms.normal
        elif place == rows[LATERAL_ROW]:
            linear = terms.lateral1
        elif place == rows[LATERAL_ROW] + 1:
            linear = terms.lateral2
        elif place == rows[SPINNING_ROW]:
            angular = terms.normal
            coefficient = terms.friction[2]
        else:
            coefficient = terms.friction[1]
            angular = terms.rolling2 if place > rows[ROLLING_ROW] else terms.rolling1

        inverse_mass, velocity, block = write_pair_jacobian(
            model, state, scratch, pair_rows, world, place, block, terms.ends, terms.point_a, terms.point_b,
            linear, angular,
        )  # fmt: skip
        if terms.ignored != 0:
            inverse_mass = real(0.0)
        velocity = velocity + wp.dot(terms.carried, linear) + wp.dot(terms.carried_spin, angular)
        change = friction_change(settings, velocity, terms.drift, linear)
        softness = real(0.0)
        if place == rows[LATERAL_ROW] or place == rows[LATERAL_ROW] + 1:
            change = lateral_change(settings, terms, velocity, place - row, linear)
            softness = terms.lateral_softness + 0.0
        elif place != row and terms.ignored == 0:
            softness = torsion_softness(settings)
        lower = -coefficient
        upper = coefficient
        if place == row:
            change = normal_change(settings, shapes, terms, world, velocity)
            lower = real(0.0)
            upper = real(0.0) + _UNBOUNDED
            softness = terms.softness
        write_row(pair_rows, world, place, inverse_mass, change, softness, lower, upper, coefficient)
        if terms.ignored != 0:
            pair_rows.row_terms[world, place].inverse_mass = real(0.0)
        pair_rows.row_bound[world, place] = row
    return end, block


@func
def keep_contact_impulses(contacts: Contacts, pair_rows: PairRows, world: Int32, contact: Int32):
    """Store the impulses of a contact's rows."""
    rows = pair_rows.contact_rows[world, contact]
    keep_contact_impulse(
        contacts, world, contact, pair_rows.row_terms[world, rows[NORMAL_ROW]].impulse,
        pair_rows.row_terms[world, rows[LATERAL_ROW]].impulse,
        pair_rows.row_terms[world, rows[LATERAL_ROW] + 1].impulse,
        pair_rows.row_terms[world, rows[LATERAL_ROW]].friction, Int32(NOT_RESTING),
    )  # fmt: skip
