"""Options of `connect`: words such as `--width=800`."""

from __future__ import annotations

import re

_WORDS = re.compile(r'(?:[^\s"]|"[^"]*")+')


def values_of(options: str) -> dict[str, str]:
    """The values of options `--name=value` by name; empty for `--name`. The last one of a name counts.

    Args:
        options: Options separated by spaces; double quotes enclose values with spaces.
    """
    words = (word.lstrip("-").partition("=") for word in _WORDS.findall(options))
    return {name: value.replace('"', "") for name, _, value in words}
