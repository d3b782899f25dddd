"""Converts an MJCF file to URDF files: `python -m pybullet_utils.examples.mjcf2urdf --mjcf file`."""

from __future__ import annotations

import argparse

import pybullet
import pybullet_data
from pybullet_utils.bullet_client import BulletClient
from pybullet_utils.urdfEditor import UrdfEditor


def main() -> None:
    """Writes a file for each body, named after the robot or root link and the id."""
    parser = argparse.ArgumentParser(description="Writes the bodies of an MJCF file as URDF files.")
    parser.add_argument("--mjcf", default="mjcf/humanoid.xml", help="file to load")
    client = BulletClient(pybullet.DIRECT)
    client.setAdditionalSearchPath(pybullet_data.getDataPath())
    for body in client.loadMJCF(parser.parse_args().mjcf, flags=client.URDF_USE_IMPLICIT_CYLINDER):
        editor = UrdfEditor()
        editor.initializeFromBulletBody(body, client._client)
        root, robot = (name.decode() for name in client.getBodyInfo(body))
        editor.saveUrdf(f"{robot or root}{body}.urdf")


if __name__ == "__main__":
    main()
