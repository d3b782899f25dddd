"""Asks real PyBullet for images of the test scenes, and writes them to `oracle.npz`.

Run it with a Python that has PyBullet, not Carom:

    .oracle/bin/python tests/render/record_oracle.py
"""

from __future__ import annotations

import importlib
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np
from image_scenes import SCENES, take_picture

IMAGES = Path(__file__).with_name("oracle.npz")

# Depths are kept as whole numbers of this: they take half the space.
DEPTH_STEP = 1e-6


def main() -> None:
    pybullet: Any = importlib.import_module("pybullet")
    pybullet.connect(pybullet.DIRECT)
    arrays: dict[str, Any] = {"pybullet": np.array(version("pybullet"))}
    for scene in SCENES:
        rgba, depth, label = take_picture(pybullet, scene)
        arrays[f"{scene.name}_colour"] = rgba[:, :, :3]
        arrays[f"{scene.name}_depth"] = np.round(depth.astype(np.float64) / DEPTH_STEP).astype(np.int32)
        arrays[f"{scene.name}_label"] = label
    np.savez_compressed(IMAGES, **arrays)


if __name__ == "__main__":
    main()
