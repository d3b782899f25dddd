"""Options of `connect`: words such as `--width=800`."""

from __future__ import annotations

import re
from collections.abc import Iterator

_WORDS = re.compile(r'(?:[^\s"]|"[^"]*")+')


def named_values(options: str) -> Iterator[tuple[str, str]]:
    """Names and values of options `--name=value`, in their order; the value of `--name` is empty.

    Args:
        options: Options separated by spaces; double quotes enclose values with spaces.
    """
    for word in _WORDS.findall(options):
        name, _, value = word.lstrip("-").partition("=")
        yield name, value.replace('"', "")
