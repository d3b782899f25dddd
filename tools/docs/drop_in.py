"""Writes docs/status.md and docs/api/pybullet.md from the drop-in itself: `python tools/docs/drop_in.py`."""

import inspect
from collections import defaultdict
from pathlib import Path
from typing import Any

import pybullet
from pybullet import _constants

DOCS = Path(__file__).parents[2] / "docs"

# The order of the sections; files not named here follow, under their names.
TITLES = {
    "_connection": "Connections",
    "_loading": "Loading",
    "_loading_scenes": "Loading scenes",
    "_collision_shapes": "Collision shapes",
    "_visual_shapes": "Visual shapes",
    "_multi_body": "Bodies made of shapes",
    "_vhacd": "Convex decomposition",
    "_engine": "Stepping and engine parameters",
    "_bodies": "Bodies",
    "_joints": "Joints",
    "_motors": "Motors",
    "_motors_multi_dof": "Motors of joints with several freedoms",
    "_links": "Links",
    "_dynamics": "Masses, friction, damping, limits",
    "_forces": "External forces",
    "_contacts": "Contacts",
    "_nearby": "Nearest points and overlaps",
    "_rays": "Rays",
    "_collision_filters": "Collision filters",
    "_shape_data": "What shapes a body has",
    "_constraints": "Constraints",
    "_algebra": "Inverse dynamics, Jacobians, mass matrices",
    "_inverse_kinematics": "Inverse kinematics",
    "_gui": "Sliders, keys and the window's camera",
    "_debug_drawing": "Drawings",
    "_camera": "Camera images",
    "_camera_legacy": "Camera images, the old way",
    "_camera_maths": "Camera matrices",
    "_textures": "Colours and textures",
    "_soft_bodies": "Soft bodies",
    "_scene_script": "Scenes as scripts",
    "_states": "States and world files",
    "_user_data": "User data",
    "_logging": "Logs",
    "_plugins": "Plugins",
    "_maths": "Maths",
}
UNAVAILABLE = "_unavailable"

NOTES = {
    "_gui": "The window is [a page in the browser](viewer.md).",
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
_NO_SOFT_BODIES = "no effect yet: there are no soft bodies"
_NO_DEVICES = "no effect: devices of virtual reality are never there"
WITHOUT_EFFECT = {
    **dict.fromkeys(
        ["CONTACT_REPORT_EXISTING", "CONTACT_RECOMPUTE_CLOSEST", "SENSOR_FORCE_TORQUE"], _NOBODY_TAKES_IT
    ),
    **{name: _NOBODY_TAKES_IT for name in vars(_constants) if name.startswith("IK_HAS_")},
    **{name: _NO_DEVICES for name in vars(_constants) if name.startswith(("VR_", "COV_ENABLE_VR_"))},
    **dict.fromkeys(
        ["RESET_USE_DEFORMABLE_WORLD", "RESET_USE_REDUCED_DEFORMABLE_WORLD", "MESH_DATA_SIMULATION_MESH"],
        _NO_SOFT_BODIES,
    ),
    "RESET_USE_DISCRETE_DYNAMICS_WORLD": "no effect: worlds of rigid bodies are all alike",
    "RESET_USE_SIMPLE_BROADPHASE": "no effect: pairs are found in one way",
    "URDF_GLOBAL_VELOCITIES_MB": "no effect: bodies move the same with it in PyBullet, but for rounding",
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
    """The file a function is written in, without its ending."""
    # The builtins that `pybullet` consists of call a Python function, their `__self__`.
    return Path(inspect.getsourcefile(function.__self__) or "").stem


def first_line(function: Any) -> str:
    """The first line of a function's documentation."""
    return (inspect.getdoc(function.__self__) or "").partition("\n")[0]


def sections() -> dict[str, tuple[str, list[str]]]:
    """Title and functions of each file, in order; the functions that are not available come last."""
    by_home: dict[str, list[str]] = defaultdict(list)
    for name, function in functions().items():
        by_home[home(function)].append(name)
    missing = by_home.pop(UNAVAILABLE, [])
    others = {
        file: file.strip("_").replace("_", " ").capitalize() for file in sorted(by_home.keys() - TITLES)
    }
    ordered = {file: (title, by_home[file]) for file, title in (TITLES | others).items() if file in by_home}
    return {**ordered, UNAVAILABLE: ("Not available yet", sorted(missing))}


def constants() -> dict[str, dict[str, int]]:
    """The constants by the titles they have in their file, with their values."""
    groups: dict[str, dict[str, int]] = {}
    title = ""
    for line in inspect.getsource(_constants).splitlines():
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
    _, missing = parts.pop(UNAVAILABLE)
    lines = [
        "# Status",
        "",
        "<!-- Written by tools/docs/drop_in.py. -->",
        "",
        f"Of the {len(available)} functions of PyBullet 3.2.7, {len(available) - len(missing)} work in this "
        "version of Carom, with",
        "every keyword, default, return layout and error. The [constants](#constants) come last.",
    ]
    for file, (title, names) in parts.items():
        lines += ["", f"## {title}", ""]
        if file in NOTES:
            lines += [NOTES[file], ""]
        lines += ["| function | what it does |", "|---|---|"]
        for name in names:
            limit = f" *Limited: {LIMITED[name]}.*" if name in LIMITED else ""
            lines.append(f"| `{name}` | {first_line(available[name])}{limit} |")
    if missing:
        lines += [
            "",
            "## Not available yet",
            "",
            'These exist and raise `pybullet.error("... is not available in this version of Carom")`:',
            "",
            ", ".join(f"`{name}`" for name in missing) + ".",
        ]
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
        "are ours. Everything is a name of the module `pybullet`. Functions that are not built yet are",
        "listed under [status](../status.md).",
        "",
        "The examples start from this world; `folder` is an empty directory.",
        "",
        "```python",
        *EXAMPLE_WORLD.splitlines(),
        "```",
    ]
    for file, (title, _) in sections().items():
        if file != UNAVAILABLE:
            lines += ["", f"## {title}", "", f"::: pybullet.{file}{MEMBERS}"]
    return "\n".join(lines) + "\n"


PAGES = {DOCS / "status.md": status, DOCS / "api" / "pybullet.md": reference}


if __name__ == "__main__":
    for path, page in PAGES.items():
        path.write_text(page(), encoding="utf-8")
