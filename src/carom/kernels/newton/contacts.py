"""Rows of contacts for the converged solver: rigid ones, and those that yield by MuJoCo's law."""

import warp as wp

from carom.kernels.contact.ranked_friction import LEAST_FRICTION
from carom.kernels.dynamics.contact_compliance import (
    combined_restitution,
    let_contact_yield,
    yields_without_bounce,
)
from carom.kernels.newton.contact_jacobian import write_contact_jacobians
from carom.kernels.newton.members import place_of
from carom.kernels.newton.memory import begin_at_last_impulse
from carom.kernels.newton.rows import begin_contact_rows, bound_row
from carom.kernels.solver.contact_terms import (
    contact_terms,
    lateral_change,
    normal_change,
)
from carom.kernels.solver.pair_rows import has_room, tree_blocks
from carom.kernels.structs import (
    Contacts,
    ContactTerms,
    Model,
    NewtonWork,
    PairRows,
    Scratch,
    Settings,
    Shapes,
    State,
)
from carom.kernels.types import Int32, Vector3, func, real
from carom.layouts.codes import CAPSULE, PLANE
from carom.layouts.newton import (
    CONE,
    DISC,
    FOLLOWING,
    OFF,
    PAIR_BLOCK,
    PAIR_ROW,
    PYRAMID,
    REBOUNDING,
    ROWS,
    SHORT,
)
from carom.layouts.pair_rows import ROWS_PER_PAIR

# R relative to the inverse mass, of normals and of friction.
NORMAL_REGULAR = real(1e-4)
FRICTION_REGULAR = real(1e-3)
# Penetrations are corrected within so many substeps, but not faster than this [m/s].
CORRECTION_STEPS = real(5.0)
FASTEST_CORRECTION = real(1.0)
# With less inverse mass nothing can move along a row.
LEAST_INVERSE_MASS = real(2.220446049250313e-16)
_UNBOUNDED = real(1e300)
# Capsules that stand straighter on a plane have no direction on it.
LEAST_LEAN = real(1e-12)


@func
def remembered_pull(contacts: Contacts, terms: ContactTerms, world: Int32, contact: Int32) -> Vector3:
    """The last impulse of friction of a contact, turned into its present plane, within its bound.

    It is kept in world axes in place of a friction anchor, for which this law has no use. The other anchor
    gets what was remembered, before it is turned: a step is linearised with that.
    """
    normal = contacts.contact_impulse[world, contact][0]
    kept = Vector3(0.0, 0.0, 0.0)
    pull = Vector3(0.0, 0.0, 0.0)
    if normal > 0.0:
        kept = contacts.contact_anchor_a[world, contact]
        pull = kept - terms.normal * wp.dot(kept, terms.normal)
        length = wp.length(pull)
        bound = wp.max(terms.friction[0], 0.0) * normal
        if length > bound:
            kept = kept * (bound / length)
            pull = pull * (bound / length)
    contacts.contact_anchor_b[world, contact] = kept
    return pull


@func
def write_normal(
    settings: Settings,
    shapes: Shapes,
    work: NewtonWork,
    terms: ContactTerms,
    last: real,
    world: Int32,
    row: Int32,
):
    """Write the law of a contact's normal: no approach within the substep beyond its gap."""
    h = settings.time_step
    gap = terms.distance
    inverse_mass = work.newton_row[world, row].inverse_mass
    velocity = work.newton_row[world, row].speed
    regular = NORMAL_REGULAR * inverse_mass + settings.contact_softness
    wanted = -gap / h
    if gap <= 0.0:
        wanted = wp.min(-gap / (CORRECTION_STEPS * h), FASTEST_CORRECTION)
    a, b = terms.shape_a, terms.shape_b
    if shapes.shape_stiffness[world, a] >= 0.0 or shapes.shape_stiffness[world, b] >= 0.0:
        regular = wp.max(regular, terms.softness)
        if gap <= 0.0:
            wanted = -terms.erp * gap / h
    bound_row(work, world, row, regular, wanted - velocity, 0.0, _UNBOUNDED)
    if last > 0.0:
        work.newton_row[world, row].rate = -regular * last
    restitution = combined_restitution(shapes, world, a, b)
    work.newton_row[world, row].distance = gap
    work.newton_row[world, row].from_forces = terms.from_forces
    if restitution > 0.0:
        work.newton_row[world, row].restitution = restitution
        if velocity < -settings.restitution_threshold:
            work.count_newton[world, REBOUNDING] = work.count_newton[world, REBOUNDING] + 1


