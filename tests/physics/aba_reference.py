"""A second algorithm for forward dynamics: the articulated-body algorithm.

Written from R. Featherstone, Rigid Body Dynamics Algorithms (2008), tables 7.1 and 9.4, in NumPy,
with spatial vectors (angular, linear) in the frames of the links: nothing here is shared with the
engine, which works in world axes with a joint-space matrix.

The frame of a link is its joint's; that of the base is its inertial frame.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from carom.description import JointType, Pose
from carom.model.body_spec import BASE, BodySpec, LinkSpec

Matrix = np.ndarray


@dataclass(frozen=True)
class Motion:
    """What forward dynamics finds; the base's in world axes, at its centre of mass."""

    base_angular: np.ndarray
    base_linear: np.ndarray
    joints: np.ndarray


@dataclass
class Element:
    """A link on its way through the recursions; the first is the base, which has no joint."""

    parent: int
    axes: Matrix  # of the link frame, in the world
    velocity: np.ndarray
    inertia: Matrix  # becomes the articulated-body inertia
    bias: np.ndarray  # becomes the articulated-body bias force
    to_link: Matrix = field(default_factory=lambda: np.eye(6))  # motion vectors from the parent frame
    subspace: Matrix = field(default_factory=lambda: np.zeros((6, 0)))
    centripetal: np.ndarray = field(default_factory=lambda: np.zeros(6))
    drive: np.ndarray = field(default_factory=lambda: np.zeros(0))
    row: Matrix = field(default_factory=lambda: np.zeros((6, 0)))
    acceleration: np.ndarray = field(default_factory=lambda: np.zeros(6))


def cross_matrix(v: np.ndarray) -> Matrix:
    """The matrix of v × ."""
    return np.array([[0.0, -v[2], v[1]], [v[2], 0.0, -v[0]], [-v[1], v[0], 0.0]])


def rotation(q: np.ndarray) -> Matrix:
    """The matrix of a unit quaternion (x, y, z, w)."""
    u, w = np.asarray(q[:3]), q[3]
    return (w * w - u @ u) * np.eye(3) + 2.0 * np.outer(u, u) + 2.0 * w * cross_matrix(u)


def turn(axis: np.ndarray, angle: float) -> Matrix:
    """Rotation about a unit axis, by Rodrigues' formula."""
    k = cross_matrix(axis)
    return np.eye(3) + np.sin(angle) * k + (1.0 - np.cos(angle)) * (k @ k)


def motion_transform(orientation: Matrix, origin: np.ndarray) -> Matrix:
    """Takes motion vectors into a frame, whose axes are the columns of `orientation`, at `origin`."""
    to_frame = orientation.T
    x = np.zeros((6, 6))
    x[:3, :3] = x[3:, 3:] = to_frame
    x[3:, :3] = -to_frame @ cross_matrix(origin)
    return x


def motion_cross(v: np.ndarray) -> Matrix:
    """The matrix of the spatial v × for motion vectors; that for forces is its negative transpose."""
    x = np.zeros((6, 6))
    x[:3, :3] = x[3:, 3:] = cross_matrix(v[:3])
    x[3:, :3] = cross_matrix(v[3:])
    return x


def spatial_inertia(link: LinkSpec, inertial_frame: Pose) -> Matrix:
    """Inertia about the origin of the frame that `inertial_frame` is given in."""
    axes = rotation(np.array(inertial_frame.orientation))
    c = cross_matrix(np.array(inertial_frame.position))
    inertia = np.zeros((6, 6))
    inertia[:3, :3] = axes @ np.diag(link.inertia) @ axes.T + link.mass * c @ c.T
    inertia[:3, 3:] = link.mass * c
    inertia[3:, :3] = link.mass * c.T
    inertia[3:, 3:] = link.mass * np.eye(3)
    return inertia


