"""Constraint rows over up to two trees: Jacobians and relaxation."""

import warp as wp

from carom.kernels.dynamics.rows import inverse_or_off
from carom.kernels.maths.blocks import add_multiple, dot_product, fill_zero
from carom.kernels.maths.equal_steps import equal_steps
from carom.kernels.maths.min_max import INDEFINITE, within_bounds
from carom.kernels.structs import Model, PairRows, RowTerms, Scratch, Settings, State
from carom.kernels.types import Index4, Int32, Vector2, Vector3, func, real
from carom.layouts.codes import ISOTROPIC
from carom.layouts.pair_rows import ROWS_PER_PAIR


@func
def tree_blocks(model: Model, tree: Int32) -> Int32:
    """Number of blocks of four in a vector over a tree's active dofs; 0 for the world, -1."""
    return Int32(0) if tree < 0 else (model.tree[tree].dof_count + 3) // 4


@func
def has_room(
    model: Model, pair_rows: PairRows, row: Int32, block: Int32, tree_a: Int32, tree_b: Int32
) -> bool:
    """Whether the maximum number of rows between two trees fits, from the next free row and block on."""
    blocks = tree_blocks(model, tree_a) + tree_blocks(model, tree_b)
    if row + ROWS_PER_PAIR > pair_rows.row_start.shape[1]:
        return False
    return block + ROWS_PER_PAIR * blocks <= pair_rows.jacobian_row.shape[1]


@func
def write_jacobian(
    model: Model,
    state: State,
    scratch: Scratch,
    pair_rows: PairRows,
    world: Int32,
    tree: Int32,
    link: Int32,
    point: Vector3,
    linear: Vector3,
    angular: Vector3,
    start: Int32,
):
    """Write the Jacobian row of a point of a link along `linear` and about `angular`, and its response.

    The point is in world axes. Both are stored from block `start` on, in arrays of their own.

    Returns:
        Inverse mass of the row for this tree, and its present velocity.
    """
    inverse_mass, velocity = real(0.0), real(0.0)
    blocks = tree_blocks(model, tree)
    if blocks > 0:
        fill_zero(pair_rows.jacobian_row, start, world, blocks)
        fill_zero(pair_rows.jacobian_response, start, world, blocks)
        reference = wp.transform_get_translation(state.link_pose[world, model.tree[tree].first_link])
        moment = wp.cross(point - reference, linear) + angular
        first = model.tree[tree].first_dof
        matrix = model.tree[tree].first_block
        dof = model.link[link].nearest_dof
        while dof >= 0:
            share = wp.dot(scratch.dof[world, dof].linear, linear) + wp.dot(
                scratch.dof[world, dof].angular, moment
            )
            velocity += share * state.dof_velocity[world, dof]
            pair_rows.entry_row[world, 4 * start + dof - first] = share
            add_multiple(
                pair_rows.jacobian_response, start, share, scratch.block_inverse_mass,
                matrix + (dof - first) * blocks, world, blocks,
            )  # fmt: skip
            dof = model.dof[dof].parent
        inverse_mass = dot_product(
            pair_rows.jacobian_row, start, pair_rows.jacobian_response, start, world, blocks
        )
    return inverse_mass, velocity


@func
def place_row(
    model: Model, pair_rows: PairRows, world: Int32, row: Int32, tree_a: Int32, tree_b: Int32, start: Int32
) -> Int32:
    """Store the trees of a row and the first block of its Jacobian; returns the next free block."""
    blocks_a, blocks_b = tree_blocks(model, tree_a), tree_blocks(model, tree_b)
    delta_a = model.tree[tree_a].first_delta if tree_a >= 0 else Int32(0)
    delta_b = model.tree[tree_b].first_delta if tree_b >= 0 else Int32(0)
    pair_rows.row_place[world, row] = Index4(delta_a, blocks_a, delta_b, blocks_b)
    pair_rows.row_start[world, row] = start
    pair_rows.row_bound[world, row] = Int32(-1)
    return start + blocks_a + blocks_b


@func
def write_row(
    pair_rows: PairRows,
    world: Int32,
    row: Int32,
    inverse_mass: real,
    change: real,
    softness: real,
    lower: real,
    upper: real,
    friction: real,
):
    """Write the data of a row that requests the `change` of its velocity.

    `softness` (constraint force mixing) is the velocity by which the row yields per unit of impulse.
    """
    effective_mass = inverse_or_off(inverse_mass + softness)
    diagonal = 1.0 / effective_mass if effective_mass > 0.0 else INDEFINITE
    terms = RowTerms()
    terms.share = change * effective_mass
    terms.effective_mass = effective_mass
    terms.inverse_mass = diagonal
    terms.lower = lower
    terms.upper = upper
    terms.impulse = 0.0
    terms.softness = softness * effective_mass
    terms.friction = friction
    pair_rows.row_terms[world, row] = terms


@func
def row_velocity_change(
    scratch: Scratch, pair_rows: PairRows, world: Int32, place: Index4, start: Int32
) -> real:
    """Change of a row's velocity by the delta velocities so far."""
    total = real(0.0)
    if place[1] > 0:
        total = dot_product(pair_rows.jacobian_row, start, scratch.delta_velocity, place[0], world, place[1])
    if place[3] > 0:
        total += dot_product(
            pair_rows.jacobian_row, start + place[1], scratch.delta_velocity, place[2], world, place[3]
        )
    return total


