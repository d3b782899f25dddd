"""The URDF reader."""

from carom.formats.urdf.reader import read_urdf

__all__ = ["read_urdf"]
