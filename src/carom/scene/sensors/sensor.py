"""Sensors of a body, as handles."""

from __future__ import annotations

from typing import TYPE_CHECKING

from carom.checks import Array
from carom.description.sensor import SensorSpec
from carom.native.gates import gated
from carom.scene.common.sensor import CommonSensor
from carom.scene.handles import world_of
from carom.scene.named import Named
from carom.scene.sensors.lone_source import LoneSource
from carom.scene.sensors.shown import shown
from carom.scene.sensors.together import together

if TYPE_CHECKING:
    from carom.scene.body import Body


class BodySensor(CommonSensor):
    """One sensor of a body.

    Attributes:
        body: The body.
        index: Its number among the sensors of the body.
    """

    __slots__ = ("body", "index")

    def __init__(self, body: Body, index: int) -> None:
        self.body: Body = body
        self.index: int = index

    def __repr__(self) -> str:
        of = f" of {self.spec.object_type.value} {self.spec.object!r}" if self.spec.object else ""
        return f"<Sensor {self.index} {self.name!r} of {self.body.name!r}: {self.spec.kind.value}{of}>"

    @property
    def spec(self) -> SensorSpec:
        """What it was made from."""
        return self.body.spec.sensors[self.index]

    @property
    def name(self) -> str:
        """Its name."""
        return self.spec.name

    def read(self) -> Array:
        """What it shows now, shape (dim,), in the units of its class in `carom.description.sensors`.

        Poses and velocities are those of the present coordinates; accelerations and forces those of the last
        step, and accelerations are 0 before the first one.

        Raises:
            StateError: Its delay is longer than the measurements that it keeps reach back.
        """
        return shown(self.body, self.index)


class BodySensors(Named[BodySensor]):
    """All sensors of a body: `sensors["imu"]`, `sensors[0]`."""

    def __init__(self, body: Body) -> None:
        super().__init__("sensor", [BodySensor(body, index) for index in range(len(body.spec.sensors))])
        self._body = body
        self._names = self.names

    def __repr__(self) -> str:
        return f"<Sensors of {self._body.name!r}: {', '.join(map(repr, self.names)) or 'none'}>"

    @gated("_body.world.call_lock")
    def read(self) -> dict[str, Array]:
        """What each shows now, by name; see `BodySensor.read`."""
        source = LoneSource(world_of(self._body))
        reader = together(source, self._body)
        shown, others = reader.values(source)
        numbers = shown[0]
        if not others:
            return {name: numbers[place] for name, place in zip(self._names, reader.slices, strict=True)}
        return {
            name: others[index][0].copy() if place is None else numbers[place]
            for index, (name, place) in enumerate(zip(self._names, reader.slices, strict=True))
        }
