"""How fast shapes move, from the coordinates alone."""

import warp as wp

from carom.collision.extremes import greater
from carom.model.codes import PLANAR, PRISMATIC, REVOLUTE, SPHERICAL
from carom.model.contact_structs import Shapes
from carom.model.real import Int32, Vector3, func, real
from carom.model.structs import Model, Settings, State

# Motions in a step beyond this are not looked ahead [m]; their squares still are ordinary numbers.
FARTHEST = real(1.0e18)


@func
def rates_of(state: State, world: Int32, dof: Int32) -> Vector3:
    """Three velocity coordinates."""
    return Vector3(
        state.dof_velocity[world, dof],
        state.dof_velocity[world, dof + 1],
        state.dof_velocity[world, dof + 2],
    )


@func
def velocity_by_joint(model: Model, state: State, world: Int32, link: Int32, point: Vector3) -> Vector3:
    """Velocity that the joint of a link gives to a point in the world that moves with it [m/s]."""
    pose = state.link_pose[world, link]
    turn = wp.transform_get_rotation(pose)
    center = wp.transform_get_translation(pose)
    pivot = center - wp.quat_rotate(turn, model.link[link].com_from_pivot)
    kind = model.link[link].joint_type
    dof = model.link[link].first_dof
    if kind == REVOLUTE:
        axis = wp.quat_rotate(turn, model.link[link].axis)
        return wp.cross(axis, point - pivot) * state.dof_velocity[world, dof]
    if kind == PRISMATIC:
        return wp.quat_rotate(turn, model.link[link].axis) * state.dof_velocity[world, dof]
    if kind == SPHERICAL:
        return wp.cross(wp.quat_rotate(turn, rates_of(state, world, dof)), point - pivot)
    if kind == PLANAR:
        rates = rates_of(state, world, dof)
        axis = wp.quat_rotate(turn, model.link[link].axis)
        along = model.link[link].planar_axis1 * rates[1] + model.link[link].planar_axis2 * rates[2]
        return wp.cross(axis, point - center) * rates[0] + wp.quat_rotate(turn, along)
    return Vector3(0.0, 0.0, 0.0)


@func
def look_ahead(
    shapes: Shapes, model: Model, settings: Settings, state: State, world: Int32, shape: Int32
) -> real:
    """How far ahead of a shape continuous collision detection looks [m].

    As far as it or its base moves in a substep, if that is more than half its swept sphere's radius: slower
    ones are caught in time without. That follows from the coordinates, so that a restored state goes on as it
    did.
    """
    radius = shapes.shape_ccd_radius[shape]
    if radius <= 0.0:
        return 0.0
    link = shapes.shape_link[shape]
    point = wp.transform_get_translation(state.link_pose[world, link] * shapes.shape_pose[shape])
    velocity = Vector3(0.0, 0.0, 0.0)
    while model.link[link].parent >= 0:
        velocity += velocity_by_joint(model, state, world, link, point)
        link = model.link[link].parent
    first = model.tree[shapes.shape_tree[shape]].first_velocity
    of_base = rates_of(state, world, first + 3)
    arm = point - wp.transform_get_translation(state.link_pose[world, link])
    velocity += of_base + wp.cross(rates_of(state, world, first), arm)
    motion = greater(wp.length(velocity), wp.length(of_base)) * settings.time_step
    if motion > 0.5 * radius and motion < FARTHEST:
        return motion
    return 0.0
