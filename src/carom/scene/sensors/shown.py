"""What sensors of a body in a single world show now."""

from __future__ import annotations

from typing import TYPE_CHECKING

from carom.checks import Array
from carom.native.gates import gated
from carom.scene.handles import world_of
from carom.scene.sensors.lone_source import LoneSource
from carom.scene.sensors.together import read_one

if TYPE_CHECKING:
    from carom.scene.core.body_core import BodyCore


@gated("world.call_lock")
def shown(body: BodyCore, sensor: int) -> Array:
    """What the sensor with this index shows, as `BodySensor.read`."""
    return read_one(LoneSource(world_of(body)), body, sensor)[0]
