"""What a file brought into a world: its bodies and everything else by name, and what was left out."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, overload

from carom.scene.actuators.actuator import BodyActuator
from carom.scene.body import Body

if TYPE_CHECKING:
    from carom.formats.mjcf.compiled.model import FileCamera, Site
    from carom.formats.reading.ignored import IgnoredList
    from carom.world.compiled_constraints import NamedConstraint
    from carom.world.keyframe import Keyframe
    from carom.world.world import World

_MOST_NAMES = 8


class Scene(Sequence[Body]):
    """The content of a file in a world; a sequence of its bodies, also by name.

    Attributes:
        world: The world.
        source: The file.
        format: Its format: `URDF`, `SDF`, `MJCF` or `saved world`.
        bodies: The bodies, in the order of the file.
        constraints: Couplings of joints, and connected and welded links, by name.
        actuators: Actuators of all bodies by name, in the order of an MJCF file.
        sensors: Sensors by name; none are made yet.
        sites: Named frames of MJCF files, by name.
        keyframes: Named states of MJCF files, by name; `reset` puts the bodies into one.
        cameras: Cameras of MJCF files, by name.
        options: What an MJCF file states in `<option>`, by name; `apply_options` sets it in the world.
        ignored: What the file says and the simulation lacks; prints as a table.
    """

    def __init__(
        self,
        world: World,
        source: Path,
        format_name: str,
        bodies: Sequence[Body],
        ignored: IgnoredList,
        constraints: Sequence[NamedConstraint] = (),
    ) -> None:
        self.world: World = world
        self.source: Path = source
        self.format: str = format_name
        self.bodies: list[Body] = list(bodies)
        self.constraints: dict[str, NamedConstraint] = {it.name: it for it in constraints}
        self.actuators: dict[str, BodyActuator] = {it.name: it for body in bodies for it in body.actuators}
        self.sensors: dict[str, Any] = {}
        self.sites: dict[str, Site] = {}
        self.keyframes: dict[str, Keyframe] = {}
        self.cameras: dict[str, FileCamera] = {}
        self.options: dict[str, Any] = {}
        self.ignored: IgnoredList = ignored

    def reset(self, keyframe: str) -> None:
        """Put the bodies of the scene into a state of the file; the time of the world goes on.

        Actuators get its controls and activations; motors keep their commands.

        Args:
            keyframe: Its name.

        Raises:
            KeyError: There is no keyframe of this name.
        """
        if keyframe not in self.keyframes:
            known = ", ".join(map(repr, self.keyframes)) or "none"
            raise KeyError(f"no keyframe has the name {keyframe!r}; those of {self.source.name} are {known}")
        self.keyframes[keyframe].apply()

    def apply_options(self) -> None:
        """Set gravity and the time step of the world to those of the file; other options have no effect."""
        if "gravity" in self.options:
            has_gravity = self.options.get("flag.gravity", True)
            self.world.gravity = self.options["gravity"] if has_gravity else (0.0, 0.0, 0.0)
        if "timestep" in self.options:
            self.world.parameters.time_step = self.options["timestep"]
            self.world.apply_parameters()

    def __repr__(self) -> str:
        names = ", ".join(repr(body.name) for body in self.bodies[:_MOST_NAMES])
        more = f" and {len(self.bodies) - _MOST_NAMES} more" if len(self.bodies) > _MOST_NAMES else ""
        return f"<Scene of {self.source.name} ({self.format}): {names or 'no bodies'}{more}>"

    def __len__(self) -> int:
        return len(self.bodies)

    @overload
    def __getitem__(self, which: int | str) -> Body: ...
    @overload
    def __getitem__(self, which: slice) -> list[Body]: ...
    def __getitem__(self, which: int | str | slice) -> Body | list[Body]:
        """A body by place or name, or several by place.

        Raises:
            KeyError: No body, or more than one, has this name.
            IndexError: There are not as many bodies.
        """
        if not isinstance(which, str):
            return self.bodies[which]
        found = [body for body in self.bodies if body.name == which]
        if len(found) != 1:
            known = ", ".join(repr(body.name) for body in self.bodies) or "none"
            problem = f"{len(found)} bodies have" if found else "no body has"
            raise KeyError(f"{problem} the name {which!r}; those of {self.source.name} are {known}")
        return found[0]
