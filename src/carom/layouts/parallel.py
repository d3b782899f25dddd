"""Additional data of steps in fine launches: workspace for islands and pairs of shapes in parallel."""

from typing import TYPE_CHECKING, Any

from carom.layouts.contacts import Candidate
from carom.layouts.pair_rows import ContactTerms
from carom.layouts.types import (
    Index4Rows,
    Int32,
    IntRows,
    Ints,
    Rows,
    Type,
    Vector3Rows,
    Vector4Rows,
    real,
    struct,
)

# Maximum number of contact candidates of a pair.
MAX_CANDIDATES = 8

# What a world does in a run of steps: begin it; resume it after the steps it has done; stay as it is; or
# continue what it is doing already.
BEGIN, RESUME, STAY, GO_ON = 0, 1, 2, 3

# Starts of the parts of an island's window, or their lengths; see `kernels.parallel.workspace`.
if TYPE_CHECKING:
    Window = Any
else:
    Window = Type("int32", (9,), "vector")


@struct
class IslandProgress:
    """Progress of solving an island."""

    rows: Int32  # returned by `solver.island_rows`
    pair_row: Int32
    block: Int32
    visits: Int32
    units: Int32  # returned by `units.write_units`
    manifold_blocks: Int32
    character: Int32
    resting: Int32  # 1: its contacts are warm started
    outcome: Int32  # see `warm_starting.NOT_RESTING`
    stage: Int32  # see `UNWRITTEN` in `kernels.parallel.workspace`
    residual: real
    sweeps: Int32


@struct
class IslandWork:
    """Intermediate results of islands solved in parallel; an island uses the tree row of its root."""

    tree_window: Rows[Window]  # starts of the parts of its window
    tree_room: Rows[Window]  # their lengths
    tree_progress: Rows[IslandProgress]
    # 1 + the tree, if its velocities were not finite before or after the solver; else 0.
    tree_free_fault: IntRows
    tree_motion_fault: IntRows
    terms: Rows[ContactTerms]


@struct
class RunWork:
    """Worlds that take part in a run of steps, and whether it succeeded."""

    world_part: Ints  # `BEGIN`, `RESUME`, `STAY` or `GO_ON`
    trouble: Ints  # first entry: 1 if in some world a velocity was not finite or something did not fit


@struct
class PairResult:
    """Result of the narrow phase for a pair of shapes."""

    first: Int32  # first of its contacts of the last substep, among the saved ones
    end: Int32  # end of these
    new_points: Int32  # results of `collide.find_candidates`
    candidates: Int32


@struct
class PairWork:
    """Contact candidates of all pairs of all worlds, and workspace for finding them.

    Candidates have a world axis, like the fields of `Pairs`. Each *worker* has the workspace of one pair at a
    time, see `Pairs`; there are fewer workers than pairs.
    """

    world_kept: Ints  # first row of the saved contacts of the last substep, see `manifold.keep_previous`
    pair_result: Rows[PairResult]
    candidate: Rows[Candidate]  # `MAX_CANDIDATES` for each pair

    worker_candidate: Rows[Candidate]
    worker_polygon_a: Vector3Rows
    worker_polygon_b: Vector3Rows
    worker_polygon_clipped: Vector3Rows
    worker_polytope_point: Vector3Rows
    worker_polytope_point_a: Vector3Rows
    worker_polytope_plane: Vector4Rows
    worker_polytope_face: Index4Rows
    worker_polytope_edge: Index4Rows
