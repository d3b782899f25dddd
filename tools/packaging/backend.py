"""The build backend: Hatchling, also where pip asks for metadata.

Hatchling hides from pip that it can make a project's metadata without a wheel, since build hooks might
change the requirements. So pip would build the wheel to find out what it requires, and say "Preparing
metadata" while it is compiled. Our build hook leaves the requirements as they are.
"""

import os

# Hatchling looks for pip when it is imported.
_pip = os.environ.pop("PIP_BUILD_TRACKER", None)
try:
    from hatchling.build import build_editable as build_editable
    from hatchling.build import build_sdist as build_sdist
    from hatchling.build import build_wheel as build_wheel
    from hatchling.build import get_requires_for_build_editable as get_requires_for_build_editable
    from hatchling.build import get_requires_for_build_sdist as get_requires_for_build_sdist
    from hatchling.build import get_requires_for_build_wheel as get_requires_for_build_wheel
    from hatchling.build import prepare_metadata_for_build_editable as prepare_metadata_for_build_editable
    from hatchling.build import prepare_metadata_for_build_wheel as prepare_metadata_for_build_wheel
finally:
    if _pip is not None:
        os.environ["PIP_BUILD_TRACKER"] = _pip
