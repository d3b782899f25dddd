"""Writes the small meshes of the test robots: run it again after changing it, and commit what it writes."""

from __future__ import annotations

from pathlib import Path

import numpy as np

MESHES = Path(__file__).parent / "meshes"

# A wedge: a triangle in the x-z plane, drawn out along y. Its numbers are not round on purpose.
WEDGE = np.array(
    [
        [0.013, -0.021, 0.007],
        [0.213, -0.021, 0.017],
        [0.033, -0.021, 0.127],
        [0.013, 0.059, 0.007],
        [0.213, 0.059, 0.017],
        [0.033, 0.059, 0.127],
    ]
)
WEDGE_FACES = [(0, 1, 2), (3, 5, 4), (0, 3, 4), (0, 4, 1), (1, 4, 5), (1, 5, 2), (2, 5, 3), (2, 3, 0)]


def box_corners(center: tuple[float, float, float], half: tuple[float, float, float]) -> np.ndarray:
    signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    return np.array(center) + signs * np.array(half)


BOX_QUADS = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]


def write_two_boxes() -> None:
    """An OBJ with a group and an object, quads, texture indices, and negative indices in the second."""
    lines = ["# two boxes", "g lower"]
    first = box_corners((0.1, 0.02, 0.03), (0.11, 0.07, 0.05))
    lines += [f"v {x:.6f} {y:.6f} {z:.6f}" for x, y, z in first]
    lines += ["vt 0 0", "vn 0 0 1"]
    lines += ["f " + " ".join(f"{i + 1}/1/1" for i in quad) for quad in BOX_QUADS]
    second = box_corners((0.05, -0.04, 0.2), (0.03, 0.04, 0.1))
    lines += ["o upper"]
    lines += [f"v {x:.6f} {y:.6f} {z:.6f}" for x, y, z in second]
    lines += ["f " + " ".join(f"{i - 8}" for i in quad) for quad in BOX_QUADS]
    (MESHES / "two_boxes.obj").write_text("\n".join(lines) + "\n")


def write_wedge_stl() -> None:
    record = np.zeros(len(WEDGE_FACES), dtype=[("n", "<f4", 3), ("v", "<f4", (3, 3)), ("a", "<u2")])
    record["v"] = WEDGE[np.array(WEDGE_FACES)]
    header = b"wedge".ljust(80) + len(WEDGE_FACES).to_bytes(4, "little")
    (MESHES / "wedge.stl").write_bytes(header + record.tobytes())


def write_wedge_dae() -> None:
    numbers = " ".join(f"{value * 100:.4f}" for value in WEDGE.ravel())
    indices = " ".join(str(i) for face in WEDGE_FACES for i in face)
    (MESHES / "wedge.dae").write_text(
        f"""<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
  <asset><unit name="centimeter" meter="0.01"/><up_axis>Y_UP</up_axis></asset>
  <library_geometries>
    <geometry id="wedge-mesh">
      <mesh>
        <source id="wedge-positions">
          <float_array id="wedge-array" count="{WEDGE.size}">{numbers}</float_array>
          <technique_common>
            <accessor source="#wedge-array" count="{len(WEDGE)}" stride="3"/>
          </technique_common>
        </source>
        <vertices id="wedge-vertices"><input semantic="POSITION" source="#wedge-positions"/></vertices>
        <triangles count="{len(WEDGE_FACES)}">
          <input semantic="VERTEX" source="#wedge-vertices" offset="0"/>
          <p>{indices}</p>
        </triangles>
      </mesh>
    </geometry>
  </library_geometries>
  <library_visual_scenes>
    <visual_scene id="scene">
      <node id="turned">
        <matrix>0 -1 0 2 1 0 0 3 0 0 1 -1 0 0 0 1</matrix>
        <instance_geometry url="#wedge-mesh"/>
        <node id="beside">
          <matrix>1 0 0 30 0 1 0 0 0 0 1 0 0 0 0 1</matrix>
          <instance_geometry url="#wedge-mesh"/>
        </node>
      </node>
    </visual_scene>
  </library_visual_scenes>
  <scene><instance_visual_scene url="#scene"/></scene>
</COLLADA>
"""
    )


if __name__ == "__main__":
    write_two_boxes()
    write_wedge_stl()
    write_wedge_dae()
