"""The equations of motion of a body in a step that has been performed, linearised at its accelerations."""

import warp as wp

from carom.kernels.joints.coordinates import vector_at
from carom.kernels.linearization.matrices import clear, inverse_of_mass
from carom.kernels.mechanism.derivatives import put_vector, step_derivatives
from carom.kernels.mechanism.dynamics import turned_back
from carom.kernels.mechanism.many_bodies import take_parameters
from carom.kernels.mechanism.sweep import base_rotation, question_length, rates_of
from carom.kernels.structs import (
    MechanismBatch,
    MechanismSizes,
    MechanismTable,
    Model,
    Scratch,
    Settings,
    State,
    StepBatch,
    StepSpace,
    SweepTable,
)
from carom.kernels.types import Int32, func, kernel, real
from carom.layouts.codes import BASE_POSITIONS, PD_KD, PD_KP, PD_MAX_FORCE, PD_POSITION, PD_VELOCITY
from carom.layouts.linearization import OVERFLOWED
from carom.layouts.mechanism import POSE


@func
def read_velocities(
    model: Model,
    settings: Settings,
    scratch: Scratch,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
    dof: Int32,
):
    """Read the velocities of a dof before the step, after free motion, and of the solver."""
    first = 3 * place * space.dofs + dof
    row = space.dof_row[dof]
    tree = space.dof_tree[dof]
    before = scratch.dof[world, row].start_velocity
    free = before + settings.time_step * scratch.dof[world, row].free_acceleration
    entry = 4 * model.tree[tree].first_delta + space.dof_place[dof]
    steps.velocity[first] = before
    steps.velocity[first + space.dofs] = free
    steps.velocity[first + 2 * space.dofs] = free + scratch.entry_delta_velocity[world, entry]


@func
def write_question(
    sizes: MechanismSizes,
    batch: MechanismBatch,
    model: Model,
    settings: Settings,
    scratch: Scratch,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
    end: Int32,
    first: Int32,
    first_dof: Int32,
    first_position: Int32,
):
    """Write the question for the accelerations of free motion (0) or of the solver (1) from `first` on."""
    put_vector(batch.question, first, model.gravity_vector[world, 0])
    for index in range(BASE_POSITIONS + sizes.coordinates):
        batch.question[first + POSE + index] = scratch.position_start[world, first_position + index]
    rates = rates_of(sizes, first)
    changes = rates + sizes.dofs
    for index in range(sizes.dofs):
        before = 3 * place * space.dofs + first_dof + index
        rate = steps.velocity[before]
        after = steps.velocity[before + (1 + end) * space.dofs]
        batch.question[rates + index] = rate
        batch.question[changes + index] = (after - rate) / settings.time_step
    if sizes.base_dofs > 0:
        turn = base_rotation(batch.question, first)
        for part in range(2):
            own = rates + 3 * part
            put_vector(batch.question, own, turned_back(turn, vector_at(batch.question, own)))
            own = changes + 3 * part
            put_vector(batch.question, own, turned_back(turn, vector_at(batch.question, own)))


@func
def drive_gains(state: State, scratch: Scratch, space: StepSpace, world: Int32, dof: Int32, rate: real):
    """By how much explicit PD control falls with position and with velocity."""
    by_position = real(0.0)
    by_velocity = real(0.0)
    coordinate = space.dof_position[dof]
    if coordinate >= 0:
        drive = state.dof_pd[world, space.dof_row[dof]]
        bound = drive[PD_MAX_FORCE]
        position = scratch.position_start[world, coordinate]
        force = drive[PD_KP] * (drive[PD_POSITION] - position) + drive[PD_KD] * (drive[PD_VELOCITY] - rate)
        if bound > 0.0 and wp.abs(force) < bound:
            by_position = drive[PD_KP]
            by_velocity = drive[PD_KD]
    return by_position, by_velocity


