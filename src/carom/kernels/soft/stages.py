"""The stages of a step of soft bodies, one kernel for each."""

import warp as wp

from carom.kernels.contact.bounds import place_shapes
from carom.kernels.maths.min_max import maximum
from carom.kernels.soft.contact import move_anchors, move_touches, relax_anchors, relax_touches
from carom.kernels.soft.damping import damp_springs, damp_tetras
from carom.kernels.soft.elasticity import relax_springs, relax_tetras
from carom.kernels.soft.face_contact import move_face_touches, relax_face_touches
from carom.kernels.soft.face_touches import find_face_touches, write_face_touches
from carom.kernels.soft.feedback import report_pushes, wake_held
from carom.kernels.soft.frames import carry_nodes, follow_nodes, report_nodes
from carom.kernels.soft.neighbours import find_neighbours, relax_neighbours
from carom.kernels.soft.pushes import exchange_velocities, keep_velocities, take_over_pushes
from carom.kernels.soft.touches import find_touches, write_anchors, write_touches
from carom.kernels.structs import (
    Model,
    PairRows,
    Pairs,
    Scratch,
    Settings,
    Shapes,
    SoftModel,
    SoftWork,
    State,
)
from carom.kernels.types import Int32, Vector3, called_func, func, kernel, real
from carom.layouts.soft import BODIES
from carom.layouts.status import STATUS, WELL

# Largest phase of the fastest vibration in one small step [rad], as long as the number of small steps stays
# within its limit.
_PHASE = real(1.0)
_MIN_STEPS = 4
_MAX_STEPS = 128


@func
def node_end(soft: SoftModel, body: Int32) -> Int32:
    """The row after the last node of a body."""
    return soft.soft[body].first_node + soft.soft[body].node_count


@func
def small_steps(soft: SoftModel, dt: real) -> Int32:
    """Number of small steps in a substep of `dt` [s]."""
    frequency = real(0.0)
    for body in range(soft.count_soft[BODIES]):
        frequency = maximum(frequency, soft.soft[body].frequency)
    wanted = wp.min(wp.ceil(frequency * dt / _PHASE), real(_MAX_STEPS))
    return wp.max(Int32(wanted), Int32(_MIN_STEPS))


@func
def move_freely(
    model: Model, soft: SoftModel, state: State, soft_work: SoftWork, world: Int32, body: Int32, h: real
):
    """Move nodes under gravity and users' forces."""
    gravity = model.gravity_vector[world, 0] * soft.soft[body].gravity_factor
    for node in range(soft.soft[body].first_node, node_end(soft, body)):
        position = state.node_position[world, node]
        soft_work.node_before[world, node] = position
        if soft.node_inverse_mass[node] > 0.0:
            acceleration = gravity + state.node_force[world, node] * soft.node_inverse_mass[node]
            velocity = state.node_velocity[world, node] + acceleration * h
            state.node_position[world, node] = position + velocity * h


@func
def take_velocities(soft: SoftModel, state: State, soft_work: SoftWork, world: Int32, body: Int32, h: real):
    """Set the velocities of nodes from their displacements in a small step of `h` [s]."""
    for node in range(soft.soft[body].first_node, node_end(soft, body)):
        moved = state.node_position[world, node] - soft_work.node_before[world, node]
        state.node_velocity[world, node] = moved / h


@func
def have_neighbours(soft: SoftModel) -> bool:
    """Whether nodes may collide with faces: there are several soft bodies, or one has self-collision."""
    count = soft.count_soft[BODIES]
    found = count > 1
    for body in range(count):
        if soft.soft[body].self_collision != 0:
            found = True
    return found


