"""Units of an island's sweeps: its contacts, grouped into manifold blocks or single.

The code of a unit, in `PairRows.unit_code`, is -1 - block for a manifold block, `SINGLES` + i for single
contact i of rigid bodies (with `TWISTING`, if it has rolling or spinning friction), and the contact itself
for any other.
"""

from carom.kernels.dynamics.contact_compliance import yields_without_bounce
from carom.kernels.solver.articulated_manifolds import VECTORS_PER_BLOCK
from carom.kernels.solver.contact_order import same_shapes
from carom.kernels.solver.contact_rows import add_contact_rows, keep_contact_impulses
from carom.kernels.solver.contact_terms import contact_friction, contact_terms, yielding_terms
from carom.kernels.solver.manifold_writing import keep_manifold_impulses, write_manifold_block
from carom.kernels.solver.pair_rows import has_room, tree_blocks
from carom.kernels.solver.single_contacts import (
    SINGLES,
    TWISTING,
    keep_single_impulses,
    single_of,
    write_single_contact,
    write_twisting_contact,
)
from carom.kernels.solver.warm_starting import is_rigid
from carom.kernels.structs import Contacts, Model, PairRows, Scratch, Settings, Shapes, State
from carom.kernels.types import Index4, Int32, Vector3, called_func, func, real
from carom.layouts.codes import ISOTROPIC

# What an island's contacts have: nothing in particular; some have rolling or spinning friction; none has, and
# all yield.
PLAIN, TWISTED, YIELDING = 0, 1, 2


@func
def has_torsion(friction: Vector3) -> bool:
    """Whether a contact with these coefficients has rolling or spinning friction."""
    return friction[1] > 0.0 or friction[2] > 0.0


@func
def twists(shapes: Shapes, contacts: Contacts, world: Int32, contact: Int32) -> bool:
    """Whether a contact may have rolling or spinning friction, of its shapes or of the pair of links."""
    pair = contacts.contact_shapes[world, contact]
    if has_torsion(contact_friction(shapes, world, pair[0], pair[1])):
        return True
    if shapes.shape_friction_rank[world, pair[0]] == 0:
        return False
    return shapes.link_pair_twists[pair[2]] != 0 and shapes.link_pair_twists[pair[3]] != 0


@func
def may_join(
    shapes: Shapes, contacts: Contacts, world: Int32, contact: Int32, first: Int32, rigid: bool
) -> bool:
    """Whether a contact may be in the same manifold block as `first`, a contact before it.

    Blocks of rigid bodies have contacts of two shapes, as warm starting requires; articulated ones may have
    contacts of several links, so that a robot standing on four feet needs one block.
    """
    if contact < 0:
        return False
    pair = contacts.contact_shapes[world, first]
    if rigid:
        return same_shapes(contacts, world, contact, pair)
    other = contacts.contact_shapes[world, contact]
    return (
        shapes.shape_tree[other[0]] == shapes.shape_tree[pair[0]]
        and shapes.shape_tree[other[1]] == shapes.shape_tree[pair[1]]
        and not twists(shapes, contacts, world, contact)
    )


@func
def next_unit(
    shapes: Shapes, contacts: Contacts, pair_rows: PairRows, world: Int32, first: Int32, rigid: bool
):
    """Contacts of the unit that begins with `first`, -1 for none, and their number."""
    members = Index4(first, -1, -1, -1)
    count = Int32(1)
    if not twists(shapes, contacts, world, first):
        following = pair_rows.contact_next[world, first]
        while count < 4 and may_join(shapes, contacts, world, following, first, rigid):
            members[count] = following
            following = pair_rows.contact_next[world, following]
            count += 1
    return members, count


@func
def places_of_single(settings: Settings, rigid: bool, torsion: bool) -> Int32:
    """Number of places among single contacts of a contact without others in its unit; 0 if it is not one.

    `rigid` says whether its bodies are, `torsion` whether it has rolling or spinning friction. Such contacts
    have rows over two trees if friction is isotropic, because the sums of these are in another order.
    """
    if not rigid or (torsion and settings.cone_friction == ISOTROPIC):
        return Int32(0)
    return Int32(2) if torsion else Int32(1)


