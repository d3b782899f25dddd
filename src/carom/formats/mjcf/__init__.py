"""MJCF, the file format of MuJoCo."""

from carom.formats.mjcf.reader import read_mjcf

__all__ = ["read_mjcf"]
