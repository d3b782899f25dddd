"""Debug drawings of scripts, and their sliders, buttons and handles."""

from __future__ import annotations

from dataclasses import dataclass

from carom.description.pose import Quaternion, Vector3

_WHITE = (1.0, 1.0, 1.0)


@dataclass(frozen=True, slots=True)
class DebugItem:
    """A drawing on a link, -1 for the base, of a body or the world (-1); life time [s], 0 for ever."""

    life_time: float = 0.0
    parent_body: int = -1
    parent_link: int = -1


@dataclass(frozen=True, slots=True)
class DebugLine(DebugItem):
    """A line from one point to another; `width` in pixels."""

    start: Vector3 = (0.0, 0.0, 0.0)
    end: Vector3 = (0.0, 0.0, 0.0)
    colour: Vector3 = _WHITE
    width: float = 1.0


@dataclass(frozen=True, slots=True)
class DebugText(DebugItem):
    """Text at a point; it faces the camera unless it has an orientation."""

    text: str = ""
    position: Vector3 = (0.0, 0.0, 0.0)
    colour: Vector3 = _WHITE
    size: float = 1.0
    orientation: Quaternion | None = None


@dataclass(frozen=True, slots=True)
class DebugPoints(DebugItem):
    """A cloud of points, each with its colour; `size` in pixels."""

    positions: tuple[Vector3, ...] = ()
    colours: tuple[Vector3, ...] = ()
    size: float = 1.0


@dataclass(slots=True)
class Handle:
    """A frame that the user moves with the mouse: position [m] and orientation (x, y, z, w), in the world."""

    name: str
    pose: tuple[Vector3, Quaternion]

    @property
    def position(self) -> Vector3:
        """Its position, in the world [m]."""
        return self.pose[0]

    @property
    def orientation(self) -> Quaternion:
        """Its orientation, in the world: a unit quaternion (x, y, z, w)."""
        return self.pose[1]


@dataclass(slots=True)
class Slider:
    """A number that the user can set; with `lower > upper` a button that counts its clicks."""

    name: str
    lower: float
    upper: float
    value: float

    @property
    def is_button(self) -> bool:
        """Whether it is a button."""
        return self.lower > self.upper


@dataclass(slots=True)
class Choice(Slider):
    """One of several texts; `value` is its number. Without texts it is a checkbox: 0 or 1."""

    options: tuple[str, ...] = ()

    @property
    def chosen(self) -> str:
        """The text that the user has chosen."""
        return self.options[int(self.value)]

    @property
    def checked(self) -> bool:
        """Whether the checkbox is checked."""
        return self.value != 0.0
