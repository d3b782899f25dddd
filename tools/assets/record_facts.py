"""Record what the original assets look like to real PyBullet, as figures our own files must reproduce.

Run with an interpreter that has PyBullet and the original pybullet_data:

    .oracle/bin/python tools/assets/record_facts.py [NAME ...]

It writes tests/pybullet_data/facts/<name>.json, one file per asset, and needs nothing of Carom.
"""

from __future__ import annotations

import json
import subprocess
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
    "a1/a1.urdf",
    "aliengo/aliengo.urdf",
    "bicycle/bike.urdf",
    "biped/biped2d_pybullet.urdf",
    "block.urdf",
    "cartpole.urdf",
    "cloth_z_up.urdf",
    "cube.urdf",
    "cube_collisionfilter.urdf",
    "cube_no_rotation.urdf",
    "cube_rotate.urdf",
    "cube_small.urdf",
    "differential/diff_ring.urdf",
    "domino/domino.urdf",
    "duck_vhacd.urdf",
    "franka_panda/panda.urdf",
    "gripper/wsg50_one_motor_gripper.sdf",
    "gripper/wsg50_one_motor_gripper_left_finger.urdf",
    "gripper/wsg50_one_motor_gripper_new.sdf",
    "gripper/wsg50_one_motor_gripper_new_free_base.sdf",
    "gripper/wsg50_one_motor_gripper_no_finger.sdf",
    "gripper/wsg50_one_motor_gripper_right_finger.urdf",
    "gripper/wsg50_with_r2d2_gripper.sdf",
    "humanoid/humanoid.urdf",
    "husky/husky.urdf",
    "jenga/jenga.urdf",
    "kiva_shelf/model.sdf",
    "kuka_iiwa/kuka_with_gripper.sdf",
    "kuka_iiwa/kuka_with_gripper2.sdf",
    "kuka_iiwa/model.sdf",
    "kuka_iiwa/model.urdf",
    "kuka_iiwa/model_free_base.urdf",
    "kuka_iiwa/model_vr_limits.urdf",
    "laikago/laikago.urdf",
    "laikago/laikago_toes.urdf",
    "laikago/laikago_toes_limits.urdf",
    "laikago/laikago_toes_zup.urdf",
    "laikago/laikago_toes_zup_lores.urdf",
    "lego/lego.urdf",
    "mini_cheetah/mini_cheetah.urdf",
    "mjcf/ant.xml",
    "mjcf/capsule.xml",
    "mjcf/capsule_fromtoX.xml",
    "mjcf/capsule_fromtoY.xml",
    "mjcf/capsule_fromtoZ.xml",
    "mjcf/cylinder.xml",
    "mjcf/cylinder_fromtoX.xml",
    "mjcf/cylinder_fromtoY.xml",
    "mjcf/cylinder_fromtoZ.xml",
    "mjcf/ground.xml",
    "mjcf/ground_plane.xml",
    "mjcf/half_cheetah.xml",
    "mjcf/hello_mjcf.xml",
    "mjcf/hopper.xml",
    "mjcf/humanoid.xml",
    "mjcf/humanoid_fixed.xml",
    "mjcf/humanoid_symmetric.xml",
    "mjcf/humanoid_symmetric_no_ground.xml",
    "mjcf/inverted_double_pendulum.xml",
    "mjcf/inverted_pendulum.xml",
    "mjcf/pusher.xml",
    "mjcf/reacher.xml",
    "mjcf/striker.xml",
    "mjcf/swimmer.xml",
    "mjcf/thrower.xml",
    "mjcf/walker2d.xml",
    "objects/mug.urdf",
    "pendulum5.urdf",
    "plane.urdf",
    "plane100.urdf",
    "plane_implicit.urdf",
    "plane_stadium.sdf",
    "plane_transparent.urdf",
    "pr2_gripper.urdf",
    "quadruped/microtaur/microtaur.urdf",
    "quadruped/minitaur.urdf",
    "quadruped/minitaur_derpy.urdf",
    "quadruped/minitaur_fixed_all.urdf",
    "quadruped/minitaur_fixed_knees.urdf",
    "quadruped/minitaur_rainbow_dash.urdf",
    "quadruped/minitaur_rainbow_dash_v1.urdf",
    "quadruped/minitaur_single_motor.urdf",
    "quadruped/minitaur_v1.urdf",
    "quadruped/quadruped.urdf",
    "quadruped/spirit40.urdf",
    "quadruped/spirit40newer.urdf",
    "quadruped/vision60.urdf",
    "r2d2.urdf",
    "racecar/racecar.urdf",
    "racecar/racecar_differential.urdf",
    "samurai.urdf",
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
    "stadium.sdf",
    "stadium_no_collision.sdf",
    "table/table.urdf",
    "table_square/table_square.urdf",
    "teddy_large.urdf",
    "teddy_vhacd.urdf",
    "tray/tray.urdf",
    "tray/tray_textured2.urdf",
    "tray/traybox.urdf",
    "urdf/mug.urdf",
    "xarm/base.urdf",
    "xarm/base_com.urdf",
    "xarm/link1.urdf",
    "xarm/link1_com.urdf",
    "xarm/link2.urdf",
    "xarm/link2_com.urdf",
    "xarm/link3.urdf",
    "xarm/link3_com.urdf",
    "xarm/link4.urdf",
    "xarm/link4_com.urdf",
    "xarm/link5.urdf",
    "xarm/link5_com.urdf",
    "xarm/link6.urdf",
    "xarm/link6_com.urdf",
    "xarm/xarm6_robot.urdf",
    "xarm/xarm6_robot_white.urdf",
    "xarm/xarm6_with_gripper.urdf",
    *(f"random_urdfs/{number:03d}/{number:03d}.urdf" for number in range(10)),
)

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


