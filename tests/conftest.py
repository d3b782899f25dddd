"""Settings that hold for all tests."""

import os

from hypothesis import settings

# A busy machine is no reason to fail; and a run that decides about a change has to be repeatable.
settings.register_profile("carom", deadline=None, derandomize="CI" in os.environ)
settings.load_profile("carom")
# Viewers open a browser where somebody could see it, but not here.
os.environ.setdefault("CI", "")
