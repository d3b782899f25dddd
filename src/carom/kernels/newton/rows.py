"""Rows of an island for the converged solver: those of joints, user constraints and contacts."""

import warp as wp

from carom.kernels.newton.members import place_of
from carom.kernels.solver.activity import is_in_force
from carom.kernels.solver.contact_terms import (
    combined_restitution,
    contact_terms,
    lateral_change,
    may_yield,
    normal_change,
    yielding_terms,
)
from carom.kernels.solver.joint_solver import joint_constraint_rows
from carom.kernels.solver.pair_rows import has_room, write_pair_jacobian
from carom.kernels.solver.user_constraints import add_user_rows
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
    UserConstraints,
)
from carom.kernels.types import Int32, Vector3, func, real
from carom.layouts.codes import USER
from carom.layouts.contacts import ROWS_PER_PAIR
from carom.layouts.newton import (
    BOUNDED,
    CONE,
    DISC,
    FOLLOWING,
    OF_FRICTION,
    OF_JOINT,
    OF_NORMAL,
    OF_USER,
    OFF,
    PAIR_BLOCK,
    PAIR_ROW,
    PYRAMID,
    REBOUNDING,
    ROWS,
    SHORT,
)

# R relative to the inverse mass: of joints and user constraints, of normals, of friction.
_JOINT_REGULAR = real(1e-5)
_NORMAL_REGULAR = real(1e-4)
_FRICTION_REGULAR = real(1e-3)
# Penetrations are corrected within so many substeps, but not faster than this [m/s].
_CORRECTION_STEPS = real(5.0)
_FASTEST_CORRECTION = real(1.0)
# With less inverse mass nothing can move along a row.
_LEAST_INVERSE_MASS = real(2.220446049250313e-16)
_UNBOUNDED = real(1e300)


@func
def clear_row(work: NewtonWork, world: Int32, row: Int32, origin: Int32, source: Int32):
    """Begin a row that is off."""
    work.newton_row[world, row].kind = OFF
    work.newton_row[world, row].origin = origin
    work.newton_row[world, row].source = source
    work.newton_row[world, row].bounded_by = -1
    work.newton_row[world, row].start = -1
    work.newton_row[world, row].place_a = 0
    work.newton_row[world, row].blocks_a = 0
    work.newton_row[world, row].place_b = 0
    work.newton_row[world, row].blocks_b = 0
    work.newton_row[world, row].state = 0
    work.newton_row[world, row].friction = real(0.0)
    work.newton_row[world, row].regular = real(1.0)
    work.newton_row[world, row].target = real(0.0)
    work.newton_row[world, row].lower = real(0.0)
    work.newton_row[world, row].upper = real(0.0)
    work.newton_row[world, row].first = real(0.0)
    work.newton_row[world, row].impulse = real(0.0)
    work.newton_row[world, row].rate = real(0.0)
    work.newton_row[world, row].slope = real(0.0)
    work.newton_row[world, row].direction = real(0.0)
    work.newton_row[world, row].restitution = real(0.0)
    work.newton_row[world, row].impact = real(0.0)


@func
def bound_row(
    work: NewtonWork, world: Int32, row: Int32, regular: real, target: real, lower: real, upper: real
):
    """Let a row ask for the change `target` of its rate, within bounds of its impulse."""
    work.newton_row[world, row].kind = BOUNDED
    work.newton_row[world, row].regular = regular
    work.newton_row[world, row].target = target
    work.newton_row[world, row].rate = -target
    work.newton_row[world, row].lower = wp.min(lower, upper)
    work.newton_row[world, row].upper = wp.max(lower, upper)


@func
def place_pair(
    model: Model, work: NewtonWork, pair_rows: PairRows, world: Int32, row: Int32, pair_row: Int32,
    tree_a: Int32, tree_b: Int32,
):  # fmt: skip
    """Take over the Jacobian of a row over two trees."""
    place = pair_rows.row_place[world, pair_row]
    work.newton_row[world, row].start = pair_rows.row_start[world, pair_row]
    work.newton_row[world, row].place_a = place_of(model, work, world, tree_a)
    work.newton_row[world, row].blocks_a = place[1]
    work.newton_row[world, row].place_b = place_of(model, work, world, tree_b)
    work.newton_row[world, row].blocks_b = place[3]


