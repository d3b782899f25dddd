"""Reading all sensors of a body in one launch: the work is done when they are read, not in each step."""

import warp as wp

from carom.kernels.sensors.frames import frame_velocity, place_links, turn_of_link
from carom.kernels.sensors.last_loads import settle_loads
from carom.kernels.sensors.measures import measured
from carom.kernels.structs import Contacts, Model, Scratch, SensorTable, State
from carom.kernels.types import Int32, Vector3, Vector4, func, kernel
from carom.layouts.queries import (
    ACCELEROMETER,
    CLOCK,
    FRAME_ANGULAR_ACCELERATION,
    FRAME_LINEAR_ACCELERATION,
)


@func
def is_of_steps(kind: Int32) -> bool:
    """Whether sensors of a kind measure accelerations, which are known only after a step."""
    return kind == ACCELEROMETER or kind == FRAME_LINEAR_ACCELERATION or kind == FRAME_ANGULAR_ACCELERATION


@func
def keep(sensors: SensorTable, i: Int32, first: Int32, value: Vector4):
    """Store what a sensor has measured, with its bias and within its bounds."""
    for k in range(sensors.sensor[i].dim):
        shown = value[k] + sensors.sensor[i].bias[k]
        sensors.value_shown[first + k] = wp.min(
            wp.max(shown, sensors.sensor[i].lower), sensors.sensor[i].upper
        )


@func
def measure_step(
    model: Model,
    state: State,
    scratch: Scratch,
    sensors: SensorTable,
    world: Int32,
    tree: Int32,
    first: Int32,
    count: Int32,
):
    """Measure accelerations in the last step of a tree, from the motion that the step has kept."""
    last = state.tree_last_step[world, tree]
    then = State()
    then = state
    then.position = state.position_before
    then.dof_velocity = state.dof_velocity_before
    place_links(model, then, scratch, world, tree)
    for i in range(count):
        if is_of_steps(sensors.sensor[i].kind):
            link = sensors.sensor[i].link
            velocity = scratch.link[world, link].omega
            if sensors.sensor[i].kind != FRAME_ANGULAR_ACCELERATION:
                velocity = frame_velocity(scratch, world, link, sensors.sensor[i].position)
            for k in range(3):
                sensors.value_shown[first + sensors.sensor[i].first_value + k] = velocity[k]
    then.position = state.position_after
    then.dof_velocity = state.dof_velocity_after
    place_links(model, then, scratch, world, tree)
    for i in range(count):
        kind = sensors.sensor[i].kind
        if is_of_steps(kind):
            link = sensors.sensor[i].link
            place = first + sensors.sensor[i].first_value
            before = Vector3(
                sensors.value_shown[place], sensors.value_shown[place + 1], sensors.value_shown[place + 2]
            )
            velocity = scratch.link[world, link].omega
            if kind != FRAME_ANGULAR_ACCELERATION:
                velocity = frame_velocity(scratch, world, link, sensors.sensor[i].position)
            rate = (velocity - before) / last[3]
            if kind != FRAME_ANGULAR_ACCELERATION:
                rate -= Vector3(last[0], last[1], last[2])
            if kind == ACCELEROMETER:
                turn = turn_of_link(scratch, world, link) * sensors.sensor[i].turn
                rate = wp.quat_rotate_inv(turn, rate)
            keep(sensors, i, place, Vector4(rate[0], rate[1], rate[2], 0.0))


@kernel
def sensors_kernel(
    model: Model,
    state: State,
    scratch: Scratch,
    contacts: Contacts,
    sensors: SensorTable,
    tree: Int32,
    sensor_count: Int32,
    tree_count: Int32,
    of_steps: Int32,
    of_loads: Int32,
    width: Int32,
    first_world: Int32,
):
    """Store what sensors of a tree show in each world, `width` numbers each.

    Some are of accelerations if `of_steps` is not 0, some of forces if `of_loads` is not 0. Accelerations
    before the first step are left as they are.
    """
    world = first_world + wp.tid()
    first = world * width
    if of_loads != 0:
        settle_loads(model, state, scratch, world, tree)
    if of_steps != 0 and state.tree_last_step[world, tree][3] > 0.0:
        measure_step(model, state, scratch, sensors, world, tree, first, sensor_count)
    for i in range(tree_count):
        place_links(model, state, scratch, world, sensors.tree_number[i])
    for i in range(sensor_count):
        kind = sensors.sensor[i].kind
        place = first + sensors.sensor[i].first_value
        if kind == CLOCK:
            keep(sensors, i, place, Vector4(sensors.value_shown[place], 0.0, 0.0, 0.0))
        elif not is_of_steps(kind):
            keep(sensors, i, place, measured(model, state, scratch, contacts, sensors, world, i))
