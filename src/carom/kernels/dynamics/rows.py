"""Constraint rows that act on one dof of one tree.

A row requests a change of the rate of its dof; the solver computes the impulse on the dof, within
bounds, that causes it. Rows of an island are contiguous, in the order in which the solver visits them.
"""

import warp as wp

from carom.kernels.maths.blocks import write_multiple
from carom.kernels.structs import Model, Scratch
from carom.kernels.types import Int32, Vector3, func, real

# Rows with less inverse mass than this are switched off (double precision epsilon).
MIN_INVERSE_MASS = real(2.220446049250313e-16)


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
    """Write a row that requests the `change` of the rate of `dof`; returns `row + 1`."""
    tree = model.constraint[constraint].tree
    i = dof - model.tree[tree].first_dof
    blocks = (model.tree[tree].dof_count + 3) // 4
    delta = model.tree[tree].first_delta
    response = model.tree[tree].first_block + i * blocks
    if effective_mass == 0.0:
        change = real(0.0)
    scratch.row[world, row].constraint = constraint
    scratch.row[world, row].entry = 4 * delta + i
    scratch.row[world, row].delta = delta
    scratch.row[world, row].response = response
    scratch.row[world, row].blocks = blocks
    scratch.row[world, row].soft = 0
    scratch.row[world, row].change = change
    scratch.row[world, row].effective_mass = effective_mass
    scratch.row[world, row].lower = lower
    scratch.row[world, row].upper = upper
    scratch.row[world, row].impulse = real(0.0)
    write_multiple(
        scratch.block_response, response, effective_mass, scratch.block_inverse_mass, response, world, blocks
    )
    return row + 1


@func
def row_dof(model: Model, scratch: Scratch, world: Int32, row: Int32) -> Int32:
    """The dof a row acts on."""
    tree = model.constraint[scratch.row[world, row].constraint].tree
    return model.tree[tree].first_dof + scratch.row[world, row].entry - 4 * scratch.row[world, row].delta


@func
def inverse_mass_entry(model: Model, scratch: Scratch, world: Int32, tree: Int32, i: Int32, j: Int32) -> real:
    """Entry (i, j) of a tree's inverse mass matrix over its active dofs."""
    blocks = (model.tree[tree].dof_count + 3) // 4
    return scratch.entry_inverse_mass[world, 4 * (model.tree[tree].first_block + i * blocks) + j]


@func
def inverse_or_off(inverse_mass: real) -> real:
    """Effective mass of a row from its inverse mass; 0 if that is too small, as nothing can move."""
    # A conditional expression makes kernels of rows on GPUs spill registers.
    if inverse_mass > MIN_INVERSE_MASS:
        return 1.0 / inverse_mass
    return 0.0


@func
def inverses_or_off(inverse_masses: Vector3) -> Vector3:
    """As `inverse_or_off`, for three rows."""
    return Vector3(
        inverse_or_off(inverse_masses[0]),
        inverse_or_off(inverse_masses[1]),
        inverse_or_off(inverse_masses[2]),
    )


@func
def inverse_moments_or_off(moments: Vector3) -> Vector3:
    """Inverses of a body's moments of inertia; 0 if one is too small, as then nothing turns it in Bullet."""
    if wp.min(wp.min(moments[0], moments[1]), moments[2]) > MIN_INVERSE_MASS:
        return Vector3(1.0 / moments[0], 1.0 / moments[1], 1.0 / moments[2])
    return Vector3(0.0, 0.0, 0.0)


@func
def dof_effective_mass(model: Model, scratch: Scratch, world: Int32, tree: Int32, dof: Int32) -> real:
    """Effective mass of a row on a single dof."""
    i = dof - model.tree[tree].first_dof
    return inverse_or_off(inverse_mass_entry(model, scratch, world, tree, i, i))


@func
def along_axes(scratch: Scratch, world: Int32, dof: Int32, first: Int32) -> Vector3:
    """Angular velocity by a unit rate of a dof, along the axes of the three dofs from `first` on."""
    angular = scratch.dof[world, dof].angular
    return Vector3(
        wp.dot(scratch.dof[world, first].angular, angular),
        wp.dot(scratch.dof[world, first + 1].angular, angular),
        wp.dot(scratch.dof[world, first + 2].angular, angular),
    )


@func
def angular_inverse_masses(
    model: Model, scratch: Scratch, world: Int32, tree: Int32, last_dof: Int32, first: Int32
) -> Vector3:
    """Angular velocity of the link of `last_dof` along each axis, by a unit angular impulse along it.

    The axes are those of the three dofs from `first` on.
    """
    total = Vector3(0.0, 0.0, 0.0)
    first_of_tree = model.tree[tree].first_dof
    i = last_dof
    while i >= 0:
        along_i = along_axes(scratch, world, i, first)
        if along_i[0] != 0.0 or along_i[1] != 0.0 or along_i[2] != 0.0:
            j = last_dof
            while j >= 0:
                share = wp.cw_mul(along_i, along_axes(scratch, world, j, first))
                total += share * inverse_mass_entry(
                    model, scratch, world, tree, i - first_of_tree, j - first_of_tree
                )
                j = model.dof[j].parent
        i = model.dof[i].parent
    return total


@func
def axis_effective_masses(model: Model, scratch: Scratch, world: Int32, tree: Int32, link: Int32) -> Vector3:
    """Effective masses of the three axes of a spherical joint.

    As in Bullet, the inverse inertias of both links are added as if the links were independent. So effective
    masses are too small, but the rows still converge, in smaller steps.
    """
    first = model.link[link].first_dof
    own = angular_inverse_masses(model, scratch, world, tree, first + 2, first)
    parents = angular_inverse_masses(model, scratch, world, tree, model.dof[first].parent, first)
    return inverses_or_off(own + parents)
