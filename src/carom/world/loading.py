"""Bodies of a world from the files that describe robots: URDF, SDF, MJCF and USD."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast, overload

from carom.description.pose import Pose
from carom.model.body_spec import BodySpec
from carom.native.change import Change
from carom.scene.body import Body
from carom.world.shape_adding import ShapeAdding
from carom.world.soft_loading import SoftLoading

if TYPE_CHECKING:
    from carom.editing.description import Description
    from carom.formats.kinds import FileKind
    from carom.formats.search import AssetSearch
    from carom.world.compiled_constraints import NamedConstraint
    from carom.world.face.texts import Assets
    from carom.world.robot_files import Choices
    from carom.world.scene import Scene
    from carom.world.world import World

_ORIGIN = (0.0, 0.0, 0.0)
_NO_TURN = (0.0, 0.0, 0.0, 1.0)


def _source(what: str | Path | Description) -> Path | Description:
    """A description, or the path of a file; raises `TypeError` for anything else."""
    if isinstance(what, (str, Path)):
        return Path(what)
    from carom.editing.description import Description

    return what if isinstance(what, Description) else Path(what)


class DescriptionLoading(ShapeAdding, SoftLoading):
    """Bodies from files of robots, whose readers are imported when needed, from shapes and as soft bodies."""

    @overload
    def load(
        self, what: BodySpec, position: Sequence[float] = ..., orientation: Sequence[float] = ...
    ) -> Body: ...
    @overload
    def load(
        self,
        what: str | Path | Description | tuple[str, Assets],
        position: Sequence[float] = ...,
        orientation: Sequence[float] = ...,
        *,
        fixed_base: bool = ...,
        scale: float = ...,
        flags: int = ...,
        strict: bool = ...,
        package_paths: Sequence[str | Path] = ...,
        missing_meshes: str = ...,
        default_mass: float | None = ...,
        xacro_args: Mapping[str, object] | None = ...,
        srdf: str | Path | None = ...,
    ) -> Scene: ...
    def load(
        self,
        what: BodySpec | str | Path | Description | tuple[str, Assets],
        position: Sequence[float] = (0.0, 0.0, 0.0),
        orientation: Sequence[float] = (0.0, 0.0, 0.0, 1.0),
        *,
        fixed_base: bool = False,
        scale: float = 1.0,
        flags: int = 0,
        strict: bool = False,
        package_paths: Sequence[str | Path] = (),
        missing_meshes: str = "error",
        default_mass: float | None = None,
        xacro_args: Mapping[str, object] | None = None,
        srdf: str | Path | None = None,
    ) -> Body | Scene:
        """Add what a file describes: a robot or a scene (URDF, SDF, MJCF, USD), or a world saved by `save`.

        The format is found by the content of the file. A warning says how much of it is not simulated, and
        `print(scene.ignored)` lists that. See `load_urdf` for how URDF files are read.

        Gravity, time step and fluid of the file (of MJCF files also those that MuJoCo takes where nothing is
        stated) hold in a world without bodies, but for what has been set there; otherwise a warning names
        those that differ, and `Scene.apply_options` sets them.

        A world without bodies becomes a copy of a saved world, parameters and time included, and continues
        exactly as that one did. In any other world, the saved bodies and their constraints are added to those
        already there, with the poses they had.

        Args:
            what: Path of the file; its text, which begins with `<`; a text and the files that it refers to by
                their names, `(text, {"hand.stl": content})`; a description as `carom.read` makes it, which
                is compiled as MJCF is; or the specification of a body, which is added at rest.
            position: Where the frame of the file, or the base's link frame, is in the world [m].
            orientation: Its orientation, quaternion (x, y, z, w).
            fixed_base: Fix the base of a URDF file in the world.
            scale: Factor on all lengths of a URDF or SDF file.
            flags: Loading flags of a URDF or MJCF file, see `carom.layouts.flags.LoadFlags`.
            strict: Raise an error if something in the file would not be simulated.
            package_paths: Directories of ROS packages, or that contain them; see `load_urdf`.
            missing_meshes: `"warn"` leaves out shapes whose mesh is missing, of URDF and MJCF files also
                those whose mesh cannot be read; `"error"` raises an error.
            default_mass: Mass of links of URDF files without `<inertial>` [kg].
            xacro_args: Values of the arguments that a xacro file declares, by name; macros are expanded
                without ROS.
            srdf: Path of an SRDF file, which may be xacro, that says more of the robot of a URDF file: its
                groups of joints become `Scene.groups`, their states keyframes, in which joints of other
                groups are at 0, and the links whose collisions it disables never collide. Whether others of
                the robot do is left to `flags`.

        Returns:
            The bodies of the file and everything else in it by name; of a specification the body's handle. A
            body gets the number of the body that was removed last, if any.

        Raises:
            carom.errors.DescriptionError: The file, or that of a mesh, cannot be used; the world is as
                before.
            ValueError: An argument is out of range, or not for this format.
        """
        if isinstance(what, BodySpec):
            return self._add(what, position, orientation)
        from carom.world.face.texts import TextFiles, is_text

        if is_text(what):
            files = TextFiles(cast("Any", what))
            found = self.load(
                files.path,
                position,
                orientation,
                fixed_base=fixed_base,
                scale=scale,
                flags=flags,
                strict=strict,
                package_paths=package_paths,
                missing_meshes=missing_meshes,
                default_mass=default_mass,
                xacro_args=xacro_args,
                srdf=srdf,
            )
            # They are there as long as the scene, whose description is read from them.
            found._files = files
            return found
        from carom.formats.kinds import is_robot_file
        from carom.world.file_options import take_effect
        from carom.world.robot_files import Choices

        source = _source(cast("str | Path | Description", what))
        if not isinstance(source, Path) or is_robot_file(source):
            choices = Choices(
                fixed_base,
                scale,
                flags,
                strict,
                package_paths,
                missing_meshes,
                default_mass,
                xacro_args,
                srdf,
            )
            was_empty = not self.bodies
            scene = self._load_file(source, position, orientation, choices)
            take_effect(scene, in_empty_world=was_empty)
            return scene
        from carom.formats.reading.ignored import IgnoredList
        from carom.scene.named_constraints.connect import connections_of
        from carom.scene.named_constraints.joint_coupling import couplings_of
        from carom.scene.tendons.coupling import tendon_couplings_of
        from carom.world.scene import Scene

        world, bodies = cast("World", self), self.load_saved(source)
        constraints = [
            *couplings_of(world, bodies), *connections_of(world, bodies), *tendon_couplings_of(bodies)
        ]  # fmt: skip
        return Scene(world, source, "saved world", bodies, IgnoredList(), constraints)

    def load_saved(self, path: str | Path) -> list[Body]:
        """Add all bodies of a world that was saved by `save`; see `load`, which takes other files as well.

        Raises:
            carom.errors.DescriptionError: The file cannot be used; the world is as before.
        """
        from carom.world_files.world_file import load_world

        return load_world(self, Path(path))

    def load_urdf(
        self,
        path: str | Path,
        position: Sequence[float] = (0.0, 0.0, 0.0),
        orientation: Sequence[float] = (0.0, 0.0, 0.0, 1.0),
        *,
        fixed_base: bool = False,
        scale: float = 1.0,
        flags: int = 0,
        as_pybullet: bool = False,
        strict: bool = False,
        package_paths: Sequence[str | Path] = (),
        missing_meshes: str = "error",
        default_mass: float | None = None,
        xacro_args: Mapping[str, object] | None = None,
    ) -> Body:
        """Add the robot that a URDF file describes, as its author meant it.

        So inertia is that of the file, links without `<inertial>` have no mass, joints have the damping and
        the friction that it states and follow those that they `<mimic>`; no motor holds a joint, and no air
        damps the body. A base without mass is fixed in the world if all links that are fixed to it are
        without mass as well. A joint that moves only links without mass stays where it is put: no force moves
        it, which the warning about what is not simulated says.

        Args:
            path: The file; one that comes with `pybullet_data` is found by its name.
            position: Of the base's link frame [m].
            orientation: Of the base's link frame, quaternion (x, y, z, w).
            fixed_base: Fix the base in the world.
            scale: Factor on all lengths.
            flags: Loading flags, see `carom.layouts.flags.LoadFlags`.
            as_pybullet: Read it as PyBullet does: inertia from collision shapes, 1 kg for links without
                `<inertial>`, motors that hold all joints, damping of 0.04 1/s. The next four arguments then
                have no effect.
            strict: Raise an error if something in the file would not be simulated.
            package_paths: Directories of ROS packages, or that contain them, for `package://` and `model://`;
                without them the directories above the file are searched.
            missing_meshes: `"warn"` leaves out shapes whose mesh is missing or cannot be read; `"error"`
                raises an error.
            default_mass: Mass of links without `<inertial>` [kg], with as many kg m² about each axis.
            xacro_args: Values of the arguments that a xacro file declares, by name.

        Raises:
            carom.errors.DescriptionError: The file cannot be used, or it is strict and something is left
                out; the world is as before.
            ValueError: An argument is out of range.
        """
        if as_pybullet:
            from carom.soft.from_urdf import urdf_body

            spec = urdf_body(Path(path), _search(), scale=scale, flags=flags, fixed_base=fixed_base)
            return self._add(spec, position, orientation)
        from carom.formats.kinds import FileKind
        from carom.world.robot_files import Choices

        choices = Choices(
            fixed_base, scale, flags, strict, package_paths, missing_meshes, default_mass, xacro_args
        )
        return self._load_file(Path(path), position, orientation, choices, FileKind.URDF)[0]

    def load_sdf(self, path: str | Path, *, scale: float = 1.0, strict: bool = False) -> list[Body]:
        """Add the models that an SDF file describes, at their poses in the file.

        They are read as the format's specification says: inertia from the file or from the shapes (1 kg and 1
        kg m² where none is stated), frames, axes in the frames that they name, limits only where they are
        stated, damping, friction and springs of joints, gearboxes as couplings of joints. Included
        models are those of their files, looked up by `model://` in `package_paths` of `World.load` and above
        the file. Links and joints of a model inside another have names like `arm::hand`; of one that is
        merged into another they keep their names. A joint that is not at the origin of its link carries it
        by a massless link, `LINK@JOINT`; the second axis of a joint `j` is the joint `j@axis2`.

        A surface is that of a link: friction (1 where none is stated), restitution, and stiffness and damping
        of contacts. Sensors are sites and sensors: `imu` has `imu/acceleration`, `imu/angular_velocity` and
        `imu/orientation`. Plugins that are controllers of joints or rotors of multicopters are actuators with
        the name of the joint or link. Models whose joints form loops are refused.

        Args:
            path: The file; one that comes with `pybullet_data` is found by its name.
            scale: Factor on lengths.
            strict: Raise an error if something in the file would not be simulated.

        Returns:
            Their bodies, in the order of the file.

        Raises:
            carom.errors.DescriptionError: The file cannot be used; the world is as before.
        """
        from carom.formats.kinds import FileKind
        from carom.world.robot_files import Choices

        choices = Choices(scale=scale, strict=strict)
        return self._load_file(Path(path), _ORIGIN, _NO_TURN, choices, FileKind.SDF).bodies

    def load_mjcf(self, path: str | Path, *, flags: int = 0, strict: bool = False) -> list[Body]:
        """Add the bodies that an MJCF file describes, as MuJoCo compiles it, at their poses in the file.

        So masses and inertia are those of all geoms, by the rules of `<compiler>`; the geoms of the world are
        one static body, `world`; a body of the world without joints is fixed, and one with a free joint moves
        freely; links of a body collide with each other unless a joint connects them. Joints are at their
        `ref`. A body with several joints has a link without mass, `BODY@JOINT`, for each but the last.
        `World.load` gives sites, cameras, keyframes and options as well.

        Args:
            path: The file; one that comes with `pybullet_data` is found by its name.
            flags: Loading flags, see `carom.layouts.flags.LoadFlags`.
            strict: Raise an error if something in the file would not be simulated.

        Returns:
            The body `world` if the world has geoms, then its bodies in the order of the file.

        Raises:
            carom.errors.DescriptionError: The file cannot be used; the world is as before.
        """
        from carom.formats.kinds import FileKind
        from carom.world.robot_files import Choices

        choices = Choices(flags=flags, strict=strict)
        return self._load_file(Path(path), _ORIGIN, _NO_TURN, choices, FileKind.MJCF).bodies

    def _load_file(
        self,
        what: Path | Description,
        position: Sequence[float],
        orientation: Sequence[float],
        choices: Choices,
        kind: FileKind | None = None,
    ) -> Scene:
        """Add everything that a robot file or a description describes; see `World.load`."""
        from carom.checks import vector
        from carom.description.pose import Pose
        from carom.world.compiled_constraints import constrain
        from carom.world.compiled_files import describe, equip, finish, put_on_stage
        from carom.world.robot_files import (
            compiled_description,
            couple,
            give_semantics,
            has_mimics,
            placed,
            read_robot_file,
            report,
        )
        from carom.world.scene import Scene

        place = vector(position, 3, "position").tolist()
        turn = vector(orientation, 4, "orientation").tolist()
        if isinstance(what, Path):
            source = read_robot_file(what, choices, kind)
        else:
            source = compiled_description(what, choices)
        report(source, strict=choices.strict)
        constraints: list[NamedConstraint] = []

        frame = Pose((place[0], place[1], place[2]), (turn[0], turn[1], turn[2], turn[3]))

        def also(bodies: list[Body]) -> None:
            constraints.extend(couple(bodies))
            if source.model is not None:
                finish(bodies, source.model)
                constraints.extend(constrain(bodies, source.model, frame))
                equip(bodies, source.model)
            if source.sdf is not None:
                from carom.world.sdf_files import equip_sdf

                equip_sdf(bodies, source.sdf)
            if source.semantics is not None:
                give_semantics(bodies[0], source.semantics)
            if source.usd is not None:
                from carom.world.usd_files import close_loops, equip_usd

                equip_usd(bodies, source.usd, frame)
                constraints.extend(close_loops(bodies, source.usd, frame))

        is_more = source.model is not None or source.sdf is not None or source.usd is not None
        is_more = is_more or source.semantics is not None
        needs_more = is_more or any(has_mimics(spec) for spec, _ in source.bodies)
        bodies = self.load_all(placed(source.bodies, place, turn), also if needs_more else None)
        scene = Scene(
            cast("World", self),
            source.path,
            source.kind.value,
            bodies,
            source.ignored,
            constraints,
            None if isinstance(what, Path) else what,
        )
        if source.model is not None:
            describe(scene, source.model)
            put_on_stage(scene, source.model, frame)
        if source.sdf is not None:
            from carom.world.sdf_files import sites_and_cameras

            scene.options = source.sdf.options
            scene.sites, scene.cameras = sites_and_cameras(source.sdf)
        if source.semantics is not None:
            scene.groups = source.semantics.groups
        if source.usd is not None:
            scene.options, scene.cameras = source.usd.options, source.usd.cameras
        return scene

    def load_all(
        self,
        bodies: Sequence[tuple[BodySpec, Pose]],
        also: Callable[[list[Body]], None] | None = None,
        note: Callable[[Change, list[Body]], None] | None = None,
    ) -> list[Body]:
        """Add bodies at rest, all or none.

        Args:
            bodies: Specification of each body, and the world pose of its base's link frame.
            also: Called with the new bodies, which are in a draft of the world then and can be changed.
            note: Called with the new bodies before they can be used; notes what else changes with them.

        Raises:
            carom.errors.DescriptionError: The file of a mesh cannot be used; the world is as before.
        """
        from carom.file_bodies import make_shapes

        make_shapes(bodies)
        return self._add_all(bodies, also, note)


def _search() -> AssetSearch:
    """A search for files: by the path as given, and then in the folder of `pybullet_data`."""
    from carom.formats.search import AssetSearch
    from carom.formats.shipped import shipped_folder

    return AssetSearch(shipped_folder())
