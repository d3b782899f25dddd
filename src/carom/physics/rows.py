"""Constraint rows that act on one dof of one tree.

A row asks for a change of the rate of its dof; the solver finds the impulse on the dof, within
bounds, that brings it about. Rows of an island are contiguous, in the order in which the solver visits them.
"""

import warp as wp

from carom.model.codes import PLACE_DELTA, PLACE_ENTRY
from carom.model.real import Index4, Int32, Vector3, Vector8, func, real
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
    change: real,
    effective_mass: real,
    lower: real,
    upper: real,
) -> Int32:
    """Write a row that wants the rate of `dof` to change by `change`; returns `row + 1`."""
    tree = model.constraint_tree[constraint]
    i = dof - model.tree_first_dof[tree]
    blocks = (model.tree_dof_count[tree] + 3) // 4
    inverse_mass = real(0.0)
    if effective_mass > 0.0:
        inverse_mass = 1.0 / effective_mass
    delta = model.tree_first_delta[tree]
    response = model.tree_first_block[tree] + i * blocks
    scratch.row_constraint[world, row] = constraint
    scratch.row_place[world, row] = Index4(4 * delta + i, response, delta, blocks)
    scratch.row_terms[world, row] = Vector8(
        change * effective_mass, effective_mass, inverse_mass, lower, upper, 0.0, 0.0, 0.0
    )
    return row + 1


@func
def row_dof(model: Model, scratch: Scratch, world: Int32, row: Int32) -> Int32:
    """The dof a row acts on."""
    place = scratch.row_place[world, row]
    tree = model.constraint_tree[scratch.row_constraint[world, row]]
    return model.tree_first_dof[tree] + place[PLACE_ENTRY] - 4 * place[PLACE_DELTA]


@func
def inverse_mass_entry(model: Model, scratch: Scratch, world: Int32, tree: Int32, i: Int32, j: Int32) -> real:
    """Entry (i, j) of a tree's inverse mass matrix, in its active dofs."""
    blocks = (model.tree_dof_count[tree] + 3) // 4
    return scratch.entry_inverse_mass[world, 4 * (model.tree_first_block[tree] + i * blocks) + j]


@func
def inverse_or_off(inverse_mass: real) -> real:
    """Effective mass of a row; 0 where nothing can move."""
    if inverse_mass > LEAST_INVERSE_MASS:
        return 1.0 / inverse_mass
    return 0.0


@func
def dof_effective_mass(model: Model, scratch: Scratch, world: Int32, tree: Int32, dof: Int32) -> real:
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
                total += (
                    along_i * along_j * inverse_mass_entry(model, scratch, world, tree, i - first, j - first)
                )
                j = model.dof_parent[j]
        i = model.dof_parent[i]
    return total


@func
def axis_effective_masses(model: Model, scratch: Scratch, world: Int32, tree: Int32, link: Int32) -> Vector3:
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
