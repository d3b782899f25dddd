"""Sleeping (deactivation): islands at rest are left out of steps until a moving body comes near.

A tree that has been slower than its threshold for `SLEEP_DELAY` seconds wants to sleep. Trees that are near
each other, touch or are joined by user constraints are an island: it falls asleep when none of its trees is
active, and wakes up when one is. As in Bullet, neither forces nor motors wake a tree up.
"""

import warp as wp

from carom.kernels.contact.bounds import boxes_meet
from carom.kernels.dynamics.kinematics import forward_kinematics
from carom.kernels.maths.union_find import find_root
from carom.kernels.solver.activity import is_absent, link_moves, squared_motion
from carom.kernels.solver.islands import unite, unite_tied
from carom.kernels.structs import Contacts, Model, PairRows, Pairs, Settings, Shapes, State, UserConstraints
from carom.kernels.types import Int32, func, kernel, real
from carom.layouts.codes import ABSENT, ACTIVE, ASLEEP, WANTS_SLEEP, WOKEN
from carom.layouts.contacts import PAIRS, THERE
from carom.layouts.status import STATUS, WELL

# Time below the threshold after which a tree may fall asleep [s].
SLEEP_DELAY = real(2.0)


@func
def unite_neighbours(
    settings: Settings, model: Model, state: State, shapes: Shapes, pairs: Pairs, world: Int32
):
    """Put trees that are near each other, and may collide, into one island."""
    for i in range(pairs.count_pairs[world, PAIRS]):
        a = pairs.pair_shapes[world, i][0]
        b = pairs.pair_shapes[world, i][1]
        if link_moves(model, shapes.shape_link[a]) and link_moves(model, shapes.shape_link[b]):
            if boxes_meet(
                pairs.shape_lower[world, a],
                pairs.shape_upper[world, a],
                pairs.shape_lower[world, b],
                pairs.shape_upper[world, b],
                settings.near,
            ):
                unite(model, state, world, shapes.shape_tree[a], shapes.shape_tree[b])


@func
def has_moving_shapes(model: Model, shapes: Shapes, tree: Int32) -> bool:
    """Whether a link that dofs move has shapes; as in Bullet, a tree without such links never sleeps."""
    first = model.tree[tree].first_link
    for link in range(first, first + model.tree[tree].link_count):
        if shapes.link_shape_count[link] > 0 and link_moves(model, link):
            return True
    return False


@kernel
def settle_kernel(
    settings: Settings,
    model: Model,
    state: State,
    shapes: Shapes,
    pairs: Pairs,
    contacts: Contacts,
    users: UserConstraints,
    pair_rows: PairRows,
    touching: Int32,
    first_world: Int32,
):
    """Put islands without an active tree to sleep, and wake up the others, before a substep.

    `touching` is 0 if there is no collision detection; then trees cannot be near each other or touch.
    """
    world = first_world + wp.tid()
    if state.status_entry[world, STATUS] != WELL:
        return
    for tree in range(settings.tree_count):
        state.tree_island[world, tree] = tree
        pair_rows.tree_awake[world, tree] = 0
    if touching != 0:
        unite_neighbours(settings, model, state, shapes, pairs, world)
        for contact in range(contacts.count_contacts[world, THERE]):
            pair = contacts.contact_shapes[world, contact]
            if link_moves(model, pair[2]) and link_moves(model, pair[3]):
                unite(model, state, world, shapes.shape_tree[pair[0]], shapes.shape_tree[pair[1]])
    unite_tied(settings, model, state, users, world)
    for tree in range(settings.tree_count):
        if state.tree_activity[world, tree] == ACTIVE and has_moving_shapes(model, shapes, tree):
            pair_rows.tree_awake[world, find_root(state.tree_island, world, tree)] = 1
    for tree in range(settings.tree_count):
        activity = state.tree_activity[world, tree]
        if activity != ACTIVE and activity != ABSENT and has_moving_shapes(model, shapes, tree):
            if pair_rows.tree_awake[world, find_root(state.tree_island, world, tree)] == 0:
                if activity != ASLEEP:
                    # From now on its links are reported where they are, and no longer as a substep starts.
                    forward_kinematics(model, state, state.link_pose, world, tree)
                state.tree_activity[world, tree] = ASLEEP
            elif activity == ASLEEP:
                state.tree_activity[world, tree] = WOKEN
            else:
                state.tree_activity[world, tree] = WANTS_SLEEP


@func
def watch(model: Model, settings: Settings, state: State, world: Int32, tree: Int32):
    """Update the time for which a tree has been slow, and whether it wants to sleep."""
    if model.tree[tree].can_sleep == 0:
        state.tree_wants_sleep[world, tree] = 0
        state.tree_idle_time[world, tree] = 0.0
        return
    if squared_motion(model, state, world, tree) < model.tree[tree].sleep_threshold:
        state.tree_idle_time[world, tree] += settings.time_step
        if state.tree_idle_time[world, tree] > SLEEP_DELAY:
            state.tree_wants_sleep[world, tree] = 1
    else:
        state.tree_idle_time[world, tree] = 0.0
        if model.tree[tree].can_wake != 0:
            state.tree_wants_sleep[world, tree] = 0


@kernel
def watch_kernel(settings: Settings, model: Model, state: State, first_world: Int32):
    """Update which trees are active and which want to sleep, after a substep."""
    world = first_world + wp.tid()
    if state.status_entry[world, STATUS] != WELL:
        return
    for tree in range(settings.tree_count):
        if is_absent(state, world, tree):
            continue
        watch(model, settings, state, world, tree)
        if state.tree_wants_sleep[world, tree] == 0:
            state.tree_activity[world, tree] = ACTIVE
        elif state.tree_activity[world, tree] == ACTIVE:
            state.tree_activity[world, tree] = WANTS_SLEEP
