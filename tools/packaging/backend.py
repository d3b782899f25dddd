"""The build backend: Hatchling, also where pip asks for metadata.

Hatchling hides from pip that it can make a project's metadata without a wheel, since build hooks might
change the requirements. So pip would build the wheel to find out what it requires, and say "Preparing
metadata" while it is compiled. Our build hook leaves the requirements as they are.
"""

import os

__all__ = [
    "build_editable",
    "build_sdist",
    "build_wheel",
    "get_requires_for_build_editable",
    "get_requires_for_build_sdist",
    "get_requires_for_build_wheel",
    "prepare_metadata_for_build_editable",
    "prepare_metadata_for_build_wheel",
]

# Hatchling looks for pip when it is imported.
_pip = os.environ.pop("PIP_BUILD_TRACKER", None)
try:
    from hatchling.build import (
        build_editable,
        build_sdist,
        build_wheel,
        get_requires_for_build_editable,
        get_requires_for_build_sdist,
        get_requires_for_build_wheel,
        prepare_metadata_for_build_editable,
        prepare_metadata_for_build_wheel,
    )
finally:
    if _pip is not None:
        os.environ["PIP_BUILD_TRACKER"] = _pip
