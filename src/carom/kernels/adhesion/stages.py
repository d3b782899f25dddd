"""Kernels of a step beside others, where an actuator pulls a link towards all that touches it.

As in MuJoCo, all contacts of the link share the force of the actuator alike, along their normals, also those
within their margins that do not press. It is applied before velocities are advanced, so contacts resist it.
Worlds without such actuators never launch these kernels, so they cost these nothing.
"""

import warp as wp

from carom.kernels.dynamics.actuators import actuator_law, within_own_range
from carom.kernels.dynamics.contact_compliance import contact_law, yields
from carom.kernels.structs import Contacts, Model, Scratch, Settings, Shapes, State
from carom.kernels.types import Int32, Vector3, Vector6, func, kernel, real
from carom.layouts.contacts import THERE


@func
def holds(
    settings: Settings, shapes: Shapes, contacts: Contacts, world: Int32, contact: Int32, link: Int32
) -> bool:
    """Whether a link is one of the two of a contact within its margin, or pressing if it does not yield."""
    pair = contacts.contact_shapes[world, contact]
    if (pair[2] != link and pair[3] != link) or pair[2] == pair[3]:
        return False
    _reference, _impedance, _lateral, margin, _mass, _row = contact_law(
        settings, shapes, world, pair[0], pair[1]
    )
    if contacts.contact_distance[world, contact] < margin:
        return True
    return not yields(shapes, world, pair[0], pair[1]) and contacts.contact_impulse[world, contact][0] > 0.0


@func
def pull(state: State, scratch: Scratch, world: Int32, link: Int32, point: Vector3, force: Vector3):
    """Apply a force to a point of a link, in world axes, until `let_go`."""
    arm = point - wp.transform_get_translation(state.link_pose[world, link])
    torque = wp.cross(arm, force)
    wrench = Vector6(force[0], force[1], force[2], torque[0], torque[1], torque[2])
    state.link_wrench[world, link] = state.link_wrench[world, link] + wrench
    scratch.link[world, link].pull += force
    scratch.link[world, link].pull_torque += torque


@func
def forget(scratch: Scratch, world: Int32, link: Int32):
    """Forget what was applied to a link."""
    scratch.link[world, link].pull = Vector3()
    scratch.link[world, link].pull_torque = Vector3()


@func
def let_go(settings: Settings, state: State, scratch: Scratch, world: Int32):
    """Take the forces of the last substep from all links."""
    for link in range(settings.link_count):
        force, torque = scratch.link[world, link].pull, scratch.link[world, link].pull_torque
        wrench = Vector6(force[0], force[1], force[2], torque[0], torque[1], torque[2])
        state.link_wrench[world, link] = state.link_wrench[world, link] - wrench
        forget(scratch, world, link)


@kernel
def begin_adhesion_kernel(settings: Settings, scratch: Scratch, first_world: Int32):
    """Begin a step: nothing is pulled yet."""
    world = first_world + wp.tid()
    for link in range(settings.link_count):
        forget(scratch, world, link)


@kernel
def abandon_adhesion_kernel(settings: Settings, state: State, scratch: Scratch, first_world: Int32):
    """Restore the forces on links at the start of a step that failed."""
    let_go(settings, state, scratch, first_world + wp.tid())


@kernel
def adhesion_kernel(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    shapes: Shapes,
    contacts: Contacts,
    first_world: Int32,
):
    """Pull links towards what touches them in a substep, after its detection of collisions."""
    world = first_world + wp.tid()
    let_go(settings, state, scratch, world)
    count = contacts.count_contacts[world, THERE]
    for tree in range(settings.tree_count):
        first = model.tree[tree].first_actuator
        for actuator in range(first, first + model.tree[tree].actuator_count):
            if model.actuator[actuator].pulled == 0:
                continue
            link = model.tree[tree].first_link + model.actuator[actuator].pulled - 1
            force, _stiffness, _damping = actuator_law(
                model, state, world, actuator, real(0.0), real(0.0), settings.time_step
            )
            force = within_own_range(model, world, actuator, force)
            state.actuator_force[world, actuator] = force
            holding = real(0.0)
            for contact in range(count):
                if holds(settings, shapes, contacts, world, contact, link):
                    holding += 1.0
            if holding == 0.0 or force == 0.0:
                continue
            for contact in range(count):
                if holds(settings, shapes, contacts, world, contact, link):
                    pair = contacts.contact_shapes[world, contact]
                    point = 0.5 * (
                        contacts.contact_point_a[world, contact] + contacts.contact_point_b[world, contact]
                    )
                    on_b = contacts.contact_normal[world, contact] * (force / holding)
                    pull(state, scratch, world, pair[2], point, -on_b)
                    pull(state, scratch, world, pair[3], point, on_b)
