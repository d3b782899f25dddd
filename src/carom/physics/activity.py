"""What it means for a tree to be asleep; `slumber` says who is."""

from carom.model.codes import ASLEEP, STIRRED
from carom.model.real import Int32, func
from carom.model.structs import Model, State


@func
def is_asleep(state: State, world: Int32, tree: Int32) -> bool:
    """Whether a tree takes no part in this substep."""
    return state.tree_activity[world, tree] == ASLEEP


@func
def has_stirred(state: State, world: Int32, tree: Int32) -> bool:
    """Whether this is the first substep of a tree that was asleep."""
    return state.tree_activity[world, tree] == STIRRED


@func
def stop(model: Model, state: State, world: Int32, tree: Int32):
    """Take the velocity of a tree."""
    first = model.tree[tree].first_dof
    for dof in range(first, first + model.tree[tree].dof_count):
        state.dof_velocity[world, dof] = 0.0
