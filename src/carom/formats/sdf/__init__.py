"""SDF files: models and worlds."""

from carom.formats.sdf.reader import read_sdf

__all__ = ["read_sdf"]
