"""The arguments of `connect` after the method, and its options: words such as `--width=800`."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import NamedTuple

from pybullet._calls.constants import SHARED_MEMORY_KEY

_WORDS = r'(?:[^\s"]|"[^"]*")+'


def named_values(options: str) -> Iterator[tuple[str, str]]:
    """Names and values of options `--name=value`, in order; double quotes enclose values with spaces."""
    for word in re.findall(_WORDS, options):
        name, _, value = word.lstrip("-").partition("=")
        yield name, value.replace('"', "")


class Target(NamedTuple):
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
