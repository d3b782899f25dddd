"""Requested velocity, softness and friction of contacts, for all kinds of contact rows."""

import warp as wp

from carom.kernels.contact.ranked_friction import MAX_FRICTION, ranked_friction
from carom.kernels.dynamics.contact_compliance import combined_restitution, let_contact_yield
from carom.kernels.dynamics.kinematics import base_omega, base_velocity
from carom.kernels.maths.min_max import maximum, minimum, within_bounds
from carom.kernels.solver.warm_starting import next_warm_start, slides
from carom.kernels.structs import Contacts, ContactTerms, Model, Scratch, Settings, Shapes, State
from carom.kernels.types import Index4, Int32, Vector3, func, real

_MIN_DENOMINATOR = real(2.220446049250313e-16)
# Default damping of a shape in a soft contact [N s/m].
_DEFAULT_DAMPING = 0.1


@func
def contact_damping(shapes: Shapes, world: Int32, shape: Int32) -> real:
    """Damping of a shape's contacts [N s/m]."""
    damping = shapes.shape_contact_damping[world, shape]
    stiffness = shapes.shape_stiffness[world, shape]
    return wp.where(stiffness > 0.0 and damping >= 0.0, damping, real(_DEFAULT_DAMPING))


@func
def torsion_softness(settings: Settings) -> real:
    """Softness of rolling and spinning friction: as in Bullet that of the world, per impulse of a step."""
    return settings.contact_softness * settings.time_step


@func
def contact_stiffness(settings: Settings, shapes: Shapes, world: Int32, a: Int32, b: Int32):
    """Softness and error reduction of the normal row between two shapes."""
    stiffness_a = shapes.shape_stiffness[world, a]
    stiffness_b = shapes.shape_stiffness[world, b]
    if stiffness_a < 0.0 and stiffness_b < 0.0:
        return settings.contact_softness, settings.contact_erp
    # Springs are in series, dampers in parallel; a shape without a spring is rigid, but has a damper.
    compliance = real(0.0)
    if stiffness_a > 0.0:
        compliance += 1.0 / stiffness_a
    if stiffness_b > 0.0:
        compliance += 1.0 / stiffness_b
    damping = contact_damping(shapes, world, a) + contact_damping(shapes, world, b)
    stiffness = 1.0 / maximum(compliance, _MIN_DENOMINATOR)
    denominator = maximum(settings.time_step * stiffness + damping, _MIN_DENOMINATOR)
    return 1.0 / (denominator * settings.time_step), settings.time_step * stiffness / denominator


@func
def contact_friction(shapes: Shapes, world: Int32, a: Int32, b: Int32) -> Vector3:
    """Combined coefficients of friction of two shapes: lateral, rolling, spinning."""
    if shapes.shape_friction_rank[world, a] > 0 or shapes.shape_friction_rank[world, b] > 0:
        return ranked_friction(shapes, world, a, b)
    lateral_a = shapes.shape_lateral_friction[world, a]
    lateral_b = shapes.shape_lateral_friction[world, b]
    lateral = lateral_a * lateral_b
    rolling_a = shapes.shape_rolling_friction[world, a]
    rolling_b = shapes.shape_rolling_friction[world, b]
    rolling = rolling_a * lateral_b + rolling_b * lateral_a
    spinning_a = shapes.shape_spinning_friction[world, a]
    spinning_b = shapes.shape_spinning_friction[world, b]
    spinning = spinning_a * lateral_b + spinning_b * lateral_a
    return Vector3(
        within_bounds(lateral, -MAX_FRICTION, MAX_FRICTION),
        within_bounds(rolling, -MAX_FRICTION, MAX_FRICTION),
        within_bounds(spinning, -MAX_FRICTION, MAX_FRICTION),
    )


@func
def scaled_by_shape(state: State, shapes: Shapes, world: Int32, shape: Int32, direction: Vector3) -> Vector3:
    """A friction direction, its components along the axes of a shape's link multiplied by its factors."""
    factors = shapes.shape_anisotropy[world, shape]
    if factors[0] == 1.0 and factors[1] == 1.0 and factors[2] == 1.0:
        return direction
    turn = wp.transform_get_rotation(state.link_pose[world, shapes.shape_link[shape]])
    return wp.quat_rotate(turn, wp.cw_mul(wp.quat_rotate_inv(turn, direction), factors))


@func
def scaled_direction(
    state: State, shapes: Shapes, world: Int32, a: Int32, b: Int32, direction: Vector3
) -> Vector3:
    """A friction direction multiplied by the factors of both shapes."""
    return scaled_by_shape(state, shapes, world, b, scaled_by_shape(state, shapes, world, a, direction))


