"""What an SDF file that is read as written hands over."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from carom.description import Pose
from carom.description.transform import compose
from carom.formats.placed import PlacedRobot

if TYPE_CHECKING:
    from carom.description.actuator import Actuator
    from carom.description.sensor import SensorSpec


_SEEN = Pose((0.0, 0.0, 0.0), (0.5, -0.5, -0.5, 0.5))


@dataclass(frozen=True, slots=True)
class Mount:
    """A named frame on a link, with the sensors there.

    Attributes:
        name: Its name.
        link: Name of the link.
        frame: Its pose in the frame of the link.
        reach: Radius of the volume in which it feels contacts [m].
        sensors: What is measured there.
    """

    name: str
    link: str
    frame: Pose
    reach: float = 0.005
    sensors: tuple[SensorSpec, ...] = ()


@dataclass(frozen=True, slots=True)
class SdfCamera:
    """A camera on a link.

    Attributes:
        name: Its name.
        link: Name of the link.
        frame: Its pose in the frame of the link; it looks along x, and z is up.
        field_of_view: Vertical angle [degrees].
        resolution: Width and height [pixels].
    """

    name: str
    link: str
    frame: Pose
    field_of_view: float
    resolution: tuple[int, int]

    @property
    def seen(self) -> Pose:
        """Its pose in the frame of the link with the axes of MJCF's cameras: it looks along -z, y is up."""
        return compose(self.frame, _SEEN)


@dataclass(eq=False, slots=True)
class SdfModel:
    """The robots made from one model: one for each tree of links.

    Attributes:
        robots: The robots, in the order of their roots.
        collide: Names of links that collide with others of the model.
        mounts: Sites and sensors.
        cameras: Cameras.
        actuators: The joint or link that each drives, its name, and what it does.
    """

    robots: list[PlacedRobot] = field(default_factory=list)
    collide: set[str] = field(default_factory=set)
    mounts: list[Mount] = field(default_factory=list)
    cameras: list[SdfCamera] = field(default_factory=list)
    actuators: list[tuple[str, str, Actuator]] = field(default_factory=list)


@dataclass(eq=False, slots=True)
class SdfScene:
    """All of a file.

    Attributes:
        models: Its models, in order.
        options: Values for the world, by name: `gravity` [m/s²], `timestep` [s].
    """

    models: list[SdfModel] = field(default_factory=list)
    options: dict[str, Any] = field(default_factory=dict)

    @property
    def robots(self) -> list[PlacedRobot]:
        """The robots of all models, in order."""
        return [robot for model in self.models for robot in model.robots]
