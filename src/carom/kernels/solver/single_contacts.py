"""Single contacts of rigid bodies: their normal row, and rows of lateral, rolling and spinning friction.

These are the same Gauss-Seidel steps as with rows over two trees (`pair_rows`), with sums in the same order.
But all bodies have six dofs, so that sizes are known to the compiler, the rows of a contact are two pieces of
memory, and two numbers are computed at a time: the parts of a normal row by both bodies, or both friction
rows. Piles of balls consist of such contacts.

A contact with rolling or spinning friction has two places, one after the other. The first has its normal and
lateral rows, like that of any single contact; the second has its spinning row in `single_normal` and both
rolling rows in `single_lateral`. These are rows of the angular velocity of a relative to b; the same
functions relax them. Both kinds of rows are always there; a coefficient of 0 turns them off.

If one of two bodies cannot move, its place among the delta velocities is that of the other. As its Jacobian
and responses are zero, that changes nothing, and takes less time than to distinguish the cases.
"""

import warp as wp

from carom.kernels.dynamics.rows import inverse_or_off
from carom.kernels.maths.equal_steps import equal_steps
from carom.kernels.maths.min_max import INDEFINITE, later_maximum, within_bounds
from carom.kernels.solver.contact_terms import (
    friction_change,
    keep_contact_impulse,
    lateral_change,
    normal_change,
    torsion_softness,
)
from carom.kernels.solver.pair_rows import tree_blocks
from carom.kernels.solver.rigid_manifold_rows import row_direction
from carom.kernels.solver.warm_starting import NOT_RESTING
from carom.kernels.structs import Contacts, ContactTerms, Model, PairRows, Scratch, Settings, Shapes, State
from carom.kernels.types import (
    Index2,
    Int32,
    Vector2,
    Vector3,
    Vector4,
    Vector4Rows,
    Vector6,
    Vector12,
    func,
    real,
)
from carom.layouts.codes import ISOTROPIC, SPINNING_ROW

# Added to the index of a single contact, this is the code of its unit; see `units`. Another bit says that it
# has rolling or spinning friction.
SINGLES = 1 << 30
TWISTING = 1 << 29
UNBOUNDED = real(1e10)


@wp.func_native("""
    const auto* x = &wp::index(delta, world, a);
    const auto* y = &wp::index(delta, world, b);
    wp::vec_t<2, double> p[6];
    for (int i = 0; i < 6; ++i) {
        p[i][0] = row[2 * i] * x[i / 4][i % 4];
        p[i][1] = row[2 * i + 1] * y[i / 4][i % 4];
    }
    const auto sum = wp::add(wp::add(wp::add(p[0], p[4]), p[2]), wp::add(wp::add(p[1], p[5]), p[3]));
    return sum[0] + sum[1];
""")
def normal_velocity(delta: Vector4Rows, world: Int32, a: Int32, b: Int32, row: Vector12) -> real:
    """Change of the velocity of a row by the delta velocities at blocks `a` and `b`.

    `row` is as `NormalRow.jacobian`.
    """
    ...


@wp.func_native("""
    const auto* x = &wp::index(delta, world, place);
    wp::vec_t<2, double> p[6];
    for (int i = 0; i < 6; ++i) {
        p[i][0] = rows[2 * i] * x[i / 4][i % 4];
        p[i][1] = rows[2 * i + 1] * x[i / 4][i % 4];
    }
    return wp::add(wp::add(wp::add(p[0], p[4]), p[2]), wp::add(wp::add(p[1], p[5]), p[3]));
""")
def lateral_velocities(delta: Vector4Rows, world: Int32, place: Int32, rows: Vector12) -> Vector2:
    """Changes of the velocities of two rows by the delta velocities of a body, at block `place`.

    `rows` are as `LateralRows.jacobian_a`.
    """
    ...


