"""Warm starting of islands of rigid bodies at rest: contacts start from the impulses of the last step.

Sweeps then converge: a stack at rest takes a few of them instead of fifty. Bullet starts multibody contacts
from zero impulses in every step, and does not quite converge. Contacts of an island start from zero here,
too, if something in it moves, if a contact is new, soft, single or has rolling or spinning friction, or if
there are constraints; then the motion is Bullet's.

Starting from inaccurate impulses would accumulate errors over the steps, and stacks would tremble. So an
island that does not converge is solved again as in Bullet, and not warm started for some steps. If every
manifold block *holds* (it has at least three contacts, all with a normal impulse, two of which do not slide),
the exact solution is rest: small velocities left from the last step are errors of the solver and are set to
zero.
"""

import warp as wp

from carom.kernels.maths.min_max import minimum
from carom.kernels.solver.activity import is_left_out, squared_motion, stop
from carom.kernels.solver.contact_order import same_shapes
from carom.kernels.structs import Contacts, Model, PairRows, Settings, Shapes, State
from carom.kernels.types import Int32, Vector3, func, real
from carom.layouts.contacts import HOLDING, THERE

# Bits of `PairRows.tree_contacts`: the tree has contacts; some are not plain (see `is_plain`); some did not
# hold in the last step; some are with links that cannot move (at the root: some of the whole island are).
HAS_CONTACTS, HAS_OTHER_CONTACTS, HAS_LOOSE_CONTACTS, ANCHORED = 1, 2, 4, 8
# Values of `PairRows.tree_rest` at the root of an island: the island moves; it is at rest; it is at rest, all
# its blocks hold, and all its bodies are still.
MOVING, RESTING, HELD = 0, 1, 2
# Maximum sum of squared velocities of a body at rest [m²/s², rad²/s²].
REST = real(2e-4)
# The same for a body that is still.
STILL = real(1e-8)
# Maximum error of the distance of contacts that hold; correcting a larger one moves the bodies [m].
SETTLED = real(2e-7)
# Factor on `residual_threshold` for islands at rest.
RESTING_PRECISION = real(1e-4)
# Factor on their maximum number of sweeps; many are needed only in the first steps at rest.
RESTING_SWEEPS = 4


# Outcomes of solving a contact: its island was not warm started; the island converged; it did not converge;
# it converged, and the contact's manifold block holds.
NOT_RESTING, SOLVED, UNSOLVED, SOLVED_AND_HOLDS = 0, 1, 2, 3
# Minimum squared ratio of friction to its bound for a contact that slides.
SLIDING = real(1.0 - 1e-9)
# Counter of a contact in a manifold block that holds.
HOLDS = real(HOLDING)
# Number of steps without warm starting after one that did not converge.
PAUSE = real(60.0)


@func
def next_warm_start(warm_start: real, outcome: Int32) -> real:
    """Update the counter of a contact: it may be warm started from 1 on; each step adds 1, up to 1."""
    if outcome == UNSOLVED:
        return 1.0 - PAUSE
    return HOLDS if outcome == SOLVED_AND_HOLDS else minimum(warm_start + 1.0, 1.0)


@func
def slides(normal: real, first: real, second: real, friction: real) -> bool:
    """Whether a contact slides: its friction impulse is on the bound of Coulomb's law."""
    bound = normal * friction
    return first * first + second * second >= bound * bound * SLIDING


@func
def is_rigid(model: Model, tree: Int32) -> bool:
    """Whether a tree, -1 for the world, is a free rigid body or has no dofs."""
    if tree < 0:
        return True
    dofs = model.tree[tree].dof_count
    return dofs == 0 or (dofs == 6 and model.tree[tree].fixed == 0)


@func
def has_plain_contacts(shapes: Shapes, world: Int32, shape: Int32) -> bool:
    """Whether contacts of a shape are rigid, with isotropic lateral friction only."""
    return (
        shapes.shape_stiffness[world, shape] < 0.0
        and (
            (
                shapes.shape_rolling_friction[world, shape] == 0.0
                and shapes.shape_spinning_friction[world, shape] == 0.0
            )
            or (
                shapes.shape_friction_dimensions[world, shape] > 0
                and shapes.shape_friction_dimensions[world, shape] < 4
            )
        )
        and shapes.shape_anisotropy[world, shape] == Vector3(1.0, 1.0, 1.0)
    )


@func
def is_plain(model: Model, shapes: Shapes, contacts: Contacts, world: Int32, contact: Int32) -> bool:
    """Whether a contact can be warm started: not new, not single, and plain by its shapes' surfaces.

    It also has to be in a manifold block of rigid bodies: not so contacts with the fixed base of a robot.
    """
    if contacts.contact_warm_start[world, contact] < 1.0:
        return False
    pair = contacts.contact_shapes[world, contact]
    if not is_rigid(model, shapes.shape_tree[pair[0]]) or not is_rigid(model, shapes.shape_tree[pair[1]]):
        return False
    after = contact + 1
    if after == contacts.count_contacts[world, THERE]:
        after = Int32(-1)
    if not same_shapes(contacts, world, after, pair) and not same_shapes(contacts, world, contact - 1, pair):
        return False
    return has_plain_contacts(shapes, world, pair[0]) and has_plain_contacts(shapes, world, pair[1])


@func
def contact_traits(
    settings: Settings, model: Model, shapes: Shapes, contacts: Contacts, world: Int32, contact: Int32
) -> Int32:
    """Bits that a contact adds to `PairRows.tree_contacts` of the trees it acts on."""
    if not is_plain(model, shapes, contacts, world, contact):
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
    return RESTING if touches & HAS_LOOSE_CONTACTS != 0 or motion >= STILL else HELD


@func
def find_resting_islands(settings: Settings, model: Model, state: State, pair_rows: PairRows, world: Int32):
    """Compute the state of rest of each island, and stop anchored islands in which all blocks hold."""
    for tree in range(settings.tree_count):
        pair_rows.tree_rest[world, tree] = Int32(HELD)
        if settings.contact_warm_starting == 0.0:
            pair_rows.tree_rest[world, tree] = Int32(MOVING)
    for constraint in range(settings.constraint_count):
        tree = model.constraint[constraint].tree
        if not is_left_out(state, world, tree):
            pair_rows.tree_rest[world, state.tree_island[world, tree]] = Int32(MOVING)
    for tree in range(settings.tree_count):
        if is_left_out(state, world, tree):
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
    """Whether a manifold block prevents all relative motion of two rigid bodies.

    It does if it has three contacts or more, all with a normal impulse, and two of them do not slide.
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