@func
def put_forces(
    sizes: MechanismSizes,
    batch: MechanismBatch,
    model: Model,
    settings: Settings,
    state: State,
    scratch: Scratch,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
    end: Int32,
    start: Int32,
    first_dof: Int32,
):
    """Put derivatives of forces by positions and velocities, less those of motion, and the mass matrix."""
    count = sizes.dofs
    n = space.dofs
    for index in range(count):
        dof = first_dof + index
        row = space.dof_row[dof]
        target = ((2 * place + end) * n + dof) * space.columns + first_dof
        for other in range(count):
            steps.force[target + other] = -batch.answer[start + index * count + other]
            steps.force[target + n + other] = -batch.answer[start + (count + index) * count + other]
        stiffness = model.dof_stiffness[world, row]
        yielding = model.dof_implicit_damping[world, row] + 0.0
        if settings.explicit_forces == 0:
            yielding += settings.time_step * stiffness
        by_position, by_velocity = drive_gains(
            state, scratch, space, world, dof, steps.velocity[3 * place * n + dof]
        )
        # Springs of joints with several positions are added on the host.
        if space.dof_position[dof] >= 0:
            by_position += stiffness
        steps.force[target + index] -= by_position
        steps.force[target + n + index] -= yielding + model.dof_damping[world, row] + by_velocity
        if end == 0:
            matrix = (place * n + dof) * n + first_dof
            for other in range(count):
                steps.effective[matrix + other] = batch.answer[start + (2 * count + index) * count + other]
            if settings.explicit_forces == 0:
                steps.effective[matrix + index] += settings.time_step * yielding


@kernel
def motion_of_step_kernel(
    sizes: MechanismSizes,
    mechanism: MechanismTable,
    sweep: SweepTable,
    batch: MechanismBatch,
    settings: Settings,
    model: Model,
    state: State,
    scratch: Scratch,
    space: StepSpace,
    steps: StepBatch,
    first_dof: Int32,
    first_position: Int32,
    varied: Int32,
    first_world: Int32,
):
    """Write what a body adds to velocities, forces and mass matrices of a world; they are 0 before.

    The body's dofs in the tangent space begin at `first_dof`, its positions at `first_position`.
    """
    place = first_world + wp.tid()
    world = steps.world[place]
    if varied == 1:
        take_parameters(sizes, mechanism, batch, world)
    count = sizes.dofs
    for index in range(count):
        read_velocities(model, settings, scratch, space, steps, place, world, first_dof + index)
    for end in range(2):
        number = 2 * place + end
        start = number * 3 * count * count
        write_question(
            sizes, batch, model, settings, scratch, space, steps, place, world, end,
            number * question_length(sizes), first_dof, first_position,
        )  # fmt: skip
        clear(batch.answer, start, 3 * count * count)
        step_derivatives(sizes, mechanism, sweep, batch, number)
        if batch.answer[start] != batch.answer[start]:
            steps.problem[place] = OVERFLOWED
        put_forces(
            sizes, batch, model, settings, state, scratch, space, steps, place, world, end, start, first_dof
        )
    own = place * space.dofs * space.dofs + first_dof * (space.dofs + 1)
    inverse_of_mass(
        steps.inverse, own, steps.effective, own, space.dofs, count, steps.step,
        place * space.states * space.columns,
    )  # fmt: skip


@kernel
def derivatives_of_motion_kernel(
    sizes: MechanismSizes,
    mechanism: MechanismTable,
    sweep: SweepTable,
    batch: MechanismBatch,
    world: Int32,
    varied: Int32,
    first_world: Int32,
):
    """Answer a question by its number as `step_derivatives`, with the parameters of a world."""
    number = first_world + wp.tid()
    if varied == 1:
        take_parameters(sizes, mechanism, batch, world)
    clear(batch.answer, number * 3 * sizes.dofs * sizes.dofs, 3 * sizes.dofs * sizes.dofs)
    step_derivatives(sizes, mechanism, sweep, batch, number)