@wp.func_native("""
    auto* x = &wp::index(delta, world, place);
    for (int i = 0; i < 4; ++i)
        x[0][i] += impulse * response[i];
    for (int i = 0; i < 2; ++i)
        x[1][i] += impulse * response[i + 4];
""")
def push(delta: Vector4Rows, world: Int32, place: Int32, impulse: real, response: Vector6):
    """Add the response of a row times an impulse to the delta velocities of a body."""
    ...


@wp.func_native("""
    auto* x = &wp::index(delta, world, place);
    for (int i = 0; i < 4; ++i)
        x[0][i] = (x[0][i] + impulse[0] * first[i]) + impulse[1] * second[i];
    for (int i = 0; i < 2; ++i)
        x[1][i] = (x[1][i] + impulse[0] * first[i + 4]) + impulse[1] * second[i + 4];
""")
def push_twice(
    delta: Vector4Rows, world: Int32, place: Int32, impulse: Vector2, first: Vector6, second: Vector6
):
    """As `push`, for the responses of two rows."""
    ...


@func
def single_of(code: Int32) -> Int32:
    """Index of a single contact by the code of its unit."""
    return code & (TWISTING - 1)


@func
def relax_single_row(
    scratch: Scratch, pair_rows: PairRows, world: Int32, single: Int32, lower: real, upper: real
) -> real:
    """Relax row `single` of `PairRows.single_normal` within bounds; returns the change of its velocity."""
    place = pair_rows.single_place[world, single]
    before = pair_rows.single_impulse[world, single][0]
    velocity = normal_velocity(
        scratch.delta_velocity, world, place[0], place[1], pair_rows.single_normal[world, single].jacobian
    )
    wanted = (
        before * pair_rows.single_normal[world, single].kept
        + pair_rows.single_normal[world, single].share
        - velocity * pair_rows.single_normal[world, single].effective_mass
    )
    impulse = within_bounds(wanted, lower, upper)
    change = impulse - before
    pair_rows.single_impulse[world, single][0] = impulse
    push(scratch.delta_velocity, world, place[0], change, pair_rows.single_normal[world, single].response_a)
    push(scratch.delta_velocity, world, place[1], change, pair_rows.single_normal[world, single].response_b)
    return change * pair_rows.single_normal[world, single].inverse_mass


@func
def relax_single_normal(scratch: Scratch, pair_rows: PairRows, world: Int32, single: Int32) -> real:
    """Relax the normal row of a single contact; returns the change of its velocity."""
    return relax_single_row(scratch, pair_rows, world, single, 0.0, UNBOUNDED)


@func
def wanted_friction(
    scratch: Scratch, pair_rows: PairRows, world: Int32, single: Int32, before: Vector2
) -> Vector2:
    """Impulses with which both friction rows would reach their targets, without bounds."""
    place = pair_rows.single_place[world, single]
    velocity = lateral_velocities(
        scratch.delta_velocity, world, place[0], pair_rows.single_lateral[world, single].jacobian_a
    ) + lateral_velocities(
        scratch.delta_velocity, world, place[1], pair_rows.single_lateral[world, single].jacobian_b
    )
    softness = pair_rows.single_softness[world, single]
    kept = before
    if softness > 0.0:
        lost = softness * pair_rows.single_lateral[world, single].effective_mass
        kept = wp.cw_mul(before, Vector2(1.0, 1.0) - lost)
    return (
        kept
        + pair_rows.single_lateral[world, single].share
        - wp.cw_mul(velocity, pair_rows.single_lateral[world, single].effective_mass)
    )


@func
def push_sideways(scratch: Scratch, pair_rows: PairRows, world: Int32, single: Int32, impulse: Vector2):
    """Apply impulses along both friction rows to the delta velocities of both bodies."""
    place = pair_rows.single_place[world, single]
    push_twice(
        scratch.delta_velocity, world, place[0], impulse,
        pair_rows.single_lateral[world, single].response_a1,
        pair_rows.single_lateral[world, single].response_a2,
    )  # fmt: skip
    push_twice(
        scratch.delta_velocity, world, place[1], impulse,
        pair_rows.single_lateral[world, single].response_b1,
        pair_rows.single_lateral[world, single].response_b2,
    )  # fmt: skip


