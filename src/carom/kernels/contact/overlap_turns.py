"""When Bullet finds a new overlap, see `overlaps`."""

import warp as wp

from carom.kernels.contact.bounds import boxes_meet, is_bounded, made_bounds
from carom.kernels.contact.resets import is_moved
from carom.kernels.structs import Model, Pairs, Settings, Shapes, State
from carom.kernels.types import Index2, Int32, Vector3, func, real

# When bounds are brought up to date: when a body is created; when it is reset; in the step.
STAGES = wp.constant(3)


@func
def widening_of(settings: Settings) -> real:
    """How far Bullet widens the bounds of a body on each side, except when it is created [m]."""
    return 0.5 * settings.near


@func
def meet(pairs: Pairs, world: Int32, a: Int32, b_lower: Vector3, b_upper: Vector3, widening: real) -> bool:
    """Whether the present bounds of shape a and others meet, if both together are so much wider."""
    return boxes_meet(pairs.shape_lower[world, a], pairs.shape_upper[world, a], b_lower, b_upper, widening)


@func
def bounds_before(
    settings: Settings,
    shapes: Shapes,
    model: Model,
    state: State,
    pairs: Pairs,
    world: Int32,
    shape: Int32,
    known: Int32,
    is_reset: bool,
):
    """Minimum and maximum corner of the bounds that Bullet has of a shape until they are brought up to date.

    Those of a new shape, one from row `known` on, are those with which it was created. Other ones have moved
    on since, unless the shape was reset; of that motion only the velocity of its base is known.
    """
    if shape >= known:
        return made_bounds(shapes, model, state, pairs, world, shape)
    back = Vector3(0.0, 0.0, 0.0)
    if not is_reset:
        first = model.tree[shapes.shape_tree[shape]].first_velocity
        back = settings.time_step * Vector3(
            state.dof_velocity[world, first + 3],
            state.dof_velocity[world, first + 4],
            state.dof_velocity[world, first + 5],
        )
    return pairs.shape_lower[world, shape] - back, pairs.shape_upper[world, shape] - back


@func
def turn_of(
    settings: Settings,
    shapes: Shapes,
    model: Model,
    state: State,
    pairs: Pairs,
    world: Int32,
    pair: Index2,
    known: Int32,
    resets: Int32,
) -> Int32:
    """When Bullet finds a new overlap, as a number that increases with time.

    New bodies are compared with those before them, by bounds that are not widened, and that are those of
    `bounds.made_bounds`; then those that have been reset, see `resets`. Then the bounds of one body after the
    other are brought up to date and compared with those of all others, of which the later ones are still
    where they were.

    Args:
        settings: Time step, number of shapes.
        shapes: All shapes.
        model: The trees.
        state: Their velocities.
        pairs: Bounds of the shapes.
        world: The world.
        pair: The two shapes.
        known: Number of shapes that are not new.
        resets: Number of shapes that have been reset.
    """
    # What stands for the links of both.
    a = shapes.link_first_shape[shapes.shape_link[pair[0]]]
    b = shapes.link_first_shape[shapes.shape_link[pair[1]]]
    place_a = Int32(-1)
    place_b = Int32(-1)
    if resets > 0:
        place_a = pairs.shape_reset_place[world, a]
        place_b = pairs.shape_reset_place[world, b]
    moved_a = is_moved(shapes, state, pairs, world, a, resets)
    moved_b = is_moved(shapes, state, pairs, world, b, resets)
    b_is_new = b >= known
    # The bounds of a plane meet those of all others wherever they are.
    is_with_plane = not (is_bounded(shapes, pair[0]) and is_bounded(shapes, pair[1]))
    if b_is_new and (is_with_plane or not (moved_a or moved_b)):
        widening = wp.where(a < known, widening_of(settings), real(0.0))
        lower, upper = bounds_before(settings, shapes, model, state, pairs, world, a, known, False)
        made_lower, made_upper = made_bounds(shapes, model, state, pairs, world, b)
        if boxes_meet(made_lower, made_upper, lower, upper, widening):
            return b
    if place_a >= 0 or place_b >= 0:
        if place_b >= 0 and (place_a < 0 or place_b < place_a):
            return turn_of_reset(settings, shapes, model, state, pairs, world, b, a, moved_a, known)
        return turn_of_reset(settings, shapes, model, state, pairs, world, a, b, moved_b, known)
    widening = wp.where(b_is_new, widening_of(settings), settings.near)
    lower, upper = bounds_before(settings, shapes, model, state, pairs, world, b, known, False)
    if meet(pairs, world, a, lower, upper, widening):
        return 2 * settings.shape_count + a
    return 2 * settings.shape_count + b


@func
def turn_of_reset(
    settings: Settings,
    shapes: Shapes,
    model: Model,
    state: State,
    pairs: Pairs,
    world: Int32,
    a: Int32,
    b: Int32,
    b_was_moved: bool,
    known: Int32,
) -> Int32:
    """`turn_of` where shape a has been reset, and b later, which `b_was_moved`, or not."""
    place = pairs.shape_reset_place[world, b]
    if not b_was_moved:
        b_is_new = b >= known
        widening = wp.where(b_is_new, widening_of(settings), settings.near)
        lower, upper = bounds_before(settings, shapes, model, state, pairs, world, b, known, place >= 0)
        if meet(pairs, world, a, lower, upper, widening):
            return settings.shape_count + pairs.shape_reset_place[world, a]
    if place >= 0:
        return settings.shape_count + place
    return 2 * settings.shape_count + b
