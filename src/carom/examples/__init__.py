"""What the scripts of the tutorials share: `carom.examples.window`, and robots of their own.

It is installed with Carom, so that a script runs from any folder it is saved in.
"""

from __future__ import annotations

from pathlib import Path

_ROBOTS = Path(__file__).parent / "robots"


def robot_file(name: str) -> str:
    """The path of a robot of the tutorials.

    Args:
        name: Name of its file, such as `one_joint_arm.urdf` or `quadruped.xml`.

    Returns:
        The path of the file.

    Raises:
        FileNotFoundError: There is no such robot; the message lists those that there are.
    """
    path = _ROBOTS / name
    if not path.is_file():
        there = ", ".join(sorted(file.name for file in _ROBOTS.iterdir()))
        raise FileNotFoundError(f"no robot of the tutorials is named {name!r}; expected one of {there}")
    return str(path)