@func
def relax_in_pyramid(scratch: Scratch, pair_rows: PairRows, world: Int32, single: Int32, bound: real) -> real:
    """Relax one friction row of a contact, then the other; returns the larger change of their velocities.

    Each impulse is at most `bound`.
    """
    impulses = pair_rows.single_impulse[world, single]
    largest = real(0.0)
    if bound > 0.0:
        row = Int32(0)
        while row < 2:
            before = Vector2(impulses[1], impulses[2])
            wanted = wanted_friction(scratch, pair_rows, world, single, before)
            change = Vector2(0.0, 0.0)
            impulses[1 + row] = within_bounds(wanted[row], -bound, bound)
            change[row] = impulses[1 + row] - before[row]
            push_sideways(scratch, pair_rows, world, single, change)
            velocity = change[row] * pair_rows.single_lateral[world, single].inverse_mass[row]
            largest = later_maximum(largest, wp.abs(velocity))
            row += 1
        pair_rows.single_impulse[world, single] = impulses
    return largest


@func
def lateral_coupling(pair_rows: PairRows, world: Int32, single: Int32) -> real:
    """Change of the velocity of one friction row of a contact by a unit impulse of the other."""
    coupling = real(0.0)
    for dof in range(6):
        second = 2 * dof + 1
        coupling += (
            pair_rows.single_lateral[world, single].jacobian_a[second]
            * pair_rows.single_lateral[world, single].response_a1[dof]
        )
        coupling += (
            pair_rows.single_lateral[world, single].jacobian_b[second]
            * pair_rows.single_lateral[world, single].response_b1[dof]
        )
    return coupling


@func
def movable_inverse_mass(pair_rows: PairRows, world: Int32, single: Int32) -> Vector2:
    """Inverse masses of both friction rows of a contact; 0 where nothing can move."""
    inverse_mass = pair_rows.single_lateral[world, single].inverse_mass
    mass = pair_rows.single_lateral[world, single].effective_mass
    return Vector2(
        inverse_mass[0] if mass[0] > 0.0 else 0.0,
        inverse_mass[1] if mass[1] > 0.0 else 0.0,
    )


@func
def relax_in_cone(
    settings: Settings, scratch: Scratch, pair_rows: PairRows, world: Int32, single: Int32, bound: real
) -> real:
    """Relax both friction rows of a contact at once; returns the sum of the changes of their velocities.

    The length of both impulses is at most `bound`. If friction is isotropic, the length of both changes is
    returned instead.
    """
    impulses = pair_rows.single_impulse[world, single]
    before = Vector2(impulses[1], impulses[2])
    after = wanted_friction(scratch, pair_rows, world, single, before)
    if settings.cone_friction == ISOTROPIC:
        inverse_mass = movable_inverse_mass(pair_rows, world, single)
        steps = equal_steps(inverse_mass[0], inverse_mass[1], lateral_coupling(pair_rows, world, single))
        after = before + wp.cw_mul(after - before, steps)
    square = after[0] * after[0] + after[1] * after[1]
    if square >= bound * bound:
        scale = bound / wp.sqrt(square) if square > 0.0 else 0.0
        after = after * scale
    change = after - before
    push_sideways(scratch, pair_rows, world, single, change)
    pair_rows.single_impulse[world, single][1] = after[0]
    pair_rows.single_impulse[world, single][2] = after[1]
    if settings.cone_friction == ISOTROPIC:
        return wp.length(wp.cw_mul(change, movable_inverse_mass(pair_rows, world, single)))
    velocity = wp.cw_mul(change, pair_rows.single_lateral[world, single].inverse_mass)
    return velocity[0] + velocity[1]


