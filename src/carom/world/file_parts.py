"""What packages above the engine add to world files."""

from __future__ import annotations

from carom.render import saved_looks
from carom.world_files.world_file import Parts

PARTS: Parts = {"looks": saved_looks}
"""The parts by their names in the file."""