def planar_axes(link: LinkSpec) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Normal and the two directions of a planar joint, in the link frame.

    The first direction is the normal cross the x axis of the inertial frame.
    """
    normal = np.array(link.joint_axis)
    x_axis = rotation(np.array(link.inertial_frame.orientation))[:, 0]
    first = np.cross(normal, x_axis)
    first /= np.linalg.norm(first)
    return normal, first, np.cross(first, normal)


def joint_motion(link: LinkSpec, q: np.ndarray) -> tuple[Matrix, np.ndarray, Matrix]:
    """Orientation and origin of the link frame in the joint frame, and the motion subspace."""
    axis = np.array(link.joint_axis)
    zero = np.zeros(3)
    if link.joint_type in (JointType.REVOLUTE, JointType.CONTINUOUS):
        return turn(axis, q[0]), zero, np.concatenate([axis, zero])[:, None]
    if link.joint_type == JointType.PRISMATIC:
        return np.eye(3), axis * q[0], np.concatenate([zero, axis])[:, None]
    if link.joint_type == JointType.SPHERICAL:
        # Coordinates and rates are in the axes of the inertial frame.
        axes = rotation(np.array(link.inertial_frame.orientation))
        return axes @ rotation(q) @ axes.T, zero, np.vstack([axes, np.zeros((3, 3))])
    if link.joint_type == JointType.PLANAR:
        normal, first, second = planar_axes(link)
        subspace = np.zeros((6, 3))
        subspace[:3, 0], subspace[3:, 1], subspace[3:, 2] = normal, first, second
        return turn(normal, q[0]), first * q[1] + second * q[2], subspace
    return np.eye(3), zero, np.zeros((6, 0))


def joint_frame(spec: BodySpec, link: LinkSpec) -> tuple[Matrix, np.ndarray]:
    """Orientation and origin of a joint frame in the frame of the parent link."""
    orientation = rotation(np.array(link.joint_frame.orientation))
    origin = np.array(link.joint_frame.position)
    if link.parent == BASE:
        axes = rotation(np.array(spec.base.inertial_frame.orientation))
        return axes.T @ orientation, axes.T @ (origin - np.array(spec.base.inertial_frame.position))
    return orientation, origin


def bias_force(inertia: Matrix, velocity: np.ndarray, wrench: np.ndarray, axes: Matrix, centre) -> np.ndarray:
    """Force that keeps a link at its velocity while `wrench` acts about its centre of mass."""
    force = axes.T @ wrench[:3]
    external = np.concatenate([axes.T @ wrench[3:] + np.cross(centre, force), force])
    return -motion_cross(velocity).T @ inertia @ velocity - external


def outward_velocities(
    spec: BodySpec,
    position: np.ndarray,
    velocity: np.ndarray,
    joint_force: np.ndarray,
    link_wrench: np.ndarray,
) -> list[Element]:
    """First pass: velocities and bias forces, from the base to the tips."""
    axes = rotation(position[3:7])
    base_velocity = np.concatenate([axes.T @ velocity[:3], axes.T @ velocity[3:6]])
    inertia = spatial_inertia(spec.base, Pose())
    bias = bias_force(inertia, base_velocity, link_wrench[0], axes, np.zeros(3))
    elements = [Element(BASE, axes, base_velocity, inertia, bias)]
    q, dof = 7, 6
    for link, wrench in zip(spec.links, link_wrench[1:], strict=True):
        parent = elements[link.parent + 1]
        places = {JointType.SPHERICAL: 4, JointType.PLANAR: 3, JointType.FIXED: 0}.get(link.joint_type, 1)
        turned, slid, subspace = joint_motion(link, position[q : q + places])
        orientation, origin = joint_frame(spec, link)
        to_link = motion_transform(orientation @ turned, origin + orientation @ slid)
        dofs = slice(dof, dof + subspace.shape[1])
        relative = subspace @ velocity[dofs]
        own = to_link @ parent.velocity + relative
        axes = parent.axes @ orientation @ turned
        inertia = spatial_inertia(link, link.inertial_frame)
        elements.append(
            Element(
                parent=link.parent + 1,
                axes=axes,
                velocity=own,
                inertia=inertia,
                bias=bias_force(inertia, own, wrench, axes, np.array(link.inertial_frame.position)),
                to_link=to_link,
                subspace=subspace,
                centripetal=motion_cross(own) @ relative,
                drive=joint_force[dofs.start - 6 : dofs.stop - 6],
            )
        )
        q, dof = q + places, dofs.stop
    return elements


def inward_inertias(elements: list[Element]) -> None:
    """Second pass: articulated-body inertias and bias forces, from the tips to the base."""
    for element in reversed(elements[1:]):
        subspace = element.subspace
        element.row = element.inertia @ subspace
        element.drive = element.drive - subspace.T @ element.bias
        share = element.row @ np.linalg.inv(subspace.T @ element.row)
        apparent = element.inertia - share @ element.row.T
        bias = element.bias + apparent @ element.centripetal + share @ element.drive
        parent = elements[element.parent]
        parent.inertia = parent.inertia + element.to_link.T @ apparent @ element.to_link
        parent.bias = parent.bias + element.to_link.T @ bias


def outward_accelerations(elements: list[Element]) -> np.ndarray:
    """Third pass: accelerations, from the base to the tips; returns those of the joints."""
    rates = [np.zeros(0)]
    for element in elements[1:]:
        carried = element.to_link @ elements[element.parent].acceleration + element.centripetal
        pivot = element.subspace.T @ element.row
        rates.append(np.linalg.solve(pivot, element.drive - element.row.T @ carried))
        element.acceleration = carried + element.subspace @ rates[-1]
    return np.concatenate(rates)


def forward_dynamics(
    spec: BodySpec,
    position: np.ndarray,
    velocity: np.ndarray,
    joint_force: np.ndarray,
    gravity: np.ndarray,
    link_wrench: np.ndarray,
) -> Motion:
    """Accelerations of a body.

    Args:
        spec: The body.
        position: Base position, base quaternion (inertial frame), joint positions.
        velocity: Base angular and linear velocity (world axes, centre of mass), joint rates.
        joint_force: Generalized forces, shape as joint rates.
        gravity: World axes.
        link_wrench: Force and torque about the centre of mass of the base and each link, world axes.
    """
    elements = outward_velocities(spec, position, velocity, joint_force, link_wrench)
    inward_inertias(elements)
    base = elements[0]
    # Gravity acts as if everything accelerated the other way.
    weight = np.concatenate([np.zeros(3), base.axes.T @ gravity])
    base.acceleration = -weight if spec.fixed_base else -np.linalg.solve(base.inertia, base.bias)
    joints = outward_accelerations(elements)
    spatial = base.acceleration + weight
    linear = spatial[3:] + np.cross(base.velocity[:3], base.velocity[3:])
    return Motion(base.axes @ spatial[:3], base.axes @ linear, joints)
