"""Meshes in the COLLADA format, without materials."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from tools.assets.obj_mesh import ObjMesh, triangles


def dae_text(mesh: ObjMesh, name: str) -> str:
    """The COLLADA file of a mesh with normals, in metres and with y upwards."""
    assert mesh.normals is not None
    corners = triangles(mesh)
    numbers = " ".join(str(corner) for corner in corners.ravel().tolist())
    return f"""<?xml version="1.0" encoding="utf-8"?>
<!-- Written by tools/assets of Carom; MIT licence. -->
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
  <asset><unit meter="1" name="meter"/><up_axis>Y_UP</up_axis></asset>
  <library_geometries>
    <geometry id="{name}-mesh" name="{name}">
      <mesh>
{_source(f"{name}-positions", mesh.vertices, 3)}
{_source(f"{name}-normals", mesh.normals, 2)}
        <vertices id="{name}-vertices">
          <input semantic="POSITION" source="#{name}-positions"/>
          <input semantic="NORMAL" source="#{name}-normals"/>
        </vertices>
        <triangles count="{len(corners)}">
          <input semantic="VERTEX" source="#{name}-vertices" offset="0"/>
          <p>{numbers}</p>
        </triangles>
      </mesh>
    </geometry>
  </library_geometries>
  <library_visual_scenes>
    <visual_scene id="scene">
      <node id="{name}"><instance_geometry url="#{name}-mesh"/></node>
    </visual_scene>
  </library_visual_scenes>
  <scene><instance_visual_scene url="#scene"/></scene>
</COLLADA>
"""


def _source(name: str, rows: NDArray[np.float64], decimals: int) -> str:
    values = " ".join(f"{value:.{decimals}f}" for value in rows.ravel())
    return f"""        <source id="{name}">
          <float_array id="{name}-array" count="{rows.size}">{values}</float_array>
          <technique_common>
            <accessor source="#{name}-array" count="{len(rows)}" stride="3">
              <param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/>
            </accessor>
          </technique_common>
        </source>"""
