"""Making patches of contacts, and reporting what they did; see `patches`."""

from carom.kernels.solver.calm import SOLVED, SOLVED_AND_HOLDS, holds
from carom.kernels.solver.contact_terms import keep_contact_impulse
from carom.kernels.solver.couplings import tree_blocks
from carom.kernels.solver.long_patch_rows import clear_run, write_long_contact
from carom.kernels.solver.patch_rows import write_rigid_rows
from carom.kernels.structs import Contacts, Couplings, Model, Patch, Scratch, Settings, Shapes, State
from carom.kernels.types import Index4, Int32, func


@func
def tree_place(model: Model, tree: Int32) -> Int32:
    """First block of a tree in `delta_velocity`; 0 for the world, -1."""
    if tree < 0:
        return Int32(0)
    return model.tree[tree].first_delta


@func
def write_patch(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    shapes: Shapes,
    couplings: Couplings,
    world: Int32,
    patch: Int32,
    members: Index4,
    count: Int32,
    a: Int32,
    b: Int32,
    run: Int32,
    temporary: Int32,
):
    """Write the rows of the `count` contacts in `members` of two trees, whose terms are in `Couplings.terms`.

    `run` is where in `Couplings.run_block` their matrices go, -1 if they are rigid bodies; the
    blocks from `temporary` on of a row over two trees are free.
    """
    couplings.patch[world, patch] = Patch()
    couplings.patch[world, patch].place = Index4(
        tree_place(model, a), tree_blocks(model, a), tree_place(model, b), tree_blocks(model, b)
    )
    couplings.patch[world, patch].run = run
    couplings.patch[world, patch].members = members
    couplings.patch[world, patch].count = count
    if run < 0:
        write_rigid_rows(settings, model, state, scratch, shapes, couplings, world, patch, a, b)
        return
    clear_run(couplings, world, patch)
    contact = Int32(0)
    while contact < count:
        write_long_contact(
            settings, model, state, scratch, shapes, couplings, couplings.terms[world, contact], world, patch,
            contact, temporary,
        )  # fmt: skip
        contact += 1


@func
def keep_patch_impulses(contacts: Contacts, couplings: Couplings, world: Int32, patch: Int32, outcome: Int32):
    """Report the impulses of the contacts of a patch, and the `outcome` of the search for them."""
    normal = couplings.patch[world, patch].normal_impulse
    lateral = couplings.patch[world, patch].friction_impulse
    friction = couplings.patch[world, patch].friction
    members = couplings.patch[world, patch].members
    if outcome == SOLVED and holds(couplings, world, patch):
        outcome = Int32(SOLVED_AND_HOLDS)
    for i in range(couplings.patch[world, patch].count):
        keep_contact_impulse(
            contacts, world, members[i], normal[i], lateral[2 * i], lateral[2 * i + 1], friction[i], outcome
        )
