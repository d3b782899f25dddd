"""What the rows of the link arrays stand for."""

import warp as wp

from carom.model.real import Ints


@wp.struct
class Places:
    """The body and the link of each row, by the numbers that users know them by."""

    place_body: Ints
    place_link: Ints  # -1: the base