@func
def take_joint_row(model: Model, scratch: Scratch, work: NewtonWork, world: Int32, source: Int32):
    """Add row `source` of a joint."""
    row = work.count_newton[world, ROWS] + 0
    clear_row(work, world, row, Int32(OF_JOINT), source)
    tree = model.constraint[scratch.row[world, source].constraint].tree
    place = place_of(model, work, world, tree)
    entry = scratch.row[world, source].entry - 4 * scratch.row[world, source].delta
    work.newton_row[world, row].place_a = 4 * place + entry
    mass = scratch.row[world, source].effective_mass
    if mass > 0.0:
        regular = _JOINT_REGULAR / mass
        if scratch.row[world, source].soft != 0:
            # Of rows that yield: λ = share / softness (b − J Δv).
            share = scratch.row_share[world, source]
            regular = scratch.row_softness[world, source] / share
        bound_row(
            work, world, row, regular, scratch.row[world, source].change, scratch.row[world, source].lower,
            scratch.row[world, source].upper,
        )  # fmt: skip
    work.count_newton[world, ROWS] = row + 1


@func
def take_user_row(
    model: Model, work: NewtonWork, pair_rows: PairRows, world: Int32, source: Int32, tree_a: Int32,
    tree_b: Int32,
):  # fmt: skip
    """Add row `source` of a user constraint."""
    row = work.count_newton[world, ROWS] + 0
    clear_row(work, world, row, Int32(OF_USER), source)
    terms = pair_rows.row_terms[world, source]
    place_pair(model, work, pair_rows, world, row, source, tree_a, tree_b)
    if terms.effective_mass > 0.0:
        softness = terms.softness / terms.effective_mass
        inverse_mass = 1.0 / terms.effective_mass - softness
        regular = wp.max(softness, _JOINT_REGULAR * inverse_mass)
        target = terms.share / terms.effective_mass
        bound_row(work, world, row, regular, target, terms.lower, terms.upper)
    work.count_newton[world, ROWS] = row + 1


@func
def add_constraints(
    model: Model,
    settings: Settings,
    state: State,
    scratch: Scratch,
    users: UserConstraints,
    pair_rows: PairRows,
    work: NewtonWork,
    world: Int32,
    root: Int32,
) -> Int32:
    """Add the rows of an island's motors, limits and user constraints; returns how many are of joints."""
    joint_row = Int32(0)
    constraint = pair_rows.tree_first_constraint[world, root]
    while constraint >= 0:
        if work.count_newton[world, ROWS] + 2 * ROWS_PER_PAIR > work.newton_row.shape[1]:
            work.count_newton[world, SHORT] = 1
            return joint_row
        if model.constraint[constraint].kind != USER:
            before = joint_row + 0
            joint_row = joint_constraint_rows(model, settings, state, scratch, world, constraint, joint_row)
            while before < joint_row:
                take_joint_row(model, scratch, work, world, before)
                before += 1
        else:
            user = model.constraint[constraint].link
            if is_in_force(state, users, world, user):
                tree_a, tree_b = users.user_tree_a[user], users.user_tree_b[user]
                row = work.count_newton[world, PAIR_ROW] + 0
                block = work.count_newton[world, PAIR_BLOCK] + 0
                if not has_room(model, pair_rows, row, block, tree_a, tree_b):
                    work.count_newton[world, SHORT] = 1
                    return joint_row
                after, block = add_user_rows(
                    settings, model, state, scratch, users, pair_rows, world, user, row, block
                )
                while row < after:
                    take_user_row(model, work, pair_rows, world, row, tree_a, tree_b)
                    row += 1
                work.count_newton[world, PAIR_ROW] = after
                work.count_newton[world, PAIR_BLOCK] = block
        constraint = pair_rows.constraint_next[world, constraint]
    return joint_row


@func
def remembered_pull(contacts: Contacts, terms: ContactTerms, world: Int32, contact: Int32) -> Vector3:
    """The last impulse of friction of a contact, turned into its present plane, within its bound.

    It is kept in world axes in place of a friction anchor, for which this law has no use.
    """
    normal = contacts.contact_impulse[world, contact][0]
    if normal <= 0.0:
        return Vector3(0.0, 0.0, 0.0)
    pull = contacts.contact_anchor_a[world, contact]
    pull = pull - terms.normal * wp.dot(pull, terms.normal)
    length = wp.length(pull)
    bound = wp.max(terms.friction[0], 0.0) * normal
    if length > bound:
        pull = pull * (bound / length)
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
    regular = _NORMAL_REGULAR * inverse_mass + settings.contact_softness
    wanted = -gap / h
    if gap <= 0.0:
        wanted = wp.min(-gap / (_CORRECTION_STEPS * h), _FASTEST_CORRECTION)
    a, b = terms.ends[1], terms.ends[3]
    if shapes.link_stiffness[world, a] >= 0.0 or shapes.link_stiffness[world, b] >= 0.0:
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
    if friction <= 0.0 or inverse_mass <= _LEAST_INVERSE_MASS:
        return
    regular = _FRICTION_REGULAR * inverse_mass
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
    if inverse_mass > _LEAST_INVERSE_MASS:
        regular = _FRICTION_REGULAR * inverse_mass
        bound = friction * last
        bound_row(work, world, row, regular, -work.newton_row[world, row].speed, -bound, bound)
        work.newton_row[world, row].friction = friction
        work.newton_row[world, row].bounded_by = normal


