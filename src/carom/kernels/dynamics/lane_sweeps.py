"""A sweep over rows of motors, limits and user constraints of several worlds at once, each in a lane.

The build compiles this module with a type of several numbers in place of `real`, as it does with
`dynamics.lane_motion`. Whole numbers are those of all worlds: `native/source/lanes/lane_sweeps.cpp` sees to
it that their rows have the same places.
"""

from carom.kernels.solver.sweeps import sweep_over_visits
from carom.kernels.structs import PairRows, Scratch
from carom.kernels.types import Int32, RealRows, kernel


@kernel
def lane_sweep_kernel(
    scratch: Scratch, pair_rows: PairRows, residuals: RealRows, visits: Int32, sweep: Int32
):
    """Relax the rows in `visit_row` once; `residuals` gets the maximum change squared."""
    residuals[0, 0] = sweep_over_visits(scratch, pair_rows, 0, visits, sweep)
