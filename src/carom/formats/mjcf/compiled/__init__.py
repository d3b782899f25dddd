"""MJCF as MuJoCo compiles it: defaults, options of the compiler, masses and inertia from geoms."""

from carom.formats.mjcf.compiled.model import CompiledModel
from carom.formats.mjcf.compiled.reader import compile_mjcf

__all__ = ["CompiledModel", "compile_mjcf"]