@func
def anchor_drift(state: State, shapes: Shapes, contacts: Contacts, world: Int32, contact: Int32) -> Vector3:
    """Vector from a contact's friction anchor on b to that on a, in world axes [m]; 0 if it has none."""
    pair = contacts.contact_shapes[world, contact]
    if (
        shapes.shape_friction_anchor[world, pair[0]] == 0
        and shapes.shape_friction_anchor[world, pair[1]] == 0
    ):
        return Vector3(0.0, 0.0, 0.0)
    on_a = wp.transform_point(state.link_pose[world, pair[2]], contacts.contact_anchor_a[world, contact])
    on_b = wp.transform_point(state.link_pose[world, pair[3]], contacts.contact_anchor_b[world, contact])
    return on_a - on_b


@func
def velocity_from_forces(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    world: Int32,
    tree: Int32,
    link: Int32,
    point: Vector3,
    direction: Vector3,
) -> real:
    """Change of a link point's velocity along a direction by the forces of this substep [m/s]."""
    reference = wp.transform_get_translation(state.link_pose[world, model.tree[tree].first_link])
    moment = wp.cross(point - reference, direction)
    acceleration = real(0.0)
    dof = model.link[link].nearest_dof
    while dof >= 0:
        along = wp.dot(scratch.dof[world, dof].linear, direction)
        along += wp.dot(scratch.dof[world, dof].angular, moment)
        acceleration += along * scratch.dof[world, dof].force
        dof = model.dof[dof].parent
    return settings.time_step * acceleration


@func
def velocities_from_forces(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    world: Int32,
    tree: Int32,
    link: Int32,
    point: Vector3,
    terms: ContactTerms,
) -> Vector3:
    """As `velocity_from_forces`, along the normal and both directions of lateral friction at once."""
    reference = wp.transform_get_translation(state.link_pose[world, model.tree[tree].first_link])
    arm = point - reference
    moment0, moment1, moment2 = (
        wp.cross(arm, terms.normal),
        wp.cross(arm, terms.lateral1),
        wp.cross(arm, terms.lateral2),
    )
    acceleration = Vector3(0.0, 0.0, 0.0)
    dof = model.link[link].nearest_dof
    while dof >= 0:
        linear = scratch.dof[world, dof].linear
        angular = scratch.dof[world, dof].angular
        along = Vector3(
            wp.dot(linear, terms.normal) + wp.dot(angular, moment0),
            wp.dot(linear, terms.lateral1) + wp.dot(angular, moment1),
            wp.dot(linear, terms.lateral2) + wp.dot(angular, moment2),
        )
        acceleration += along * scratch.dof[world, dof].force
        dof = model.dof[dof].parent
    return settings.time_step * acceleration


@func
def parting_from_forces(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    world: Int32,
    terms: ContactTerms,
    direction: Vector3,
) -> real:
    """Change of the velocity of a relative to b along a direction by the forces of this substep [m/s]."""
    return velocity_from_forces(
        settings, model, state, scratch, world, terms.ends[0], terms.ends[1], terms.point_a, direction
    ) - velocity_from_forces(
        settings, model, state, scratch, world, terms.ends[2], terms.ends[3], terms.point_b, direction
    )


@func
def carried_velocity(model: Model, state: State, world: Int32, tree: Int32, point: Vector3) -> Vector3:
    """Velocity of a point that moves with a fixed base, which no impulse changes; 0 for others and -1."""
    if tree < 0 or model.tree[tree].fixed == 0:
        return Vector3(0.0, 0.0, 0.0)
    reference = wp.transform_get_translation(state.link_pose[world, model.tree[tree].first_link])
    turning = wp.cross(base_omega(model, state, world, tree), point - reference)
    return base_velocity(model, state, world, tree) + turning


@func
def carried_spin(model: Model, state: State, world: Int32, tree: Int32) -> Vector3:
    """Angular velocity of a fixed base; 0 for other bases and -1."""
    if tree < 0 or model.tree[tree].fixed == 0:
        return Vector3(0.0, 0.0, 0.0)
    return base_omega(model, state, world, tree)


@func
def surface_moves(shapes: Shapes, world: Int32, shape: Int32) -> bool:
    """Whether the surface of a shape moves in it, as a belt does."""
    linear = shapes.shape_surface_velocity[world, shape]
    angular = shapes.shape_surface_spin[world, shape]
    return (
        linear[0] != 0.0
        or linear[1] != 0.0
        or linear[2] != 0.0
        or angular[0] != 0.0
        or angular[1] != 0.0
        or angular[2] != 0.0
    )


