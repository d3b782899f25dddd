"""Writes `tables`: what PyBullet says of the files of its `pybullet_data`.

`assets.json` are those it loads, and the types of their joints. `at_limits.json` are those of them with a
joint that stands exactly at one of its limits when it is loaded, `children_first.json` those that list a link
before its parent, and `fine.json` those with a hull of very many corners, and meshes that make one.
`bare.json` are those with a link that has a joint to move and no collision shape. `swept.json` are those with
capsules that are given by two points: the least radius of these, and the greatest of these and of balls [m].
`thin.json` are those with boxes thinner than 5 cm, and how thin [m]. `tied.json` are those with fixed joints:
of each link the one that fixed joints tie it to, which is nearest to the base; once as links are numbered
without flags, and once with `URDF_MAINTAIN_LINK_ORDER`.

Run by the interpreter with PyBullet; it needs nothing else.
"""

import glob
import json
import os
import re
import time
from xml.etree import ElementTree

import pybullet as p
import pybullet_data

# Too slow, soft, or refused; or they end PyBullet.
LEFT_OUT = (
    "torus_deform", "cloth_z_up", "model_for_sdf", "samurai", "microtaur", "free_base.sdf", "kuka_world",
    "model2", "gripper_new_free",
)  # fmt: skip
SLOW, MANY_BODIES = 0.4, 8
MESHES = (
    "cube.obj", "duck_vhacd.obj", "sphere_smooth.obj", "l_finger_tip.stl", "teddy2_VHACD_CHs.obj", "duck.obj",
)  # fmt: skip
MANY_CORNERS = 100
THIN = 0.05


def load(name):
    """Load a file; its bodies."""
    p.resetSimulation()
    if name.endswith("urdf"):
        return [p.loadURDF(name)]
    return list((p.loadSDF if name.endswith("sdf") else p.loadMJCF)(name))


def holds(question, name):
    """Whether a question about a file is answered with yes: asked in a process of its own, which may end."""
    child = os.fork()
    if child == 0:
        try:
            os._exit(0 if question(name) else 1)
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


def tied(body):
    """Of each link that from which on fixed joints lead to it; -1 is the base."""
    infos = [p.getJointInfo(body, j) for j in range(p.getNumJoints(body))]
    first = list(range(len(infos)))
    for j in range(len(infos)):
        # A link may have a number below that of its parent.
        while first[j] >= 0 and infos[first[j]][2] == p.JOINT_FIXED:
            first[j] = infos[first[j]][16]
    return first


def is_fine(body):
    """Whether a link of a body is a hull of many corners."""
    for link in range(-1, p.getNumJoints(body)):
        meshes = [shape for shape in p.getCollisionShapeData(body, link) if shape[2] == p.GEOM_MESH]
        if meshes and p.getMeshData(body, link)[0] > MANY_CORNERS:
            return True
    return False


def has_a_fine_hull(name):
    """Whether a body of a file has such a hull."""
    return any(map(is_fine, load(name)))


def has_a_bare_link(body):
    """Whether a link of a body has a joint to move and no collision shape."""
    return any(
        p.getJointInfo(body, j)[2] != p.JOINT_FIXED and not p.getCollisionShapeData(body, j)
        for j in range(p.getNumJoints(body))
    )


def lists_a_child_first(name):
    """Whether a URDF file lists a link before its parent."""
    p.resetSimulation()
    body = p.loadURDF(name, flags=p.URDF_MAINTAIN_LINK_ORDER)
    return any(p.getJointInfo(body, j)[16] >= j for j in range(p.getNumJoints(body)))


def radii_of_swept(name):
    """The least radius of capsules that a file gives by two points, the greatest of round shapes; or None."""
    root = ElementTree.parse(name).getroot()
    default = root.find("default/geom")
    usual = {} if default is None else default.attrib
    geoms = [{**usual, **geom.attrib} for body in root.iter("body") for geom in body.iter("geom")]
    radii = [
        float(geom["size"].split()[0]) for geom in geoms if "fromto" in geom and geom.get("type") == "capsule"
    ]
    balls = [float(geom["size"].split()[0]) for geom in geoms if geom.get("type") == "sphere"]
    return [min(radii), max(radii + balls)] if radii else None


def thinnest_box(name):
    """The least extent of a box that collides in a URDF file, if it is below 5 cm, or None."""
    with open(name) as file:
        collisions = re.findall("<collision.*?</collision>", file.read(), re.DOTALL)
    boxes = re.findall("<box\\s+size=[\"']([^\"']*)", " ".join(collisions))
    sizes = [abs(float(size)) for box in boxes for size in box.split()]
    return min(sizes) if sizes and min(sizes) < THIN else None


def makes_a_fine_hull(name):
    """Whether the hull of a mesh has many corners."""
    return is_fine(p.createMultiBody(1, p.createCollisionShape(p.GEOM_MESH, fileName=name)))


def main():
    """Write the tables."""
    folder = os.path.join(os.path.dirname(os.path.abspath(__file__)), "tables")
    os.chdir(pybullet_data.getDataPath())
    names = sorted(name for name in glob.glob("**/*.urdf", recursive=True) if "random_urdfs" not in name)
    names += [f"random_urdfs/{number}/{number}.urdf" for number in ("000", "007", "042")]
    names += sorted(glob.glob("**/*.sdf", recursive=True) + glob.glob("mjcf/*.xml"))
    p.connect(p.DIRECT)
    lines, bare, limits, children_first = [], [], [], []
    swept, thin, ties = {}, {}, {}
    fine = [name for name in MESHES if holds(makes_a_fine_hull, name)]
    for name in names:
        if any(word in name for word in LEFT_OUT) or not holds(load, name):
            continue
        start = time.time()
        bodies = load(name)
        if time.time() - start > SLOW or len(bodies) > MANY_BODIES:
            continue
        types = [[p.getJointInfo(body, j)[2] for j in range(p.getNumJoints(body))] for body in bodies]
        if name.endswith(".xml") and radii_of_swept(name):
            swept[name] = radii_of_swept(name)
        if name.endswith(".urdf") and thinnest_box(name) is not None:
            thin[name] = thinnest_box(name)
        if name.endswith(".urdf") and p.JOINT_FIXED in types[0]:
            listed = p.loadURDF(name, flags=p.URDF_MAINTAIN_LINK_ORDER)
            ties[name] = [tied(bodies[0]), tied(listed)]
        if any(map(has_a_bare_link, bodies)):
            bare.append(name)
        if any(map(at_limit, bodies)):
            limits.append(name)
        if holds(has_a_fine_hull, name):
            fine.append(name)
        lines.append(f"{json.dumps(name)}: {json.dumps(types, separators=(',', ':'))}")
        if name.endswith("urdf") and holds(lists_a_child_first, name):
            children_first.append(name)
    tables = {
        "at_limits": limits,
        "bare": bare,
        "children_first": children_first,
        "fine": fine,
        "swept": swept,
        "thin": thin,
    }
    for table, rows in tables.items():
        with open(os.path.join(folder, f"{table}.json"), "w") as file:
            file.write(json.dumps(rows, indent=1) + "\n")
    with open(os.path.join(folder, "tied.json"), "w") as file:
        rows = [f"{json.dumps(name)}: {json.dumps(ties[name], separators=(',', ':'))}" for name in ties]
        file.write("{\n" + ",\n".join(rows) + "\n}\n")
    with open(os.path.join(folder, "assets.json"), "w") as file:
        file.write("{\n" + ",\n".join(lines) + "\n}\n")


if __name__ == "__main__":
    main()
