"""Islands of rigid bodies at rest, whose contacts start from their last impulses.

The solver then has little left to do, and goes on until it is done: a stack at rest takes a few sweeps
instead of fifty. Bullet starts from nothing in every step, and gets nearly there. Wherever something moves,
contacts are new, soft, alone or have rolling friction, or joints are involved, contacts start from nothing,
and the motion is Bullet's.

A start from impulses that were not quite right would add errors up over the steps, and stacks would tremble.
So what could not be solved is done again as in Bullet, and the next attempt comes later.
"""

import warp as wp

from carom.collision.manifold import THERE
from carom.model.contact_structs import Contacts, Couplings, Shapes
from carom.model.real import Int32, Vector3, func, real
from carom.model.structs import Model, Settings, State
from carom.physics.activity import is_asleep, squared_motion
from carom.physics.contact_order import same_shapes

# What `Couplings.tree_touches` says of a tree: it has contacts, and some of them are not plain.
TOUCHES, TOUCHES_BADLY = 1, 2
# Sum of squared velocities of a body at rest, at most [m²/s², rad²/s²].
REST = real(2e-4)
# Share of `residual_threshold` that ends the sweeps of a calm island.
CALM_PRECISION = real(1e-4)
# How many times the usual sweeps it may take; a few are enough but for those after it has come to rest.
CALM_SWEEPS = 4


# How the search for the impulses of a contact went: it was not in a calm island, or that was solved or not.
NOT_CALM, SOLVED, UNSOLVED = 0, 1, 2
# Steps without an attempt after one that failed.
PAUSE = real(60.0)


@func
def next_trust(trust: real, outcome: Int32) -> real:
    """Whether a step may start from the last impulses of a contact: if 1, to which each step adds one."""
    if outcome == UNSOLVED:
        return 1.0 - PAUSE
    return wp.min(trust + 1.0, 1.0)


@func
def is_rigid(model: Model, tree: Int32) -> bool:
    """Whether a tree, -1 for none, is a rigid body, free to move or not to be moved at all."""
    if tree < 0:
        return True
    dofs = model.tree[tree].dof_count
    return dofs == 0 or (dofs == 6 and model.tree[tree].fixed == 0)


@func
def has_plain_contacts(shapes: Shapes, link: Int32) -> bool:
    """Whether a link is rigid in contact and knows but lateral friction, alike in all directions."""
    return (
        shapes.link_stiffness[link] < 0.0
        and shapes.link_rolling_friction[link] == 0.0
        and shapes.link_spinning_friction[link] == 0.0
        and shapes.link_anisotropy[link] == Vector3(1.0, 1.0, 1.0)
    )


@func
def is_plain(shapes: Shapes, contacts: Contacts, world: Int32, contact: Int32) -> bool:
    """Whether a contact was there before, in a patch that can be solved, and neither rolls nor gives."""
    if contacts.contact_impulse[world, contact][3] < 1.0:
        return False
    pair = contacts.contact_shapes[world, contact]
    after = contact + 1
    if after == contacts.count_contacts[world, THERE]:
        after = Int32(-1)
    if not same_shapes(contacts, world, after, pair) and not same_shapes(contacts, world, contact - 1, pair):
        return False
    return has_plain_contacts(shapes, pair[2]) and has_plain_contacts(shapes, pair[3])


@func
def rests(model: Model, state: State, world: Int32, tree: Int32) -> bool:
    """Whether a tree is a rigid body at rest."""
    return is_rigid(model, tree) and squared_motion(model, state, world, tree) < REST


@func
def find_calm(settings: Settings, model: Model, state: State, couplings: Couplings, world: Int32):
    """Mark the roots of islands that are not calm."""
    for tree in range(settings.tree_count):
        couplings.tree_restless[world, tree] = Int32(0)
        if couplings.tree_first_constraint[world, tree] >= 0 or settings.contact_warm_starting == 0.0:
            couplings.tree_restless[world, tree] = Int32(1)
    for tree in range(settings.tree_count):
        if is_asleep(state, world, tree):
            continue
        if couplings.tree_touches[world, tree] == TOUCHES_BADLY or not rests(model, state, world, tree):
            couplings.tree_restless[world, state.tree_island[world, tree]] = 1
