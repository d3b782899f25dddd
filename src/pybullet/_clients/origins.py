"""Which call loaded a body, so that `saveWorld` can write it down."""

from __future__ import annotations

from collections.abc import Mapping

from carom.record import record


@record(eq=False)
class FileLoad:
    """A call that loaded a file.

    Attributes:
        function: Its name.
        arguments: Its arguments but for the file, by name.
        takes_pose: It is told where to put the one body it loads.
        count: How many bodies it loaded.
    """

    function: str
    arguments: Mapping[str, float | str]
    takes_pose: bool = False
    count: int = 1


@record
class Origin:
    """Where a body came from: the `index`-th body of a load."""

    load: FileLoad
    index: int = 0
