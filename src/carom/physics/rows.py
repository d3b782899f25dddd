"""Constraint rows that act on one dof of one tree.

A row asks for a change of velocity along its dof; the solver finds the impulse, within bounds, that
brings it about. Rows of an island are contiguous, in the order in which the solver visits them.
"""

import warp as wp

from carom.model.real import Int32, Vector3, func, real
from carom.model.structs import Model, Scratch

# Rows with less inverse mass than this are switched off (double precision epsilon).
LEAST_INVERSE_MASS = real(2.220446049250313e-16)


@func
def add_row(
    model: Model,
    scratch: Scratch,
    world: Int32,
    constraint: Int32,
    row: Int32,
    dof: Int32,
    sign: real,
    change: real,
    inverse_diagonal: real,
    lower: real,
    upper: real,
) -> Int32:
    """Write a row that wants `sign` times the rate of `dof` to change by `change`; returns `row + 1`."""
    tree = model.constraint_tree[constraint]
    scratch.row_constraint[world, row] = constraint
    scratch.row_tree[world, row] = tree
    scratch.row_dof[world, row] = dof - model.tree_first_dof[tree]
    scratch.row_sign[world, row] = sign
    scratch.row_target[world, row] = change
    scratch.row_inverse_diagonal[world, row] = inverse_diagonal
    scratch.row_lower[world, row] = lower
    scratch.row_upper[world, row] = upper
    scratch.row_impulse[world, row] = 0.0
    return row + 1


@func
def inverse_mass_entry(model: Model, scratch: Scratch, world: Int32, tree: Int32, i: Int32, j: Int32) -> real:
    """Entry (i, j) of a tree's inverse mass matrix, in its active dofs."""
    blocks = (model.tree_dof_count[tree] + 3) // 4
    block = model.tree_first_block[tree] + i * blocks + j // 4
    return scratch.block_inverse_mass[world, block][j % 4]


@func
def inverse_or_off(inverse_mass: real) -> real:
    """Effective mass of a row; 0 where nothing can move."""
    if inverse_mass > LEAST_INVERSE_MASS:
        return 1.0 / inverse_mass
    return 0.0


@func
def unit_inverse_diagonal(model: Model, scratch: Scratch, world: Int32, tree: Int32, dof: Int32) -> real:
    """Effective mass of a row on a single dof."""
    i = dof - model.tree_first_dof[tree]
    return inverse_or_off(inverse_mass_entry(model, scratch, world, tree, i, i))


@func
def angular_inverse_mass(
    model: Model, scratch: Scratch, world: Int32, tree: Int32, last_dof: Int32, direction: Vector3
) -> real:
    """Angular velocity along `direction` that a unit torque along it gives the link moved by `last_dof`."""
    total = real(0.0)
    first = model.tree_first_dof[tree]
    i = last_dof
    while i >= 0:
        along_i = wp.dot(direction, scratch.dof_angular[world, i])
        if along_i != 0.0:
            j = last_dof
            while j >= 0:
                along_j = wp.dot(direction, scratch.dof_angular[world, j])
                total += along_i * along_j * inverse_mass_entry(model, scratch, world, tree, i - first, j - first)
                j = model.dof_parent[j]
        i = model.dof_parent[i]
    return total


@func
def joint_axis_inverse_diagonal(
    model: Model, scratch: Scratch, world: Int32, tree: Int32, link: Int32
) -> Vector3:
    """Effective masses of the three axes of a spherical joint.

    The responses of both links add as if they were strangers, as Bullet has it; the rows converge
    all the same, only by smaller steps.
    """
    result = Vector3(0.0, 0.0, 0.0)
    first = model.link_first_dof[link]
    for axis in range(3):
        direction = scratch.dof_angular[world, first + axis]
        own = angular_inverse_mass(model, scratch, world, tree, first + 2, direction)
        parents = angular_inverse_mass(model, scratch, world, tree, model.dof_parent[first], direction)
        result[axis] = inverse_or_off(own + parents)
    return result
