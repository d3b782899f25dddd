"""What sensors of each kind measure, but for accelerations; the same as in `carom.scene.sensors.measure`.

All results have four numbers; only the first `dim` of a sensor count.
"""

import warp as wp

from carom.kernels.joints.trees import with_joint_load
from carom.kernels.sensors.frames import (
    center_of_link,
    center_velocity,
    frame_position,
    frame_velocity,
    turn_of_link,
)
from carom.kernels.sensors.volumes import is_touched
from carom.kernels.structs import Contacts, Model, Scratch, SensorTable, State
from carom.kernels.types import Int32, Quaternion, Vector3, Vector4, func, real
from carom.layouts.contacts import THERE
from carom.layouts.queries import (
    ACTUATOR_FORCE,
    ACTUATOR_POSITION,
    ACTUATOR_VELOCITY,
    BALL_ANGULAR_VELOCITY,
    BALL_QUATERNION,
    FORCE,
    FRAME_ANGULAR_VELOCITY,
    FRAME_LINEAR_VELOCITY,
    FRAME_POSITION,
    FRAME_QUATERNION,
    FRAME_X_AXIS,
    GYRO,
    JOINT_ACTUATOR_FORCE,
    JOINT_LIMIT_FORCE,
    JOINT_LIMIT_POSITION,
    JOINT_POSITION,
    JOINT_VELOCITY,
    MAGNETOMETER,
    SUBTREE_CENTER_OF_MASS,
    SUBTREE_LINEAR_MOMENTUM,
    SUBTREE_LINEAR_VELOCITY,
    TORQUE,
    TOUCH,
    VELOCIMETER,
)


@func
def one_number(value: real) -> Vector4:
    """A result of one number."""
    return Vector4(value, 0.0, 0.0, 0.0)


@func
def three_of(value: Vector3) -> Vector4:
    """A result of three numbers."""
    return Vector4(value[0], value[1], value[2], 0.0)


@func
def four_of(value: Quaternion) -> Vector4:
    """A result of four numbers."""
    return Vector4(value[0], value[1], value[2], value[3])


@func
def measured_in_frame(scratch: Scratch, sensors: SensorTable, world: Int32, i: Int32) -> Vector4:
    """What a sensor measures at a frame of a link, seen from another frame or from the world."""
    kind = sensors.sensor[i].kind
    link = sensors.sensor[i].link
    at = sensors.sensor[i].position
    turn = turn_of_link(scratch, world, link) * sensors.sensor[i].turn
    if kind == GYRO:
        return three_of(wp.quat_rotate_inv(turn, scratch.link[world, link].omega))
    if kind == VELOCIMETER:
        return three_of(wp.quat_rotate_inv(turn, frame_velocity(scratch, world, link, at)))
    if kind == MAGNETOMETER:
        return three_of(wp.quat_rotate_inv(turn, sensors.sensor[i].vector))
    other = sensors.sensor[i].reference_link
    seen = Quaternion(0.0, 0.0, 0.0, 1.0)
    origin = Vector3(0.0, 0.0, 0.0)
    if other >= 0:
        seen = turn_of_link(scratch, world, other) * sensors.sensor[i].reference_turn
        origin = frame_position(scratch, world, other, sensors.sensor[i].reference_position)
    if kind == FRAME_POSITION:
        position = frame_position(scratch, world, link, at)
        if other >= 0:
            position = wp.quat_rotate_inv(seen, position - origin)
        return three_of(position)
    if kind == FRAME_LINEAR_VELOCITY:
        velocity = frame_velocity(scratch, world, link, at)
        if other >= 0:
            arm = frame_position(scratch, world, link, at) - origin
            carried = frame_velocity(scratch, world, other, sensors.sensor[i].reference_position)
            carried += wp.cross(scratch.link[world, other].omega, arm)
            velocity = wp.quat_rotate_inv(seen, velocity - carried)
        return three_of(velocity)
    if kind == FRAME_ANGULAR_VELOCITY:
        omega = scratch.link[world, link].omega
        if other >= 0:
            omega = wp.quat_rotate_inv(seen, omega - scratch.link[world, other].omega)
        return three_of(omega)
    if other >= 0:
        turn = wp.quat_inverse(seen) * turn
    if kind == FRAME_QUATERNION:
        return four_of(turn)
    axis = Vector3(0.0, 0.0, 0.0)
    axis[kind - FRAME_X_AXIS] = 1.0
    return three_of(wp.quat_rotate(turn, axis))


