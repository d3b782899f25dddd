"""Workspace for the narrow phase of several pairs of shapes in parallel."""

import warp as wp

from carom.kernels.structs import CandidateRows, Pairs, PairWork
from carom.kernels.types import Index4Rows, Int32, Vector3Rows, Vector4Rows, func
from carom.layouts.parallel import MAX_CANDIDATES

# C++ for a view of an array in which all worlds share the row of a worker: the stride over worlds is zero.
_ROW = """
    auto own = pool;
    own.data = &wp::index(pool, worker, 0);
    own.strides[0] = 0;
    return own;
"""


@wp.func_native(_ROW)
def own_indices(pool: Index4Rows, worker: Int32) -> Index4Rows:
    """The row of a worker, as the row of every world."""
    ...


@wp.func_native(_ROW)
def own_vectors3(pool: Vector3Rows, worker: Int32) -> Vector3Rows:
    """The row of a worker, as the row of every world."""
    ...


@wp.func_native(_ROW)
def own_vectors4(pool: Vector4Rows, worker: Int32) -> Vector4Rows:
    """The row of a worker, as the row of every world."""
    ...


@wp.func_native(_ROW)
def own_candidates(pool: CandidateRows, worker: Int32) -> CandidateRows:
    """The row of a worker, as the row of every world."""
    ...


@func
def pairs_of_worker(pairs: Pairs, work: PairWork, worker: Int32) -> Pairs:
    """The arrays of collision detection, with a worker's own workspace for a pair."""
    own = Pairs()
    own = pairs
    own.candidate = own_candidates(work.worker_candidate, worker)
    own.polygon_a = own_vectors3(work.worker_polygon_a, worker)
    own.polygon_b = own_vectors3(work.worker_polygon_b, worker)
    own.polygon_clipped = own_vectors3(work.worker_polygon_clipped, worker)
    own.polytope_point = own_vectors3(work.worker_polytope_point, worker)
    own.polytope_point_a = own_vectors3(work.worker_polytope_point_a, worker)
    own.polytope_plane = own_vectors4(work.worker_polytope_plane, worker)
    own.polytope_face = own_indices(work.worker_polytope_face, worker)
    own.polytope_edge = own_indices(work.worker_polytope_edge, worker)
    return own


@func
def pairs_with_candidates(pairs: Pairs, work: PairWork, i: Int32) -> Pairs:
    """The arrays of collision detection, with the candidates of a pair."""
    own = Pairs()
    own = pairs
    own.candidate = work.candidate[:, MAX_CANDIDATES * i : MAX_CANDIDATES * (i + 1)]
    return own
