"""Write every file of src/pybullet_data: `python -m tools.assets.build [NAME ...]` from the repository root."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path

import numpy as np

from tools.assets import panda
from tools.assets.fields import Field
from tools.assets.parts import Robot, Vector3
from tools.assets.surface import mesh_of
from tools.assets.urdf_text import urdf_text

TARGET = Path(__file__).resolve().parents[2] / "src" / "pybullet_data"
CELL = 0.017

ROBOTS: Mapping[str, Callable[[], Robot]] = {
    "franka_panda/panda.urdf": panda.panda,
}


def housings(folder: str, fields: Mapping[str, tuple[Field, Vector3, Vector3]]) -> dict[str, Callable[[], bytes]]:
    """The OBJ files of blended bodies."""

    def encoded(field: Field, low: Vector3, high: Vector3) -> bytes:
        return mesh_of(field, np.asarray(low), np.asarray(high), CELL).text().encode()

    return {f"{folder}/{name}.obj": partial(encoded, *body) for name, body in fields.items()}


def files() -> dict[str, Callable[[], bytes]]:
    """Every file we make: its path in the data folder, and what makes its bytes."""
    made: dict[str, Callable[[], bytes]] = {}
    for path, robot in ROBOTS.items():
        made[path] = lambda robot=robot: urdf_text(robot()).encode()
    made |= housings("franka_panda/meshes", panda.fields())
    return made


def main(names: list[str]) -> None:
    for path, make in files().items():
        if names and not any(name in path for name in names):
            continue
        target = TARGET / path
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(make())


if __name__ == "__main__":
    main(sys.argv[1:])
