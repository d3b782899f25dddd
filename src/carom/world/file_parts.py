"""Parts of world files that belong to packages above the engine."""

from __future__ import annotations

from carom.render import saved_looks
from carom.world_files.world_file import Parts

PARTS: Parts = {"looks": saved_looks}
"""The parts by their names in the file."""
