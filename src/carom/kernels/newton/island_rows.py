"""What an island is solved from: its rows, and the places of its matrices."""

from carom.kernels.newton.contacts import add_contact
from carom.kernels.newton.envelope import fit_envelope
from carom.kernels.newton.ordering import order_members
from carom.kernels.newton.rows import add_constraints
from carom.kernels.structs import (
    Contacts,
    Model,
    NewtonWork,
    PairRows,
    Scratch,
    Settings,
    Shapes,
    State,
    UserConstraints,
)
from carom.kernels.types import Int32, func
from carom.layouts.newton import NEWTON_COLUMNS, PLACES, ROWS, SHORT


@func
def gather_rows(
    model: Model,
    settings: Settings,
    state: State,
    scratch: Scratch,
    shapes: Shapes,
    contacts: Contacts,
    users: UserConstraints,
    pair_rows: PairRows,
    work: NewtonWork,
    world: Int32,
    root: Int32,
    compliant: Int32,
) -> Int32:
    """Write the rows of an island; returns how many are of joints."""
    for column in range(NEWTON_COLUMNS):
        work.count_newton[world, column] = 0
    order_members(model, shapes, contacts, pair_rows, work, world, root)
    joint_rows = add_constraints(
        model, settings, state, scratch, users, pair_rows, work, world, root, compliant
    )
    contact = pair_rows.tree_first_contact[world, root]
    while contact >= 0 and work.count_newton[world, SHORT] == 0:
        add_contact(
            settings, model, state, scratch, shapes, contacts, pair_rows, work, world, contact, compliant
        )
        contact = pair_rows.contact_next[world, contact]
    return joint_rows


@func
def fit_matrices(work: NewtonWork, pair_rows: PairRows, world: Int32) -> Int32:
    """Place the matrices of an island; returns their number of entries, negative if there is no room."""
    if work.count_newton[world, SHORT] != 0:
        return Int32(-1)
    return fit_envelope(
        work.vector_last, work.vector_start, work.newton_row, pair_rows.jacobian_row, world,
        work.count_newton[world, ROWS], work.count_newton[world, PLACES], work.matrix_mass.shape[1],
    )  # fmt: skip
