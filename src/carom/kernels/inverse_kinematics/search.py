"""The search for joint positions at which the ends of a chain reach their targets.

PyBullet's iteration comes first, so that the result is the same if it converges. If it does not converge, or
leaves errors of angles or violated limits, the search may continue from there with the Levenberg-Marquardt
method within the limits, which converges quadratically. In a local minimum it restarts from random poses
around the initial one, at increasing distances.
"""

import warp as wp

from carom.kernels.inverse_kinematics.kinematics import (
    Errors,
    advance,
    copy,
    fill_jacobian,
    measure_errors,
    place,
    turn_joints,
)
from carom.kernels.inverse_kinematics.selective_step import selective_step
from carom.kernels.inverse_kinematics.steps import bounded_step, damped_step, null_space_step
from carom.kernels.structs import Chain, ChainSizes, Search
from carom.kernels.types import Int32, Quaternion, Reals, Vector3, func, kernel, real
from carom.layouts.chain import DAMPED, NULL_SPACE, SELECTIVE

# Iteration ends when the largest change of a joint is smaller than this.
_NO_STEP = real(1e-14)
_MIN_THRESHOLD = real(1e-9)
# Damping relative to the sum of squared errors, and the damping that remains at the target.
_DAMPING_BY_ERROR = real(0.5)
_MIN_DAMPING = real(1e-8)
_TRIES = wp.constant(6)
# A local minimum is assumed after this many steps (_SLOW_STEPS), each with at least this share
# (_LITTLE_PROGRESS) of the squared errors of the step before.
_LITTLE_PROGRESS = real(0.999)
_SLOW_STEPS = wp.constant(3)
# Least tolerance [m] with `patience`: a search that is repeated in each time step gets nearer each time.
_NEAR = real(0.02)
# Minimum number of poses to try with limits: often only a very different pose of the arm is within them.
_WITHIN_LIMITS = wp.constant(300)
# Hysteresis: a restart that does not reach the target either is taken only if its squared errors are at most
# this share of the best, so that repeated searches do not make an arm jump for a small gain.
_WORTH_A_JUMP = real(0.8)
# Share of the joints' ranges within which the first restart is drawn.
_FIRST_SPREAD = real(0.05)


@func
def follow(
    sizes: ChainSizes,
    chain: Chain,
    search: Search,
    oriented: Int32,
    step_kind: Int32,
    iterations: Int32,
    threshold: real,
):
    """PyBullet's iteration. It measures errors before each step, so it does one more step at the target."""
    blocks = (1 + oriented) * sizes.ends
    iteration = Int32(0)
    while iteration < iterations:
        place(sizes, chain, search, search.coordinate_now)
        errors = measure_errors(sizes, chain, search, oriented)
        fill_jacobian(sizes, chain, search, search.coordinate_now, oriented)
        greatest = real(0.0)
        if step_kind == NULL_SPACE:
            greatest = null_space_step(sizes, chain, search, search.coordinate_now, blocks)
        elif step_kind == SELECTIVE:
            greatest = selective_step(sizes, chain, search, blocks)
        else:
            greatest = damped_step(sizes, chain, search, blocks)
        advance(sizes, chain, search, search.coordinate_now, search.coordinate_now)
        iteration += 1
        if errors.distance <= threshold or greatest < _NO_STEP:
            iteration = iterations


@func
def keep_limits(sizes: ChainSizes, chain: Chain, search: Search, coordinates: Reals) -> Int32:
    """Clamp joint positions to their limits; returns 1 if any was outside."""
    changed = Int32(0)
    for dof in range(sizes.dofs):
        coordinate = chain.dof_coordinate[dof]
        if coordinate >= 0:
            position = coordinates[coordinate]
            within = wp.clamp(position, search.dof[dof].lower, search.dof[dof].upper)
            if within != position:
                coordinates[coordinate] = within
                changed = Int32(1)
    return changed


