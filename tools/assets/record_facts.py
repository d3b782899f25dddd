"""Record what the original assets look like to real PyBullet, as figures our own files must reproduce.

Run with an interpreter that has PyBullet and the original pybullet_data:

    .oracle/bin/python tools/assets/record_facts.py [NAME ...]

It writes tests/pybullet_data/facts/<name>.json, one file per asset, and needs nothing of Carom.
"""

from __future__ import annotations

import json
import math
import sys
from pathlib import Path
from typing import Any

import pybullet as p
import pybullet_data

ROOT = Path(__file__).resolve().parents[2]
FACTS = ROOT / "tests" / "pybullet_data" / "facts"

ASSETS = (
    "TwoJointRobot_w_fixedJoints.urdf",
    "TwoJointRobot_wo_fixedJoints.urdf",
    "block.urdf",
    "cartpole.urdf",
    "cube.urdf",
    "cube_collisionfilter.urdf",
    "cube_no_rotation.urdf",
    "cube_rotate.urdf",
    "cube_small.urdf",
    "domino/domino.urdf",
    "duck_vhacd.urdf",
    "franka_panda/panda.urdf",
    "jenga/jenga.urdf",
    "kuka_iiwa/model.urdf",
    "kuka_iiwa/model_free_base.urdf",
    "kuka_iiwa/model_vr_limits.urdf",
    "lego/lego.urdf",
    "objects/mug.urdf",
    "pendulum5.urdf",
    "plane.urdf",
    "plane100.urdf",
    "plane_implicit.urdf",
    "plane_transparent.urdf",
    "r2d2.urdf",
    "soccerball.urdf",
    "sphere2.urdf",
    "sphere2red.urdf",
    "sphere2red_nocol.urdf",
    "sphere8cube.urdf",
    "sphere_1cm.urdf",
    "sphere_small.urdf",
    "sphere_transparent.urdf",
    "sphere_with_restitution.urdf",
    "spherical_joint_limit.urdf",
    "table/table.urdf",
    "table_square/table_square.urdf",
    "tray/tray.urdf",
    "tray/traybox.urdf",
)

# The Panda's hand is turned by an eighth of a circle: this joint position squares it with the world.
SQUARING_POSES: dict[str, list[dict[int, float]]] = {"franka_panda/panda.urdf": [{}, {6: math.pi / 4}]}

LOADING_FLAGS = {"default": 0, "inertia_from_file": p.URDF_USE_INERTIA_FROM_FILE}


def joint_facts(body: int, joint: int) -> dict[str, Any]:
    """What getJointInfo says, by name."""
    info = p.getJointInfo(body, joint)
    return {
        "name": info[1].decode(),
        "type": info[2],
        "damping": info[6],
        "friction": info[7],
        "lower": info[8],
        "upper": info[9],
        "effort": info[10],
        "velocity": info[11],
        "link": info[12].decode(),
        "axis": list(info[13]),
        "parent_frame_position": list(info[14]),
        "parent_frame_orientation": list(info[15]),
        "parent": info[16],
    }


def dynamics_facts(body: int, link: int) -> dict[str, Any]:
    """What getDynamicsInfo says, by name."""
    info = p.getDynamicsInfo(body, link)
    return {
        "mass": info[0],
        "lateral_friction": info[1],
        "inertia": list(info[2]),
        "inertial_position": list(info[3]),
        "inertial_orientation": list(info[4]),
        "restitution": info[5],
        "rolling_friction": info[6],
        "spinning_friction": info[7],
        "contact_damping": info[8],
        "contact_stiffness": info[9],
    }


def link_frame(body: int, link: int) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """World pose of a link frame."""
    if link >= 0:
        state = p.getLinkState(body, link, computeForwardKinematics=True)
        if state is None:
            raise RuntimeError(f"link {link} of body {body} has no state")
        return state[4], state[5]
    inertial = p.getDynamicsInfo(body, -1)[3:5]
    return p.multiplyTransforms(*p.getBasePositionAndOrientation(body), *p.invertTransform(*inertial))


def squared_bounds(body: int, link: int) -> list[list[float]] | None:
    """Corners of getAABB in the link frame, or None where the link is askew to the world."""
    position, orientation = link_frame(body, link)
    matrix = p.getMatrixFromQuaternion(orientation)
    if max(min(abs(x), abs(abs(x) - 1.0)) for x in matrix) > 1e-3:
        return None
    to_link = p.invertTransform(position, orientation)
    corners = [p.multiplyTransforms(*to_link, corner, (0, 0, 0, 1))[0] for corner in p.getAABB(body, link)]
    return [
        [min(pair) for pair in zip(*corners, strict=True)],
        [max(pair) for pair in zip(*corners, strict=True)],
    ]


def collision_facts(body: int, link: int) -> list[dict[str, Any]]:
    """What getCollisionShapeData says of the link's shapes, file names left out."""
    return [
        {
            "type": shape[2],
            "dimensions": list(shape[3]),
            "position": list(shape[5]),
            "orientation": list(shape[6]),
        }
        for shape in p.getCollisionShapeData(body, link)
    ]


def facts_of(path: str, name: str) -> dict[str, Any]:
    """Everything recorded of one file, loaded in the default way and with inertia from the file."""
    facts: dict[str, Any] = {"file": name, "pybullet": p.getAPIVersion()}
    for key, flags in LOADING_FLAGS.items():
        body = p.loadURDF(path, flags=flags)
        links = range(-1, p.getNumJoints(body))
        facts[key] = [dynamics_facts(body, link) for link in links]
        if flags == 0:
            base, robot = p.getBodyInfo(body)
            facts["base"], facts["robot"] = base.decode(), robot.decode()
            facts["joints"] = [joint_facts(body, joint) for joint in links if joint >= 0]
            facts["collisions"] = [collision_facts(body, link) for link in links]
            bounds: list[Any] = [None for _ in links]
            for pose in SQUARING_POSES.get(name, [{}]):
                for joint in links:
                    if joint >= 0:
                        p.resetJointState(body, joint, pose.get(joint, 0.0))
                bounds = [
                    known or squared_bounds(body, link) for known, link in zip(bounds, links, strict=True)
                ]
            facts["bounds"] = bounds
        p.removeBody(body)
    return facts


def write_facts(name: str) -> None:
    """Record one asset of the original data folder."""
    facts = facts_of(str(Path(pybullet_data.getDataPath()) / name), name)
    target = FACTS / (name.replace("/", "__").removesuffix(".urdf") + ".json")
    target.parent.mkdir(parents=True, exist_ok=True)
    target.write_text(json.dumps(facts, indent=1) + "\n")


def main(names: list[str]) -> None:
    p.connect(p.DIRECT)
    p.setPhysicsEngineParameter(enableFileCaching=0)
    for name in names or ASSETS:
        write_facts(name)


if __name__ == "__main__":
    main(sys.argv[1:])
