"""Loads and writes a URDF file: `python -m pybullet_utils.readwriteurdf --urdf_in a --urdf_out b`."""

from __future__ import annotations

import argparse

import pybullet
import pybullet_data
from pybullet_utils.bullet_client import BulletClient
from pybullet_utils.urdfEditor import UrdfEditor


def main() -> None:
    """Loads and writes the files that the command line names."""
    parser = argparse.ArgumentParser(description="Loads a URDF file and writes it to another.")
    parser.add_argument("--urdf_in", default="test.urdf", help="file to load")
    parser.add_argument("--urdf_out", default="out.urdf", help="file to write")
    parser.add_argument("--urdf_flags", type=int, default=0, help="flags of loadURDF")
    asked = parser.parse_args()
    client = BulletClient(pybullet.DIRECT)
    client.setAdditionalSearchPath(pybullet_data.getDataPath())
    editor = UrdfEditor()
    editor.initializeFromBulletBody(client.loadURDF(asked.urdf_in, flags=asked.urdf_flags), client._client)
    editor.saveUrdf(asked.urdf_out)


if __name__ == "__main__":
    main()
