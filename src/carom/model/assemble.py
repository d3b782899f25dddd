"""Conversion of a robot to a body: link order, loading flags, inertias."""

from __future__ import annotations

from collections.abc import Callable
from math import inf

from carom.description import Inertial, Joint, JointType, Link, Pose, Robot
from carom.description.joint import JOINT_CODE, NEEDS_LIMIT
from carom.description.pose import Vector3
from carom.layouts.codes import LIMIT_KIND, ConstraintKind
from carom.layouts.contacts import MARGIN
from carom.layouts.flags import LoadFlags
from carom.logger import Logger
from carom.model.body_spec import BASE, DEFAULT_LINK_DAMPING, DEFAULT_MAX_VELOCITY, BodySpec, LinkSpec
from carom.model.inertia import inertia_from_file, inertia_from_shapes
from carom.model.tree import TreeNode, depth_first, file_order, make_tree

_log = Logger(__name__)


def assemble(
    robot: Robot,
    *,
    flags: LoadFlags = LoadFlags.NONE,
    fixed_base: bool = False,
    compound_margin: float = MARGIN,
    as_written: bool = False,
) -> BodySpec:
    """Convert a robot to a body for the engine.

    Links come depth first, children in the order of their joints in the file; with MAINTAIN_LINK_ORDER in the
    order of the file, except that a link never comes before its parent. The base is fixed exactly when its
    mass is zero, to which `fixed_base` sets it; `compound_margin` is that of every link [m].

    With `as_written` the body is as the author of the file meant it: inertia from the file, no damping by
    air, no motors that hold joints, links merged with their frames, spherical joints that turn links. A base
    is then also fixed if it has no mass and no link that is fixed to it has any. Links of a robot with terms
    of its free base are not merged, as these are of the motion of the base's own frame.

    Raises:
        DescriptionError: The file of a collision mesh cannot be used.
    """
    root = make_tree(robot)
    read_inertia = inertia_from_file
    if as_written:
        # Imported only here and below: PyBullet's reading needs none of it.
        from carom.model.written_inertia import has_massless_base, written_inertia

        read_inertia = written_inertia
        flags |= LoadFlags.USE_INERTIA_FROM_FILE
        fixed_base = fixed_base or has_massless_base(root)
    has_terms = any((robot.base_damping, robot.base_armature, robot.base_stiffness))
    if flags & LoadFlags.MERGE_FIXED_LINKS and not has_terms:
        _merge(root, fixed_base=fixed_base, as_written=as_written)
    if as_written:
        from carom.model.written_inertia import hang_balls

        hang_balls(root)
    order = file_order(root) if flags & LoadFlags.MAINTAIN_LINK_ORDER else depth_first(root)
    base = _link_spec(root.link, flags, compound_margin, read_inertia, is_massless=fixed_base)
    if as_written:
        base.damping, base.armature = robot.base_damping, robot.base_armature
        base.stiffness = robot.base_stiffness
    index_of = {id(node): index for index, node in enumerate(order, start=BASE)}
    links = [_link_spec(node.link, flags, compound_margin, read_inertia) for node in order[1:]]
    for node in order:
        for child in node.children:
            _attach(links[index_of[id(child)]], child, index_of[id(node)])
    body = BodySpec(
        robot.name,
        base,
        links,
        fixed_base=fixed_base if as_written else base.mass == 0.0,
        flags=int(flags),
        source=robot.source,
        user_data=dict(robot.user_data),
        link_damping=0.0 if as_written else DEFAULT_LINK_DAMPING,
        max_velocity=inf if as_written else DEFAULT_MAX_VELOCITY,
        is_held=not as_written,
        actuators=robot.actuators if as_written else (),
        is_mocap=robot.is_mocap,
    )
    if flags & LoadFlags.PRINT_URDF_INFO:
        _log.info("%s", outline(body))
    return body


def _merge(root: TreeNode, *, fixed_base: bool, as_written: bool) -> None:
    if as_written:
        from carom.model.written_inertia import merge_rigidly

        merge_rigidly(root, fixed_base=fixed_base)
    else:
        from carom.model.merge_fixed import merge_fixed_links

        merge_fixed_links(root, fixed_base=fixed_base)