@func
def write_disc(
    work: NewtonWork,
    world: Int32,
    row: Int32,
    normal: Int32,
    friction: real,
    last: real,
    memory1: real,
    memory2: real,
):
    """Write the law of two rows of friction: no motion but what the change of their last impulse causes."""
    inverse_mass = 0.5 * (
        work.newton_row[world, row].inverse_mass + work.newton_row[world, row + 1].inverse_mass
    )
    if friction <= 0.0 or inverse_mass <= LEAST_INVERSE_MASS:
        return
    regular = FRICTION_REGULAR * inverse_mass
    bound = friction * last
    first, second = work.newton_row[world, row].speed, work.newton_row[world, row + 1].speed
    bound_row(work, world, row, regular, regular * memory1 - first, 0.0, bound)
    bound_row(work, world, row + 1, regular, regular * memory2 - second, 0.0, bound)
    # Where it has stuck, it is taken to stick again.
    if memory1 * memory1 + memory2 * memory2 < 0.999999 * bound * bound:
        work.newton_row[world, row].rate = -regular * memory1
        work.newton_row[world, row + 1].rate = -regular * memory2
    work.newton_row[world, row].kind = DISC
    work.newton_row[world, row + 1].kind = FOLLOWING
    work.newton_row[world, row].friction = friction
    work.newton_row[world, row].bounded_by = normal


@func
def write_spinning(work: NewtonWork, world: Int32, row: Int32, normal: Int32, friction: real, last: real):
    """Write the law of a row of spinning friction."""
    inverse_mass = work.newton_row[world, row].inverse_mass
    if inverse_mass > LEAST_INVERSE_MASS:
        regular = FRICTION_REGULAR * inverse_mass
        bound = friction * last
        bound_row(work, world, row, regular, -work.newton_row[world, row].speed, -bound, bound)
        work.newton_row[world, row].friction = friction
        work.newton_row[world, row].bounded_by = normal


@func
def pyramid_direction(normal: Vector3) -> Vector3:
    """The first direction of friction that MuJoCo's pyramids have, on which their law depends."""
    axis = Vector3(0.0, 1.0, 0.0)
    if wp.abs(normal[1]) >= 0.5:
        axis = Vector3(0.0, 0.0, 1.0)
    return wp.normalize(axis - normal * wp.dot(normal, axis))


@func
def capsule_on_plane(shapes: Shapes, a: Int32, b: Int32) -> Int32:
    """Which of two shapes is a capsule where the other one is a plane; -1 for others."""
    found = Int32(-1)
    if shapes.shape_kind[a] == PLANE and shapes.shape_kind[b] == CAPSULE:
        found = b + 0
    elif shapes.shape_kind[a] == CAPSULE and shapes.shape_kind[b] == PLANE:
        found = a + 0
    return found


@func
def axis_of_capsule(state: State, shapes: Shapes, world: Int32, capsule: Int32) -> Vector3:
    """The axis of a capsule in the axes of the world."""
    turn = wp.transform_get_rotation(shapes.shape_pose[capsule])
    turn = wp.transform_get_rotation(state.link_pose[world, shapes.shape_link[capsule]]) * turn
    return wp.quat_rotate(turn, Vector3(0.0, 0.0, 1.0))


@func
def direction_on_shapes(
    state: State, shapes: Shapes, world: Int32, a: Int32, b: Int32, normal: Vector3
) -> Vector3:
    """The first direction of friction as MuJoCo has it: capsules lie along it on planes."""
    first = pyramid_direction(normal)
    capsule = capsule_on_plane(shapes, a, b)
    if capsule >= 0:
        axis = axis_of_capsule(state, shapes, world, capsule)
        axis -= normal * wp.dot(normal, axis)
        if wp.length(axis) > LEAST_LEAN:
            first = wp.normalize(axis)
    return first


