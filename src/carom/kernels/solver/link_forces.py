"""Forces of contacts and user constraints on the links of one tree, for force-torque sensors.

They are computed from the impulses of the solver, tree by tree, after all islands have been solved. So
islands solved in parallel never write to the same link, and sums have a fixed order. A tree without dofs is
in no island, but its sensors measure these forces as well.
"""

import warp as wp

from carom.kernels.dynamics.feedback import add_link_force, add_slide_torque, note_push
from carom.kernels.solver.activity import can_move, is_in_force, is_left_out, pushed_tree
from carom.kernels.solver.contact_terms import impulse_on_a
from carom.kernels.solver.user_constraints import (
    coupled_position,
    held_directions,
    held_points,
    held_turn,
    pose_row,
    user_ends,
    user_row_count,
    world_frame,
)
from carom.kernels.structs import Contacts, Model, Scratch, Settings, Shapes, State, UserConstraints
from carom.kernels.types import Int32, Vector3, func, real
from carom.layouts.codes import USER_BASE_FRICTION, USER_COUPLING, USER_GEAR, USER_TENDON
from carom.layouts.contacts import THERE


@func
def gather_link_forces(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    shapes: Shapes,
    contacts: Contacts,
    users: UserConstraints,
    world: Int32,
    tree: Int32,
):
    """Add to the constraint forces of a tree with sensors those of its contacts and user constraints."""
    if model.tree[tree].sensor_count == 0 or is_left_out(state, world, tree):
        return
    for contact in range(contacts.count_contacts[world, THERE]):
        gather_contact_force(settings, model, state, scratch, shapes, contacts, world, tree, contact)
    for user in range(settings.user_count):
        if is_in_force(state, users, world, user):
            gather_user_forces(settings, model, state, scratch, users, world, tree, user)


@func
def gather_contact_force(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    shapes: Shapes,
    contacts: Contacts,
    world: Int32,
    tree: Int32,
    contact: Int32,
):
    """Add the force of a contact to the constraint forces of a tree's links, if the contact was solved.

    As in PyBullet, torques of rolling and spinning friction are left out.
    """
    pair = contacts.contact_shapes[world, contact]
    a = shapes.shape_tree[pair[0]]
    b = shapes.shape_tree[pair[1]]
    if a != tree and b != tree:
        return
    pushed = pushed_tree(shapes, model, pair)
    if pushed < 0 or is_left_out(state, world, pushed):
        return
    note_push(model, scratch, world, tree)
    force = impulse_on_a(contacts, world, contact) / settings.time_step
    if a == tree:
        add_link_force(state, scratch, world, pair[2], contacts.contact_point_a[world, contact], force)
    if b == tree:
        add_link_force(state, scratch, world, pair[3], contacts.contact_point_b[world, contact], -force)


@func
def gather_user_forces(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    users: UserConstraints,
    world: Int32,
    tree: Int32,
    user: Int32,
):
    """Add force and torque of a user constraint to those of a tree's links, if it was solved."""
    ends = user_ends(users, user)
    if ends[0] != tree and ends[2] != tree:
        return
    pushed = ends[0]
    if not can_move(model, pushed):
        pushed = ends[2]
    if not can_move(model, pushed) or is_left_out(state, world, pushed):
        return
    if users.user_kind[user] == USER_COUPLING:
        size = state.user_impulse[world, user][0] / settings.time_step
        _target, slope = coupled_position(state, model, users, world, user)
        if ends[0] == tree:
            add_coupling(model, scratch, world, tree, ends[1], size)
        if ends[2] == tree:
            add_coupling(model, scratch, world, tree, ends[3], -slope * size)
        return
    note_push(model, scratch, world, tree)
    if users.user_kind[user] >= USER_TENDON and users.user_kind[user] != USER_BASE_FRICTION:
        return
    force, torque = user_wrench(settings, model, state, scratch, users, world, user)
    point_a, point_b = held_points(state, users, world, user)
    if users.user_kind[user] == USER_GEAR:
        # The force on a prismatic joint acts at the centre of mass, without a torque.
        point_a = wp.transform_get_translation(state.link_pose[world, ends[1]])
        point_b = wp.transform_get_translation(state.link_pose[world, ends[3]])
    if ends[0] == tree:
        add_link_force(state, scratch, world, ends[1], point_a, force)
        scratch.link[world, ends[1]].constraint_torque += torque
    if ends[2] == tree:
        add_link_force(state, scratch, world, ends[3], point_b, -force)
        scratch.link[world, ends[3]].constraint_torque -= torque


@func
def add_coupling(model: Model, scratch: Scratch, world: Int32, tree: Int32, link: Int32, size: real):
    """Note the force or torque of a coupling along a joint of one dof."""
    if model.tree[tree].sensed_count > 0:
        add_joint_force(model, scratch, world, link, size)
    else:
        scratch.dof[world, model.link[link].first_dof].coupling += size


@func
def add_joint_force(model: Model, scratch: Scratch, world: Int32, link: Int32, size: real):
    """Add the force or torque of a joint of one dof to its link, and the opposite to the parent."""
    dof = model.link[link].first_dof
    parent = model.link[link].parent
    angular = scratch.dof[world, dof].angular * size
    linear = Vector3(0.0, 0.0, 0.0)
    if wp.dot(angular, angular) == 0.0:
        linear = scratch.dof[world, dof].linear * size
    scratch.link[world, link].constraint_torque += angular
    scratch.link[world, link].constraint_force += linear
    scratch.link[world, parent].constraint_torque -= angular
    scratch.link[world, parent].constraint_force -= linear
    add_slide_torque(scratch, world, link, parent, linear)


@func
def user_wrench(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    users: UserConstraints,
    world: Int32,
    user: Int32,
):
    """Force [N] and torque [N m] of a user constraint on link a in the last substep, in world axes."""
    force, torque = Vector3(0.0, 0.0, 0.0), Vector3(0.0, 0.0, 0.0)
    impulse = state.user_impulse[world, user] / settings.time_step
    if users.user_kind[user] == USER_GEAR:
        # As in PyBullet, the torques or forces on both links are along the axis of joint a.
        dof = model.link[users.user_link_a[user]].first_dof
        torque = scratch.dof[world, dof].angular * impulse[0]
        if wp.dot(torque, torque) == 0.0:
            force = scratch.dof[world, dof].linear * impulse[0]
        return force, torque
    ends = user_ends(users, user)
    frame_a = world_frame(state, world, ends[0], ends[1], users.user_frame_a[user])
    frame_b = world_frame(state, world, ends[2], ends[3], users.user_frame_b[user])
    axes, _turned = held_turn(users, user, frame_a, frame_b)
    directions = held_directions(state, users, world, user, axes)
    for i in range(user_row_count(users.user_kind[user])):
        linear, angular, _axis = pose_row(users.user_kind[user], directions, axes, i)
        force += linear * impulse[i]
        torque += angular * impulse[i]
    return force, torque
