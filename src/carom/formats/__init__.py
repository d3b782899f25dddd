"""From files to descriptions. Knows no physics."""

from carom.formats.search import AssetSearch
from carom.formats.urdf import read_urdf

__all__ = ["AssetSearch", "read_urdf"]