@func
def relax_single_friction(
    settings: Settings, scratch: Scratch, pair_rows: PairRows, world: Int32, single: Int32
) -> real:
    """Relax the friction rows of a single contact; returns the change of their velocities."""
    impulses = pair_rows.single_impulse[world, single]
    bound = impulses[3] * impulses[0]
    if settings.cone_friction != 0:
        return relax_in_cone(settings, scratch, pair_rows, world, single, bound)
    return relax_in_pyramid(scratch, pair_rows, world, single, bound)


@func
def place_of_body(model: Model, tree: Int32, other: Int32) -> Int32:
    """First block of a tree in `delta_velocity`, or that of the other tree if this one cannot move."""
    return model.tree[tree].first_delta if tree_blocks(model, tree) > 0 else model.tree[other].first_delta


@func
def response6(scratch: Scratch, world: Int32, block: Int32, jacobian: Vector6) -> Vector6:
    """Change of the dofs' velocities by a unit impulse; the inverse mass matrix begins at a block."""
    response = Vector6(0.0)
    for i in range(6):
        dof = 5 - i
        left = scratch.block_inverse_mass[world, block + 2 * dof]
        right = scratch.block_inverse_mass[world, block + 2 * dof + 1]
        response += jacobian[dof] * Vector6(left[0], left[1], left[2], left[3], right[0], right[1])
    return response


@func
def own_product(jacobian: Vector6, response: Vector6) -> real:
    """Inverse mass of a row for a body; the order of the sum is that of `normal_velocity`."""
    product = wp.cw_mul(jacobian, response)
    return ((product[0] + product[4]) + product[2]) + ((product[1] + product[5]) + product[3])


@func
def response_of_body(
    model: Model, state: State, scratch: Scratch, world: Int32, tree: Int32, jacobian: Vector6
):
    """Response and present velocity of a row with this Jacobian for a body that can move."""
    velocity = real(0.0)
    first = model.tree[tree].first_dof
    for i in range(6):
        velocity += jacobian[5 - i] * state.dof_velocity[world, first + 5 - i]
    return response6(scratch, world, model.tree[tree].first_block, jacobian), velocity


@func
def row_of_body(
    model: Model,
    state: State,
    scratch: Scratch,
    world: Int32,
    tree: Int32,
    point: Vector3,
    direction: Vector3,
):
    """Row of the velocity of a point of a rigid body along a direction.

    Returns:
        Its Jacobian, its response and its present velocity; 0 if the body cannot move.
    """
    jacobian = Vector6(0.0)
    response = Vector6(0.0)
    velocity = real(0.0)
    if tree_blocks(model, tree) > 0:
        reference = wp.transform_get_translation(state.link_pose[world, model.tree[tree].first_link])
        moment = wp.cross(point - reference, direction)
        jacobian = Vector6(moment[0], moment[1], moment[2], direction[0], direction[1], direction[2])
        response, velocity = response_of_body(model, state, scratch, world, tree, jacobian)
    return jacobian, response, velocity


@func
def requested_change(
    settings: Settings, shapes: Shapes, terms: ContactTerms, world: Int32, row: Int32, velocity: real
) -> real:
    """Requested change of the velocity of a row of a contact; `row` as for `row_direction`."""
    direction = row_direction(terms, row)
    total = velocity + wp.dot(terms.carried, direction)
    if row == 0:
        return normal_change(settings, shapes, terms, world, total)
    return lateral_change(settings, terms, total, row, direction)


@func
def write_row_of_body(
    pair_rows: PairRows,
    world: Int32,
    single: Int32,
    row: Int32,
    body: Int32,
    jacobian: Vector6,
    response: Vector6,
):
    """Write the part of a row by one of the two bodies, 0 or 1; `row` as for `row_direction`."""
    for dof in range(6):
        if row == 0:
            pair_rows.single_normal[world, single].jacobian[2 * dof + body] = jacobian[dof]
        elif body == 0:
            pair_rows.single_lateral[world, single].jacobian_a[2 * dof + row - 1] = jacobian[dof]
        else:
            pair_rows.single_lateral[world, single].jacobian_b[2 * dof + row - 1] = jacobian[dof]
    place = 3 * body + row
    if place == 0:
        pair_rows.single_normal[world, single].response_a = response
    elif place == 1:
        pair_rows.single_lateral[world, single].response_a1 = response
    elif place == 2:
        pair_rows.single_lateral[world, single].response_a2 = response
    elif place == 3:
        pair_rows.single_normal[world, single].response_b = response
    elif place == 4:
        pair_rows.single_lateral[world, single].response_b1 = response
    else:
        pair_rows.single_lateral[world, single].response_b2 = response


