"""What layers above the engine add to the files of worlds."""

from __future__ import annotations

from carom.render import saved_looks
from carom.world_files.world_file import Parts

PARTS: Parts = {"looks": saved_looks}
"""The parts by their names in the file."""
