"""Values exchanged between the processes of an MPI job. Without mpi4py there is one process, the root."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

ROOT_PROC_RANK = 0


def _world() -> Any:
    """The module `mpi4py.MPI`, or None if mpi4py is not installed."""
    try:
        from mpi4py import MPI  # type: ignore[import-not-found]
    except ImportError:
        return None
    return MPI


def get_num_procs() -> int:
    """The number of processes."""
    mpi = _world()
    return 1 if mpi is None else mpi.COMM_WORLD.Get_size()


def get_proc_rank() -> int:
    """The rank of this process, from 0."""
    mpi = _world()
    return ROOT_PROC_RANK if mpi is None else mpi.COMM_WORLD.Get_rank()


def is_root_proc() -> bool:
    """Whether this is the root process."""
    return get_proc_rank() == ROOT_PROC_RANK


def bcast(x: np.ndarray) -> None:
    """Overwrites an array in each process with that of the root process."""
    mpi = _world()
    if mpi is not None:
        mpi.COMM_WORLD.Bcast(x, root=ROOT_PROC_RANK)


def reduce_sum(x: Any) -> Any:
    """The sum, elementwise for arrays, over all processes."""
    return reduce_all(x, "SUM")


def reduce_prod(x: Any) -> Any:
    """The product, elementwise for arrays, over all processes."""
    return reduce_all(x, "PROD")


def reduce_avg(x: Any) -> Any:
    """The mean, elementwise for arrays, over all processes."""
    return reduce_sum(x) / get_num_procs()


def reduce_min(x: Any) -> Any:
    """The minimum, elementwise for arrays, over all processes."""
    return reduce_all(x, "MIN")


def reduce_max(x: Any) -> Any:
    """The maximum, elementwise for arrays, over all processes."""
    return reduce_all(x, "MAX")


def reduce_all(x: Any, op: Any) -> Any:
    """A number or an array, reduced over all processes with an MPI operation or the name of one."""
    mpi = _world()
    if mpi is None:
        return np.array(x) if isinstance(x, np.ndarray) else x
    operation = getattr(mpi, op) if isinstance(op, str) else op
    return _with_buffers(x, lambda mine, result: mpi.COMM_WORLD.Allreduce(mine, result, op=operation))


def gather_all(x: Any) -> list[Any]:
    """The numbers or arrays of all processes, in the order of their ranks."""
    mpi = _world()
    mine = np.array([x])
    if mpi is None:
        return list(mine)
    everybody = np.repeat(np.zeros_like(mine), get_num_procs(), axis=0)
    mpi.COMM_WORLD.Allgather(mine, everybody)
    return list(everybody)


def _with_buffers(x: Any, exchange: Callable[[np.ndarray, np.ndarray], None]) -> Any:
    is_array = isinstance(x, np.ndarray)
    mine = x if is_array else np.array([x])
    result = np.zeros_like(mine)
    exchange(mine, result)
    return result if is_array else result[0]
