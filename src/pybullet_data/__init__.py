"""Carom's own assets, under the file names PyBullet scripts use.

`p.setAdditionalSearchPath(pybullet_data.getDataPath())` makes them available to `loadURDF` and friends.
"""

import os

__all__ = ["getDataPath"]


def getDataPath() -> str:
    """Folder that holds the assets: robots, floors, things, meshes and textures."""
    return os.path.dirname(os.path.abspath(__file__))
