"""The viewer: a page in the browser that shows a running world, with controls that a script can read.

`connect(p.GUI)` opens it for scripts written for PyBullet. With the modern API, in a notebook for instance:

    from carom import World
    from carom.viewer import Viewer

    world = World()
    world.load_urdf("robot.urdf")
    Viewer(world)        # the last line of a cell shows the page below it
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from carom.viewer.viewer import Viewer

__all__ = ["Viewer"]


def __getattr__(name: str) -> Any:
    if name == "Viewer":
        from carom.viewer.viewer import Viewer

        return Viewer
    raise AttributeError(f"module 'carom.viewer' has no attribute {name!r}")
