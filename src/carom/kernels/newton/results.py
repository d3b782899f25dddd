"""What the impulses of a solved island are stored in: rows of joints and constraints, and contacts."""

from carom.kernels.solver.contact_terms import keep_contact_impulse
from carom.kernels.solver.warm_starting import NOT_RESTING
from carom.kernels.structs import Contacts, NewtonWork, PairRows, Scratch
from carom.kernels.types import Int32, Vector3, func
from carom.layouts.newton import OF_JOINT, OF_NORMAL, OF_USER, ROWS


@func
def keep_contact(contacts: Contacts, work: NewtonWork, world: Int32, row: Int32):
    """Store the impulses of the contact of a normal, and that of friction in world axes as its memory.

    What it has remembered before stays in its other anchor.
    """
    contact = work.newton_row[world, row].source
    normal = work.newton_row[world, row].impulse + work.newton_row[world, row].impact
    first = work.newton_row[world, row + 1].impulse
    second = work.newton_row[world, row + 2].impulse
    remembered = contacts.contact_anchor_b[world, contact] + Vector3(0.0, 0.0, 0.0)
    keep_contact_impulse(
        contacts, world, contact, normal, first, second, work.newton_row[world, row + 1].friction,
        Int32(NOT_RESTING),
    )  # fmt: skip
    pull = (
        first * contacts.contact_direction1[world, contact]
        + second * contacts.contact_direction2[world, contact]
    )
    contacts.contact_anchor_a[world, contact] = pull
    contacts.contact_anchor_b[world, contact] = remembered


@func
def keep_results(scratch: Scratch, contacts: Contacts, pair_rows: PairRows, work: NewtonWork, world: Int32):
    """Store the impulses of all rows of an island."""
    for row in range(work.count_newton[world, ROWS]):
        origin = work.newton_row[world, row].origin
        source = work.newton_row[world, row].source
        if origin == OF_JOINT:
            scratch.row[world, source].impulse = work.newton_row[world, row].impulse
        elif origin == OF_USER:
            pair_rows.row_terms[world, source].impulse = work.newton_row[world, row].impulse
        elif origin == OF_NORMAL:
            keep_contact(contacts, work, world, row)