@called_func
def write_units(
    model: Model,
    settings: Settings,
    state: State,
    scratch: Scratch,
    shapes: Shapes,
    contacts: Contacts,
    pair_rows: PairRows,
    world: Int32,
    first_contact: Int32,
    row: Int32,
    block: Int32,
    share: real,
):
    """Write the rows of an island's contacts, from the next free `row` and `block` on.

    Consecutive contacts that may be solved together become a manifold block. Blocks of rigid bodies start
    from their last impulses times `share`.

    Returns:
        Number of units, negative if some did not fit; number of manifold blocks; what the contacts have, as
        `YIELDING`.
    """
    units, manifold_blocks, next_matrices = Int32(0), Int32(0), Int32(0)
    character = Int32(YIELDING)
    singles = Int32(0)
    contact = first_contact + 0
    while contact >= 0:
        pair = contacts.contact_shapes[world, contact]
        a = shapes.shape_tree[pair[0]]
        b = shapes.shape_tree[pair[1]]
        rigid = is_rigid(model, a) and is_rigid(model, b)
        members, count = next_unit(shapes, contacts, pair_rows, world, contact, rigid)
        i = Int32(0)
        while i < count:
            pair_rows.terms[world, i] = contact_terms(
                settings, model, state, scratch, shapes, contacts, world, members[i],
                pair_rows.contact_solved_up_to[world, members[i]], share,
            )  # fmt: skip
            if yields_without_bounce(shapes, world, pair[0], pair[1]):
                pair_rows.terms[world, i] = yielding_terms(
                    settings, model, state, scratch, shapes, world, pair_rows.terms[world, i]
                )
            elif character == YIELDING:
                character = Int32(PLAIN)
            i += 1
        room = has_room(model, pair_rows, row, block, a, b)
        if count > 1:
            matrices = Int32(-1)
            if not rigid:
                matrices = next_matrices + 0
                next_matrices += VECTORS_PER_BLOCK * (tree_blocks(model, a) + tree_blocks(model, b))
                if next_matrices > pair_rows.matrix_block.shape[1] or not room:
                    return Int32(-1), manifold_blocks, character
            write_manifold_block(
                settings, model, state, scratch, shapes, pair_rows, world,
                manifold_blocks, members, count, a, b, matrices,
                block,
            )  # fmt: skip
            pair_rows.unit_code[world, units] = -1 - manifold_blocks
            manifold_blocks += 1
        else:
            twisting = has_torsion(pair_rows.terms[world, 0].friction)
            if twisting:
                character = Int32(TWISTED)
            places = places_of_single(settings, rigid, twisting)
            if places > 0:
                if singles + places > pair_rows.single_normal.shape[1]:
                    return Int32(-1), manifold_blocks, character
                pair_rows.unit_code[world, units] = SINGLES + singles
                if twisting:
                    pair_rows.unit_code[world, units] = SINGLES + TWISTING + singles
                    write_twisting_contact(
                        settings, model, state, scratch, shapes, pair_rows, pair_rows.terms[world, 0], world,
                        contact, singles,
                    )  # fmt: skip
                else:
                    write_single_contact(
                        settings, model, state, scratch, shapes, pair_rows, pair_rows.terms[world, 0], world,
                        contact, singles,
                    )  # fmt: skip
                singles += places
            else:
                if not room:
                    return Int32(-1), manifold_blocks, character
                row, block = add_contact_rows(
                    settings, model, state, scratch, shapes, pair_rows, pair_rows.terms[world, 0], world,
                    contact, row, block,
                )  # fmt: skip
                pair_rows.unit_code[world, units] = contact
        units += 1
        contact = pair_rows.contact_next[world, members[count - 1]]
    return units, manifold_blocks, character


@func
def keep_unit_impulses(contacts: Contacts, pair_rows: PairRows, world: Int32, units: Int32, outcome: Int32):
    """Store the impulses of an island's contacts, and the `outcome` of solving them."""
    for unit in range(units):
        code = pair_rows.unit_code[world, unit]
        if code < 0:
            keep_manifold_impulses(contacts, pair_rows, world, -1 - code, outcome)
        elif code >= SINGLES:
            keep_single_impulses(contacts, pair_rows, world, single_of(code))
        else:
            keep_contact_impulses(contacts, pair_rows, world, code)