@func
def surface_spin(state: State, shapes: Shapes, world: Int32, shape: Int32) -> Vector3:
    """Angular velocity of a shape's surface in the shape, in world axes."""
    link = wp.transform_get_rotation(state.link_pose[world, shapes.shape_link[shape]])
    turn = link * wp.transform_get_rotation(shapes.shape_pose[shape])
    return wp.quat_rotate(turn, shapes.shape_surface_spin[world, shape])


@func
def surface_velocity(state: State, shapes: Shapes, world: Int32, shape: Int32, point: Vector3) -> Vector3:
    """Velocity of a shape's surface in the shape at a point, both in world axes."""
    pose = wp.transform_multiply(state.link_pose[world, shapes.shape_link[shape]], shapes.shape_pose[shape])
    place = wp.transform_point(wp.transform_inverse(pose), point)
    turning = wp.cross(shapes.shape_surface_spin[world, shape], place)
    motion = shapes.shape_surface_velocity[world, shape] + turning
    return wp.quat_rotate(wp.transform_get_rotation(pose), motion)


@func
def with_moving_surfaces(state: State, shapes: Shapes, world: Int32, terms: ContactTerms) -> ContactTerms:
    """The terms of a contact whose surfaces move: friction feels that along them and about the normal.

    This is apart from `contact_terms` so that other contacts keep their bits. Anchors would hold a belt.
    """
    middle = 0.5 * (terms.point_a + terms.point_b)
    a, b = terms.shape_a, terms.shape_b
    motion = surface_velocity(state, shapes, world, a, middle) - (
        surface_velocity(state, shapes, world, b, middle)
    )
    spin = surface_spin(state, shapes, world, a) - surface_spin(state, shapes, world, b)
    terms.carried = terms.carried + motion - terms.normal * wp.dot(terms.normal, motion)
    terms.carried_spin = terms.carried_spin + terms.normal * wp.dot(terms.normal, spin)
    terms.drift = Vector3(0.0, 0.0, 0.0)
    return terms


@func
def contact_terms(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    shapes: Shapes,
    contacts: Contacts,
    world: Int32,
    contact: Int32,
    solved_up_to: real,
    share: real,
) -> ContactTerms:
    """Data of a contact for its rows; also replaces the contact's friction directions by scaled ones.

    Beyond the distance `solved_up_to` [m] rows are off. Initial impulses are the last impulses times `share`.
    """
    pair = contacts.contact_shapes[world, contact]
    a, b = pair[0], pair[1]
    softness, erp = contact_stiffness(settings, shapes, world, a, b)
    terms = ContactTerms()
    terms.ends = Index4(shapes.shape_tree[a], pair[2], shapes.shape_tree[b], pair[3])
    terms.shape_a = a
    terms.shape_b = b
    terms.point_a = contacts.contact_point_a[world, contact]
    terms.point_b = contacts.contact_point_b[world, contact]
    terms.normal = contacts.contact_normal[world, contact]
    terms.rolling1 = contacts.contact_direction1[world, contact]
    terms.rolling2 = contacts.contact_direction2[world, contact]
    terms.lateral1 = scaled_direction(state, shapes, world, a, b, terms.rolling1)
    terms.lateral2 = scaled_direction(state, shapes, world, a, b, terms.rolling2)
    contacts.contact_direction1[world, contact] = terms.lateral1
    contacts.contact_direction2[world, contact] = terms.lateral2
    terms.drift = anchor_drift(state, shapes, contacts, world, contact)
    terms.distance = contacts.contact_distance[world, contact]
    terms.friction = contact_friction(shapes, world, a, b)
    terms.softness = softness
    terms.erp = erp
    terms.start = share * contacts.contact_impulse[world, contact]
    terms.ignored = Int32(terms.distance > solved_up_to)
    terms.carried = carried_velocity(model, state, world, terms.ends[0], terms.point_a) - carried_velocity(
        model, state, world, terms.ends[2], terms.point_b
    )
    terms.carried_spin = carried_spin(model, state, world, terms.ends[0]) - carried_spin(
        model, state, world, terms.ends[2]
    )
    if surface_moves(shapes, world, a) or surface_moves(shapes, world, b):
        terms = with_moving_surfaces(state, shapes, world, terms)
    terms.from_forces = real(0.0)
    terms.yields = Int32(0)
    terms.lateral_softness = real(0.0)
    if combined_restitution(shapes, world, a, b) > 0.0:
        terms.from_forces = parting_from_forces(settings, model, state, scratch, world, terms, terms.normal)
    if terms.ignored != 0:
        # Rows without inverse mass are off; softness alone would make them push without bound.
        terms.softness = real(0.0)
    return terms


