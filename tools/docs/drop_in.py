"""Writes docs/status.md and docs/api/pybullet.md from the drop-in itself: `python tools/docs/drop_in.py`."""

import inspect
from collections import defaultdict
from pathlib import Path
from typing import Any

import pybullet
from pybullet._calls import constants as codes

DOCS = Path(__file__).parents[2] / "docs"

# The order of the sections; files not named here follow, under their names.
TITLES = {
    "_connections.connection": "Connections",
    "_loading.loading": "Loading",
    "_loading.loading_scenes": "Loading scenes",
    "_loading.soft": "Loading soft bodies",
    "_shapes.collision_shapes": "Collision shapes",
    "_shapes.visual_shapes": "Visual shapes",
    "_loading.multi_body": "Bodies made of shapes",
    "_shapes.vhacd": "Convex decomposition",
    "_engine.engine": "Stepping and engine parameters",
    "_bodies.bodies": "Bodies",
    "_joints.joints": "Joints",
    "_joints.motors": "Motors",
    "_joints.motors_multi_dof": "Motors of joints with several freedoms",
    "_bodies.links": "Links",
    "_bodies.dynamics": "Masses, friction, damping, limits",
    "_bodies.forces": "External forces",
    "_contacts.contacts": "Contacts",
    "_contacts.nearby": "Nearest points and overlaps",
    "_contacts.rays": "Rays",
    "_contacts.collision_filters": "Collision filters",
    "_shapes.shape_data": "What shapes a body has",
    "_joints.constraints": "Constraints",
    "_algorithms.algebra": "Inverse dynamics, Jacobians, mass matrices",
    "_algorithms.inverse_kinematics": "Inverse kinematics",
    "_window.gui": "Sliders, keys and the window's camera",
    "_window.debug_drawing": "Drawings",
    "_cameras.camera": "Camera images",
    "_cameras.camera_legacy": "Camera images, the old way",
    "_maths.camera_maths": "Camera matrices",
    "_shapes.textures": "Colours and textures",
    "_bodies.soft_bodies": "Soft bodies",
    "_loading.scene_script": "Scenes as scripts",
    "_engine.states": "States and world files",
    "_bodies.user_data": "User data",
    "_logs.logging": "Logs",
    "_plugins.plugins": "Plugins",
    "_maths.maths": "Maths",
}

NOTES = {
    "_window.gui": "The window is [a page in the browser](viewer.md).",
}

# What the examples of the reference start from. They are run as tests.
EXAMPLE_WORLD = """\
import pybullet as p
import pybullet_data

p.connect(p.DIRECT)
p.setAdditionalSearchPath(pybullet_data.getDataPath())
p.setGravity(0, 0, -9.8)
plane = p.loadURDF("plane.urdf")
arm = p.loadURDF("kuka_iiwa/model.urdf", useFixedBase=1)
cube = p.loadURDF("cube_small.urdf", [0.5, 0, 0.025])
"""

LIMITED = {
    "configureDebugVisualizer": "the flags of virtual reality are recorded and have no effect",
    "setPhysicsEngineParameter": "all values of `constraintSolverType` are solved as 1, and "
    "`allowedCcdPenetration` and `enableSAT` have no effect",
    "vhacd": "needs the library CoACD, which cuts differently from V-HACD",
}

# Constants that can be given and change nothing, or that no function takes or returns, and why.
_NOBODY_TAKES_IT = "no function takes it, nor does one in PyBullet"
_NO_DEVICES = "no effect: devices of virtual reality are never there"
WITHOUT_EFFECT = {
    **dict.fromkeys(
        ["CONTACT_REPORT_EXISTING", "CONTACT_RECOMPUTE_CLOSEST", "SENSOR_FORCE_TORQUE"], _NOBODY_TAKES_IT
    ),
    **{name: _NOBODY_TAKES_IT for name in vars(codes) if name.startswith("IK_HAS_")},
    **{name: _NO_DEVICES for name in vars(codes) if name.startswith(("VR_", "COV_ENABLE_VR_"))},
    "RESET_USE_DISCRETE_DYNAMICS_WORLD": "no effect: worlds of rigid bodies are all alike",
    "RESET_USE_SIMPLE_BROADPHASE": "no effect: pairs are found in one way",
    "URDF_ENABLE_CACHED_GRAPHICS_SHAPES": "no effect: shapes that are the same are always shared",
    "URDF_INITIALIZE_SAT_FEATURES": "no effect: faces and edges are always known",
    "GEOM_CONCAVE_INTERNAL_EDGE": "no effect",
    "CONSTRAINT_SOLVER_LCP_PGS": "no effect yet: solved as type 1",
    "CONSTRAINT_SOLVER_LCP_DANTZIG": "no effect yet: solved as type 1",
    "COV_ENABLE_TINY_RENDERER": "no effect: there is one renderer",
    "ER_TINY_RENDERER": "no effect: there is one renderer",
    "ER_BULLET_HARDWARE_OPENGL": "no effect: there is one renderer",
    "STATE_LOGGING_CUSTOM_TIMER": "logs nothing",
    "CNSFileIO": "refused, as by PyBullet as it is distributed",
}