@func
def descend(
    sizes: ChainSizes,
    chain: Chain,
    search: Search,
    oriented: Int32,
    budget: Int32,
    threshold: real,
    errors: Errors,
):
    """Minimise the errors from `coordinate_now` on, until they are below the threshold or progress is slow.

    `search` has joint frames and errors at `coordinate_now`, as has `errors`. `oriented` is 1 if the ends
    have target orientations as well, `threshold` the tolerance of distances [m] and angles [rad]. At most
    `budget` poses are tried. Returns the errors at the end, and the number of poses tried.
    """
    blocks = (1 + oriented) * sizes.ends
    tried, slow = Int32(0), Int32(0)
    left = errors
    growth = real(1.0)
    while tried < budget and slow < _SLOW_STEPS and (left.distance > threshold or left.angle > threshold):
        fill_jacobian(sizes, chain, search, search.coordinate_now, oriented)
        attempt, better = Int32(0), Int32(0)
        while better == 0 and attempt < _TRIES and tried < budget:
            damping = growth * _DAMPING_BY_ERROR * left.squares + _MIN_DAMPING
            bounded_step(sizes, chain, search, search.coordinate_now, blocks, damping)
            advance(sizes, chain, search, search.coordinate_now, search.coordinate_trial)
            place(sizes, chain, search, search.coordinate_trial)
            trial = measure_errors(sizes, chain, search, oriented)
            tried += 1
            attempt += 1
            if trial.squares < left.squares:
                better = Int32(1)
                growth = wp.max(0.25 * growth, real(1.0e-3))
                slow += 1
                if trial.squares < _LITTLE_PROGRESS * left.squares:
                    slow = Int32(0)
                left = trial
                copy(sizes.coordinates, search.coordinate_trial, search.coordinate_now)
            else:
                growth *= 8.0
                # The next attempt starts from this pose again and needs its errors.
                place(sizes, chain, search, search.coordinate_now)
                measure_errors(sizes, chain, search, oriented)
        if better == 0:
            slow = _SLOW_STEPS
    return left, tried


@func
def scatter(sizes: ChainSizes, chain: Chain, search: Search, spread: real, seed: Int32):
    """Draw a new start, `coordinate_now`, within a share of the joints' ranges around `coordinate_start`."""
    copy(sizes.coordinates, search.coordinate_start, search.coordinate_now)
    random = wp.rand_init(seed)
    for column in range(sizes.columns):
        dof = chain.column[column].dof
        low = chain.column[column].low
        high = chain.column[column].high
        if search.dof[dof].lower > -1.0e6 and search.dof[dof].upper < 1.0e6:
            low = search.dof[dof].lower
            high = search.dof[dof].upper
        offset = spread * (high - low) * (real(wp.randf(random)) - 0.5) * 2.0
        coordinate = chain.dof_coordinate[dof]
        search.dof[dof].step = offset
        if coordinate >= 0:
            search.coordinate_now[coordinate] = wp.clamp(
                search.coordinate_start[coordinate] + offset, low, high
            )
    turn_joints(sizes, chain, search, search.coordinate_start, search.coordinate_now)


@func
def take_targets(sizes: ChainSizes, search: Search):
    """Convert the given targets to the frame of the base."""
    origin = Vector3(search.base_pose[0], search.base_pose[1], search.base_pose[2])
    base = Quaternion(search.base_pose[3], search.base_pose[4], search.base_pose[5], search.base_pose[6])
    for end in range(sizes.ends):
        search.end_target_position[end] = wp.quat_rotate_inv(base, search.end_given_position[end] - origin)
        search.end_target_rotation[end] = wp.quat_inverse(base) * wp.normalize(search.end_given_rotation[end])


