"""Writing a robot as a USD stage with the physics schema."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import fields
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from carom.description import Collision, ContactParameters, Inertial, Joint, Link, Pose, Robot, Visual
from carom.description.eigen import diagonalize
from carom.description.pose import IDENTITY
from carom.description.transform import Matrix3, compose, multiplied, quaternion_from_matrix
from carom.errors import DescriptionError
from carom.formats.reading.ignored import IgnoredList
from carom.formats.robot.common_joints import with_common_joints
from carom.formats.usd.target import Target
from carom.formats.usd.written_joint import write_joint
from carom.formats.usd.written_shape import write_shape

_USUAL_FRICTION = 0.5
_MOST_STEPS = 60


def write_usd(robot: Robot, target: Path, *, fixed_base: bool = False) -> IgnoredList:
    """Write a robot; `World.load` reads the same from it, with links and joints of the same names.

    Lengths are in metres, z is up. Meshes are copied into the stage. What the schema keeps in single
    precision is also there in double, see `carom.formats.usd.exact`. The suffix says what is written: `.usda`
    is text, `.usd` and `.usdc` are binary, `.usdz` is an archive.

    Args:
        robot: The robot, at the positions 0 of its joints.
        target: The file.
        fixed_base: Hold its root in the world.

    Returns:
        What the robot has and the file does not say.

    Raises:
        DescriptionError: It is a soft body, or `usd-core` is not installed.
        OSError: The file cannot be written.
    """
    if robot.deformable is not None:
        raise DescriptionError("soft bodies are not written as USD", file=robot.source)
    return Writer(with_common_joints(robot), target, fixed_base=fixed_base).write()


class Writer(Target):
    """Fills the stage, and writes it."""

    def __init__(self, robot: Robot, file: Path, *, fixed_base: bool) -> None:
        super().__init__(robot, file)
        self.fixed_base: bool = fixed_base

    def write(self) -> IgnoredList:
        """Fill the stage, and write it."""
        pxr, stage = self.pxr, self.stage
        pxr.UsdGeom.SetStageMetersPerUnit(stage, 1.0)
        pxr.UsdGeom.SetStageUpAxis(stage, pxr.UsdGeom.Tokens.z)
        pxr.UsdPhysics.SetStageKilogramsPerUnit(stage, 1.0)
        top = pxr.UsdGeom.Xform.Define(stage, self.root).GetPrim()
        stage.SetDefaultPrim(top)
        self.name(top, self.robot.name)
        pxr.UsdPhysics.ArticulationRootAPI.Apply(top)
        self.values.put(top, "newton:selfCollisionEnabled", "Bool", False)
        pxr.UsdGeom.Scope.Define(stage, self.scope)
        poses = _poses(self.robot)
        for index, link in enumerate(self.robot.links):
            self._link(index, link, poses[index])
        for joint in self.robot.joints:
            write_joint(self, joint)
        if self.fixed_base:
            self._hold(poses[self.robot.root])
        self._export()
        return IgnoredList.of(self.lost)

    def _link(self, index: int, link: Link, pose: Pose) -> None:
        path = self.links[index]
        prim = self.pxr.UsdGeom.Xform.Define(self.stage, path).GetPrim()
        self.name(prim, link.name)
        self.values.place(prim, pose)
        self.pxr.UsdPhysics.RigidBodyAPI.Apply(prim)
        self._mass(prim, link)
        if link.gravity_compensation == 1.0:
            self.values.put(prim, "physxRigidBody:disableGravity", "Bool", True)
        elif link.gravity_compensation:
            self.leave_out(
                "link", "all its weight counts", "USD knows all of it or none", "gravity_compensation"
            )
        if link.fluid is not None:
            self.leave_out("link", "no fluid moves it", "USD has no fluids", "fluid")
        if link.user_data:
            self.leave_out("link", "none: a note", "it is for scripts", "user_data")
        material = self._surface(index, link.contact, "surface")
        for number, collision in enumerate(link.collisions):
            own = material
            if collision.contact is not None:
                own = self._surface(index, collision.contact, f"surface_{number}")
            self._shape(index, collision, f"collision_{number}", own)
        for number, visual in enumerate(link.visuals):
            if not visual.stands_in:
                self._shape(index, visual, f"visual_{number}", None)

    def _mass(self, prim: Any, link: Link) -> None:
        """Mass, and inertia by its principal axes; of links without mass that is said apart."""
        self.pxr.UsdPhysics.MassAPI.Apply(prim)
        inertial = link.inertial
        put = self.values.put
        if not inertial.mass:
            put(prim, "carom:massless", "Bool", True)
            put(prim, "physics:mass", "Float", 1e-9)
            if not any(inertial.tensor):
                put(prim, "physics:diagonalInertia", "Float3", (1e-12, 1e-12, 1e-12))
            self.leave_out(
                "link", "none here: other programs give it 1e-9 kg", "bodies of USD have mass", "inertial"
            )
            if not any(inertial.tensor):
                return
        else:
            put(prim, "physics:mass", "Float", inertial.mass)
        put(prim, "physics:centerOfMass", "Point3f", inertial.frame.position)
        moments, axes = _principal(inertial)
        scaling = 1.0 if link.contact.inertia_scaling is None else link.contact.inertia_scaling
        moments = tuple(scaling * moment for moment in moments)
        put(prim, "physics:diagonalInertia", "Float3", moments)
        if min(moments) < 0.0 or not any(moments) or not inertial.mass:
            put(prim, "carom:oddInertia", "Bool", True)
            self.leave_out(
                "link/inertial",
                "none here: other programs take the inertia of its colliders, or refuse it",
                "the schema has no body with such moments",
            )
        put(prim, "physics:principalAxes", "Quatf", axes)

    def _surface(self, index: int, contact: ContactParameters, name: str) -> Any | None:
        """The physics material of a link or a shape that states one."""
        known = ("lateral_friction", "restitution", "friction_rank", "friction_dimensions", "inertia_scaling")
        if contact.friction_dimensions:
            contact = contact.without_rank()
        for field in fields(contact):
            if field.name not in known and getattr(contact, field.name) not in (None, False, 0):
                self.leave_out("link/contact", "contacts have the usual value", "USD has none", field.name)
        if contact.lateral_friction is None and contact.restitution is None:
            return None
        path = self.names.under(self.links[index], name)
        material = self.pxr.UsdShade.Material.Define(self.stage, path)
        prim = material.GetPrim()
        self.pxr.UsdPhysics.MaterialAPI.Apply(prim)
        friction = _USUAL_FRICTION if contact.lateral_friction is None else contact.lateral_friction
        for name, value in (("static", friction), ("dynamic", friction)):
            self.values.put(prim, f"physics:{name}Friction", "Float", value)
        self.values.put(prim, "physics:restitution", "Float", contact.restitution or 0.0)
        return material

    def _shape(self, index: int, shape: Collision | Visual, name: str, material: Any | None) -> None:
        path = self.names.under(self.links[index], shape.name or name)
        prim = write_shape(self, path, shape)
        if prim is None:
            return
        if isinstance(shape, Visual):
            if shape.material is not None and shape.material.rgba is not None:
                *colour, opacity = shape.material.rgba
                gprim = self.pxr.UsdGeom.Gprim(prim)
                gprim.CreateDisplayColorAttr([tuple(colour)])
                gprim.CreateDisplayOpacityAttr([opacity])
            if shape.material is not None and shape.material.texture is not None:
                self.leave_out(
                    "visual/material", "none for the dynamics: no texture", "colours are written", "texture"
                )
            return
        self.pxr.UsdPhysics.CollisionAPI.Apply(prim)
        self.pxr.UsdGeom.Imageable(prim).CreatePurposeAttr(self.pxr.UsdGeom.Tokens.guide)
        if shape.group is not None or shape.mask is not None:
            self.leave_out("collision", "it collides with all", "groups are not written", "group", "mask")
        if material is not None:
            binding = self.pxr.UsdShade.MaterialBindingAPI.Apply(prim)
            binding.Bind(material, self.pxr.UsdShade.Tokens.weakerThanDescendants, "physics")

    def _hold(self, pose: Pose) -> None:
        prim = self.pxr.UsdPhysics.FixedJoint.Define(self.stage, self.held).GetPrim()
        prim.GetRelationship("physics:body1").SetTargets([self.links[self.robot.root]])
        self.values.put(prim, "physics:localPos0", "Point3f", pose.position)
        self.values.put(prim, "physics:localRot0", "Quatf", pose.orientation)

    def _export(self) -> None:
        pxr, layer = self.pxr, self.stage.GetRootLayer()
        if self.file.suffix.lower() != ".usdz":
            self._checked(lambda: layer.Export(str(self.file)))
            return
        with TemporaryDirectory() as folder:
            inner = Path(folder, f"{self.file.stem}.usdc")
            self._checked(lambda: layer.Export(str(inner)))
            self._checked(lambda: pxr.UsdUtils.CreateNewUsdzPackage(str(inner), str(self.file)))

    def _checked(self, write: Callable[[], bool]) -> None:
        try:
            done = write()
        except self.pxr.Tf.ErrorException:
            done = False
        if not done:
            raise OSError(f"{self.file} cannot be written")


def _principal(inertial: Inertial) -> tuple[tuple[float, ...], tuple[float, ...]]:
    """Principal moments, and their axes in the frame of the link."""
    a, b, c, d, e, f = inertial.tensor
    turn = inertial.frame.orientation
    if not (b or c or e):
        return (a, d, f), turn
    tensor: Matrix3 = ((a, b, c), (b, d, e), (c, e, f))
    moments, axes = diagonalize(tensor, 1e-17, _MOST_STEPS)
    return moments, multiplied(turn, quaternion_from_matrix(axes))


def _poses(robot: Robot) -> list[Pose]:
    """The frames of all links in that of the root, at the positions 0 of all joints."""
    above: dict[int, Joint] = {joint.child: joint for joint in robot.joints}
    found: dict[int, Pose] = {robot.root: IDENTITY}
    for index in range(len(robot.links)):
        chain = []
        at = index
        while at not in found:
            chain.append(at)
            at = above[at].parent
        for link in reversed(chain):
            found[link] = compose(found[above[link].parent], above[link].frame)
    return [found[index] for index in range(len(robot.links))]
