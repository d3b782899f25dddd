"""Bodies and links of the rows of the link arrays."""

from collections.abc import Sequence
from typing import Any

from carom.layouts.queries import Places
from carom.native.tables import ArrayTable


def row_map_struct(places: Sequence[tuple[int, int]], table: ArrayTable | None = None) -> Any:
    """A struct of the bodies and links of the rows of the link arrays.

    Args:
        places: Body and link of each row.
        table: An empty table for them, if there is one.
    """
    table = table or ArrayTable(Places)
    table.reserve({"place": len(places)})
    for name, column in zip(("place_body", "place_link"), zip(*places, strict=True), strict=False):
        table.numpy[name][: len(places)] = column
    return table.struct()
