"""The arguments of `connect` after the method."""

from __future__ import annotations

from carom.record import record
from pybullet._calls.constants import SHARED_MEMORY_KEY
from pybullet._calls.options import named_values


@record
class Target:
    """The arguments of `connect` after the method.

    Attributes:
        key: Key of shared memory.
        host: Host of the server.
        port: Port of the server; negative for the default.
        options: Options separated by spaces; double quotes enclose values with spaces.
    """

    key: int = SHARED_MEMORY_KEY
    host: str = "localhost"
    port: int = -1
    options: str = ""

    def option(self, name: str) -> str | None:
        """The value of the last `--name=value`, empty for `--name`; None if not given."""
        return dict(named_values(self.options)).get(name)
