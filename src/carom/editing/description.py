"""Descriptions and their parts: a robot or scene as a tree that can be changed before it is compiled."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from carom.checks import vector
from carom.closed import Closed
from carom.description.pose import Pose
from carom.description.transform import compose
from carom.editing.attributes import Value, check_attribute, check_free, element_of, missing, text_of
from carom.editing.elements import IN_BODIES, SECTIONS, copied, pairs, pose_of, section
from carom.editing.joining import join
from carom.editing.keys import Keys
from carom.editing.losses import Losses
from carom.editing.moving import between
from carom.editing.references import BODY, MESH, SITE, kind_of, named, references
from carom.editing.removing import remove_elements
from carom.editing.scaling import scale_tree
from carom.errors import DescriptionError
from carom.files.xml_element import Element
from carom.formats.reading.ignored import IgnoredList

if TYPE_CHECKING:
    from carom.formats.search import AssetSearch

_OF_SHAPE = ("file", "vertex", "normal", "texcoord", "face", "builtin", "params", "content_type")
_ORIGIN = (0.0, 0.0, 0.0)
_NO_TURN = (0.0, 0.0, 0.0, 1.0)


class Description(Closed):
    """A robot or a scene as data: bodies, joints, shapes, sites, actuators, sensors and all else by name.

    `carom.read` makes one of a file. It can be changed, put into others, written as MJCF, URDF or USD, and
    added to a world by `World.load`. Its terms are those of MJCF, whatever it was read from: lengths in
    metres, angles in radians, poses in the body around. Of an MJCF file includes, frames, copies, attached
    models and defaults have been resolved, so each element says by itself what counts for it.

    Attributes:
        source: The file it was read from.
        ignored: What that file says and a description does not hold; of an MJCF file what MuJoCo leaves out.
    """

    def __init__(self, root: Element, source: Path, ignored: IgnoredList, search: AssetSearch) -> None:
        self.source: Path = source
        self.ignored: IgnoredList = ignored
        self._root: Element = root
        self._search: AssetSearch = search
        self._close(Description)

    @property
    def root(self) -> Element:
        """The root of the tree of elements, `<mujoco>`; internal."""
        return self._root

    @property
    def search(self) -> AssetSearch:
        """The search for files that it names; internal."""
        return self._search

    @property
    def name(self) -> str:
        """Its name, as the model of an MJCF file and the robot of a URDF file have one."""
        return self._root.attributes.get("model", "")

    @name.setter
    def name(self, name: str) -> None:
        self._root.attributes["model"] = name

    @property
    def bodies(self) -> Parts:
        """Its bodies by name: of URDF and SDF files the links."""
        return Parts(self, BODY)

    @property
    def joints(self) -> Parts:
        """Its joints by name, also free ones."""
        return Parts(self, "joint")

    @property
    def geoms(self) -> Parts:
        """Its shapes by name; those without a name are not here."""
        return Parts(self, "geom")

    @property
    def sites(self) -> Parts:
        """Its sites by name."""
        return Parts(self, SITE)

    @property
    def cameras(self) -> Parts:
        """Its cameras by name."""
        return Parts(self, "camera")

    @property
    def actuators(self) -> Parts:
        """Its actuators by name."""
        return Parts(self, "actuator")

    @property
    def sensors(self) -> Parts:
        """Its sensors by name."""
        return Parts(self, "sensor")

    @property
    def tendons(self) -> Parts:
        """Its tendons by name."""
        return Parts(self, "tendon")

    @property
    def equalities(self) -> Parts:
        """Its constraints by name: couplings of joints and tendons, connected and welded bodies."""
        return Parts(self, "equality")

    @property
    def meshes(self) -> Parts:
        """Its meshes by name; `replace_mesh` changes their files."""
        return Parts(self, MESH)

    @property
    def materials(self) -> Parts:
        """Its materials by name."""
        return Parts(self, "material")

    @property
    def keyframes(self) -> Parts:
        """Its keyframes by name."""
        return Parts(self, "keyframe")

    def copy(self) -> Description:
        """A copy that can be changed by itself."""
        return Description(copied(self._root), self.source, self.ignored, self._search)

    def attach(
        self,
        other: Description,
        at: str,
        *,
        prefix: str = "",
        position: Sequence[float] = _ORIGIN,
        orientation: Sequence[float] = _NO_TURN,
    ) -> IgnoredList:
        """Put another description into a body of this one, as a gripper onto an arm.

        It is fixed there: bodies that were free lose their free joints. Its actuators, sensors, tendons,
        constraints, assets and keyframes come with it; its options (gravity, time step, solver) do not count.
        Keyframes of the same name become one, and joints that a keyframe says nothing of are at their
        references in it. The other description is not changed, so it can be attached again, with another
        prefix.

        Args:
            other: What is attached.
            at: Name of a site or, if there is none, of a body.
            prefix: Added in front of all names in `other`, so that they are not those here.
            position: Of the world of `other` in the frame of the site or body [m].
            orientation: Likewise, quaternion (x, y, z, w).

        Returns:
            What of `other` does not count here: free joints, and options that differ.

        Raises:
            KeyError: There is no such site or body.
            carom.errors.DescriptionError: Both have something of one name, or a body of `other` has to stay
                in the world; nothing is changed.
            ValueError: The pose is none.
        """
        pose = _pose(position, orientation)
        known = named(self._root)
        body = known.get((BODY, at))
        if (site := known.get((SITE, at))) is not None:
            body = next(parent for parent, it in pairs(self._root) if it is site)
            pose = compose(_pose_of_site(site), pose)
        if body is None:
            names = [name for kind, name in known if kind in (SITE, BODY)]
            raise KeyError(missing(self.name, "site or body", at, names))
        is_world = body.tag == "worldbody"
        return self._join(other, body, pose, prefix, is_world=is_world)

    def merge(
        self,
        other: Description,
        *,
        prefix: str = "",
        position: Sequence[float] = _ORIGIN,
        orientation: Sequence[float] = _NO_TURN,
    ) -> IgnoredList:
        """Put another description beside this one, into the same world; free bodies stay free.

        Args:
            other: What is added, with all that belongs to it; see `attach`.
            prefix: Added in front of all names in `other`.
            position: Of its world in this one's [m].
            orientation: Likewise, quaternion (x, y, z, w).

        Returns:
            What of `other` does not count here: options that differ.

        Raises:
            carom.errors.DescriptionError: Both have something of one name; nothing is changed.
            ValueError: The pose is none.
        """
        pose = _pose(position, orientation)
        return self._join(other, section(self._root, "worldbody"), pose, prefix, is_world=True)

    def _join(
        self, other: Description, body: Element, pose: Pose, prefix: str, *, is_world: bool
    ) -> IgnoredList:
        losses = Losses(other.source)
        join(self._root, other.root, body, pose, prefix, losses, is_world=is_world)
        self.ignored = IgnoredList.of([*self.ignored, *other.ignored])
        return losses.list()

    def scale(self, factor: float) -> None:
        """Multiply all lengths by a factor, with densities as they are.

        So masses grow with the third power, moments of inertia with the fifth. Positions of sliding joints
        are lengths, also in keyframes. Gains, gears and ranges of actuators, stiffness and damping, couplings
        of joints, and what tendons over joints state remain as they are.

        Raises:
            ValueError: The factor is not positive.
        """
        if not 0.0 < factor < float("inf"):
            raise ValueError(f"factor is {factor}; expected a positive number")
        scale_tree(self._root, factor)

    def rename(self, old: str, new: str, *, kind: str | None = None) -> None:
        """Give something another name, also where others name it.

        Args:
            old: Its name.
            new: Its new name.
            kind: What it is, as `body` or `joint`; needed if things of several kinds have this name.

        Raises:
            KeyError: There is nothing of this name.
            ValueError: The name is taken or empty, or several kinds have the old one.
        """
        found, element = self._find(old, kind)
        if not new:
            raise ValueError("a name must not be empty")
        if (found, new) in named(self._root):
            raise ValueError(f"there is a {found} {new!r} already")
        for reference in references(self._root):
            if (reference.kind, reference.name) == (found, old):
                reference.restate(new)
        element.attributes["class" if found == "class" else "name"] = new

    def remove(self, name: str, *, kind: str | None = None) -> list[str]:
        """Remove something, what is in it, and what needs it.

        Of a body that is all bodies, joints and shapes in it, and the actuators, sensors, tendons and
        constraints that name one of these; a body whose joint is removed is fixed to the one around it, where
        it is at the reference. Keyframes keep what they say of the rest.

        Args:
            name: Its name.
            kind: What it is, as `body` or `joint`; needed if things of several kinds have this name.

        Returns:
            What went with it, as `["geom 'pad'", "actuator 'grip'"]`.

        Raises:
            KeyError: There is nothing of this name.
            ValueError: Several kinds have this name.
        """
        _, element = self._find(name, kind)
        keys = Keys(self._root)
        gone = remove_elements(self._root, [element])
        keys.write(self._root)
        return gone

    def replace_mesh(self, name: str, file: str | Path, *, scale: Sequence[float] | None = None) -> None:
        """Take the triangles of a mesh from another file; all shapes that have the mesh change.

        Bodies whose mass follows from their shapes get that of the new ones; those that state their mass, as
        links of URDF files, keep it.

        Args:
            name: Name of the mesh, see `meshes`.
            file: An OBJ, STL, DAE, GLB, glTF or PLY file.
            scale: Factors along x, y and z, or one for all; without them, those of the old mesh.

        Raises:
            KeyError: There is no such mesh.
            carom.errors.DescriptionError: The file cannot be used; nothing is changed.
        """
        from carom.meshes.reader import read_mesh

        element = self.meshes[name]
        path = Path(file).absolute()
        if not path.is_file():
            raise DescriptionError("there is no such file", file=path)
        read_mesh(path, by_ears=True)
        for attribute in _OF_SHAPE:
            if attribute in element.attributes:
                del element[attribute]
        element["file"] = str(path)
        if scale is not None:
            factors = [float(scale)] * 3 if isinstance(scale, (int, float)) else scale
            element["scale"] = vector(factors, 3, "scale").tolist()

    def add(self, section_name: str, tag: str, **attributes: Value) -> Part | None:
        """Add an element to a section, as `add("actuator", "motor", name="m", joint="knee")`.

        `Part.add` of a body adds to that; to the world, `add("worldbody", "geom", ...)`.

        Args:
            section_name: Name of the section: `actuator`, `sensor`, `equality`, `contact`, `asset`...
            tag: Name of the element in MJCF.
            attributes: Its attributes.

        Returns:
            The part, if it has a name.

        Raises:
            ValueError: There is no such section or attribute, or the name is taken.
        """
        if section_name not in SECTIONS:
            raise ValueError(f"there is no section {section_name!r}; there are {', '.join(SECTIONS)}")
        return self.put(section(self._root, section_name), tag, attributes)

    def put(self, parent: Element, tag: str, attributes: Mapping[str, Value]) -> Part | None:
        """Add an element to another one; internal."""
        element = element_of(tag, parent.tag, attributes)
        check_free(self._root, element, parent)
        keys = Keys(self._root)
        parent.children.append(element)
        keys.write(self._root)
        kind = kind_of(element, parent)
        return Part(self, kind, element) if kind and "name" in element.attributes else None

    def text(self) -> str:
        """The description as MJCF, with absolute paths of files."""
        from carom.editing.mjcf_text import mjcf_text

        return mjcf_text(self._root, None)

    def write(self, path: str | Path, *, model: str | None = None) -> IgnoredList:
        """Write it as MJCF (`.xml` or `.mjcf`), URDF (`.urdf`) or USD (`.usd`, `.usda`, `.usdc`, `.usdz`).

        Args:
            path: The file; its ending says what is written. Paths in it are relative to it.
            model: Of several robots the one that is written as URDF or USD: its name, that of its root body,
                or its number from 0. MJCF has all.

        Returns:
            What the description has and the file does not say, also `ignored`; print it.

        Raises:
            carom.errors.DescriptionError: Something in the description is wrong, or there are several robots.
            ValueError: The ending is another one.
            OSError: The file cannot be written.
        """
        from carom.editing.writing_files import write

        lost = write(self._root, self.source, self._search, Path(path), model)
        return IgnoredList.of([*self.ignored, *lost])

    def _find(self, name: str, kind: str | None) -> tuple[str, Element]:
        known = named(self._root)
        found = {each: it for (each, own), it in known.items() if own == name and kind in (None, each)}
        if not found:
            names = [own for each, own in known if kind in (None, each)]
            raise KeyError(missing(self.name, kind or "part", name, names))
        if len(found) > 1:
            raise ValueError(f"{name!r} is the name of a {', a '.join(found)}; say which by kind=")
        return next(iter(found.items()))

    def __repr__(self) -> str:
        return f"<Description {self.name!r}: {len(self.bodies)} bodies, {len(self.joints)} joints>"


class Part(Closed):
    """A body, joint, geom, site, actuator or anything else in a description that has a name.

    `part["damping"]` is the text of an attribute of MJCF (`None` if it is not stated), in metres, kilograms
    and radians, with poses in the frame of the body around it; `part["damping"] = 0.3` states it, and
    `del part["damping"]` leaves it out. Numbers may be given as numbers or sequences.

    Attributes:
        description: The description that it is in.
        kind: What it is: `body`, `joint`, `geom`, `site`, `actuator`...
    """

    def __init__(self, description: Description, kind: str, element: Element) -> None:
        self.description: Description = description
        self.kind: str = kind
        self._element: Element = element
        self._close(Part)

    @property
    def tag(self) -> str:
        """Name of its element in MJCF."""
        return self._element.tag

    @property
    def name(self) -> str:
        """Its name; `rename` changes it."""
        return self._element.attributes["class" if self.kind == "class" else "name"]

    @property
    def attributes(self) -> dict[str, str]:
        """A copy of all attributes that are stated."""
        return dict(self._element.attributes)

    def rename(self, name: str) -> None:
        """Give it another name, also where others name it; raises `ValueError` if the name is taken."""
        self.description.rename(self.name, name, kind=self.kind)

    def remove(self) -> list[str]:
        """Remove it, what is in it and what needs it; gives what went with it. See `Description.remove`."""
        return self.description.remove(self.name, kind=self.kind)

    def add(self, tag: str, **attributes: Value) -> Part | None:
        """Add an element to a body: a `geom`, `site`, `joint`, `camera`, `inertial` or another `body`.

        Args:
            tag: Name of the element in MJCF.
            attributes: Its attributes.

        Returns:
            The part, if it has a name.

        Raises:
            ValueError: It is no body, or has no such element or attribute, or the name is taken.
        """
        if self.kind != "body":
            raise ValueError(f"{self.kind} {self.name!r} holds no other elements; a body does")
        if tag not in (*IN_BODIES, "body"):
            raise ValueError(f"a body has no <{tag}>; it has {', '.join((*IN_BODIES, 'body'))}")
        return self.description.put(self._element, tag, attributes)

    def __getitem__(self, attribute: str) -> str | None:
        check_attribute(self._element.tag, self.kind, attribute)
        return self._element.attributes.get(attribute)

    def __setitem__(self, attribute: str, value: Value) -> None:
        check_attribute(self._element.tag, self.kind, attribute)
        if attribute in ("name", "class"):
            raise ValueError(f"{attribute} is not set; `rename` changes names")
        self._element.attributes[attribute] = text_of(value)

    def __delitem__(self, attribute: str) -> None:
        check_attribute(self._element.tag, self.kind, attribute)
        if attribute in ("name", "class"):
            raise ValueError(f"{attribute} stays; `remove` removes the whole {self.kind}")
        self._element.attributes.pop(attribute, None)

    def __repr__(self) -> str:
        return f"<{self.kind} {self.name!r} of the description {self.description.name!r}>"


class Parts(Mapping[str, Part]):
    """The parts of a kind in a description, by name."""

    def __init__(self, description: Description, kind: str) -> None:
        self._description = description
        self._kind = kind

    def _elements(self) -> dict[str, Element]:
        return {name: it for (kind, name), it in named(self._description.root).items() if kind == self._kind}

    def __getitem__(self, name: str) -> Part:
        found = self._elements()
        if name not in found:
            raise KeyError(missing(self._description.name, self._kind, name, list(found)))
        return Part(self._description, self._kind, found[name])

    def __iter__(self) -> Iterator[str]:
        return iter(self._elements())

    def __len__(self) -> int:
        return len(self._elements())

    def __repr__(self) -> str:
        return f"<{self._kind}: {', '.join(self) or 'none'}>"


def _pose_of_site(site: Element) -> Pose:
    return between(copied(site)) if "fromto" in site.attributes else pose_of(site)


def _pose(position: Sequence[float], orientation: Sequence[float]) -> Pose:
    x, y, z = vector(position, 3, "position").tolist()
    turn = vector(orientation, 4, "orientation")
    length = float((turn @ turn) ** 0.5)
    if length == 0.0:
        raise ValueError("orientation has no length, so it is no rotation")
    i, j, k, w = (turn / length).tolist()
    return Pose((x, y, z), (i, j, k, w))
