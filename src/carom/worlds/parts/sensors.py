"""Sensors and sites of a body in many worlds."""

from __future__ import annotations

import numpy as np

from carom.checks import Array
from carom.description.sensor import SensorObject, SensorSpec
from carom.description.site import SiteSpec
from carom.native.gates import gated
from carom.pose import Pose as WorldPose
from carom.pose import Velocity
from carom.scene.common.sensor import CommonSensor
from carom.scene.sensors.frames import frame_of, motion, placement
from carom.scene.sensors.source import Source
from carom.scene.sensors.together import read_one, read_together
from carom.worlds.batch import Batch
from carom.worlds.parts.links import LinkBatch
from carom.worlds.parts.part import Parts, SensedPart


class SensorBatch(CommonSensor, SensedPart):
    """One sensor of a body in all worlds; get it from `worlds[body].sensors`.

    Attributes:
        index: Its number among the sensors of the body.
        name: Its name.
    """

    __slots__ = ()

    @property
    def spec(self) -> SensorSpec:
        """What it was made from."""
        return self._batch._body.spec.sensors[self.index]

    @gated("_batch._scene.call_lock")
    def read(self) -> Array:
        """What it shows in each world, as `BodySensor.read`: (count, dim), on the host."""
        return read_one(self._source, self._batch._body, self.index)


class SensorBatches(Parts[SensorBatch]):
    """All sensors of a body in all worlds: `sensors["imu"].read()`, `sensors.read()`."""

    def __init__(self, batch: Batch, source: Source) -> None:
        count = len(batch._body.spec.sensors)
        super().__init__("sensor", [SensorBatch(batch, source, index) for index in range(count)])
        self._batch = batch
        self._source = source

    @gated("_batch._scene.call_lock")
    def read(self) -> dict[str, Array]:
        """What each shows, by name: (count, dim) each, on the host; if names are equal, the last one."""
        shown = read_together(self._source, self._batch._body)
        return {name: values.copy() for name, values in zip(self.names, shown, strict=True)}


class SiteBatch(SensedPart):
    """A site, a frame on a link, in all worlds; get it from `worlds[body].sites`.

    Attributes:
        index: Its number among the sites of the body.
        name: Its name.
    """

    __slots__ = ()

    @property
    def spec(self) -> SiteSpec:
        """What it was made from."""
        return self._batch._body.spec.sites[self.index]

    @property
    def link(self) -> LinkBatch:
        """The link that it is on."""
        return LinkBatch(self._batch, self.spec.link)

    @property
    @gated("_batch._scene.call_lock")
    def pose(self) -> WorldPose:
        """World poses for the present coordinates, copies on the host: (count, 3) and (count, 4)."""
        frame = frame_of(self._batch._body, SensorObject.SITE, self.name)
        position, orientation = placement(self._source, frame)
        return WorldPose(np.array(position), np.array(orientation))

    @property
    @gated("_batch._scene.call_lock")
    def velocity(self) -> Velocity:
        """Velocities of its origin and angular velocities, in world axes, (count, 3) each."""
        found = motion(self._source, frame_of(self._batch._body, SensorObject.SITE, self.name))
        return Velocity(np.array(found.linear), np.array(found.angular))


class SiteBatches(Parts[SiteBatch]):
    """All sites of a body in all worlds: `sites["tool"].pose`."""

    def __init__(self, batch: Batch, source: Source) -> None:
        count = len(batch._body.spec.sites)
        super().__init__("site", [SiteBatch(batch, source, index) for index in range(count)])
        self._batch = batch