@func
def turning_change(settings: Settings, terms: ContactTerms, speed: real, from_forces: real) -> real:
    """Requested change of the angular velocity of a contact that yields about a direction."""
    before = speed - from_forces
    return before - settings.time_step * terms.erp * before - speed


@func
def write_yielding(
    settings: Settings,
    shapes: Shapes,
    work: NewtonWork,
    terms: ContactTerms,
    world: Int32,
    row: Int32,
    count: Int32,
):
    """Write MuJoCo's law of a contact that yields: a normal, with a cone or a pyramid of friction.

    Its `count` rows are the normal, two of lateral friction, two of rolling friction, and spinning friction;
    the last three as far as they are there.
    """
    h = settings.time_step
    terms.from_forces = h * work.newton_row[world, row].from_forces
    terms.lateral_from_forces[0] = h * work.newton_row[world, row + 1].from_forces
    terms.lateral_from_forces[1] = h * work.newton_row[world, row + 2].from_forces
    for i in range(count):
        speed = work.newton_row[world, row + i].speed
        target = real(0.0)
        if i == 0:
            target = normal_change(settings, shapes, terms, world, speed)
        elif i <= 2:
            # Neither has an anchor, so the direction does not count.
            target = lateral_change(settings, terms, speed, i, terms.lateral1)
        else:
            target = turning_change(settings, terms, speed, h * work.newton_row[world, row + i].from_forces)
        bound_row(work, world, row + i, terms.softness, target, 0.0, _UNBOUNDED)
        if i > 0:
            work.newton_row[world, row + i].kind = OFF
    friction = terms.friction[0]
    if friction <= 0.0:
        return
    share = wp.max(shapes.shape_mixing[world, terms.shape_a][2], shapes.shape_mixing[world, terms.shape_b][2])
    work.newton_row[world, row].kind = CONE
    if share > 0.0:
        work.newton_row[world, row].kind = PYRAMID
        # Of each of the four edges.
        work.newton_row[world, row].regular = 2.0 * friction * friction * terms.lateral_softness
    lateral = terms.lateral_softness
    if share < 0.0:
        # Cones with an `impratio`.
        lateral = -share * lateral
    work.newton_row[world, row].size = count
    work.newton_row[world, row].friction = friction
    for i in range(1, count):
        coefficient = friction + 0.0
        if i > 2:
            coefficient = terms.friction[2]
            if i < 5 and count > 4:
                coefficient = terms.friction[1]
        ratio = friction / wp.max(coefficient, LEAST_FRICTION)
        work.newton_row[world, row + i].kind = FOLLOWING
        work.newton_row[world, row + i].regular = lateral * ratio * ratio
        work.newton_row[world, row + i].friction = coefficient


@func
def add_speed(work: NewtonWork, world: Int32, row: Int32, speed: real):
    """Add to the velocity of a row."""
    work.newton_row[world, row].speed = work.newton_row[world, row].speed + speed


