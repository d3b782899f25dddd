"""What surfaces that move in their shapes, as belts do, change of the linearised rows of a contact."""

import warp as wp

from carom.kernels.linearization.contact_points import shape_frame
from carom.kernels.linearization.dof_motion import point_motion
from carom.kernels.linearization.link_rows import direction_of
from carom.kernels.structs import Shapes, State, StepBatch, StepSpace, TouchingLinks
from carom.kernels.types import Int32, Vector3, func, real
from carom.layouts.linearization import MOVES_A, MOVES_B


@func
def surface_at(state: State, shapes: Shapes, world: Int32, shape: Int32, point: Vector3):
    """The place of a shape, and velocity at a point and angular velocity of its surface in it."""
    pose = shape_frame(state, shapes, world, shape)
    turn = wp.transform_get_rotation(pose)
    origin = wp.transform_get_translation(pose)
    spin = wp.quat_rotate(turn, shapes.shape_surface_spin[world, shape])
    slip = wp.quat_rotate(turn, shapes.shape_surface_velocity[world, shape])
    return origin, slip + wp.cross(spin, point - origin), spin


@func
def surface_change(
    steps: StepBatch, entry: Int32, side: Int32, origin: Vector3, point: Vector3, moved: Vector3,
    slip: Vector3, spin: Vector3,
):  # fmt: skip
    """Changes of such velocities by a dof, whose entry is given; `moved` is the motion of the point."""
    slipped, spun = wp.cross(spin, moved), Vector3(0.0, 0.0, 0.0)
    if steps.reach_side[entry] & side != 0:
        axis = steps.axis_angular[entry]
        spun = wp.cross(axis, spin)
        # As if all turned with the shape, but for the point, which has its own motion.
        carried = point_motion(steps, entry, point)
        slipped = wp.cross(axis, slip) + wp.cross(spin, moved - carried)
    return slipped, spun


@func
def add_surface(
    state: State,
    shapes: Shapes,
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    world: Int32,
    touch: TouchingLinks,
    row: Int32,
    number: Int32,
    angular: Int32,
    kept: real,
) -> real:
    """Add to `steps.rate` of a row of friction what follows from surfaces that move, 0 if none does.

    Args:
        state: The state.
        shapes: The shapes.
        space: The tangent space.
        steps: The steps.
        place: The place.
        world: The world.
        touch: The contact.
        row: The row among the rows of all worlds.
        number: Its direction.
        angular: 1 for a row about it.
        kept: Which share of the velocity before the step it keeps.

    Returns:
        What the surfaces add to its rate, less that share.
    """
    if touch.surface_moves == 0 or (angular == 1 and number > 0):
        return real(0.0)
    n = space.dofs
    share = 1.0 - kept
    middle = 0.5 * (touch.point_a + touch.point_b)
    origin_a, slip_a, spin_a = surface_at(state, shapes, world, touch.shape_a, middle)
    origin_b, slip_b, spin_b = surface_at(state, shapes, world, touch.shape_b, middle)
    direction = direction_of(touch, number)
    motion = wp.where(angular == 1, spin_a - spin_b, slip_a - slip_b)
    for index in range(touch.reach):
        dof = steps.reach[place * n + index]
        entry = place * n + dof
        moved = 0.5 * (steps.moved_a[entry] + steps.moved_b[entry])
        slipped_a, spun_a = surface_change(
            steps, entry, Int32(MOVES_A), origin_a, middle, moved, slip_a, spin_a
        )
        slipped_b, spun_b = surface_change(
            steps, entry, Int32(MOVES_B), origin_b, middle, moved, slip_b, spin_b
        )
        changed = wp.where(angular == 1, spun_a - spun_b, slipped_a - slipped_b)
        turned = steps.turned[(3 * place + number) * n + dof]
        steps.rate[row * n + dof] += share * (wp.dot(turned, motion) + wp.dot(direction, changed))
    return share * wp.dot(direction, motion)
