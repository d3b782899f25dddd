"""The calls of the surface test, by capability."""

from ..call import Calls
from . import (
    algebra,
    bodies,
    connections,
    data,
    images,
    joints,
    loading,
    maths,
    motors,
    queries,
    shapes,
    window,
    worlds,
)

CALLS: dict[str, Calls] = {}
for part in (
    connections,
    worlds,
    loading,
    bodies,
    joints,
    motors,
    shapes,
    queries,
    images,
    window,
    algebra,
    maths,
    data,
):
    CALLS |= part.CALLS
