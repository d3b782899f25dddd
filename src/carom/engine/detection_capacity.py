"""Required lengths of the arrays of collision detection."""

from __future__ import annotations

from carom.layouts.contacts import COLUMNS, MAX_CORNERS, RADIX

CANDIDATES = 64
CORNERS = 64


def scratch_capacity(shape_count: int, contact_capacity: int) -> dict[str, int]:
    """Minimum number of rows per axis of `Pairs`, except its `pair` axis, which grows on overflow.

    Args:
        shape_count: Number of shapes.
        contact_capacity: Rows of `Contacts`.
    """
    nodes = 2
    while nodes < shape_count:
        nodes *= 2
    return {
        "shape": shape_count,
        "node": nodes,
        "twig": 2 * shape_count,
        "bucket": RADIX,
        "candidate": CANDIDATES,
        "polygon": CORNERS,
        "polytope": 2 * MAX_CORNERS,
        "previous": 2 * contact_capacity,
        "count": COLUMNS,
    }
