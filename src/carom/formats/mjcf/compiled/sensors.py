"""`<sensor>`: what is measured of sites, joints, actuators and bodies."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace

from carom.description.pose import Pose
from carom.description.sensor import (
    DISTANCE_KINDS,
    FRAME_KINDS,
    MAX_RAYS,
    RANGE_FIELDS,
    SUBTREE_KINDS,
    SensorKind,
    SensorObject,
    SensorSpec,
    objects_of,
)
from carom.errors import DescriptionError
from carom.files.xml_element import Element
from carom.formats.mjcf.compiled.contact_sensors import read_contact_sensor, read_distance_sensor
from carom.formats.mjcf.compiled.elements import Scope
from carom.formats.mjcf.compiled.looks.camera import range_image
from carom.formats.mjcf.compiled.model import CompiledModel, Site
from carom.formats.mjcf.compiled.names import Names, in_order, resolved
from carom.formats.robot.context import shown

_LOST = "there is no such sensor"
_WORLD = "world"
_OF_SIDES = {kind.value: kind for kind in (SensorKind.CONTACT, *DISTANCE_KINDS)}
_APART = (SensorKind.SUBTREE_LINEAR_MOMENTUM, *_OF_SIDES.values())
_OF_MUJOCO = tuple(kind for kind in SensorKind if kind not in _APART)
BUILT: dict[str, SensorKind] = {kind.value: kind for kind in _OF_MUJOCO}
"""The kinds that are read, by the names of their elements, besides those between two sides."""
_FRAMES = {"site": SensorObject.SITE, "xbody": SensorObject.LINK, "body": SensorObject.INERTIAL_FRAME}
_LOADS = (SensorKind.FORCE, SensorKind.TORQUE)
# Size of the site that stands for the frame of a geom or a camera [m].
_SMALL = (0.005, 0.005, 0.005)
_BALLS = (SensorKind.BALL_QUATERNION, SensorKind.BALL_ANGULAR_VELOCITY)


class SensorReader:
    """Reads all `<sensor>` sections into a model whose other parts are known."""

    def __init__(
        self, model: CompiledModel, names: Names, geoms: Mapping[str, str], frames: Mapping[str, Pose | None]
    ) -> None:
        """`geoms` has the body of each geom by name, `frames` its frame in that, None for meshes."""
        self.model = model
        self._geoms = geoms
        self._frames = frames
        self._names = names
        self._lines: dict[str, int] = {}
        self._scopes: list[Scope] = []
        self._kinds = {name: kind for name, _, kind in model.joints if name}
        self._robots = {
            link.name: placed.robot.name for placed in model.robots for link in placed.robot.links
        }
        self._colliding = {
            shape.name for placed in model.robots for link in placed.robot.links for shape in link.collisions
        }
        links = [link for placed in model.robots for link in placed.robot.links]
        # Each geom is seen, and bodies have links without geoms as well.
        self._partly = {link.name for link in links if 0 < len(link.collisions) < len(link.visuals)}
        self._ghosts = {link.name for link in links if link.visuals and not link.collisions}
        self._held = {
            link.name for placed in model.robots if placed.fixed_base for link in placed.robot.links[:1]
        }

    def read(self, scope: Scope) -> None:
        """Read the sensors of a file and of all that it attaches; raises `DescriptionError`."""
        for element, of in self._names.sections(scope, "sensor"):
            kind = BUILT.get(element.tag)
            if element.tag in _OF_SIDES:
                self._read_sides(of, element, _OF_SIDES[element.tag])
            if kind is None:
                continue
            element.note()
            attributes = element.attributes
            object_type, name, known, problem = self._object(of, element, kind)
            reference_type, reference = SensorObject.NONE, ""
            if not problem and kind in FRAME_KINDS and attributes.get("refname"):
                reference_type, reference, others, problem = self._frame(of, element, "ref")
                known = known | others
                if reference == _WORLD and reference_type is not SensorObject.SITE:
                    reference_type, reference = SensorObject.NONE, ""
            if problem:
                of.context.leave_out(element, _LOST, problem)
                continue
            if not {name, reference}.isdisjoint(self._names.nodes):
                of.context.leave_out(element, _LOST, "nodes of flexes have no sensors")
                continue
            copies = self._names.copies(of, [name, reference], known) if name else [of]
            if not copies:
                self._names.missing(of, element, [name, reference], known, object_type.value)
            for copy in copies:
                spec = self._spec(copy, element, kind)
                whole = resolved(copy, name, known)
                kind_of_frame = attributes.get("objtype")
                if kind is SensorKind.RANGE_FINDER:
                    spec = self._with_rays(copy, element, spec, whole)
                    kind_of_frame = "camera" if _is_camera(element) else None
                found = replace(
                    spec,
                    object_type=object_type,
                    object=self._framed(kind_of_frame, whole),
                    reference_type=reference_type,
                    reference=self._framed(attributes.get("reftype"), resolved(copy, reference, known)),
                )
                self._add(copy, element, found)
        self.model.sensors = in_order(self.model.sensors, self._scopes)

    def _read_sides(self, scope: Scope, element: Element, kind: SensorKind) -> None:
        """Read a sensor of contacts or distance."""
        element.note()
        if kind is SensorKind.CONTACT:
            stated, problem = read_contact_sensor(scope.context, element)
        else:
            stated, problem = read_distance_sensor(scope.context, element, kind), ""
        first, second = stated.object, stated.reference
        known = self._known_sides(stated.object_type, stated.reference_type)
        copies = self._names.copies(scope, [first, second], known) if first or second else [scope]
        if not copies:
            self._names.missing(scope, element, [first, second], known, "such geom, body or site")
        for copy in copies:
            quality = self._spec(copy, element, kind)
            spec = replace(
                quality,
                object_type=stated.object_type,
                object=resolved(copy, first, known),
                reference_type=stated.reference_type,
                reference=resolved(copy, second, known),
                fields=stated.fields,
                slots=stated.slots,
                reduction=stated.reduction,
                reach=quality.reach if kind is SensorKind.CONTACT else quality.cutoff,
            )
            lost = problem or self._problem_of_sides(spec)
            if lost:
                copy.context.leave_out(element, _LOST, lost)
                continue
            if kind in DISTANCE_KINDS and self._bodies_of(spec) & self._partly:
                copy.context.leave_out(
                    element, "geoms of a body that do not collide do not count", "they have no shape for it"
                )
            spec = self._owned(spec)
            if not spec.object:
                copy.context.leave_out(element, _LOST, "the world has no sensors")
                continue
            self._add(copy, element, spec)

    def _known_sides(self, *kinds: SensorObject) -> set[str]:
        """The names of all that sides of these types can be."""
        known: set[str] = set()
        for kind in kinds:
            if kind is SensorObject.SITE:
                known |= {*self.model.sites}
            elif kind is SensorObject.SHAPE:
                known |= {*self._geoms}
            elif kind is not SensorObject.NONE:
                known |= {*self._names.bodies, _WORLD}
        return known

    def _problem_of_sides(self, spec: SensorSpec) -> str:
        """What of the sides of a sensor of contacts or distance is not built; empty if nothing is."""
        sides = ((spec.object_type, spec.object), (spec.reference_type, spec.reference))
        if any(kind is SensorObject.SHAPE and name not in self._colliding for kind, name in sides):
            return "its geom does not collide"
        if spec.kind not in DISTANCE_KINDS:
            return ""
        bodies = self._bodies_of(spec)
        if bodies & self._ghosts:
            return "no geom of its body collides"
        if _WORLD in bodies and _WORLD not in self._robots:
            return "the world has no geoms"
        first, second = (self._body_of(kind, name) for kind, name in sides)
        if first == second and SensorObject.LINK in (spec.object_type, spec.reference_type):
            return "one side is part of the other"
        return ""

    def _bodies_of(self, spec: SensorSpec) -> set[str]:
        """The bodies that are sides as a whole."""
        sides = ((spec.object_type, spec.object), (spec.reference_type, spec.reference))
        return {name for kind, name in sides if kind is SensorObject.LINK}

    def _owned(self, spec: SensorSpec) -> SensorSpec:
        """A sensor with a robot's part as its object; without an object if both sides are of the world."""
        own, other = (
            (kind, name) if self._body_of(kind, name) in self._robots else (SensorObject.NONE, "")
            for kind, name in ((spec.object_type, spec.object), (spec.reference_type, spec.reference))
        )
        if spec.reference_type is SensorObject.SUBTREE and spec.reference == _WORLD:
            spec = replace(spec, reference_type=SensorObject.NONE, reference="")
        if spec.object_type is SensorObject.SUBTREE and spec.object == _WORLD:
            spec = replace(spec, object_type=SensorObject.NONE, object="")
            own = SensorObject.NONE, ""
        if own[1]:
            return spec
        if not other[1] or spec.object_type is SensorObject.SITE:
            return replace(spec, object="")
        return replace(
            spec,
            object_type=other[0],
            object=other[1],
            reference_type=spec.object_type,
            reference=spec.object,
            is_reversed=True,
        )

    def _body_of(self, kind: SensorObject, name: str) -> str:
        """The body of a side of a contact or distance."""
        if kind is SensorObject.SITE:
            return self.model.sites[name].body
        return self._geoms[name] if kind is SensorObject.SHAPE else name

    def _object(
        self, scope: Scope, element: Element, kind: SensorKind
    ) -> tuple[SensorObject, str, set[str], str]:
        """What a sensor measures: type, name, all names of this type, and what of it is not built."""
        if kind in FRAME_KINDS:
            return self._frame(scope, element, "obj")
        (what,) = objects_of(kind)
        known: Iterable[str] = ()
        attribute, problem = "", ""
        if what is SensorObject.SITE:
            attribute, known = "site", self.model.sites
            if kind is SensorKind.RANGE_FINDER and _is_camera(element):
                if "site" in element.attributes:
                    raise scope.context.error(element, "a range finder has a site or a camera, and not both")
                name = _required_name(scope, element, "camera")
                return what, name, *self._cameras(scope, name)
        elif what is SensorObject.JOINT:
            attribute, known = "joint", self._kinds
        elif what is SensorObject.ACTUATOR:
            attribute, known = "actuator", (actuator.name for actuator in self.model.actuators)
        elif what is SensorObject.TENDON:
            attribute, known = "tendon", self.model.tendons
        elif kind in SUBTREE_KINDS:
            attribute, known = "body", (*self._names.bodies, _WORLD)
        if not attribute:
            return what, "", set(), "" if self.model.robots else "there are no bodies"
        return what, _required_name(scope, element, attribute), {*known}, problem

    def _frame(self, scope: Scope, element: Element, prefix: str) -> tuple[SensorObject, str, set[str], str]:
        """The frame that attributes of a prefix name, as `_object`."""
        kind = scope.context.required(element, f"{prefix}type")
        name = _required_name(scope, element, f"{prefix}name")
        if kind == "geom":
            known = {it for it, frame in self._frames.items() if frame is not None}
            problem = ""
            if self._names.copies(scope, [name], {*self._frames} - known):
                problem = "frames of meshes are not measured; a site can be"
            return SensorObject.SITE, name, known, problem
        if kind == "camera":
            return SensorObject.SITE, name, *self._cameras(scope, name)
        if kind not in _FRAMES:
            raise scope.context.error(
                element, f"{prefix}type={shown(kind)} is none of site, body, xbody, geom and camera"
            )
        known = self.model.sites if kind == "site" else (*self._names.bodies, _WORLD)
        return _FRAMES[kind], name, {*known}, ""

    def _cameras(self, scope: Scope, name: str) -> tuple[set[str], str]:
        """Names of all cameras with a frame, and why one of a name has none; empty if it has."""
        known = {it for it, camera in self.model.cameras.items() if camera.mode == "fixed"}
        if self._names.copies(scope, [name], {*self.model.cameras} - known):
            return known, "frames of cameras that track or aim are not measured"
        return known, ""

    def _framed(self, kind: str | None, name: str) -> str:
        """The name of what has a frame; of a geom or a camera that of a site which is made at its place."""
        if not name or kind not in ("geom", "camera"):
            return name
        body, frame = self._geoms.get(name, ""), self._frames.get(name)
        if kind == "camera":
            body, frame = self.model.cameras[name].body, self.model.cameras[name].frame
        assert frame is not None
        site = f"{name}@{kind}"
        self.model.sites.setdefault(site, Site(site, body, frame, "sphere", _SMALL))
        return site

    def _spec(self, scope: Scope, element: Element, kind: SensorKind) -> SensorSpec:
        """Name and quality of a sensor."""
        context, attributes = scope.context, element.attributes
        spec = SensorSpec(
            self._name(scope, element),
            kind,
            cutoff=context.number(element, attributes, "cutoff", 0.0),
            delay=context.number(element, attributes, "delay", 0.0),
            period=context.number(element, attributes, "interval", 0.0),
            samples=int(context.number(element, attributes, "nsample", 0.0)),
        )
        if attributes.get("interp", "zoh") != "zoh":
            context.leave_out(
                element, "it shows the last sample that is old enough", "samples are held", "interp"
            )
        if kind is SensorKind.MAGNETOMETER and "magnetic" in self.model.options:
            spec = replace(spec, magnetic_field=self.model.options["magnetic"])
        return spec

    def _with_rays(self, scope: Scope, element: Element, spec: SensorSpec, name: str) -> SensorSpec:
        """A range finder with what it shows, of a camera with its rays."""
        words = element.attributes.get("data", "dist").split()
        if not words or [word for word in RANGE_FIELDS if word in words] != words:
            known = ", ".join(RANGE_FIELDS)
            raise scope.context.error(
                element, f"data={shown(' '.join(words))} must be some of {known}, in this order"
            )
        image = range_image(self.model.cameras[name]) if _is_camera(element) else None
        if image is not None and not 0 < image.width * image.height <= MAX_RAYS:
            raise scope.context.error(element, f"its camera has more than {MAX_RAYS} pixels, or none")
        return replace(spec, shows=tuple(words), image=image)

    def _add(self, scope: Scope, element: Element, spec: SensorSpec) -> None:
        """Add a sensor to the model, unless what it refers to is not simulated."""
        problem = self._unbuilt(spec)
        if problem:
            scope.context.leave_out(element, _LOST, problem)
            return
        if spec.kind in _LOADS and self._is_pulled(spec.object):
            scope.context.leave_out(
                element, "it does not feel forces along tendons and at sites", "they are not gathered"
            )
        try:
            spec.check()
        except DescriptionError as error:
            raise scope.context.error(element, error.reason) from None
        self.model.sensors.append(spec)
        self._scopes.append(scope)

    def _is_pulled(self, site: str) -> bool:
        """Whether tendons, or actuators at sites, act on the robot of a site."""
        robot = self._robots[self.model.sites[site].body]
        acting = [it.spec.site for it in self.model.actuators if it.spec is not None and it.spec.site]
        return any(it.robot == robot for it in self.model.tendons.values()) or any(
            self._robots.get(self.model.sites[name].body) == robot for name in acting
        )

    def _unbuilt(self, spec: SensorSpec) -> str:
        """What of a sensor is not built; empty if nothing is."""
        if spec.object_type is SensorObject.JOINT:
            kind, wanted = self._kinds[spec.object], spec.kind in _BALLS
            if (kind == "spherical") != wanted or kind == "free":
                types = "ball joints" if wanted else "hinges and slides"
                return f"such sensors are for {types} only"
        if spec.object_type is SensorObject.ACTUATOR:
            specs = {actuator.name: actuator.spec for actuator in self.model.actuators}
            return "" if specs[spec.object] is not None else "its actuator is not simulated"
        if spec.object_type is SensorObject.TENDON and not self.model.tendons[spec.object].robot:
            return "its tendon is not simulated"
        if spec.kind in _OF_SIDES.values():
            return ""
        if spec.kind in SUBTREE_KINDS and spec.object == _WORLD:
            return "all in the world is of several bodies"
        for kind, name in ((spec.object_type, spec.object), (spec.reference_type, spec.reference)):
            if kind in _FRAMES.values():
                body = self.model.sites[name].body if kind is SensorObject.SITE else name
                if spec.kind in _LOADS and (body in self._held or body == _WORLD):
                    return "the force on a fixed base is not computed"
                if body not in self._robots:
                    return "nothing of the file is fixed in the world, which has no sensors of its own"
        return ""

    def _name(self, scope: Scope, element: Element) -> str:
        name = scope.name(element)
        if not name:
            return f"sensor{len(self.model.sensors)}_{scope.context.next_number()}"
        scope.context.refuse_duplicate(element, name, self._lines)
        return name


def _is_camera(element: Element) -> bool:
    """Whether a range finder has the rays of a camera."""
    return "camera" in element.attributes


def _required_name(scope: Scope, element: Element, attribute: str) -> str:
    """The name that a required attribute states."""
    name = scope.context.required(element, attribute)
    if not name:
        raise scope.context.error(element, f"{attribute} is empty; it has to name what is measured")
    return name
