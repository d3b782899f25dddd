"""What a file brought into a world: its bodies and everything else by name, and what was left out."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, overload

from carom.closed import Closed
from carom.native.gates import gated
from carom.scene.actuators.actuator import BodyActuator
from carom.scene.body import Body
from carom.scene.keyframes.keyframe import Keyframe, keyframes_of

if TYPE_CHECKING:
    from carom.camera import Camera
    from carom.editing.description import Description
    from carom.formats.mjcf.compiled.model import FileCamera, Site
    from carom.formats.reading.ignored import IgnoredList
    from carom.scene.following import Following
    from carom.scene.sensors.sensor import BodySensor
    from carom.scene.tendons.tendon import BodyTendon
    from carom.world.compiled_constraints import NamedConstraint
    from carom.world.world import World

_MAX_NAMES = 8


class Scene(Closed, Sequence[Body]):
    """The content of a file in a world; a sequence of its bodies, also by name.

    Attributes:
        world: The world.
        source: The file.
        format: Its format: `URDF`, `SDF`, `MJCF`, `USD` or `saved world`.
        bodies: The bodies, in the order of the file.
        constraints: Couplings of joints and of tendons, and connected and welded links, by name.
        actuators: Actuators of all bodies by name, in the order of an MJCF file.
        sites: Named frames of MJCF files and places of sensors of SDF files, by name; `Body.sites` has those
            of each body.
        cameras: Cameras of MJCF, SDF and USD files, by name; `camera` makes images by one.
        followings: How those of them follow bodies that do.
        options: What an MJCF file states in `<option>`, by name, and of a `<world>` of SDF its `gravity`, its
            `timestep`, and the `magnetic_field` of its magnetometers. They hold in a world that was empty,
            and `apply_options` sets them in any.
        groups: Of an SRDF file: names of the joints of each group, by its name.
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
        description: Description | None = None,
    ) -> None:
        self.world: World = world
        self.source: Path = source
        self.format: str = format_name
        self.bodies: list[Body] = list(bodies)
        self.constraints: dict[str, NamedConstraint] = {it.name: it for it in constraints}
        self.actuators: dict[str, BodyActuator] = {it.name: it for body in bodies for it in body.actuators}
        self.sites: dict[str, Site] = {}
        self.cameras: dict[str, FileCamera] = {}
        self.followings: dict[str, Following] = {}
        self.options: dict[str, Any] = {}
        self.groups: dict[str, tuple[str, ...]] = {}
        self.ignored: IgnoredList = ignored
        self._files: object = None
        self._loaded: Description | None = None if description is None else description.copy()
        self._close(Scene)

    def apply_options(self) -> None:
        """Set gravity, fluid and time step of the world to those of the file, and how far its solver goes.

        `World.load` has done so if the world was empty, but for what had been set there before.

        Constraints of MJCF files yield, by forces that depend on all others: with the usual
        `solver_residual_threshold` of 1e-7 the solver ends while they are 1e-4 to 2e-3 from those of MuJoCo,
        so `options["solver_residual_threshold"]` is 1e-11 for them. Other options have no effect.
        An integrator that is not built for what is in the world does not take effect; a warning says so.
        """
        from carom.world.file_options import set_parameters, stated_parameters

        set_parameters(self, stated_parameters(self))

    def __repr__(self) -> str:
        names = ", ".join(repr(body.name) for body in self.bodies[:_MAX_NAMES])
        more = f" and {len(self.bodies) - _MAX_NAMES} more" if len(self.bodies) > _MAX_NAMES else ""
        return f"<Scene of {self.source.name} ({self.format}): {names or 'no bodies'}{more}>"

    @property
    def sensors(self) -> dict[str, BodySensor]:
        """The sensors of all bodies by name; if two have the same name, the first."""
        found: dict[str, BodySensor] = {}
        for body in self.bodies:
            for sensor in body.sensors:
                found.setdefault(sensor.name, sensor)
        return found

    @property
    def tendons(self) -> dict[str, BodyTendon]:
        """The tendons of all bodies by name; if two have the same name, the first."""
        found: dict[str, BodyTendon] = {}
        for body in self.bodies:
            for tendon in body.tendons:
                found.setdefault(tendon.name, tendon)
        return found

    @property
    def keyframes(self) -> dict[str, Keyframe]:
        """The keyframes of the bodies by name."""
        return keyframes_of(self.bodies)

    @property
    def description(self) -> Description:
        """The file, or the description that was loaded, as a description that can be changed.

        The bodies of the world stay as they are; `world.load(description)` adds others. A URDF file that was
        loaded with a fixed base has one here as well; other choices of `World.load` don't count.

        Raises:
            carom.errors.DescriptionError: The file has gone, or is a saved world.
        """
        if self._loaded is not None:
            return self._loaded.copy()
        from carom.editing.files import read

        is_urdf = self.format == "URDF"
        return read(self.source, fixed_base=is_urdf and all(body.fixed_base for body in self.bodies))

    def camera(self, name: str, width: int = 320, height: int = 240) -> Camera:
        """A camera for images as one of the file, on the link that has it, with its field of view or lens.

        It follows bodies or looks at them as its `mode` says.

        Args:
            name: One of `cameras`.
            width: Number of columns; the image of a file that states a resolution has that one.
            height: Number of rows, likewise.

        Raises:
            KeyError: The file has no camera of this name.
        """
        if name not in self.cameras:
            known = ", ".join(map(repr, self.cameras)) or "none"
            raise KeyError(f"{self.source.name} has no camera {name!r}; it has {known}")
        from carom.camera import Camera

        it = self.cameras[name]
        if min(it.resolution) > 1:
            width, height = it.resolution
        if it.is_orthographic:
            camera = Camera.orthographic(width, height, it.field_of_view)
        elif it.lens is None:
            camera = Camera.with_field_of_view(width, height, it.field_of_view)
        else:
            (fx, fy), (x, y) = it.lens.focal, it.lens.middle
            middle = x * width - 0.5, y * height - 0.5
            camera = Camera(width, height, fx=fx * width, fy=fy * height, cx=middle[0], cy=middle[1])
        links = (link for body in self.bodies for link in body.links if link.name == it.body)
        camera.mount(next(links, None))
        pose = it.image_frame
        camera.place(pose.position, pose.orientation)
        camera.following = self.followings.get(name)
        return camera

    @gated("world.call_lock")
    def reset(self, name: str) -> None:
        """Reset the bodies that have a keyframe of this name to it, and the world to its time.

        Raises:
            KeyError: No body has a keyframe of this name.
        """
        keyframes = self.keyframes
        if name not in keyframes:
            known = ", ".join(map(repr, keyframes)) or "none"
            raise KeyError(f"{self.source.name} has no keyframe {name!r}; it has {known}")
        keyframes[name].reset()

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