@func
def yielding_terms(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    shapes: Shapes,
    world: Int32,
    terms: ContactTerms,
) -> ContactTerms:
    """The terms of a contact that may yield.

    This is apart from `contact_terms` so that other contacts take no time for it.
    """
    terms = let_contact_yield(settings, shapes, terms, world, terms.shape_a, terms.shape_b)
    parting = velocities_from_forces(
        settings, model, state, scratch, world, terms.ends[0], terms.ends[1], terms.point_a, terms
    ) - velocities_from_forces(
        settings, model, state, scratch, world, terms.ends[2], terms.ends[3], terms.point_b, terms
    )
    terms.from_forces = parting[0]
    terms.lateral_from_forces[0] = parting[1]
    terms.lateral_from_forces[1] = parting[2]
    if terms.ignored != 0:
        terms.softness = real(0.0)
        terms.lateral_softness = real(0.0)
    return terms


@func
def normal_change(
    settings: Settings, shapes: Shapes, terms: ContactTerms, world: Int32, velocity: real
) -> real:
    """Requested change of the normal velocity of a contact.

    A gap may close within the step, but not more. Penetration is corrected at the rate `terms.erp`, in
    addition to restitution. But neither this correction nor the forces of this step make bodies rebound
    faster than they approached; otherwise, at a restitution of 1, they would gain energy with every bounce.
    Contacts that yield have a spring and damper instead.
    """
    if terms.yields != 0:
        before = velocity - terms.from_forces
        return before - settings.time_step * (terms.damping * before + terms.pull) - velocity
    gap = terms.distance + settings.contact_slop
    parting = -gap / settings.time_step
    if gap <= 0.0:
        parting *= terms.erp
    if wp.abs(velocity) < settings.restitution_threshold or velocity >= 0.0:
        return parting - velocity
    restitution = combined_restitution(shapes, world, terms.shape_a, terms.shape_b)
    if restitution <= 0.0:
        return parting - velocity
    rebound = maximum(restitution, 1.0) * (terms.from_forces - velocity)
    return minimum(parting - restitution * velocity, maximum(rebound, parting)) - velocity


@func
def friction_change(settings: Settings, velocity: real, drift: Vector3, direction: Vector3) -> real:
    """Change of velocity along a friction direction that stops sliding and corrects a drift."""
    return -velocity - wp.dot(drift, direction) * settings.friction_erp / settings.time_step


@func
def lateral_change(
    settings: Settings, terms: ContactTerms, velocity: real, row: Int32, direction: Vector3
) -> real:
    """Requested change of the velocity of a row of lateral friction, 1 or 2, along its direction."""
    if terms.yields != 0:
        before = velocity - terms.lateral_from_forces[row - 1]
        return before - settings.time_step * terms.erp * before - velocity
    return friction_change(settings, velocity, terms.drift, direction)


@func
def impulse_on_a(contacts: Contacts, world: Int32, contact: Int32) -> Vector3:
    """Impulse of a contact on its side a in the last substep, friction included, in world axes."""
    along = contacts.contact_impulse[world, contact]
    return (
        along[0] * contacts.contact_normal[world, contact]
        + along[1] * contacts.contact_direction1[world, contact]
        + along[2] * contacts.contact_direction2[world, contact]
    )


@func
def keep_contact_impulse(
    contacts: Contacts,
    world: Int32,
    contact: Int32,
    normal: real,
    first: real,
    second: real,
    friction: real,
    outcome: Int32,
):
    """Store the impulses of a contact; if it slides, its friction anchor moves to its present point.

    The impulses are along the normal and the two friction directions, `friction` is the coefficient of
    lateral friction, and `outcome` that of solving the contact, see `warm_starting.next_warm_start`.
    """
    contacts.contact_impulse[world, contact] = Vector3(normal, first, second)
    contacts.contact_warm_start[world, contact] = next_warm_start(
        contacts.contact_warm_start[world, contact], outcome
    )
    if slides(normal, first, second, friction):
        contacts.contact_anchor_a[world, contact] = contacts.contact_local_a[world, contact]
        contacts.contact_anchor_b[world, contact] = contacts.contact_local_b[world, contact]