@func
def find_coordinates(
    sizes: ChainSizes,
    chain: Chain,
    search: Search,
    oriented: Int32,
    step_kind: Int32,
    bounded: Int32,
    iterations: Int32,
    further: Int32,
    threshold: real,
    patience: real,
):
    """Search for joint positions and write them to `coordinate_best`.

    `oriented` is 1 if the ends have target orientations as well, `bounded` 1 if there are limits, `threshold`
    the tolerance of distances [m] and angles [rad]. PyBullet's iteration has at most `iterations` steps of
    the method `step_kind`: `DAMPED`, `NULL_SPACE` or `SELECTIVE`. After it `further` poses may be tried; with
    limits at least `_WITHIN_LIMITS`. PyBullet's result is taken, converged or not, if at most the share
    `patience` of the distance is left.
    """
    take_targets(sizes, search)
    for column in range(sizes.columns):
        search.column[column].held = 0
        search.column[column].weight = real(1.0)
        if step_kind == DAMPED:
            search.column[column].weight = 1.0 / search.dof[chain.column[column].dof].damping
    for dof in range(sizes.dofs):
        search.dof[dof].step = real(0.0)
    copy(sizes.coordinates, search.coordinate_start, search.coordinate_now)
    bearable = real(0.0)
    if patience > 0.0:
        place(sizes, chain, search, search.coordinate_now)
        first = measure_errors(sizes, chain, search, oriented)
        bearable = wp.max(patience * first.distance, _NEAR)
    follow(sizes, chain, search, oriented, step_kind, iterations, threshold)
    outside = keep_limits(sizes, chain, search, search.coordinate_now) if bounded == 1 else Int32(0)
    place(sizes, chain, search, search.coordinate_now)
    errors = measure_errors(sizes, chain, search, oriented)
    copy(sizes.coordinates, search.coordinate_now, search.coordinate_best)
    goal = wp.max(threshold, _MIN_THRESHOLD)
    if errors.distance <= goal and errors.angle <= goal:
        return
    if errors.distance <= bearable and outside == 0:
        return

    # PyBullet's iteration checks distances only. If they are within tolerance (`content`), its result is
    # replaced only by one whose angles are within tolerance as well.
    content = errors.distance <= goal and outside == 0
    best = errors.squares
    if step_kind == DAMPED:
        mean = real(0.0)
        for column in range(sizes.columns):
            mean += search.column[column].weight / real(sizes.columns)
        for column in range(sizes.columns):
            search.column[column].weight = search.column[column].weight / mean
    for dof in range(sizes.dofs):
        search.dof[dof].step = real(0.0)
    left = wp.max(further, _WITHIN_LIMITS) if bounded == 1 and not content else further
    spread = _FIRST_SPREAD
    worth = real(1.0)
    seed = Int32(1)
    while left > 0:
        found, tried = descend(sizes, chain, search, oriented, left, goal, errors)
        left -= tried + 1
        arrived = found.distance <= goal and found.angle <= goal
        if arrived or (found.squares < worth * best and not content):
            best = found.squares
            copy(sizes.coordinates, search.coordinate_now, search.coordinate_best)
        if arrived:
            return
        scatter(sizes, chain, search, spread, seed)
        for dof in range(sizes.dofs):
            search.dof[dof].step = real(0.0)
        if bounded == 1:
            keep_limits(sizes, chain, search, search.coordinate_now)
        place(sizes, chain, search, search.coordinate_now)
        errors = measure_errors(sizes, chain, search, oriented)
        spread = wp.min(1.6 * spread, real(1.0))
        worth = _WORTH_A_JUMP
        seed += 1


@kernel
def inverse_kinematics_kernel(
    sizes: ChainSizes,
    chain: Chain,
    search: Search,
    oriented: Int32,
    step_kind: Int32,
    bounded: Int32,
    iterations: Int32,
    further: Int32,
    threshold: real,
    patience: real,
):
    """See `find_coordinates`."""
    find_coordinates(
        sizes, chain, search, oriented, step_kind, bounded, iterations, further, threshold, patience
    )
