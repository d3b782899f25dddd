"""Restitution: contacts that approach rebound by Newton's law, in rounds, before an island is solved.

Those that approach are resolved together, with no other rows; then those that approach by this, until there
are none. So an impact propagates through bodies that touch (C. Smith et al., Reflections on simultaneous
impact, SIGGRAPH 2012).
"""

import warp as wp

from carom.kernels.newton.envelope import clear_entries
from carom.kernels.newton.equations import PRECISION, add_vector, converge
from carom.kernels.newton.law import row_products
from carom.kernels.structs import NewtonWork, PairRows, Settings
from carom.kernels.types import Int32, func, real
from carom.layouts.newton import BOUNDED, OF_NORMAL, OFF, PLACES, ROWS

_MOST_ROUNDS = 200
# R of a normal in an impact, relative to its inverse mass.
_REGULAR = real(1e-9)


@func
def rebound_speed(work: NewtonWork, world: Int32, row: Int32, time_step: real, is_first: bool) -> real:
    """The speed at which a contact has to part.

    In the first round it conserves, or multiplies by e², what semi-implicit Euler conserves of a body in a
    field γ: ½ v² + γ q − ½ h γ v. So a ball with e = 1 keeps its height, whatever the step and the gap.
    """
    speed = work.newton_row[world, row].speed
    restitution = work.newton_row[world, row].restitution
    if not is_first:
        return -restitution * speed
    gain = -work.newton_row[world, row].from_forces
    before = speed + gain
    height = wp.max(work.newton_row[world, row].distance, 0.0) / time_step
    # All in speeds: γ h is `gain`, and q / h is `height`.
    square = wp.max(before * before + 2.0 * gain * height - gain * before, 0.0)
    under = gain * gain + 4.0 * (restitution * restitution * square - 2.0 * gain * height)
    if under <= 0.0:
        return real(0.0)
    return wp.max(0.5 * (wp.sqrt(under) - gain), 0.0)


@func
def select_approaching(work: NewtonWork, settings: Settings, world: Int32, is_first: bool) -> Int32:
    """Let only those normals act that approach within the substep; returns how many these are."""
    count = Int32(0)
    for row in range(work.count_newton[world, ROWS]):
        work.newton_row[world, row].kind = OFF
        if work.newton_row[world, row].origin == OF_NORMAL:
            speed = work.newton_row[world, row].speed
            if (
                work.newton_row[world, row].own_kind == BOUNDED
                and work.newton_row[world, row].restitution > 0.0
                and speed < -settings.restitution_threshold
                and work.newton_row[world, row].distance + settings.time_step * speed < 0.0
            ):
                count += 1
                wanted = rebound_speed(work, world, row, settings.time_step, is_first)
                work.newton_row[world, row].kind = BOUNDED
                work.newton_row[world, row].target = wanted - speed
                work.newton_row[world, row].regular = _REGULAR * work.newton_row[world, row].inverse_mass
                work.newton_row[world, row].rate = speed - wanted
    return count


@func
def resolve_impacts(
    work: NewtonWork, pair_rows: PairRows, settings: Settings, world: Int32, entries: Int32
) -> Int32:
    """Add the rounds of an island's impacts to `vector_total`, and take them from the targets of all rows.

    Laws of rows are as before afterwards, with `impact` of the normals. Returns as `converge`.
    """
    rows = work.count_newton[world, ROWS]
    size = 4 * work.count_newton[world, PLACES]
    for row in range(rows):
        work.newton_row[world, row].own_kind = work.newton_row[world, row].kind
        work.newton_row[world, row].own_regular = work.newton_row[world, row].regular
        work.newton_row[world, row].own_target = work.newton_row[world, row].target
        work.newton_row[world, row].first = work.newton_row[world, row].rate
    clear_entries(work.vector_total, world, size)
    iterations, rounds = Int32(0), Int32(0)
    keep = Int32(1)
    while keep == 1:
        count = Int32(0)
        if rounds < _MOST_ROUNDS and iterations >= 0:
            count = select_approaching(work, settings, world, rounds == 0)
        if count == 0:
            keep = Int32(0)
        else:
            rounds += 1
            more = converge(work, pair_rows, world, entries, Int32(1), PRECISION)
            iterations = wp.where(more < 0, more, iterations + more)
            add_vector(work.vector_total, 1.0, work.vector_change, world, size)
            row_products(work.newton_row, pair_rows.jacobian_row, work.vector_change, world, rows, Int32(1))
            for row in range(rows):
                if work.newton_row[world, row].origin == OF_NORMAL:
                    work.newton_row[world, row].speed += work.newton_row[world, row].along
                    work.newton_row[world, row].impact += work.newton_row[world, row].impulse
    row_products(work.newton_row, pair_rows.jacobian_row, work.vector_total, world, rows, Int32(1))
    for row in range(rows):
        work.newton_row[world, row].kind = work.newton_row[world, row].own_kind
        work.newton_row[world, row].regular = work.newton_row[world, row].own_regular
        work.newton_row[world, row].target = (
            work.newton_row[world, row].own_target - work.newton_row[world, row].along
        )
        if rounds == 0:
            work.newton_row[world, row].rate = work.newton_row[world, row].first
        else:
            work.newton_row[world, row].rate = -work.newton_row[world, row].target
    return iterations
