"""Warm starting, of islands of rigid bodies at rest: their contacts start from their last impulses.

The solver then has little left to do, and goes on until it is done: a stack at rest takes a few sweeps
instead of fifty. Bullet starts from nothing in every step, and gets nearly there. Wherever something moves,
contacts are new, soft, alone or have rolling friction, or joints are involved, contacts start from nothing,
and the motion is Bullet's.

A start from impulses that were not quite right would add errors up over the steps, and stacks would tremble.
So what could not be solved is done again as in Bullet, and the next attempt comes later. And where every
manifold block *holds* (at least three contacts that all push, two of which do not slide), the exact solution
is rest: the velocity left from the last step, if next to nothing, is the solver's error and is taken away.
"""

import warp as wp

from carom.kernels.maths.min_max import minimum
from carom.kernels.solver.activity import is_asleep, squared_motion, stop
from carom.kernels.solver.contact_order import same_shapes
from carom.kernels.structs import Contacts, Model, PairRows, Settings, Shapes, State
from carom.kernels.types import Int32, Vector3, func, real
from carom.layouts.contacts import THERE

# What `PairRows.tree_contacts` says of a tree, added up: it has contacts; some are not plain; some did not
# hold in the last step; some, its own or others of the island whose root it is, are with what cannot move.
HAS_CONTACTS, HAS_OTHER_CONTACTS, HAS_LOOSE_CONTACTS, ANCHORED = 1, 2, 4, 8
# What `PairRows.tree_rest` says of the root of an island: it moves; it is at rest; and all its blocks hold
# and all its bodies are still.
MOVING, RESTING, HELD = 0, 1, 2
# Sum of squared velocities of a body at rest, at most [m²/s², rad²/s²].
REST = real(2e-4)
# The same of one that is still.
STILL = real(1e-8)
# Bodies whose contacts are this much deeper or higher than they should be still move because of that [m].
SETTLED = real(2e-7)
# Share of `residual_threshold` that ends the sweeps of an island at rest.
RESTING_PRECISION = real(1e-4)
# How many times the usual sweeps it may take; a few are enough but for those after it has come to rest.
RESTING_SWEEPS = 4


# How the search for the impulses of a contact went: it was in no island at rest; that was solved; it was
# not; it was, and the manifold block holds.
NOT_RESTING, SOLVED, UNSOLVED, SOLVED_AND_HOLDS = 0, 1, 2, 3
# Share of the largest friction, squared, from which on a contact slides.
SLIDING = real(1.0 - 1e-9)
# What `next_warm_start` says of a contact in a manifold block that holds; others go up to 1.
HOLDS = real(2.0)
# Steps without warm starting after one that did not converge.
PAUSE = real(60.0)


@func
def next_warm_start(warm_start: real, outcome: Int32) -> real:
    """Counter of a contact: from 1 on it may be warm started; each step adds one, up to 1."""
    if outcome == UNSOLVED:
        return 1.0 - PAUSE
    if outcome == SOLVED_AND_HOLDS:
        return HOLDS
    return minimum(warm_start + 1.0, 1.0)


@func
def slides(normal: real, first: real, second: real, friction: real) -> bool:
    """Whether a contact slides: its friction impulse is on the bound of Coulomb's law."""
    bound = normal * friction
    return first * first + second * second >= bound * bound * SLIDING


@func
def is_rigid(model: Model, tree: Int32) -> bool:
    """Whether a tree, -1 for none, is a rigid body, free to move or not to be moved at all."""
    if tree < 0:
        return True
    dofs = model.tree[tree].dof_count
    return dofs == 0 or (dofs == 6 and model.tree[tree].fixed == 0)


@func
def has_plain_contacts(shapes: Shapes, world: Int32, link: Int32) -> bool:
    """Whether contacts of a link are rigid and have lateral friction only, isotropic."""
    return (
        shapes.link_stiffness[world, link] < 0.0
        and shapes.link_rolling_friction[world, link] == 0.0
        and shapes.link_spinning_friction[world, link] == 0.0
        and shapes.link_anisotropy[world, link] == Vector3(1.0, 1.0, 1.0)
    )


