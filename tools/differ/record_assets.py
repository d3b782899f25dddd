"""Writes `assets.json`: which files of its `pybullet_data` PyBullet loads, and the types of their joints.

`at_limits.json` are those of them with a joint that stands exactly at one of its limits when it is loaded,
`immovable.json` those with a body whose base cannot move.

Run by the interpreter with PyBullet; it needs nothing else.
"""

import glob
import json
import os
import time

import pybullet as p
import pybullet_data

# Too slow, soft, or refused; or they end PyBullet.
LEFT_OUT = (
    "torus_deform", "cloth_z_up", "model_for_sdf", "samurai", "microtaur", "free_base.sdf", "kuka_world",
    "model2", "gripper_new_free",
)  # fmt: skip
SLOW, MANY_BODIES = 0.4, 8


def load(name):
    """Load a file; its bodies."""
    p.resetSimulation()
    if name.endswith("urdf"):
        return [p.loadURDF(name)]
    return list((p.loadSDF if name.endswith("sdf") else p.loadMJCF)(name))


def loads(name):
    """Whether a file can be loaded: tried in a process of its own."""
    child = os.fork()
    if child == 0:
        try:
            load(name)
            os._exit(0)
        except BaseException:
            os._exit(1)
    return os.waitpid(child, 0)[1] == 0


def at_limit(body):
    """Whether a joint of a body has a limit of 0, where it is."""
    for j in range(p.getNumJoints(body)):
        info = p.getJointInfo(body, j)
        if info[2] in (p.JOINT_REVOLUTE, p.JOINT_PRISMATIC) and info[8] <= info[9] and 0 in info[8:10]:
            return True
    return False


def main():
    """Write the tables."""
    folder = os.path.dirname(os.path.abspath(__file__))
    os.chdir(pybullet_data.getDataPath())
    names = sorted(name for name in glob.glob("**/*.urdf", recursive=True) if "random_urdfs" not in name)
    names += [f"random_urdfs/{number}/{number}.urdf" for number in ("000", "007", "042")]
    names += sorted(glob.glob("**/*.sdf", recursive=True) + glob.glob("mjcf/*.xml"))
    p.connect(p.DIRECT)
    lines, limits, immovable = [], [], []
    for name in names:
        if any(word in name for word in LEFT_OUT) or not loads(name):
            continue
        start = time.time()
        bodies = load(name)
        if time.time() - start > SLOW or len(bodies) > MANY_BODIES:
            continue
        types = [[p.getJointInfo(body, j)[2] for j in range(p.getNumJoints(body))] for body in bodies]
        if any(map(at_limit, bodies)):
            limits.append(name)
        if any(p.getDynamicsInfo(body, -1)[0] == 0 for body in bodies):
            immovable.append(name)
        lines.append(f"{json.dumps(name)}: {json.dumps(types, separators=(',', ':'))}")
    for table, rows in (("at_limits", limits), ("immovable", immovable)):
        with open(os.path.join(folder, f"{table}.json"), "w") as file:
            file.write(json.dumps(rows, indent=1) + "\n")
    with open(os.path.join(folder, "assets.json"), "w") as file:
        file.write("{\n" + ",\n".join(lines) + "\n}\n")


if __name__ == "__main__":
    main()
