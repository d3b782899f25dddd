"""What the rows of the link arrays stand for."""

from collections.abc import Sequence
from typing import Any

import warp as wp

from carom.model.arrays import ArrayTable
from carom.model.real import Ints


@wp.struct
class Places:
    """The body and the link of each row, by the numbers that users know them by."""

    place_body: Ints
    place_link: Ints  # -1: the base


def places_struct(places: Sequence[tuple[int, int]], device: str) -> Any:
    """A Warp struct of the bodies and links that the rows of the link arrays stand for."""
    table = ArrayTable(Places)
    table.reserve({"place": len(places)})
    for name, column in zip(("place_body", "place_link"), zip(*places, strict=True), strict=False):
        table.numpy[name][: len(places)] = column
    return table.struct(device)