@func
def push_row(scratch: Scratch, pair_rows: PairRows, world: Int32, place: Index4, start: Int32, impulse: real):
    """Apply an impulse along a row to the delta velocities of its trees."""
    if place[1] > 0:
        add_multiple(
            scratch.delta_velocity, place[0], impulse, pair_rows.jacobian_response, start, world, place[1]
        )
    if place[3] > 0:
        add_multiple(
            scratch.delta_velocity, place[2], impulse, pair_rows.jacobian_response, start + place[1], world,
            place[3],
        )  # fmt: skip


@func
def wanted_impulse(
    scratch: Scratch, pair_rows: PairRows, world: Int32, place: Index4, start: Int32, terms: RowTerms
) -> real:
    """Impulse with which a row would reach its target, without bounds."""
    return (
        terms.impulse * (1.0 - terms.softness)
        + terms.share
        - row_velocity_change(scratch, pair_rows, world, place, start) * terms.effective_mass
    )


@func
def relax_within(
    scratch: Scratch, pair_rows: PairRows, world: Int32, row: Int32, lower: real, upper: real
) -> real:
    """Relax one row within given bounds; returns the change of its velocity."""
    terms = pair_rows.row_terms[world, row]
    place = pair_rows.row_place[world, row]
    start = pair_rows.row_start[world, row]
    wanted = wanted_impulse(scratch, pair_rows, world, place, start, terms)
    impulse = within_bounds(wanted, lower, upper)
    change = impulse - terms.impulse
    pair_rows.row_terms[world, row].impulse = impulse
    push_row(scratch, pair_rows, world, place, start, change)
    return change * terms.inverse_mass


@func
def relax_pair_row(scratch: Scratch, pair_rows: PairRows, world: Int32, row: Int32) -> real:
    """As `relax_within`, with the row's own bounds."""
    terms = pair_rows.row_terms[world, row]
    return relax_within(scratch, pair_rows, world, row, terms.lower, terms.upper)


@func
def relax_in_circle(
    settings: Settings, scratch: Scratch, pair_rows: PairRows, world: Int32, row: Int32, bound: real
) -> real:
    """Relax two perpendicular rows, this and the next, with the length of both impulses at most `bound`.

    Returns the sum of the changes of their velocities; if friction is isotropic, their length.
    """
    place = pair_rows.row_place[world, row]
    start1 = pair_rows.row_start[world, row]
    start2 = start1 + place[1] + place[3]
    terms1 = pair_rows.row_terms[world, row]
    terms2 = pair_rows.row_terms[world, row + 1]
    first = wanted_impulse(scratch, pair_rows, world, place, start1, terms1)
    second = wanted_impulse(scratch, pair_rows, world, place, start2, terms2)
    inverse1 = terms1.inverse_mass if terms1.effective_mass > 0.0 else 0.0
    inverse2 = terms2.inverse_mass if terms2.effective_mass > 0.0 else 0.0
    if settings.cone_friction == ISOTROPIC:
        coupling = dot_product(
            pair_rows.jacobian_response, start1, pair_rows.jacobian_row, start2, world, place[1] + place[3]
        )
        steps = equal_steps(inverse1, inverse2, coupling)
        first = terms1.impulse + (first - terms1.impulse) * steps[0]
        second = terms2.impulse + (second - terms2.impulse) * steps[1]
    square = first * first + second * second
    if square >= bound * bound:
        scale = bound / wp.sqrt(square) if square > 0.0 else 0.0
        first, second = first * scale, second * scale
    change1, change2 = first - terms1.impulse, second - terms2.impulse
    pair_rows.row_terms[world, row].impulse = first
    pair_rows.row_terms[world, row + 1].impulse = second
    push_row(scratch, pair_rows, world, place, start1, change1)
    push_row(scratch, pair_rows, world, place, start2, change2)
    if settings.cone_friction == ISOTROPIC:
        return wp.length(Vector2(change1 * inverse1, change2 * inverse2))
    return change1 * terms1.inverse_mass + change2 * terms2.inverse_mass


@func
def write_jacobians(
    model: Model,
    state: State,
    scratch: Scratch,
    pair_rows: PairRows,
    world: Int32,
    ends: Index4,
    point_a: Vector3,
    point_b: Vector3,
    linear: Vector3,
    angular: Vector3,
    start: Int32,
):
    """Write the Jacobian row of the motion of a point of a relative to one of b, along or about an axis.

    `ends` are tree and link of a, then of b; tree -1 is the world. The row is stored from block `start` on.

    Returns:
        Inverse mass and relative velocity.
    """
    inverse_mass, velocity = real(0.0), real(0.0)
    side = Int32(0)
    while side < 2:
        point = point_a
        sign = real(1.0)
        if side == 1:
            point = point_b
            sign = real(-1.0)
            start += tree_blocks(model, ends[0])
        inverse_mass_of_side, velocity_of_side = write_jacobian(
            model, state, scratch, pair_rows, world, ends[2 * side], ends[2 * side + 1], point,
            sign * linear, sign * angular, start,
        )  # fmt: skip
        inverse_mass += inverse_mass_of_side
        velocity += velocity_of_side
        side += 1
    return inverse_mass, velocity


@func
def write_pair_jacobian(
    model: Model,
    state: State,
    scratch: Scratch,
    pair_rows: PairRows,
    world: Int32,
    row: Int32,
    block: Int32,
    ends: Index4,
    point_a: Vector3,
    point_b: Vector3,
    linear: Vector3,
    angular: Vector3,
):
    """As `write_jacobians`, from the first free `block` on, with `place_row`.

    Returns:
        Inverse mass, relative velocity, and the next free block.
    """
    after = place_row(model, pair_rows, world, row, ends[0], ends[2], block)
    inverse_mass, velocity = write_jacobians(
        model, state, scratch, pair_rows, world, ends, point_a, point_b, linear, angular, block
    )
    return inverse_mass, velocity, after