@func
def write_numbers_of_single(
    pair_rows: PairRows,
    world: Int32,
    single: Int32,
    row: Int32,
    inverse_mass: real,
    softness: real,
    change: real,
    ignored: Int32,
):
    """Write what a row has besides its vectors; it requests a `change` of its velocity.

    `row` is as for `write_row_of_body`, `inverse_mass` without softness. As in Bullet, the change of a row
    along which nothing can move is 0/0, as where a body without inertia would roll; not of contacts that are
    `ignored`.
    """
    mass = inverse_or_off(inverse_mass + softness)
    share = mass * change
    diagonal = real(0.0)
    if mass > 0.0:
        diagonal = 1.0 / mass
    elif ignored == 0:
        diagonal = INDEFINITE
    if row == 0:
        pair_rows.single_normal[world, single].share = share
        pair_rows.single_normal[world, single].effective_mass = mass
        pair_rows.single_normal[world, single].inverse_mass = diagonal
        pair_rows.single_normal[world, single].kept = 1.0 - softness * mass
    else:
        pair_rows.single_lateral[world, single].share[row - 1] = share
        pair_rows.single_lateral[world, single].effective_mass[row - 1] = mass
        pair_rows.single_lateral[world, single].inverse_mass[row - 1] = diagonal


@func
def write_row_of_single(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    shapes: Shapes,
    pair_rows: PairRows,
    terms: ContactTerms,
    world: Int32,
    single: Int32,
    row: Int32,
):
    """Write a row of a single contact; `row` as for `row_direction`."""
    inverse_mass, velocity = real(0.0), real(0.0)
    tree = terms.ends[0]
    point = terms.point_a
    direction = row_direction(terms, row)
    body = Int32(0)
    while body < 2:
        jacobian, response, velocity_of_body = row_of_body(
            model, state, scratch, world, tree, point, direction
        )
        write_row_of_body(pair_rows, world, single, row, body, jacobian, response)
        inverse_mass += own_product(jacobian, response)
        velocity += velocity_of_body
        tree = terms.ends[2]
        point = terms.point_b
        direction = -direction
        body += 1
    softness = terms.softness if row == 0 else terms.lateral_softness
    if terms.ignored != 0:
        inverse_mass = real(0.0)
    change = requested_change(settings, shapes, terms, world, row, velocity)
    write_numbers_of_single(pair_rows, world, single, row, inverse_mass, softness, change, terms.ignored)


@func
def write_single_contact(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    shapes: Shapes,
    pair_rows: PairRows,
    terms: ContactTerms,
    world: Int32,
    contact: Int32,
    single: Int32,
):
    """Write the rows of a contact as single contact `single`."""
    pair_rows.single_contact[world, single] = contact
    pair_rows.single_place[world, single] = Index2(
        place_of_body(model, terms.ends[0], terms.ends[2]),
        place_of_body(model, terms.ends[2], terms.ends[0]),
    )
    pair_rows.single_impulse[world, single] = Vector4(0.0, 0.0, 0.0, terms.friction[0])
    pair_rows.single_softness[world, single] = terms.lateral_softness
    row = Int32(0)
    while row < 3:
        write_row_of_single(settings, model, state, scratch, shapes, pair_rows, terms, world, single, row)
        row += 1