def inertial_frame(body: int, link: int) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """World pose of the inertial frame of a link."""
    if link < 0:
        return p.getBasePositionAndOrientation(body)
    state = p.getLinkState(body, link, computeForwardKinematics=True)
    if state is None:
        raise RuntimeError(f"link {link} of body {body} has no state")
    return state[0], state[1]


def bounds(body: int, link: int) -> list[list[float]]:
    """Corners of getAABB in the inertial frame of the link, to which the body is turned for it."""
    position, orientation = p.getBasePositionAndOrientation(body)
    _, turn = inertial_frame(body, link)
    upright = p.multiplyTransforms((0, 0, 0), p.invertTransform((0, 0, 0), turn)[1], (0, 0, 0), orientation)[
        1
    ]
    p.resetBasePositionAndOrientation(body, (0, 0, 0), upright)
    centre, _ = inertial_frame(body, link)
    corners = [[x - c for x, c in zip(corner, centre, strict=True)] for corner in p.getAABB(body, link)]
    p.resetBasePositionAndOrientation(body, position, orientation)
    return corners


def collision_facts(body: int, link: int) -> list[dict[str, Any]]:
    """What getCollisionShapeData says of the link's shapes, file names left out.

    It tells the size of a cylinder only where cylinders are not made into hulls.
    """
    return [
        {
            "type": shape[2],
            "dimensions": list(shape[3]),
            "position": list(shape[5]),
            "orientation": list(shape[6]),
        }
        for shape in p.getCollisionShapeData(body, link)
    ]


def loaded(path: str, flags: int) -> list[int]:
    """The bodies of a file."""
    if path.endswith(".sdf"):
        return list(p.loadSDF(path))
    if path.endswith(".xml"):
        return list(p.loadMJCF(path))
    return [p.loadURDF(path, flags=flags)]


def links_of(body: int) -> range:
    return range(-1, p.getNumJoints(body))


def description_facts(body: int) -> dict[str, Any]:
    """Names and joints of a body, and where it is."""
    base, robot = p.getBodyInfo(body)
    place, turn = p.getBasePositionAndOrientation(body)
    return {
        "robot": robot.decode(),
        "base": base.decode(),
        "place": [*place, *turn],
        "joints": [joint_facts(body, joint) for joint in range(p.getNumJoints(body))],
        "bounds": [bounds(body, link) for link in links_of(body)],
    }


def link_names(body: int) -> list[str]:
    """Names of the links after the base."""
    return [p.getJointInfo(body, joint)[12].decode() for joint in range(p.getNumJoints(body))]


def facts_of(path: str, name: str) -> list[dict[str, Any]]:
    """Everything recorded of each body of a file."""
    facts = [{"file": name, "pybullet": p.getAPIVersion()} | description_facts(b) for b in loaded(path, 0)]
    is_urdf = path.endswith(".urdf")
    for key, flags in LOADING_FLAGS.items() if is_urdf else [("default", 0)]:
        p.resetSimulation()
        for body, fact in zip(loaded(path, flags), facts, strict=True):
            fact[key] = [dynamics_facts(body, link) for link in links_of(body)]
    p.resetSimulation()
    if is_urdf:
        (fact,), (body,) = facts, loaded(path, p.URDF_MAINTAIN_LINK_ORDER)
        if (names := link_names(body)) != [joint["link"] for joint in fact["joints"]]:
            fact["file_order"] = names
    p.resetSimulation()
    if not path.endswith(".xml"):  # PyBullet crashes when it is asked for the shapes of these
        for body, fact in zip(loaded(path, p.URDF_USE_IMPLICIT_CYLINDER), facts, strict=True):
            fact["collisions"] = [collision_facts(body, link) for link in links_of(body)]
    p.resetSimulation()
    return facts


def text_of(facts: list[dict[str, Any]]) -> str:
    """JSON with a line for each link and joint."""
    bodies: list[str] = []
    for fact in facts:
        rows = [
            f'  "{key}": [\n' + ",\n".join(f"   {json.dumps(row)}" for row in value) + "\n  ]"
            if isinstance(value, list) and key != "place"
            else f'  "{key}": {json.dumps(value)}'
            for key, value in fact.items()
        ]
        bodies.append(" {\n" + ",\n".join(rows) + "\n }")
    return "[\n" + ",\n".join(bodies) + "\n]\n"


def write_facts(name: str) -> None:
    """Record one asset of the original data folder."""
    facts = facts_of(str(Path(pybullet_data.getDataPath()) / name), name)
    target = FACTS / (name.replace("/", "__").removesuffix(".urdf") + ".json")
    target.parent.mkdir(parents=True, exist_ok=True)
    target.write_text(text_of(facts))


def main(names: list[str]) -> None:
    if len(names) != 1:  # one process each: PyBullet numbers the joints of MJCF files through
        for name in names or ASSETS:
            subprocess.run([sys.executable, __file__, name], check=True)
        return
    p.connect(p.DIRECT)
    p.setPhysicsEngineParameter(enableFileCaching=0)
    write_facts(names[0])


if __name__ == "__main__":
    main(sys.argv[1:])
