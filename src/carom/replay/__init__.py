"""Replays read back: what `World.record`, `carom record` and the page's *Save* write, as arrays by names.

`read` reads a page, `export` writes it as MCAP, as a recording of Rerun, or as glTF with an animation.
"""

from carom.replay.exporting import export
from carom.replay.reading import read
from carom.replay.replay import (
    Replay,
    ReplayActuator,
    ReplayBody,
    ReplayContacts,
    ReplayEvent,
    ReplayJoint,
    ReplayLink,
    ReplayLook,
    ReplayMesh,
    ReplayShape,
    ReplayTendons,
    ReplayTexture,
)

__all__ = [
    "Replay",
    "ReplayActuator",
    "ReplayBody",
    "ReplayContacts",
    "ReplayEvent",
    "ReplayJoint",
    "ReplayLink",
    "ReplayLook",
    "ReplayMesh",
    "ReplayShape",
    "ReplayTendons",
    "ReplayTexture",
    "export",
    "read",
]
