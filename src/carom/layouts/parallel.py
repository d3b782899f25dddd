"""What steps in fine launches work on besides: room for islands, and for pairs of shapes, side by side."""

from typing import TYPE_CHECKING, Any

from carom.layouts.contacts import TermsRows
from carom.layouts.types import (
    ArrayType,
    Index4Rows,
    Int32,
    IntRows,
    Ints,
    Type,
    Vector3Rows,
    Vector4Rows,
    Vector8Rows,
    real,
    struct,
)

# A pair leaves at most so many candidates.
MOST_CANDIDATES = 4

# What a world is to do in a run of steps: begin it; go on after the steps it has done; stay as it is; or what
# it is doing already.
BEGIN, RESUME, STAY, GO_ON = 0, 1, 2, 3

# Where parts of an island's window begin, or how long they are.
Window = Type("int32", (8,), "vector")


@struct
class IslandProgress:
    """How far the search for the impulses of an island has come."""

    rows: Int32  # what `solver.island_rows` returned
    pair_row: Int32
    block: Int32
    visits: Int32
    units: Int32  # what `units.write_units` returned
    manifold_blocks: Int32
    torsion: Int32
    resting: Int32  # 1: its contacts start from their last impulses
    outcome: Int32  # see `warm_starting.NOT_RESTING`
    stage: Int32  # see `UNWRITTEN`
    residual: real
    sweeps: Int32


if TYPE_CHECKING:
    WindowRows = Any
    ProgressRows = Any
else:
    WindowRows = ArrayType(Window, 2)
    ProgressRows = ArrayType(IslandProgress, 2)


@struct
class IslandWork:
    """Intermediate results of islands that are solved side by side; the rows of trees are those of roots."""

    tree_window: WindowRows  # where its window begins
    tree_room: WindowRows  # how long that is
    tree_progress: ProgressRows
    # 1 + the tree, if its velocities were not finite before or after the solver, else 0.
    tree_free_fault: IntRows
    tree_motion_fault: IntRows
    terms: TermsRows


@struct
class RunWork:
    """Which worlds have a part in a run of steps, and what becomes of it."""

    world_part: Ints  # what it is to do: `BEGIN` and so on
    trouble: Ints  # its first entry: 1 since something went wrong or did not fit in some world


@struct
class PairWork:
    """Room for the candidates of all pairs of all worlds, and for looking for them.

    The former are arrays by world, like those of `Pairs`. There are fewer *workers*, each with the
    room that the search in one pair takes; see `Pairs`.
    """

    world_kept: Ints  # where the contacts of the last substep have been put aside
    pair_found: Index4Rows  # its first previous contact and the end of these; what `find_candidates` returned
    candidate_terms: Vector8Rows  # `MOST_CANDIDATES` for each pair

    worker_candidates: Vector8Rows
    worker_polygon_a: Vector3Rows
    worker_polygon_b: Vector3Rows
    worker_polygon_clipped: Vector3Rows
    worker_polytope_point: Vector3Rows
    worker_polytope_point_a: Vector3Rows
    worker_polytope_plane: Vector4Rows
    worker_polytope_face: Index4Rows
    worker_polytope_edge: Index4Rows
