"""`<body>`: its frame, joints, geoms and mass, and the bodies, sites and cameras in it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from carom.description import Collision, ContactParameters
from carom.description.pose import IDENTITY, Pose
from carom.description.transform import compose, inverse, rotation_matrix
from carom.files.xml_element import Element
from carom.formats.mjcf.compiled.aligning import align, is_aligned
from carom.formats.mjcf.compiled.contact import read_contact
from carom.formats.mjcf.compiled.context import ALWAYS, NEVER
from carom.formats.mjcf.compiled.elements import WORLD, Elements, Scope
from carom.formats.mjcf.compiled.flexes.flex import FileFlex
from carom.formats.mjcf.compiled.flexes.reader import read_flex
from carom.formats.mjcf.compiled.flexes.rigid import add_rigid_flex
from carom.formats.mjcf.compiled.inertia import BodyInertia, bounded, inertia_of
from carom.formats.mjcf.compiled.joint import FREE, first_number, joint_type, read_joint
from carom.formats.mjcf.compiled.looks.camera import read_camera
from carom.formats.mjcf.compiled.looks.stage import read_light
from carom.formats.mjcf.compiled.model import NODE, CompiledBody, CompiledModel
from carom.formats.mjcf.compiled.shapes.geom import Geom, read_geom
from carom.formats.mjcf.compiled.shapes.meshes import Meshes
from carom.formats.mjcf.compiled.site import read_site
from carom.formats.mjcf.compiled.softness import read_compliance
from carom.formats.mjcf.defaults import Attributes
from carom.formats.mjcf.frames import read_pose
from carom.formats.robot.context import MissingFile
from carom.native.products import turned_tensor

_UNBUILT = ("composite", "plugin")


class BodyReader:
    """Reads the bodies of a file into a `CompiledModel`.

    Attributes:
        model: What has been read so far, apart from bodies.
        bodies: All bodies, without the world, in document order.
        elements: The walk through all elements of bodies.
        geom_bodies: Name of the body of each geom, by name.
        geom_frames: Frame of each geom in its body, by name; None for meshes.
        geoms: Each geom that has a name, by name.
        aims: The cameras that look at a body, and its name.
        paired: Names of geoms, without prefixes, that collide in pairs whatever their bits say.
        missing_meshes: Geoms whose mesh is missing are left out and reported.
    """

    def __init__(self, model: CompiledModel, *, missing_meshes: bool) -> None:
        self.model = model
        self.bodies: list[CompiledBody] = []
        self.missing_meshes = missing_meshes
        self.geom_bodies: dict[str, str] = {}
        self.geom_frames: dict[str, Pose | None] = {}
        self.geoms: dict[str, Geom] = {}
        self.aims: list[tuple[Scope, Element, str]] = []
        self.paired: set[str] = set()
        self._aligned: dict[str, bool] = {}
        self.elements = Elements()
        self._meshes = Meshes()
        self._lines: dict[str, dict[str, int]] = {}

    def read_world(self, element: Element, scope: Scope) -> CompiledBody:
        """The world as a body, with all bodies in it; its mass does not count."""
        world = CompiledBody(WORLD, element)
        self._read_content(element, scope, world, is_world=True)
        world.inertia = BodyInertia.none()
        return world

    def _read_body(self, element: Element, scope: Scope, *, is_top: bool) -> CompiledBody:
        context, attributes = scope.context, element.attributes
        element.note()
        name = scope.name(element)
        if not name:
            name = f"link{len(self.bodies)}_{context.next_number()}"
        self._name("body", element, scope, name)
        body = CompiledBody(name, element)
        self.bodies.append(body)
        local = read_pose(context, element, attributes)
        body.pose = compose(scope.into, local)
        body.gravity_compensation = context.number(element, attributes, "gravcomp", 0.0)
        body.is_mocap = context.flag(element, attributes, "mocap", False)
        if body.is_mocap and not is_top:
            raise context.error(element, "only bodies of the world can be mocap bodies")
        child_class = attributes.get("childclass", scope.child_class)
        # Poses of its contents are given in the body's frame, or in the world frame if all poses are.
        into = inverse(local) if context.compiler.global_frames else IDENTITY
        if not is_top:
            # MuJoCo has the centre of a body of which nothing states mass there, and weights it so.
            body.inertia.centre = np.array(local.position)
        self._read_content(element, replace(scope, child_class=child_class, into=into), body, is_top=is_top)
        if self._aligned.get(name, False):
            self._align(body)
        return body

    def _align(self, body: CompiledBody) -> None:
        back = align(body, self.model)
        if back is None:
            return
        for name in [name for name, of in self.geom_bodies.items() if of == body.name]:
            geom, frame = self.geoms[name], self.geom_frames[name]
            self.geoms[name] = replace(geom, frame=compose(back, geom.frame))
            self.geom_frames[name] = None if frame is None else compose(back, frame)

    def _read_content(
        self,
        element: Element,
        scope: Scope,
        body: CompiledBody,
        *,
        is_world: bool = False,
        is_top: bool = False,
    ) -> None:
        geoms: list[Geom] = []
        stated: BodyInertia | None = None
        contacts: list[ContactParameters] = []
        rigid: list[tuple[Element, Scope, FileFlex]] = []
        for child, within in self.elements.inside(element, scope):
            context = within.context
            match child.tag:
                case "body":
                    body.children.append(self._read_body(child, within, is_top=is_world))
                case "geom":
                    if (geom := self._read_geom(child, within)) is not None:
                        self.geom_bodies[geom.name] = body.name
                        self.geom_frames[geom.name] = None if geom.is_mesh else geom.frame
                        self.geoms[geom.name] = geom
                        geoms.append(geom)
                        if geom.kinds != (0, 0) or geom.is_paired:
                            contacts.append(
                                read_contact(within, child, self.model.options, is_mesh=geom.is_mesh)
                            )
                case "joint" | "freejoint":
                    self._read_joint(child, within, body, is_world=is_world, is_top=is_top)
                case "inertial":
                    stated = _read_inertial(within, child)
                case "site":
                    site = read_site(within, child, body.name)
                    # One without a name is only seen; `@` keeps it apart from those that have one.
                    name = site.name or f"site@{len(self.model.sites)}"
                    self._name("site", child, within, name)
                    self.model.sites[name] = replace(site, name=name)
                case "camera":
                    camera = read_camera(within, child, body.name)
                    if camera.target:
                        self.aims.append((within, child, camera.target))
                    if camera.name:
                        self._name("camera", child, within, camera.name)
                        self.model.cameras[camera.name] = camera
                case "flexcomp":
                    if (flex := self._read_flex(child, within, body)) is not None:
                        rigid.append((child, within, flex))
                case "light":
                    if (light := read_light(within, child, body.name)) is not None:
                        self.model.lights.append(light)
                case tag if tag not in _UNBUILT:
                    raise context.error(child, f"<{tag}> is not known in a body")
        body.visuals = [geom.visual for geom in geoms]
        body.fluids = [geom.fluid for geom in geoms if geom.fluid is not None]
        colliding = [geom for geom in geoms if geom.kinds != (0, 0) or geom.is_paired]
        # What is common to all shapes is that of the first one which does not collide in pairs only.
        first = next((number for number, geom in enumerate(colliding) if geom.kinds != (0, 0)), 0)
        if contacts:
            body.contact = contacts[first]
        body.collisions = [
            Collision(
                *(geom.geometry, geom.frame, geom.name, *geom.kinds),
                contact=None if contact == body.contact else contact,
            )
            for geom, contact in zip(colliding, contacts, strict=True)
        ]
        for child, within, flex in rigid:
            add_rigid_flex(within, child, flex, flex.nodes, body, self.model.options)
        if not is_world:
            self._set_inertia(element, scope, body, geoms, stated)

    def _read_geom(self, element: Element, scope: Scope) -> Geom | None:
        element.note()
        name = scope.name(element)
        if name:
            self._name("geom", element, scope, name)
        try:
            geom = read_geom(scope, element, self._meshes)
            is_paired = geom is not None and element.attributes.get("name") in self.paired
            return replace(geom, is_paired=True) if geom is not None and is_paired else geom
        except MissingFile as problem:
            if not self.missing_meshes:
                raise
            scope.context.leave_out(element, "the shape is missing", problem.reason)
            return None

    def _read_joint(
        self, element: Element, scope: Scope, body: CompiledBody, *, is_world: bool, is_top: bool
    ) -> None:
        context = scope.context
        element.note()
        if is_world or body.is_mocap:
            raise context.error(element, "the world and mocap bodies have no joints")
        name = scope.name(element)
        if name:
            self._name("joint", element, scope, name)
        if element.tag == "freejoint" or joint_type(scope, element) == FREE:
            if not is_top or body.joints or body.is_free:
                raise context.error(element, "a free joint is the only joint of a body of the world")
            self._aligned[body.name] = is_aligned(scope, element)
            _read_free_terms(scope, element, body)
            body.is_free = True
            self.model.joints.append((name, body.name, FREE))
            return
        if body.is_free:
            raise context.error(element, "a free joint is the only joint of a body of the world")
        joint = read_joint(scope, element)
        name = name or f"joint{len(self.model.joints)}_{context.next_number()}"
        joint.joint = replace(joint.joint, name=name)
        body.joints.append(joint)
        self.model.joints.append((name, body.name, joint.joint.type.value))
        if joint.reference != 0.0:
            self.model.starts[name] = joint.reference

    def _read_flex(self, element: Element, scope: Scope, body: CompiledBody) -> FileFlex | None:
        """Add a flex to the model; one that is rigid, which is part of the shape of the body, is returned."""
        flex = read_flex(scope, element, body.name)
        if flex is None:
            self.model.lacks |= {"qpos", "qvel"}
            return None
        if not flex.name:
            raise scope.context.error(element, "it needs a name")
        self.name_flex(element, scope, flex.name)
        if len(flex.pins) == len(flex.nodes):
            return flex
        self.model.flexes.append(flex)
        # As in MuJoCo, each node that is not pinned counts as three sliders.
        for node in range(len(flex.nodes)):
            if node not in flex.pins:
                self.model.joints += [(f"{flex.name}_{node}@{axis}", body.name, NODE) for axis in "xyz"]
        return None

    def _set_inertia(
        self,
        element: Element,
        scope: Scope,
        body: CompiledBody,
        geoms: list[Geom],
        stated: BodyInertia | None,
    ) -> None:
        context, compiler = scope.context, scope.context.compiler
        first, last = compiler.group_range
        masses = [geom.mass for geom in geoms if geom.mass is not None and first <= geom.group <= last]
        if compiler.from_geoms == ALWAYS or (stated is None and compiler.from_geoms != NEVER):
            body.inertia = inertia_of(masses, body.inertia)
        elif stated is not None:
            body.inertia = stated
        problem = bounded(body.inertia, compiler)
        if problem is not None:
            raise context.error(element, f'{problem}; balanceinertia="true" in <compiler> makes them equal')

    def name_flex(self, element: Element, scope: Scope, name: str) -> None:
        """Record the name of a flex; raises `DescriptionError` if it is taken."""
        self._name("flex", element, scope, name)

    def _name(self, kind: str, element: Element, scope: Scope, name: str) -> None:
        """Record a name; raises `DescriptionError` if it is taken."""
        lines = self._lines.setdefault(kind, {"world": 0} if kind == "body" else {})
        scope.context.refuse_duplicate(element, name, lines)


def _read_inertial(scope: Scope, element: Element) -> BodyInertia:
    context, attributes = scope.context, element.attributes
    element.note()
    pose = compose(scope.into, read_pose(context, element, attributes))
    mass = context.non_negative(element, "mass")
    if "fullinertia" in attributes:
        xx, yy, zz, xy, xz, yz = context.numbers(element, "fullinertia", attributes["fullinertia"], 6, 6)
        tensor = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    elif "diaginertia" in attributes:
        tensor = np.diag(context.numbers(element, "diaginertia", attributes["diaginertia"], 3, 3))
    else:
        tensor = np.zeros((3, 3))
    turn = np.array(rotation_matrix(pose.orientation))
    axes = None if "fullinertia" in attributes else turn
    return BodyInertia(mass, np.array(pose.position), turned_tensor(turn, tensor), axes)


def _read_free_terms(scope: Scope, element: Element, body: CompiledBody) -> None:
    """Read the terms of a free joint that its class of defaults or itself states; report others."""
    if element.tag == "freejoint":
        return
    attributes: Attributes = scope.attributes(element)
    body.free_damping = first_number(scope, element, attributes, "damping", may_drive=True)
    body.free_armature = first_number(scope, element, attributes, "armature")
    body.free_friction = first_number(scope, element, attributes, "frictionloss")
    if body.free_friction:
        body.free_compliance = read_compliance(scope, element, attributes, "friction")
    body.free_stiffness = first_number(scope, element, attributes, "stiffness")
