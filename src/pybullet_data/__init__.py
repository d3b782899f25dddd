"""Carom's own assets, under the file names PyBullet scripts use.

`p.setAdditionalSearchPath(pybullet_data.getDataPath())` makes them available to `loadURDF` and the
other loading functions.
"""

import os

__all__ = ["getDataPath"]


def getDataPath() -> str:
    """The folder of the assets: robots, floors, objects, meshes and textures."""
    return os.path.dirname(os.path.abspath(__file__))
