"""Starting contacts that yield from the impulses of the last step.

Where the free rows of an island are solved for (`active_set`), what sweeps start from decides only how soon
the right rows are free and sliding has its direction. So errors of the last solution do not accumulate, as
they could in `solver.warm_starting`.
"""

from carom.kernels.convergence.active_rows import add_impulse_of_pair
from carom.kernels.convergence.active_set import unit_is_over
from carom.kernels.solver.articulated_manifolds import push_articulated
from carom.kernels.structs import Contacts, Model, PairRows, Scratch, Settings
from carom.kernels.types import Int32, Vector4, Vector8, func, real
from carom.layouts.codes import NORMAL_ROW


@func
def start_block(
    scratch: Scratch, contacts: Contacts, pair_rows: PairRows, world: Int32, block: Int32, share: real
):
    """Start the rows of an articulated manifold block, but for those along which nothing can move."""
    members = pair_rows.manifold_block[world, block].members
    normals, friction = Vector4(0.0, 0.0, 0.0, 0.0), Vector8(0.0)
    for i in range(pair_rows.manifold_block[world, block].count):
        last = share * contacts.contact_impulse[world, members[i]]
        if last[0] > 0.0 and pair_rows.manifold_block[world, block].normal_inverse_mass[i] > 0.0:
            normals[i] = last[0]
            for k in range(2):
                if pair_rows.manifold_block[world, block].friction_inverse_mass[2 * i + k] > 0.0:
                    friction[2 * i + k] = last[1 + k]
    pair_rows.manifold_block[world, block].normal_impulse = normals
    pair_rows.manifold_block[world, block].friction_impulse = friction
    push_articulated(scratch, pair_rows, world, block, normals, friction)


@func
def start_single(
    scratch: Scratch, contacts: Contacts, pair_rows: PairRows, world: Int32, contact: Int32, share: real
):
    """The same of a contact that is a unit of its own."""
    row = pair_rows.contact_rows[world, contact][NORMAL_ROW]
    last = share * contacts.contact_impulse[world, contact]
    if last[0] > 0.0 and pair_rows.row_terms[world, row].effective_mass > 0.0:
        for i in range(3):
            if pair_rows.row_terms[world, row + i].effective_mass > 0.0:
                add_impulse_of_pair(scratch, pair_rows, world, row + i, last[i])


@func
def start_from_last(
    model: Model,
    settings: Settings,
    scratch: Scratch,
    contacts: Contacts,
    pair_rows: PairRows,
    world: Int32,
    tree: Int32,
    units: Int32,
):
    """Start the contacts of an island that consists of one tree from a share of their last impulses.

    Nothing happens if some are of other trees, or of rigid bodies.
    """
    delta = model.tree[tree].first_delta
    share = settings.contact_warm_starting
    for unit in range(units):
        if not unit_is_over(pair_rows, world, pair_rows.unit_code[world, unit], delta):
            return
    for unit in range(units):
        code = pair_rows.unit_code[world, unit]
        if code < 0:
            start_block(scratch, contacts, pair_rows, world, -1 - code, share)
        else:
            start_single(scratch, contacts, pair_rows, world, code, share)
