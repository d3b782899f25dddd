"""Writes docs/status.md from the drop-in itself: `python tools/docs/status.py`."""

import inspect
from collections import defaultdict
from pathlib import Path
from typing import Any

import pybullet

PAGE = Path(__file__).parents[2] / "docs" / "status.md"

TITLES = {
    "_connection": "Connections",
    "_engine": "Stepping and engine parameters",
    "_loading": "Loading",
    "_bodies": "Bodies",
    "_joints": "Joints",
    "_motors": "Motors",
    "_motors_multi_dof": "Motors of joints with several freedoms",
    "_links": "Links",
    "_dynamics": "Masses, friction, damping, limits",
    "_forces": "External forces",
    "_algebra": "Inverse dynamics, Jacobians, mass matrices",
    "_gui": "Sliders, keys and the window's camera",
    "_debug_drawing": "Drawings",
    "_camera_maths": "Camera matrices",
    "_maths": "Maths",
}
UNAVAILABLE = "_unavailable"

NOTES = {
    "_gui": "There is no window yet: sliders keep their start values, drawings are kept but not shown, and "
    "no key is ever pressed.",
}

LIMITED = {
    "connect": "`GUI` simulates without showing a window; there are no physics servers",
    "loadURDF": "shapes give inertia, but do not collide yet",
    "changeDynamics": "contact parameters are recorded for the day there is contact",
    "setPhysicsEngineParameter": "parameters of contact are recorded for the day there is contact",
    "setDefaultContactERP": "recorded for the day there is contact",
}


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


def page() -> str:
    """The whole page."""
    by_home: dict[str, list[str]] = defaultdict(list)
    available = functions()
    for name, function in available.items():
        by_home[home(function)].append(name)
    missing = sorted(by_home.pop(UNAVAILABLE, []))
    unknown = by_home.keys() - TITLES.keys()
    if unknown:
        raise SystemExit(f"give the functions of {', '.join(sorted(unknown))} a title in {__file__}")
    done = len(available) - len(missing)
    lines = [
        "# Status",
        "",
        "<!-- Written by tools/docs/status.py. -->",
        "",
        f"Of the {len(available)} functions of PyBullet 3.2.7, {done} work in this version of Carom, with",
        "every keyword, default, return layout and error. All constants are there with their values.",
    ]
    for module, title in TITLES.items():
        if by_home[module]:
            lines += ["", f"## {title}", ""]
            if module in NOTES:
                lines += [NOTES[module], ""]
            lines += ["| function | what it does |", "|---|---|"]
            for name in by_home[module]:
                limit = f" *Limited: {LIMITED[name]}.*" if name in LIMITED else ""
                lines.append(f"| `{name}` | {first_line(available[name])}{limit} |")
    lines += [
        "",
        "## Not available yet",
        "",
        'These exist and raise `pybullet.error("... is not available in this version of Carom")`:',
        "",
        ", ".join(f"`{name}`" for name in missing) + ".",
    ]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