def _link_spec(
    link: Link,
    flags: LoadFlags,
    compound_margin: float,
    read_inertia: Callable[[Inertial, str], tuple[Vector3, Pose]],
    *,
    is_massless: bool = False,
) -> LinkSpec:
    spec = LinkSpec(
        link.name,
        mass=0.0 if is_massless else link.inertial.mass,
        inertial_frame=link.inertial.frame,
        collisions=() if flags & LoadFlags.IGNORE_COLLISION_SHAPES else link.collisions,
        visuals=() if flags & LoadFlags.IGNORE_VISUAL_SHAPES else link.visuals,
        compound_margin=compound_margin,
        contact=link.contact,
        gravity_compensation=link.gravity_compensation,
        fluid=link.fluid,
        user_data=dict(link.user_data),
    )
    if flags & LoadFlags.USE_INERTIA_FROM_FILE and not is_massless:
        spec.inertia, spec.inertial_frame = read_inertia(link.inertial, link.name)
    elif spec.mass != 0.0:
        implicit = bool(flags & LoadFlags.USE_IMPLICIT_CYLINDER)
        spec.inertia = inertia_from_shapes(spec, implicit_cylinder=implicit)
    scaling = link.contact.inertia_scaling
    if scaling is not None and spec.mass != 0.0:
        x, y, z = spec.inertia
        spec.inertia = (x * scaling, y * scaling, z * scaling)
    return spec


def _attach(spec: LinkSpec, node: TreeNode, parent: int) -> None:
    """Write the parent and the joint of a link."""
    joint = node.joint
    assert joint is not None, "every node except the root has a joint"
    spec.parent = parent
    spec.joint_name = joint.name
    spec.joint_type = _simulated_type(joint)
    spec.joint_frame = joint.frame
    spec.joint_axis = joint.axis
    spec.joint_axis_length = joint.axis_length
    spec.lower = joint.limit.lower
    spec.upper = joint.limit.upper
    spec.limited = _is_limited(joint)
    spec.effort = joint.limit.effort
    spec.velocity = joint.limit.velocity
    spec.twist = joint.limit.twist
    spec.pitch = joint.pitch
    spec.damping = joint.damping
    spec.friction = joint.friction
    spec.armature = joint.armature
    spec.stiffness = joint.stiffness
    spec.spring_reference = joint.spring_reference
    spec.limit_compliance, spec.limit_margin = joint.limit_compliance, joint.limit_margin
    spec.friction_compliance = joint.friction_compliance
    spec.mimic = joint.mimic


def _simulated_type(joint: Joint) -> JointType:
    if joint.type is JointType.FLOATING:
        _log.warning("joint %r: floating joints inside a tree are not supported; it is fixed", joint.name)
        return JointType.FIXED
    return joint.type


def _is_limited(joint: Joint) -> bool:
    limit = joint.limit
    if joint.type in NEEDS_LIMIT:
        return limit.lower <= limit.upper
    if LIMIT_KIND.get(JOINT_CODE[joint.type]) == ConstraintKind.SPHERICAL_LIMIT:
        return min(limit.lower, limit.upper, limit.twist, limit.effort) > 0.0
    return False


def outline(body: BodySpec) -> str:
    """A body's tree of links as text: a line for each, indented by its depth, with masses and joints."""
    depth = {BASE: 0}
    children: dict[int, list[int]] = {}
    for index, link in enumerate(body.links):
        depth[index] = depth[link.parent] + 1
        children.setdefault(link.parent, []).append(index)
    lines = [f"{body.base.name} (mass {body.base.mass:g})"]
    pending = children.get(BASE, [])[::-1]
    while pending:
        index = pending.pop()
        link = body.links[index]
        lines.append(
            f"{'  ' * depth[index]}{link.name}"
            f" (mass {link.mass:g}, {link.joint_type.value} joint {link.joint_name})"
        )
        pending.extend(children.get(index, [])[::-1])
    return "\n".join(lines)
