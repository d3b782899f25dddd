"""Debug drawings of scripts, and their sliders, buttons and handles."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from math import hypot, isfinite

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
    _moved: Callable[[], None] = field(default=lambda: None, repr=False, compare=False)

    @property
    def position(self) -> Vector3:
        """Its position, in the world [m]."""
        return self.pose[0]

    @property
    def orientation(self) -> Quaternion:
        """Its orientation, in the world: a unit quaternion (x, y, z, w)."""
        return self.pose[1]

    def move_to(self, position: Sequence[float], orientation: Sequence[float] | None = None) -> None:
        """Move it, on all pages; a page on which the user drags it goes on from where the user has it.

        Args:
            position: [m], in the world.
            orientation: Quaternion (x, y, z, w) of any length but 0; None for the present one.

        Raises:
            ValueError: The numbers are not a position and a quaternion.
        """
        x, y, z = map(float, position)
        a, b, c, d = map(float, self.orientation if orientation is None else orientation)
        size = hypot(a, b, c, d)
        if not all(map(isfinite, (x, y, z, size))) or size < 1e-9:
            raise ValueError(
                f"handle {self.name!r} needs a finite position and a quaternion that is not 0, "
                f"not {(x, y, z)} and {(a, b, c, d)}"
            )
        # Position and orientation are replaced together, because other threads may read them.
        self.pose = ((x, y, z), (a / size, b / size, c / size, d / size))
        self._moved()


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


def slider_of(name: str, lower: float, upper: float, start: float) -> Slider:
    """A slider; `ValueError` if a number is not finite, or not lower < upper with the start between them."""
    if not (isfinite(lower) and isfinite(upper) and lower < upper and lower <= start <= upper):
        raise ValueError(
            f"slider {name!r} needs a lower bound below the upper one and a start value between them, "
            f"not {lower}, {upper} and {start}"
        )
    return Slider(name, float(lower), float(upper), float(start))


def list_of(name: str, options: Sequence[str], start: int) -> Choice:
    """A list of texts; `ValueError` if there are none, or `start` is not the index of one."""
    if not 0 <= start < len(options):
        raise ValueError(f"choice {name!r} needs a start between 0 and {len(options) - 1}, not {start}")
    return Choice(name, 0.0, float(len(options) - 1), float(start), tuple(options))


def box_of(name: str, start: bool) -> Choice:
    """A checkbox."""
    return Choice(name, 0.0, 1.0, float(start))