@func
def keep_single_impulses(contacts: Contacts, pair_rows: PairRows, world: Int32, single: Int32):
    """Store the impulses of a single contact."""
    impulse = pair_rows.single_impulse[world, single]
    keep_contact_impulse(
        contacts, world, pair_rows.single_contact[world, single], impulse[0], impulse[1], impulse[2],
        impulse[3], Int32(NOT_RESTING),
    )  # fmt: skip


@func
def relax_single_torsion(
    settings: Settings, scratch: Scratch, pair_rows: PairRows, world: Int32, single: Int32, kind: Int32
) -> real:
    """Relax the spinning or the rolling rows of a contact, whose first place is `single`.

    Returns the change of their velocities.
    """
    normal = pair_rows.single_impulse[world, single][0]
    second = single + 1
    change = real(0.0)
    if kind == SPINNING_ROW:
        bound = pair_rows.single_normal[world, second].friction * normal
        if bound > 0.0:
            change = relax_single_row(scratch, pair_rows, world, second, -bound, bound)
    else:
        bound = pair_rows.single_impulse[world, second][3] * normal
        if bound > 0.0:
            if settings.cone_friction != 0:
                change = relax_in_cone(settings, scratch, pair_rows, world, second, bound)
            else:
                change = relax_in_pyramid(scratch, pair_rows, world, second, bound)
    return change


@func
def torsion_axis(terms: ContactTerms, row: Int32) -> Vector3:
    """Axis of a row of torsional friction: row 0 is spinning, rows 1 and 2 are rolling friction."""
    return terms.normal if row == 0 else terms.rolling1 if row == 1 else terms.rolling2


@func
def write_torsion_row(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    pair_rows: PairRows,
    terms: ContactTerms,
    world: Int32,
    second: Int32,
    row: Int32,
):
    """Write a row of torsional friction at the second place of a contact; `row` as for `torsion_axis`."""
    inverse_mass, velocity = real(0.0), real(0.0)
    tree = terms.ends[0]
    axis = torsion_axis(terms, row)
    carried = wp.dot(terms.carried_spin, axis)
    body = Int32(0)
    while body < 2:
        jacobian = Vector6(0.0)
        response = Vector6(0.0)
        velocity_of_body = real(0.0)
        if tree_blocks(model, tree) > 0:
            jacobian = Vector6(axis[0], axis[1], axis[2], 0.0, 0.0, 0.0)
            response, velocity_of_body = response_of_body(model, state, scratch, world, tree, jacobian)
        write_row_of_body(pair_rows, world, second, row, body, jacobian, response)
        inverse_mass += own_product(jacobian, response)
        velocity += velocity_of_body
        tree = terms.ends[2]
        axis = -axis
        body += 1
    softness = torsion_softness(settings)
    if terms.ignored != 0:
        inverse_mass, softness = real(0.0), real(0.0)
    # A drift is along the surface, so there is none about an axis.
    change = friction_change(settings, velocity + carried, terms.drift, Vector3(0.0, 0.0, 0.0))
    write_numbers_of_single(pair_rows, world, second, row, inverse_mass, softness, change, terms.ignored)


@func
def write_twisting_contact(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    shapes: Shapes,
    pair_rows: PairRows,
    terms: ContactTerms,
    world: Int32,
    contact: Int32,
    single: Int32,
):
    """Write the rows of a contact with rolling or spinning friction at `single` and the place after it."""
    write_single_contact(settings, model, state, scratch, shapes, pair_rows, terms, world, contact, single)
    second = single + 1
    pair_rows.single_contact[world, second] = contact
    pair_rows.single_place[world, second] = pair_rows.single_place[world, single]
    pair_rows.single_impulse[world, second] = Vector4(0.0, 0.0, 0.0, terms.friction[1])
    pair_rows.single_softness[world, second] = torsion_softness(settings)
    pair_rows.single_normal[world, second].friction = terms.friction[2]
    row = Int32(0)
    while row < 3:
        write_torsion_row(settings, model, state, scratch, pair_rows, terms, world, second, row)
        row += 1