@func
def add_contact(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    shapes: Shapes,
    contacts: Contacts,
    pair_rows: PairRows,
    work: NewtonWork,
    world: Int32,
    contact: Int32,
    compliant: Int32,
):
    """Add the rows of a contact: its normal, a disc of friction, one of rolling friction, and spinning.

    If `compliant` is 1, those of files that state MuJoCo's law follow that.
    """
    terms = contact_terms(
        settings, model, state, scratch, shapes, contacts, world, contact,
        pair_rows.contact_solved_up_to[world, contact], 1.0,
    )  # fmt: skip
    # Both sides at one point: so friction keeps the angular momentum.
    middle = 0.5 * (terms.point_a + terms.point_b)
    terms.point_a = middle
    terms.point_b = middle
    if compliant == 1:
        if yields_without_bounce(shapes, world, terms.shape_a, terms.shape_b):
            first = direction_on_shapes(state, shapes, world, terms.shape_a, terms.shape_b, terms.normal)
            second = wp.cross(terms.normal, first)
            terms.lateral1 = first
            terms.lateral2 = second
            terms.rolling1 = first
            terms.rolling2 = second
            contacts.contact_direction1[world, contact] = first
            contacts.contact_direction2[world, contact] = second
            terms = let_contact_yield(settings, shapes, terms, world, terms.shape_a, terms.shape_b)
    normal = work.count_newton[world, ROWS] + 0
    pair_row = work.count_newton[world, PAIR_ROW] + 0
    block = work.count_newton[world, PAIR_BLOCK] + 0
    tree_a, tree_b = terms.ends[0], terms.ends[2]
    if normal + ROWS_PER_PAIR > work.newton_row.shape[1] or not has_room(
        model, pair_rows, pair_row, block, tree_a, tree_b
    ):
        work.count_newton[world, SHORT] = 1
        return
    last = contacts.contact_impulse[world, contact][0] + 0.0
    pull = remembered_pull(contacts, terms, world, contact)
    count = Int32(3)
    rolling = terms.friction[1] > 0.0
    if rolling:
        count += 2
    if terms.friction[2] > 0.0:
        count += 1
    if terms.ignored != 0:
        # Rows without a Jacobian: the contact gets its impulses, which are 0.
        begin_contact_rows(work.newton_row, world, normal, Int32(3), contact, block, 0, 0, 0, 0)
        work.count_newton[world, ROWS] = normal + 3
        return
    begin_contact_rows(
        work.newton_row, world, normal, count, contact, block, place_of(model, work, world, tree_a),
        tree_blocks(model, tree_a), place_of(model, work, world, tree_b), tree_blocks(model, tree_b),
    )  # fmt: skip
    none = Vector3(0.0, 0.0, 0.0)
    after = write_contact_jacobians(
        model, state, scratch, pair_rows, work, world, normal, Int32(3), block, block, terms.ends, middle,
        wp.matrix_from_rows(terms.normal, terms.lateral1, terms.lateral2),
        wp.matrix_from_rows(none, none, none),
    )  # fmt: skip
    add_speed(work, world, normal, wp.dot(terms.carried, terms.normal))
    add_speed(work, world, normal + 1, wp.dot(terms.carried, terms.lateral1))
    add_speed(work, world, normal + 2, wp.dot(terms.carried, terms.lateral2))
    if count > 3:
        axes = wp.matrix_from_rows(terms.normal, none, none)
        if rolling:
            axes = wp.matrix_from_rows(terms.rolling1, terms.rolling2, terms.normal)
        after = write_contact_jacobians(
            model, state, scratch, pair_rows, work, world, normal + 3, count - 3, after, block, terms.ends,
            middle, wp.matrix_from_rows(none, none, none), axes,
        )  # fmt: skip
        spin = axes * terms.carried_spin
        for i in range(count - 3):
            add_speed(work, world, normal + 3 + i, spin[i])
    is_live = work.newton_row[world, normal].inverse_mass > LEAST_INVERSE_MASS
    # These press by their depth, also where the normal moves nothing, and rub.
    if terms.yields != 0 and terms.softness > 0.0:
        write_yielding(settings, shapes, work, terms, world, normal, count)
        begin_at_last_impulse(
            work.newton_row, world, normal, last, wp.dot(pull, terms.lateral1), wp.dot(pull, terms.lateral2)
        )
    elif is_live and terms.yields == 0:
        write_normal(settings, shapes, work, terms, last, world, normal)
        write_disc(
            work, world, normal + 1, normal, terms.friction[0], last, wp.dot(pull, terms.lateral1),
            wp.dot(pull, terms.lateral2),
        )  # fmt: skip
        if rolling:
            write_disc(work, world, normal + 3, normal, terms.friction[1], last, 0.0, 0.0)
        if terms.friction[2] > 0.0:
            write_spinning(work, world, normal + count - 1, normal, terms.friction[2], last)
    work.count_newton[world, ROWS] = normal + count
    work.count_newton[world, PAIR_BLOCK] = after
