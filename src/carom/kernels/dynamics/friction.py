"""Dry friction of joints: rows that stop a joint, with a force of at most its friction."""

from carom.kernels.dynamics.rows import add_row, dof_effective_mass
from carom.kernels.dynamics.yielding import yielding_row
from carom.kernels.structs import Model, Scratch, Settings, State
from carom.kernels.types import Int32, func, real


@func
def friction_row(
    model: Model,
    settings: Settings,
    state: State,
    scratch: Scratch,
    world: Int32,
    constraint: Int32,
    row: Int32,
) -> Int32:
    """Add the rows of a joint's friction, one for each of its dofs; returns the next free row.

    The greatest force along each is the upper bound of the constraint.
    """
    bound = model.constraint_upper[world, constraint] * settings.time_step
    if bound == 0.0:
        return row
    link = model.constraint[constraint].link
    first = model.link[link].first_dof
    for dof in range(first, first + model.link[link].dof_count):
        if model.constraint_impedance[world, constraint][1] > 0.0:
            row = yielding_row(
                model, settings, state, scratch, world, constraint, row, dof, real(0.0), -bound, bound
            )
        else:
            effective_mass = dof_effective_mass(model, scratch, world, model.constraint[constraint].tree, dof)
            change = -state.dof_velocity[world, dof]
            row = add_row(model, scratch, world, constraint, row, dof, change, effective_mass, -bound, bound)
    return row
