"""Meshes: triangles from OBJ, STL and DAE files."""

from carom.formats.mesh.distance_field import read_field_bounds
from carom.formats.mesh.part import MeshPart
from carom.formats.mesh.reader import read_mesh

__all__ = ["MeshPart", "read_field_bounds", "read_mesh"]
