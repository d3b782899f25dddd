"""MJCF files, as MuJoCo has them."""

from carom.formats.mjcf.reader import read_mjcf

__all__ = ["read_mjcf"]