MEMBERS = """
    options:
      show_root_heading: false
      show_root_toc_entry: false
      heading_level: 3"""


def functions() -> dict[str, Any]:
    """All functions of the module by name."""
    return {name: value for name, value in vars(pybullet).items() if inspect.isbuiltin(value)}


def home(function: Any) -> str:
    """The room and the file a function is written in, such as `_joints.motors`."""
    # The builtins that `pybullet` consists of call a Python function, their `__self__`.
    path = Path(inspect.getsourcefile(function.__self__) or "")
    return f"{path.parent.name}.{path.stem}"


def first_line(function: Any) -> str:
    """The first line of a function's documentation."""
    return (inspect.getdoc(function.__self__) or "").partition("\n")[0]


def sections() -> dict[str, tuple[str, list[str]]]:
    """Title and functions of each file, in order."""
    by_home: dict[str, list[str]] = defaultdict(list)
    for name, function in functions().items():
        by_home[home(function)].append(name)
    others = {
        file: file.partition(".")[2].replace("_", " ").capitalize()
        for file in sorted(by_home.keys() - TITLES)
    }
    return {file: (title, by_home[file]) for file, title in (TITLES | others).items() if file in by_home}


def constants() -> dict[str, dict[str, int]]:
    """The constants by the titles they have in their file, with their values."""
    groups: dict[str, dict[str, int]] = {}
    title = ""
    for line in inspect.getsource(codes).splitlines():
        if line.startswith("# "):
            title = line.removeprefix("# ")
        elif " = " in line:
            name = line.partition(" = ")[0]
            groups.setdefault(title, {})[name] = getattr(pybullet, name)
    return groups


def list_of_constants() -> list[str]:
    """The part of the status that tells of constants."""
    groups = constants()
    count = sum(map(len, groups.values()))
    lines = ["", "## Constants", ""]
    lines.append(f"All {count} constants are there with their values. Some change nothing:")
    for title, group in groups.items():
        lines += ["", f"### {title}", "", "| constant | value | state |", "|---|---|---|"]
        for name, value in group.items():
            lines.append(f"| `{name}` | {value} | {WITHOUT_EFFECT.get(name, 'works')} |")
    return lines


def status() -> str:
    """The page that lists all functions and how far they are."""
    available = functions()
    parts = sections()
    lines = [
        "# Status",
        "",
        "<!-- Written by tools/docs/drop_in.py. -->",
        "",
        f"All {len(available)} functions of PyBullet 3.2.7 work in this version of Carom, with every",
        "keyword, default, return layout and error, but for what is marked as limited. The",
        "[constants](#constants) come last.",
    ]
    for file, (title, names) in parts.items():
        lines += ["", f"## {title}", ""]
        if file in NOTES:
            lines += [NOTES[file], ""]
        lines += ["| function | what it does |", "|---|---|"]
        for name in names:
            limit = f" *Limited: {LIMITED[name]}.*" if name in LIMITED else ""
            lines.append(f"| `{name}` | {first_line(available[name])}{limit} |")
    lines += list_of_constants()
    return "\n".join(lines) + "\n"


def reference() -> str:
    """The page from which the reference of the drop-in is built."""
    lines = [
        "# pybullet",
        "",
        "<!-- Written by tools/docs/drop_in.py. -->",
        "",
        "The drop-in, function by function. Keywords, defaults and return values are PyBullet's; the texts",
        "are ours. Everything is a name of the module `pybullet`. What is limited yet is said under",
        "[status](../status.md).",
        "",
        "The examples start from this world; `folder` is an empty directory.",
        "",
        "```python",
        *EXAMPLE_WORLD.splitlines(),
        "```",
    ]
    for file, (title, _) in sections().items():
        lines += ["", f"## {title}", "", f"::: pybullet.{file}{MEMBERS}"]
    return "\n".join(lines) + "\n"


PAGES = {DOCS / "status.md": status, DOCS / "api" / "pybullet.md": reference}


if __name__ == "__main__":
    for path, page in PAGES.items():
        path.write_text(page(), encoding="utf-8")