@called_func
def take_small_steps(
    settings: Settings,
    model: Model,
    shapes: Shapes,
    scratch: Scratch,
    pair_rows: PairRows,
    soft: SoftModel,
    state: State,
    soft_work: SoftWork,
    world: Int32,
    neighbours: bool,
):
    """Move all soft bodies through a substep; trees keep their velocities, except for pushes by nodes."""
    count = small_steps(soft, settings.time_step)
    h = settings.time_step / real(count)
    for _step in range(count):
        for body in range(soft.count_soft[BODIES]):
            move_freely(model, soft, state, soft_work, world, body, h)
            relax_springs(soft, state, soft_work, world, body, h)
            relax_tetras(soft, state, soft_work, world, body, h)
        relax_anchors(scratch, pair_rows, soft, state, soft_work, world, h)
        for body in range(soft.count_soft[BODIES]):
            if neighbours:
                relax_neighbours(shapes, model, soft, state, soft_work, world, body, h)
            relax_touches(scratch, pair_rows, soft, state, soft_work, world, body, h)
            relax_face_touches(scratch, pair_rows, soft, state, soft_work, world, body, h)
        move_anchors(scratch, pair_rows, soft, soft_work, world, h)
        for body in range(soft.count_soft[BODIES]):
            move_touches(scratch, pair_rows, soft, soft_work, world, body, h)
            move_face_touches(scratch, pair_rows, soft, soft_work, world, body, h)
            take_velocities(soft, state, soft_work, world, body, h)
            damp_springs(soft, state, world, body, h)
            damp_tetras(soft, state, world, body, h)


@func
def keep_nodes(soft: SoftModel, state: State, soft_work: SoftWork, world: Int32, body: Int32):
    """Save the positions, velocities and contact forces of a body's nodes at the start of a step."""
    for node in range(soft.soft[body].first_node, node_end(soft, body)):
        soft_work.node_start_position[world, node] = state.node_position[world, node]
        soft_work.node_start_velocity[world, node] = state.node_velocity[world, node]
        soft_work.node_start_push[world, node] = state.node_push[world, node]


@func
def clear_node_forces(soft: SoftModel, state: State, world: Int32, body: Int32):
    """Clear the users' forces on a body's nodes; they act for one step."""
    for node in range(soft.soft[body].first_node, node_end(soft, body)):
        state.node_force[world, node] = Vector3(0.0, 0.0, 0.0)


@func
def return_nodes(soft: SoftModel, state: State, soft_work: SoftWork, world: Int32, body: Int32):
    """Restore a body's nodes as they were at the start of the step; clear their forces if the step failed.

    A step that is to be repeated with longer arrays needs them.
    """
    for node in range(soft.soft[body].first_node, node_end(soft, body)):
        state.node_position[world, node] = soft_work.node_start_position[world, node]
        state.node_velocity[world, node] = soft_work.node_start_velocity[world, node]
        state.node_push[world, node] = soft_work.node_start_push[world, node]
    if state.status_entry[world, STATUS] > WELL:
        clear_node_forces(soft, state, world, body)


@func
def start_soft_motion(
    settings: Settings,
    model: Model,
    state: State,
    shapes: Shapes,
    pairs: Pairs,
    soft_work: SoftWork,
    world: Int32,
):
    """Place all shapes, and give all trees the velocities that they had at the start of the substep."""
    place_shapes(shapes, state, settings, pairs, world)
    for tree in range(settings.tree_count):
        soft_work.tree_ready[world, tree] = 0
    exchange_velocities(settings, model, state, soft_work, world)


@called_func
def write_rows(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    shapes: Shapes,
    pair_rows: PairRows,
    soft: SoftModel,
    soft_work: SoftWork,
    world: Int32,
):
    """Write the rows of all touches and anchors; the status of the world tells if they do not fit."""
    row, block = Int32(0), Int32(0)
    for body in range(soft.count_soft[BODIES]):
        row, block = write_touches(
            settings, shapes, model, state, scratch, pair_rows, soft, soft_work, world, body, row, block
        )
        row, block = write_face_touches(
            settings, shapes, model, state, scratch, pair_rows, soft, soft_work, world, body, row, block
        )
    write_anchors(settings, model, state, scratch, pair_rows, soft, soft_work, world, row, block)
    wake_held(model, state, soft, world)