@func
def write_yielding(
    settings: Settings,
    shapes: Shapes,
    work: NewtonWork,
    terms: ContactTerms,
    world: Int32,
    row: Int32,
):
    """Write MuJoCo's law of a contact that yields: a normal, with a cone or a pyramid of friction."""
    for i in range(3):
        speed = work.newton_row[world, row + i].speed
        target = real(0.0)
        if i == 0:
            target = normal_change(settings, shapes, terms, world, speed)
        else:
            direction = terms.lateral1
            if i == 2:
                direction = terms.lateral2
            target = lateral_change(settings, terms, speed, i, direction)
        bound_row(work, world, row + i, terms.softness, target, 0.0, _UNBOUNDED)
        if i > 0:
            work.newton_row[world, row + i].kind = OFF
    friction = terms.friction[0]
    if friction <= 0.0:
        return
    share = wp.max(shapes.link_mixing[world, terms.ends[1]][2], shapes.link_mixing[world, terms.ends[3]][2])
    work.newton_row[world, row].kind = CONE
    if share > 0.0:
        work.newton_row[world, row].kind = PYRAMID
        # Of each of the four edges.
        work.newton_row[world, row].regular = 2.0 * friction * friction * terms.lateral_softness
    lateral = terms.lateral_softness
    if share < 0.0:
        # Cones with an `impratio`.
        lateral = -share * lateral
    for i in range(1, 3):
        work.newton_row[world, row + i].kind = FOLLOWING
        work.newton_row[world, row + i].regular = lateral
    work.newton_row[world, row].friction = friction


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
        if may_yield(shapes, world, terms):
            terms = yielding_terms(settings, model, state, scratch, shapes, world, terms)
    normal = work.count_newton[world, ROWS] + 0
    pair_row = work.count_newton[world, PAIR_ROW] + 0
    block = work.count_newton[world, PAIR_BLOCK] + 0
    tree_a, tree_b = terms.ends[0], terms.ends[2]
    if normal + ROWS_PER_PAIR > work.newton_row.shape[1] or not has_room(
        model, pair_rows, pair_row, block, tree_a, tree_b
    ):
        work.count_newton[world, SHORT] = 1
        return
    last = wp.where(terms.ignored != 0, real(0.0), contacts.contact_impulse[world, contact][0])
    pull = remembered_pull(contacts, terms, world, contact)
    count = Int32(3)
    rolling = terms.friction[1] > 0.0
    if rolling:
        count += 2
    if terms.friction[2] > 0.0:
        count += 1
    for i in range(count):
        row = normal + i
        linear = Vector3(0.0, 0.0, 0.0)
        angular = Vector3(0.0, 0.0, 0.0)
        if i == 0:
            linear = terms.normal
        elif i == 1:
            linear = terms.lateral1
        elif i == 2:
            linear = terms.lateral2
        elif rolling and i == 3:
            angular = terms.rolling1
        elif rolling and i == 4:
            angular = terms.rolling2
        else:
            angular = terms.normal
        inverse_mass, velocity, after = write_pair_jacobian(
            model, state, scratch, pair_rows, world, pair_row + i, block, terms.ends, terms.point_a,
            terms.point_b, linear, angular,
        )  # fmt: skip
        block = after
        origin = Int32(OF_FRICTION)
        if i == 0:
            origin = Int32(OF_NORMAL)
        clear_row(work, world, row, origin, contact)
        place_pair(model, work, pair_rows, world, row, pair_row + i, tree_a, tree_b)
        work.newton_row[world, row].inverse_mass = inverse_mass
        work.newton_row[world, row].speed = (
            velocity + wp.dot(terms.carried, linear) + wp.dot(terms.carried_spin, angular)
        )
    is_live = terms.ignored == 0 and work.newton_row[world, normal].inverse_mass > _LEAST_INVERSE_MASS
    if is_live and terms.yields != 0:
        write_yielding(settings, shapes, work, terms, world, normal)
    elif is_live:
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
    work.count_newton[world, PAIR_ROW] = pair_row + count
    work.count_newton[world, PAIR_BLOCK] = block
