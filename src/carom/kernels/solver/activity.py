"""Which trees can move, are asleep or absent; `sleeping` has the rules for falling asleep and waking up."""

from carom.kernels.structs import Model, Shapes, State, UserConstraints
from carom.kernels.types import Index4, Int32, func, real
from carom.layouts.codes import ABSENT, ASLEEP, USER, USER_TENDON, WOKEN


@func
def can_move(model: Model, tree: Int32) -> bool:
    """Whether a tree has dofs; the world, -1, has none."""
    if tree < 0:
        return False
    return model.tree[tree].dof_count > 0


@func
def link_moves(model: Model, link: Int32) -> bool:
    """Whether some dof moves a link."""
    return model.link[link].nearest_dof >= 0


@func
def counts_as_moving(model: Model, link: Int32) -> bool:
    """Whether a link belongs to an island.

    Bullet takes some that a dof moves for still, and some that none moves for moving (`island_links`).
    """
    return model.link[link].number >= 0


@func
def pushed_tree(shapes: Shapes, model: Model, pair: Index4) -> Int32:
    """Tree of the first of two links in contact that moves and counts as moving, or else that moves.

    -1 if neither counts as moving, or neither moves. `pair` has both shapes, then both links.
    """
    moves_a = link_moves(model, pair[2])
    moves_b = link_moves(model, pair[3])
    counts_a = counts_as_moving(model, pair[2])
    counts_b = counts_as_moving(model, pair[3])
    if moves_a and (counts_a or (counts_b and not moves_b)):
        return shapes.shape_tree[pair[0]]
    return shapes.shape_tree[pair[1]] if moves_b and (counts_a or counts_b) else -1


@func
def is_asleep(state: State, world: Int32, tree: Int32) -> bool:
    """Whether a tree is asleep."""
    return state.tree_activity[world, tree] == ASLEEP


@func
def is_absent(state: State, world: Int32, tree: Int32) -> bool:
    """Whether a tree is not in this world: its state does not change, and it has no bounds."""
    return state.tree_activity[world, tree] == ABSENT


@func
def is_left_out(state: State, world: Int32, tree: Int32) -> bool:
    """Whether a tree is asleep or absent: it is left out of dynamics and solver in this substep."""
    activity = state.tree_activity[world, tree]
    return activity == ASLEEP or activity == ABSENT


@func
def is_in_force(state: State, users: UserConstraints, world: Int32, user: Int32) -> bool:
    """Whether a user constraint is switched on, and both of its bodies are present."""
    if users.user_enabled[world, user] == 0:
        return False
    a = users.user_tree_a[user]
    b = users.user_tree_b[user]
    if a >= 0 and is_absent(state, world, a):
        return False
    return b < 0 or not is_absent(state, world, b)


@func
def ties_still_links(model: Model, users: UserConstraints, constraint: Int32) -> bool:
    """Whether a constraint is a user's, and each of its ends the world or a link that counts as still.

    As in Bullet it belongs to no island then, whatever else of its bodies can move.
    """
    if model.constraint[constraint].kind != USER:
        return False
    user = model.constraint[constraint].link
    if users.user_kind[user] >= USER_TENDON:
        return False
    a = users.user_link_a[user]
    b = users.user_link_b[user]
    if a >= 0 and counts_as_moving(model, a):
        return False
    return b < 0 or not counts_as_moving(model, b)


@func
def has_woken(state: State, world: Int32, tree: Int32) -> bool:
    """Whether this is the first substep of a tree that was asleep."""
    return state.tree_activity[world, tree] == WOKEN


@func
def squared_motion(model: Model, state: State, world: Int32, tree: Int32) -> real:
    """Sum of the squared velocities of a tree, also of one that a fixed base was given."""
    motion = real(0.0)
    dof = model.tree[tree].first_velocity
    end = model.tree[tree].first_dof + model.tree[tree].dof_count
    while dof < end:
        motion += state.dof_velocity[world, dof] * state.dof_velocity[world, dof]
        dof += 1
    return motion


@func
def stop(model: Model, state: State, world: Int32, tree: Int32):
    """Set the velocities of a tree's dofs to zero."""
    first = model.tree[tree].first_dof
    for dof in range(first, first + model.tree[tree].dof_count):
        state.dof_velocity[world, dof] = 0.0


@func
def stop_with_base(model: Model, state: State, world: Int32, tree: Int32):
    """As `stop`, also the velocity that a fixed base was given."""
    first = model.tree[tree].first_velocity
    for dof in range(first, model.tree[tree].first_dof + model.tree[tree].dof_count):
        state.dof_velocity[world, dof] = 0.0
