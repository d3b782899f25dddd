"""What the sweeps of an island relax, in order: patches, and contacts by themselves."""

from carom.model.contact_structs import Contacts, Couplings, Shapes
from carom.model.real import Index4, Int32, func, real
from carom.model.structs import Model, Scratch, Settings, State
from carom.physics.calm import is_rigid
from carom.physics.contact_order import same_shapes
from carom.physics.contact_rows import add_contact_rows, keep_contact_impulses
from carom.physics.contact_terms import contact_friction, contact_terms
from carom.physics.couplings import has_room, tree_blocks
from carom.physics.long_patches import RUN_PER_BLOCK
from carom.physics.patch_writing import keep_patch_impulses, write_patch


@func
def write_units(
    model: Model,
    settings: Settings,
    state: State,
    scratch: Scratch,
    shapes: Shapes,
    contacts: Contacts,
    couplings: Couplings,
    world: Int32,
    first_contact: Int32,
    place: Index4,
    share: real,
) -> Index4:
    """Write the rows of an island's contacts, from the free place on.

    Those of rigid bodies start from a `share` of their last impulses. Several contacts of two shapes that
    neither roll nor spin against friction make a patch.

    Returns:
        Number of units, negative if some did not fit; number of patches; 1 if there is rolling or
        spinning friction; 0.
    """
    units = Int32(0)
    patches = Int32(0)
    torsion = Int32(0)
    next_run = Int32(0)
    contact = first_contact + 0
    while contact >= 0:
        pair = contacts.contact_shapes[world, contact]
        a = shapes.shape_tree[pair[0]]
        b = shapes.shape_tree[pair[1]]
        count = Int32(1)
        following = couplings.contact_next[world, contact]
        while following == contact + count and same_shapes(contacts, world, following, pair):
            following = couplings.contact_next[world, following]
            count += 1
        i = Int32(0)
        while i < count:
            couplings.terms[world, i] = contact_terms(
                settings, model, state, scratch, shapes, contacts, world, contact + i, share
            )
            i += 1
        friction = contact_friction(shapes, pair[2], pair[3])
        twists = friction[1] > 0.0 or friction[2] > 0.0
        if twists:
            torsion = Int32(1)
        if count > 1 and not twists:
            blocks = tree_blocks(model, a) + tree_blocks(model, b)
            run = Int32(-1)
            if not is_rigid(model, a) or not is_rigid(model, b):
                run = next_run + 0
                next_run += RUN_PER_BLOCK * blocks
                if next_run > couplings.run_block.shape[1] or not has_room(model, couplings, place, a, b):
                    return Index4(-1, patches, torsion, 0)
            write_patch(
                settings, model, state, scratch, shapes, couplings, world, patches, contact, count, a, b, run,
                place[1],
            )  # fmt: skip
            couplings.unit_code[world, units] = -1 - patches
            patches += 1
            units += 1
        else:
            i = Int32(0)
            while i < count:
                if not has_room(model, couplings, place, a, b):
                    return Index4(-1, patches, torsion, 0)
                place = add_contact_rows(
                    settings, model, state, scratch, shapes, contacts, couplings, couplings.terms[world, i],
                    world, contact + i, place[0], place[1],
                )  # fmt: skip
                couplings.unit_code[world, units] = contact + i
                units += 1
                i += 1
        contact = following
    return Index4(units, patches, torsion, 0)


@func
def keep_unit_impulses(contacts: Contacts, couplings: Couplings, world: Int32, units: Int32, outcome: Int32):
    """Report the impulses of an island's contacts, and the `outcome` of the search for them."""
    unit = Int32(0)
    while unit < units:
        code = couplings.unit_code[world, unit]
        if code < 0:
            keep_patch_impulses(contacts, couplings, world, -1 - code, outcome)
        else:
            keep_contact_impulses(contacts, couplings, world, code)
        unit += 1