@func
def is_plain(shapes: Shapes, contacts: Contacts, world: Int32, contact: Int32) -> bool:
    """Whether a contact can be warm started: not new, in a block, rigid, lateral friction only."""
    if contacts.contact_warm_start[world, contact] < 1.0:
        return False
    pair = contacts.contact_shapes[world, contact]
    after = contact + 1
    if after == contacts.count_contacts[world, THERE]:
        after = Int32(-1)
    if not same_shapes(contacts, world, after, pair) and not same_shapes(contacts, world, contact - 1, pair):
        return False
    return has_plain_contacts(shapes, world, pair[2]) and has_plain_contacts(shapes, world, pair[3])


@func
def contact_traits(
    settings: Settings, shapes: Shapes, contacts: Contacts, world: Int32, contact: Int32
) -> Int32:
    """The bits that a contact adds to `PairRows.tree_contacts` of the trees it moves."""
    if not is_plain(shapes, contacts, world, contact):
        return HAS_CONTACTS | HAS_OTHER_CONTACTS
    gap = contacts.contact_distance[world, contact] + settings.contact_slop
    if contacts.contact_warm_start[world, contact] < HOLDS or wp.abs(gap) > SETTLED:
        return HAS_CONTACTS | HAS_LOOSE_CONTACTS
    return HAS_CONTACTS


@func
def rest_of(model: Model, state: State, pair_rows: PairRows, world: Int32, tree: Int32) -> Int32:
    """The highest state of rest that a tree allows its island: `MOVING`, `RESTING` or `HELD`."""
    touches = pair_rows.tree_contacts[world, tree]
    motion = squared_motion(model, state, world, tree)
    if touches & HAS_OTHER_CONTACTS != 0 or motion >= REST or not is_rigid(model, tree):
        return MOVING
    if touches & HAS_LOOSE_CONTACTS != 0 or motion >= STILL:
        return RESTING
    return HELD


@func
def find_resting_islands(settings: Settings, model: Model, state: State, pair_rows: PairRows, world: Int32):
    """Mark the roots of islands by their state of rest, and stop islands that are held."""
    for tree in range(settings.tree_count):
        pair_rows.tree_rest[world, tree] = Int32(HELD)
        if pair_rows.tree_first_constraint[world, tree] >= 0 or settings.contact_warm_starting == 0.0:
            pair_rows.tree_rest[world, tree] = Int32(MOVING)
    for tree in range(settings.tree_count):
        if is_asleep(state, world, tree):
            continue
        root = state.tree_island[world, tree]
        pair_rows.tree_rest[world, root] = wp.min(
            pair_rows.tree_rest[world, root], rest_of(model, state, pair_rows, world, tree)
        )
        anchor = pair_rows.tree_contacts[world, tree] & ANCHORED
        pair_rows.tree_contacts[world, root] = pair_rows.tree_contacts[world, root] | anchor
    for tree in range(settings.tree_count):
        root = state.tree_island[world, tree]
        if pair_rows.tree_rest[world, root] == HELD and pair_rows.tree_contacts[world, root] & ANCHORED != 0:
            stop(model, state, world, tree)


@func
def holds(pair_rows: PairRows, world: Int32, manifold_block: Int32) -> bool:
    """Whether a manifold block leaves two rigid bodies no motion against each other.

    It does if three contacts or more push, and two of them do not slide.
    """
    normal = pair_rows.manifold_block[world, manifold_block].normal_impulse
    lateral = pair_rows.manifold_block[world, manifold_block].friction_impulse
    friction = pair_rows.manifold_block[world, manifold_block].friction
    count = pair_rows.manifold_block[world, manifold_block].count
    stick = Int32(0)
    for i in range(count):
        if normal[i] <= 0.0:
            return False
        if not slides(normal[i], lateral[2 * i], lateral[2 * i + 1], friction[i]):
            stick += 1
    return count > 2 and stick > 1
