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
    """Add the row of a revolute or prismatic joint's friction; returns the next free row.

    The greatest force is the upper bound of the constraint.
    """
    bound = model.constraint_upper[world, constraint] * settings.time_step
    if bound == 0.0:
        return row
    if model.constraint_impedance[world, constraint][1] > 0.0:
        return yielding_row(model, settings, state, scratch, world, constraint, row, real(0.0), -bound, bound)
    dof = model.link[model.constraint[constraint].link].first_dof
    effective_mass = dof_effective_mass(model, scratch, world, model.constraint[constraint].tree, dof)
    change = -state.dof_velocity[world, dof]
    return add_row(model, scratch, world, constraint, row, dof, change, effective_mass, -bound, bound)