@func
def measured_load(
    model: Model, state: State, sensors: SensorTable, substep: real, world: Int32, i: Int32
) -> Vector4:
    """Force or torque of the parent on the link of a site in the last substep."""
    link = sensors.sensor[i].link
    load = state.link_load[world, link]
    force = Vector3(load[0], load[1], load[2])
    torque = Vector3(load[3], load[4], load[5])
    # The load leaves out what motors, limits and actuators of the joint itself exert along its axes.
    force, torque = with_joint_load(model, state, substep, world, link, force, torque)
    turn = sensors.sensor[i].turn
    if sensors.sensor[i].kind == FORCE:
        return three_of(wp.quat_rotate_inv(turn, force))
    return three_of(wp.quat_rotate_inv(turn, torque - wp.cross(sensors.sensor[i].position, force)))


@func
def measured_touch(
    scratch: Scratch,
    contacts: Contacts,
    sensors: SensorTable,
    substep: real,
    world: Int32,
    i: Int32,
) -> Vector4:
    """The sum of the normal forces of the contacts that the volume of a site counts."""
    link = sensors.sensor[i].link
    origin = frame_position(scratch, world, link, sensors.sensor[i].position)
    turn = turn_of_link(scratch, world, link) * sensors.sensor[i].turn
    total = real(0.0)
    for contact in range(contacts.count_contacts[world, THERE]):
        pair = contacts.contact_shapes[world, contact]
        push = contacts.contact_impulse[world, contact][0]
        if push > 0.0 and (pair[2] == link or pair[3] == link):
            # Normals point from b to a; outward of the link is away from the other one.
            outward = contacts.contact_normal[world, contact]
            if pair[2] == link:
                outward = -outward
            middle = contacts.contact_point_a[world, contact] + contacts.contact_point_b[world, contact]
            point = wp.quat_rotate_inv(turn, middle * 0.5 - origin)
            direction = wp.quat_rotate_inv(turn, outward)
            if is_touched(sensors.sensor[i].shape, sensors.sensor[i].vector, point, direction):
                total += push
    return one_number(total / substep)


@func
def measured_limit(model: Model, state: State, sensors: SensorTable, world: Int32, i: Int32) -> Vector4:
    """How far a joint is beyond its limit (not positive), or its velocity away from it; 0 within limits."""
    constraint = sensors.sensor[i].other_row
    if constraint < 0:
        return one_number(0.0)
    position = state.position[world, sensors.sensor[i].row]
    above = position - model.constraint_lower[world, constraint]
    below = model.constraint_upper[world, constraint] - position
    distance = wp.min(wp.min(above, below), 0.0)
    if sensors.sensor[i].kind == JOINT_LIMIT_POSITION:
        return one_number(distance)
    rate = state.dof_velocity[world, model.link[sensors.sensor[i].link].first_dof]
    if distance >= 0.0:
        return one_number(0.0)
    if above <= below:
        return one_number(rate)
    return one_number(-rate)


@func
def measured_actuators(model: Model, state: State, sensors: SensorTable, world: Int32, i: Int32) -> Vector4:
    """The force of all actuators of a joint on it, within its bounds."""
    total = real(0.0)
    first = sensors.sensor[i].row
    count = sensors.sensor[i].row_count
    for member in range(first, first + count):
        actuator = sensors.member_row[member]
        total += model.actuator_gear[world, actuator] * state.actuator_force[world, actuator]
    if count > 0:
        actuator = sensors.member_row[first]
        total = wp.max(total, model.actuator_joint_lower[world, actuator])
        total = wp.min(total, model.actuator_joint_upper[world, actuator])
    return one_number(total)


