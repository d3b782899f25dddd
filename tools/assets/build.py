"""Write every file of src/pybullet_data: `python -m tools.assets.build [NAME ...]` from the root."""

from __future__ import annotations

import sys
from io import BytesIO
from pathlib import Path

import numpy as np
from tools.assets.catalogue import (
    BLENDED,
    COLLADA_MESHES,
    HEIGHT_TABLES,
    LOFTED,
    MATERIALS,
    MESHES,
    MODELS,
    ROBOTS,
    SCENES,
    STL_MESHES,
    TEXTURES,
)
from tools.assets.dae_text import dae_text
from tools.assets.housings.lofts import housing
from tools.assets.mjcf_text import mjcf_text
from tools.assets.obj_mesh import material_text
from tools.assets.png import png_bytes
from tools.assets.sdf_text import sdf_text
from tools.assets.stl_bytes import stl_bytes
from tools.assets.surface import mesh_of
from tools.assets.tetras import SOFT_ROBOTS, SOLIDS
from tools.assets.textures import Colours
from tools.assets.urdf_text import urdf_text

TARGET = Path(__file__).resolve().parents[2] / "src" / "pybullet_data"


def urdf_files() -> dict[str, str]:
    """The text of every URDF file, by its path in the data folder."""
    made = {path: urdf_text(robot()) for path, robot in ROBOTS.items()}
    return made | {path: text() for path, text in SOFT_ROBOTS.items()}


def scene_files() -> dict[str, str]:
    """The text of every SDF and MJCF file."""
    made = {path: sdf_text(scene()) for path, scene in SCENES.items()}
    return made | {path: mjcf_text(model()) for path, model in MODELS.items()}


def mesh_files() -> dict[str, str]:
    """The text of every mesh, material and table of heights."""
    made = {path: material_text(name, texture) for path, (name, texture) in MATERIALS.items()}
    made |= {path: mesh().text() for path, mesh in (MESHES | SOLIDS).items()}
    made |= {path: dae_text(mesh(), name) for path, (name, mesh) in COLLADA_MESHES.items()}
    made |= {path: table() for path, table in HEIGHT_TABLES.items()}
    for folder, (fields, cell) in BLENDED.items():
        for name, (field, low, high) in fields().items():
            made[f"{folder}/{name}.obj"] = mesh_of(field, np.asarray(low), np.asarray(high), cell).text()
    for folder, bodies in LOFTED.items():
        made |= {f"{folder}/{name}.obj": housing(lofts).text() for name, lofts in bodies.items()}
    return made


def binary_files() -> dict[str, bytes]:
    """The bytes of every picture and STL file."""
    made = {path: _picture(path, colours()) for path, colours in TEXTURES.items()}
    return made | {path: stl_bytes(mesh()) for path, mesh in STL_MESHES.items()}


def _picture(path: str, colours: Colours) -> bytes:
    if path.endswith(".png"):
        return png_bytes(colours)
    from PIL import Image

    buffer = BytesIO()
    picture = Image.fromarray(np.rint(255.0 * colours).astype(np.uint8))
    picture.save(buffer, "JPEG" if path.endswith(".jpg") else "GIF")
    return buffer.getvalue()


def main(names: list[str]) -> None:
    texts = urdf_files() | scene_files() | mesh_files()
    for path, content in ({path: text.encode() for path, text in texts.items()} | binary_files()).items():
        if names and not any(name in path for name in names):
            continue
        target = TARGET / path
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(content)


if __name__ == "__main__":
    main(sys.argv[1:])
