"""Wheels have the native library of their platform in them.

`pip install .` and `python -m build --wheel` build it for this machine, for all its CPU levels. `make wheels`
names other platforms. Editable installs build nothing: there the library is built when it is first needed.
"""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface

# The platform to build for, as `carom.native.building` calls it; if not set, this one.
TARGET_VARIABLE = "CAROM_BUILD_TARGET"
_PLACE = "carom/native/libraries"


class NativeLibraryHook(BuildHookInterface):
    """Builds the native library and puts it into the wheel."""

    PLUGIN_NAME = "custom"

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Build, and say which platform the wheel is for.

        Args:
            version: `standard` or `editable`.
            build_data: What the wheel is to be; changed in place.
        """
        if version == "editable":
            return
        root = Path(self.root) / "src"
        sys.path.insert(0, str(root))
        try:
            libraries, tags = self._build(root)
        finally:
            sys.path.remove(str(root))
        for library in libraries:
            build_data["force_include"][str(library)] = f"{_PLACE}/{library.name}"
        build_data["pure_python"] = False
        build_data["tag"] = f"py3-none-{tags}"

    def _build(self, root: Path) -> tuple[list[Path], str]:
        from carom.native.building.library import build_all
        from carom.native.building.zig import BuildError
        from carom.native.targets import TARGETS, NoTarget, this_target

        name = os.environ.get(TARGET_VARIABLE)
        try:
            target = TARGETS[name] if name else this_target()
            libraries = build_all(root, target, sys.stderr)
        except (BuildError, NoTarget, KeyError) as problem:
            sys.exit(f"Carom cannot be built here: {problem}")
        return libraries, ".".join(target.wheel_tags)
