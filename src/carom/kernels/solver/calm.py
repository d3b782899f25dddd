"""Islands of rigid bodies at rest, whose contacts start from their last impulses.

The solver then has little left to do, and goes on until it is done: a stack at rest takes a few sweeps
instead of fifty. Bullet starts from nothing in every step, and gets nearly there. Wherever something moves,
contacts are new, soft, alone or have rolling friction, or joints are involved, contacts start from nothing,
and the motion is Bullet's.

A start from impulses that were not quite right would add errors up over the steps, and stacks would tremble.
So what could not be solved is done again as in Bullet, and the next attempt comes later. And where every
patch *holds* (at least three contacts that all push, two of which do not slide), the exact solution is rest:
the velocity left from the last step, if it is next to nothing, is the solver's error and is taken away.
"""

import warp as wp

from carom.kernels.maths.extremes import lesser
from carom.kernels.solver.activity import is_asleep, squared_motion, stop
from carom.kernels.solver.contact_order import same_shapes
from carom.kernels.structs import Contacts, Couplings, Model, Settings, Shapes, State
from carom.kernels.types import Int32, Vector3, func, real
from carom.layouts.contacts import THERE

# What `Couplings.tree_touches` says of a tree, added up: it has contacts; some are not plain; some did not
# hold in the last step; some, its own or others of the island whose root it is, are with what cannot move.
TOUCHES, TOUCHES_BADLY, TOUCHES_LOOSELY, ANCHORED = 1, 2, 4, 8
# What `Couplings.tree_calm` says of the root of an island: it is not calm; it is; and all its patches hold
# and all its bodies are still.
RESTLESS, CALM, HELD = 0, 1, 2
# Sum of squared velocities of a body at rest, at most [m²/s², rad²/s²].
REST = real(2e-4)
# The same of one that is still.
STILL = real(1e-8)
# Bodies whose contacts are this much deeper or higher than they should be still move because of that [m].
SETTLED = real(2e-7)
# Share of `residual_threshold` that ends the sweeps of a calm island.
CALM_PRECISION = real(1e-4)
# How many times the usual sweeps it may take; a few are enough but for those after it has come to rest.
CALM_SWEEPS = 4


# How the search for the impulses of a contact went: it was not in a calm island; that was solved; it was not;
# it was, and the patch holds.
NOT_CALM, SOLVED, UNSOLVED, SOLVED_AND_HOLDS = 0, 1, 2, 3
# Share of the greatest friction, squared, from which on a contact slides.
SLIDING = real(1.0 - 1e-9)
# What makes trust of a contact in a patch that holds.
HOLDS = real(2.0)
# Steps without an attempt after one that failed.
PAUSE = real(60.0)


@func
def next_trust(trust: real, outcome: Int32) -> real:
    """Whether a step may start from the last impulses of a contact: if at least 1; each step adds one."""
    if outcome == UNSOLVED:
        return 1.0 - PAUSE
    if outcome == SOLVED_AND_HOLDS:
        return HOLDS
    return lesser(trust + 1.0, 1.0)


@func
def slides(normal: real, first: real, second: real, friction: real) -> bool:
    """Whether the friction of a contact, given its impulses, is as great as it can be."""
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
    """Whether a link is rigid in contact and knows but lateral friction, alike in all directions."""
    return (
        shapes.link_stiffness[world, link] < 0.0
        and shapes.link_rolling_friction[world, link] == 0.0
        and shapes.link_spinning_friction[world, link] == 0.0
        and shapes.link_anisotropy[world, link] == Vector3(1.0, 1.0, 1.0)
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
    return has_plain_contacts(shapes, world, pair[2]) and has_plain_contacts(shapes, world, pair[3])


@func
def touches_how(
    settings: Settings, shapes: Shapes, contacts: Contacts, world: Int32, contact: Int32
) -> Int32:
    """What a contact adds to `Couplings.tree_touches` of the trees it moves."""
    if not is_plain(shapes, contacts, world, contact):
        return TOUCHES | TOUCHES_BADLY
    gap = contacts.contact_distance[world, contact] + settings.contact_slop
    if contacts.contact_impulse[world, contact][3] < HOLDS or wp.abs(gap) > SETTLED:
        return TOUCHES | TOUCHES_LOOSELY
    return TOUCHES


@func
def calmness(model: Model, state: State, couplings: Couplings, world: Int32, tree: Int32) -> Int32:
    """What a tree lets its island be."""
    touches = couplings.tree_touches[world, tree]
    motion = squared_motion(model, state, world, tree)
    if touches & TOUCHES_BADLY != 0 or motion >= REST or not is_rigid(model, tree):
        return RESTLESS
    if touches & TOUCHES_LOOSELY != 0 or motion >= STILL:
        return CALM
    return HELD


@func
def find_calm(settings: Settings, model: Model, state: State, couplings: Couplings, world: Int32):
    """Mark the roots of islands by how calm these are, and stop what is held."""
    for tree in range(settings.tree_count):
        couplings.tree_calm[world, tree] = Int32(HELD)
        if couplings.tree_first_constraint[world, tree] >= 0 or settings.contact_warm_starting == 0.0:
            couplings.tree_calm[world, tree] = Int32(RESTLESS)
    for tree in range(settings.tree_count):
        if is_asleep(state, world, tree):
            continue
        root = state.tree_island[world, tree]
        couplings.tree_calm[world, root] = wp.min(
            couplings.tree_calm[world, root], calmness(model, state, couplings, world, tree)
        )
        anchor = couplings.tree_touches[world, tree] & ANCHORED
        couplings.tree_touches[world, root] = couplings.tree_touches[world, root] | anchor
    for tree in range(settings.tree_count):
        root = state.tree_island[world, tree]
        if couplings.tree_calm[world, root] == HELD and couplings.tree_touches[world, root] & ANCHORED != 0:
            stop(model, state, world, tree)


@func
def holds(couplings: Couplings, world: Int32, patch: Int32) -> bool:
    """Whether a patch leaves two rigid bodies no motion against each other.

    It does if three contacts or more push, and two of them do not slide.
    """
    normal = couplings.patch[world, patch].normal_impulse
    lateral = couplings.patch[world, patch].friction_impulse
    friction = couplings.patch[world, patch].friction
    count = couplings.patch[world, patch].count
    stick = Int32(0)
    for i in range(count):
        if normal[i] <= 0.0:
            return False
        if not slides(normal[i], lateral[2 * i], lateral[2 * i + 1], friction[i]):
            stick += 1
    return count > 2 and stick > 1
