"""Shares of a kernel that several threads perform at once, each with a launch of its own.

What one of them does must not depend on what another does. So a result is the same, bit for bit, whichever
thread it comes from.
"""

import warp as wp

from carom.kernels.types import Int32, IntRows

TREES_PER_SHARE = wp.constant(8)
"""A share of a kernel that is performed for each tree is so many of them."""


@wp.func_native("""
    if (taken.shape[1] == 0)
        return last + 1;
#if defined(__CUDA_ARCH__)
    return atomicAdd(&wp::index(taken, 0, 0), 1);
#else
    return __atomic_fetch_add(&wp::index(taken, 0, 0), 1, __ATOMIC_RELAXED);
#endif
""")
def next_share(taken: IntRows, last: Int32) -> Int32:
    """The number of the next share that no thread has taken, counted from 0.

    `taken` has how many are. Without an entry there is one thread only, which takes one after the other:
    `last` is the one that it had before, -1 at first.
    """
    ...