@func
def end_soft_motion(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    soft: SoftModel,
    soft_work: SoftWork,
    world: Int32,
):
    """Give all trees their velocities back, with the pushes of soft bodies; report faulty bodies."""
    # Reported before the trees that faulty nodes have pushed are found to be not finite as well.
    for body in range(soft.count_soft[BODIES]):
        report_nodes(state, soft, world, body)
    exchange_velocities(settings, model, state, soft_work, world)
    take_over_pushes(settings, model, state, scratch, world)


@kernel
def begin_soft_kernel(soft: SoftModel, state: State, soft_work: SoftWork, first_world: Int32):
    """Save the positions and velocities of nodes at the start of a step."""
    world = first_world + wp.tid()
    for body in range(soft.count_soft[BODIES]):
        keep_nodes(soft, state, soft_work, world, body)


@kernel
def keep_velocities_kernel(
    settings: Settings, model: Model, state: State, soft_work: SoftWork, first_world: Int32
):
    """Save the velocities of trees at the start of a substep."""
    world = first_world + wp.tid()
    for tree in range(settings.tree_count):
        keep_velocities(model, state, soft_work, world, tree)


@kernel
def soft_motion_kernel(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    shapes: Shapes,
    pairs: Pairs,
    pair_rows: PairRows,
    soft: SoftModel,
    soft_work: SoftWork,
    first_world: Int32,
):
    """Move all soft bodies through a substep, after the free motion of trees."""
    world = first_world + wp.tid()
    start_soft_motion(settings, model, state, shapes, pairs, soft_work, world)
    for body in range(soft.count_soft[BODIES]):
        find_touches(settings, shapes, model, state, scratch, pairs, soft, soft_work, world, body)
        find_face_touches(settings, shapes, model, state, scratch, pairs, soft, soft_work, world, body)
    write_rows(settings, model, state, scratch, shapes, pair_rows, soft, soft_work, world)
    if state.status_entry[world, STATUS] == WELL:
        neighbours = have_neighbours(soft)
        if neighbours:
            find_neighbours(settings, shapes, model, state, soft, soft_work, world)
        take_small_steps(
            settings, model, shapes, scratch, pair_rows, soft, state, soft_work, world, neighbours
        )
        report_pushes(settings, shapes, model, state, scratch, soft, soft_work, world)
    end_soft_motion(settings, model, state, scratch, soft, soft_work, world)


@kernel
def find_touches_kernel(
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    shapes: Shapes,
    pairs: Pairs,
    soft: SoftModel,
    soft_work: SoftWork,
    world: Int32,
):
    """Find the nodes and faces near each shape at their current positions; for queries between steps."""
    place_shapes(shapes, state, settings, pairs, world)
    for body in range(soft.count_soft[BODIES]):
        find_touches(settings, shapes, model, state, scratch, pairs, soft, soft_work, world, body)
        find_face_touches(settings, shapes, model, state, scratch, pairs, soft, soft_work, world, body)


@kernel
def end_soft_kernel(soft: SoftModel, state: State, first_world: Int32):
    """Clear the users' forces on nodes after a complete step."""
    world = first_world + wp.tid()
    for body in range(soft.count_soft[BODIES]):
        clear_node_forces(soft, state, world, body)


@kernel
def abandon_soft_kernel(soft: SoftModel, state: State, soft_work: SoftWork, first_world: Int32):
    """Restore the nodes as they were at the start of the step; clear their forces if the step failed."""
    world = first_world + wp.tid()
    for body in range(soft.count_soft[BODIES]):
        return_nodes(soft, state, soft_work, world, body)


@kernel
def carry_nodes_kernel(model: Model, state: State, soft: SoftModel, first_world: Int32):
    """Put anchored nodes where single bodies have moved; update the base pose and velocity of soft bodies."""
    world = first_world + wp.tid()
    for body in range(soft.count_soft[BODIES]):
        carry_nodes(model, state, soft, world, body)
        follow_nodes(model, state, soft, world, body)


@kernel
def follow_nodes_kernel(model: Model, state: State, soft: SoftModel, first_world: Int32):
    """Update the base pose and velocity of all soft bodies from their nodes."""
    world = first_world + wp.tid()
    for body in range(soft.count_soft[BODIES]):
        follow_nodes(model, state, soft, world, body)
