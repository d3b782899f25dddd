"""A map from the rows of link arrays to bodies and links."""

from collections.abc import Sequence
from typing import Any

from carom.layouts.queries import Places
from carom.native.tables import ArrayTable


def row_map_struct(places: Sequence[tuple[int, int]], table: ArrayTable | None = None) -> Any:
    """A struct with the body and link of each row of the link arrays.

    Args:
        places: Body and link of each row.
        table: An empty table to fill; None for a new one.
    """
    table = table or ArrayTable(Places)
    table.reserve({"place": len(places)})
    for name, column in zip(("place_body", "place_link"), zip(*places, strict=True), strict=False):
        table.numpy[name][: len(places)] = column
    return table.struct()
