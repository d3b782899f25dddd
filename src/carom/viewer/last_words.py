"""What a script ends by, told to the pages that are open."""

from __future__ import annotations

import atexit
import sys
import time
from traceback import format_exception_only
from typing import TYPE_CHECKING
from weakref import WeakSet

from carom.viewer.protocol import to_page

if TYPE_CHECKING:
    from carom.viewer.latest_messages import LatestMessages
    from carom.viewer.server import PageServer

# Maximum length of the line on a page, and how long the end of a script waits for pages to take it [s].
_MAX_CHARACTERS = 300
_PATIENCE = 0.5


class LastWords:
    """Tells the pages of one viewer the last line of the exception that ends the script.

    Args:
        latest: The messages of the viewer.
        server: The server of its pages.
    """

    def __init__(self, latest: LatestMessages, server: PageServer) -> None:
        self._latest = latest
        self._server = server
        _all.add(self)

    def say(self, line: str) -> None:
        """Tells the pages a line, and closes the viewer."""
        self._latest.put("ending", to_page.ENDING(error=line[:_MAX_CHARACTERS]))
        give_up = time.monotonic() + _PATIENCE
        while not self._server.has_sent(self._latest.revision) and time.monotonic() < give_up:
            time.sleep(0.01)
        # What was sent arrives before the sockets close.
        self._server.stop()

    def forget(self) -> None:
        """Says nothing more, because the viewer is closed."""
        _all.discard(self)


def last_line() -> str | None:
    """The last line of the exception that has ended the script, None if there was none.

    In an interactive session exceptions end nothing, and one by Ctrl-C is what the user wanted.
    """
    problem = getattr(sys, "last_value", None)
    if problem is None or isinstance(problem, KeyboardInterrupt):
        return None
    if hasattr(sys, "ps1") or sys.flags.interactive:
        return None
    return "".join(format_exception_only(type(problem), problem)).strip().splitlines()[-1]


@atexit.register
def _tell_all() -> None:
    line = last_line()
    if line is None:
        return
    for words in list(_all):
        words.say(line)


_all: WeakSet[LastWords] = WeakSet()