@func
def measured_in_joint(
    model: Model, state: State, sensors: SensorTable, substep: real, world: Int32, i: Int32
) -> Vector4:
    """What a sensor of a joint or of an actuator measures."""
    kind = sensors.sensor[i].kind
    row = sensors.sensor[i].row
    if kind == JOINT_POSITION:
        return one_number(state.position[world, row])
    if kind == JOINT_VELOCITY:
        return one_number(state.dof_velocity[world, row])
    if kind == JOINT_ACTUATOR_FORCE:
        return measured_actuators(model, state, sensors, world, i)
    if kind == BALL_QUATERNION:
        return Vector4(
            state.position[world, row],
            state.position[world, row + 1],
            state.position[world, row + 2],
            state.position[world, row + 3],
        )
    if kind == BALL_ANGULAR_VELOCITY:
        rate = Vector3(
            state.dof_velocity[world, row],
            state.dof_velocity[world, row + 1],
            state.dof_velocity[world, row + 2],
        )
        return three_of(wp.quat_rotate(sensors.sensor[i].turn, rate))
    if kind == JOINT_LIMIT_FORCE:
        return one_number(wp.abs(state.dof_limit_impulse[world, row]) / substep)
    if kind == ACTUATOR_FORCE:
        return one_number(state.actuator_force[world, row])
    if kind == ACTUATOR_POSITION or kind == ACTUATOR_VELOCITY:
        gear = model.actuator_gear[world, row]
        if kind == ACTUATOR_POSITION:
            return one_number(gear * state.position[world, sensors.sensor[i].other_row])
        return one_number(gear * state.dof_velocity[world, sensors.sensor[i].other_row])
    return measured_limit(model, state, sensors, world, i)


@func
def measured_subtree(model: Model, scratch: Scratch, sensors: SensorTable, world: Int32, i: Int32) -> Vector4:
    """Centre of mass, velocity or momentum of a link and all links after it."""
    kind = sensors.sensor[i].kind
    first = sensors.sensor[i].row
    last = first + sensors.sensor[i].row_count
    mass = real(0.0)
    center, velocity = Vector3(0.0, 0.0, 0.0), Vector3(0.0, 0.0, 0.0)
    for member in range(first, last):
        link = sensors.member_row[member]
        own = model.link_mass[world, link]
        mass += own
        center += own * center_of_link(scratch, world, link)
        velocity += own * center_velocity(scratch, world, link)
    if mass > 0.0:
        center, velocity = center / mass, velocity / mass
    else:
        # Without mass it is the first link.
        center = center_of_link(scratch, world, sensors.member_row[first])
        velocity = center_velocity(scratch, world, sensors.member_row[first])
    if kind == SUBTREE_CENTER_OF_MASS:
        return three_of(center)
    if kind == SUBTREE_LINEAR_VELOCITY:
        return three_of(velocity)
    if kind == SUBTREE_LINEAR_MOMENTUM:
        return three_of(velocity * mass)
    total = Vector3(0.0, 0.0, 0.0)
    for member in range(first, last):
        link = sensors.member_row[member]
        turn = turn_of_link(scratch, world, link)
        omega = wp.quat_rotate_inv(turn, scratch.link[world, link].omega)
        spin = wp.quat_rotate(turn, wp.cw_mul(model.link_inertia[world, link], omega))
        lever = center_of_link(scratch, world, link) - center
        speed = center_velocity(scratch, world, link) - velocity
        total += spin + model.link_mass[world, link] * wp.cross(lever, speed)
    return three_of(total)


@func
def measured(
    model: Model,
    state: State,
    scratch: Scratch,
    contacts: Contacts,
    sensors: SensorTable,
    world: Int32,
    i: Int32,
) -> Vector4:
    """What a sensor of any kind but of accelerations measures, of those that follow from the present."""
    kind = sensors.sensor[i].kind
    substep = sensors.number_given[0]
    if kind >= SUBTREE_CENTER_OF_MASS:
        return measured_subtree(model, scratch, sensors, world, i)
    if kind == FORCE or kind == TORQUE:
        return measured_load(model, state, sensors, substep, world, i)
    if kind == TOUCH:
        return measured_touch(scratch, contacts, sensors, substep, world, i)
    if kind >= JOINT_POSITION and kind <= ACTUATOR_FORCE:
        return measured_in_joint(model, state, sensors, substep, world, i)
    return measured_in_frame(scratch, sensors, world, i)
