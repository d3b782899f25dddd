"""Names that prims can have."""

from __future__ import annotations

import re


class Names:
    """Paths of prims from names of links, joints and shapes, each one once."""

    def __init__(self) -> None:
        self._taken: set[str] = set()

    def under(self, parent: str, name: str) -> str:
        """A path below another one, with a name of letters, digits and underscores."""
        base = re.sub(r"\W", "_", name, flags=re.ASCII)
        if not base or base[0].isdigit():
            base = f"_{base}"
        path, number = f"{parent}/{base}", 1
        while path in self._taken:
            number += 1
            path = f"{parent}/{base}_{number}"
        self._taken.add(path)
        return path
