"""An arm on a rover, joined by the URDF editor: `python -m pybullet_utils.examples.combineUrdf`."""

from __future__ import annotations

import pybullet
import pybullet_data
from pybullet_utils.bullet_client import BulletClient
from pybullet_utils.urdfEditor import UrdfEditor


def _edited(client: BulletClient, file: str) -> UrdfEditor:
    client.setAdditionalSearchPath(pybullet_data.getDataPath())
    editor = UrdfEditor()
    editor.initializeFromBulletBody(client.loadURDF(file), client._client)
    return editor


def main() -> None:
    """Writes `combined.urdf`."""
    clients = [BulletClient(pybullet.DIRECT) for _ in range(2)]
    rover, arm = _edited(clients[0], "husky/husky.urdf"), _edited(clients[1], "kuka_iiwa/model.urdf")
    joint = rover.joinUrdf(
        arm, 0, [0.1, 0, 0.3], [0, 0, 0], [0, 0, 0], [0, 0, 0], clients[0]._client, clients[1]._client
    )
    joint.joint_type = pybullet.JOINT_FIXED
    rover.saveUrdf("combined.urdf")


if __name__ == "__main__":
    main()
