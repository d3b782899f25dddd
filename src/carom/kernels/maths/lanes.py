"""Branches on numbers in functions that are compiled for one world and for several in lanes.

A branch that only changes variables needs nothing of this: the build makes it choose in each lane for
itself (`native/building/lanes.py`). In one that stores something, `wp.where` has to choose what is stored,
and the branch may only leave out work that this would drop in all lanes.
"""

import warp as wp

__all__ = ["in_some_world"]


@wp.func_native("""
    return bool(condition);
""")
def in_some_world(condition: bool) -> bool:
    """Whether a condition holds, in one of several worlds in lanes at least."""
    ...
