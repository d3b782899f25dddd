"""Branches on numbers in functions that are compiled for one world and for several in lanes.

Such functions choose numbers with `wp.where`, in each lane for itself. A branch may only leave out work that
`wp.where` would drop in all lanes.
"""

import warp as wp

__all__ = ["in_some_world"]


@wp.func_native("""
    return bool(condition);
""")
def in_some_world(condition: bool) -> bool:
    """Whether a condition holds, in one of several worlds in lanes at least."""
    ...
