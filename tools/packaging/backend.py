"""The build backend: Hatchling, also where pip asks for metadata.

Hatchling hides from pip that it can make a project's metadata without a wheel, since build hooks might change
the requirements. So pip would build the wheel to find out what it requires, and say "Preparing metadata" while it
is compiled. Our build hook leaves the requirements as they are.
"""

import os

# Hatchling looks for pip when it is imported.
_pip = os.environ.pop("PIP_BUILD_TRACKER", None)
try:
    from hatchling.build import *  # noqa: F403
finally:
    if _pip is not None:
        os.environ["PIP_BUILD_TRACKER"] = _pip
