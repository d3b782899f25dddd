"""Forces of the fluid around the links: drag, lift and added mass.

Models and coefficients are those of MuJoCo's documentation (computation, fluid forces). Either the box that
has the inertia of a link feels drag, or ellipsoids do, each on a link of its own. All depend on positions and
velocities at the beginning of a substep alone. Without a fluid nothing of this is computed.
"""

import math

import warp as wp

from carom.kernels.maths.lanes import in_some_world
from carom.kernels.maths.min_max import greatest_entry, least_entry, maximum
from carom.kernels.structs import Model, Scratch
from carom.kernels.types import Int32, Matrix3, Vector3, Vector6, Vector8, func, real
from carom.layouts.codes import IN_FLUID_AS_BOX, IN_FLUID_AS_ELLIPSOID

_PI = real(math.pi)
_LEAST = real(1e-15)
# Drag of rotation of a face, and greatest moments of ellipsoids.
_FACE, _MOMENT = real(1.0 / 64.0), real(8.0 * math.pi / 15.0)


@func
def has_fluid(model: Model, world: Int32) -> bool:
    """Whether there is a fluid in a world, or in some of those in lanes."""
    return in_some_world(model.fluid_density[world, 0] + model.fluid_viscosity[world, 0] > 0.0)


@func
def times(a: Vector3, b: Vector3) -> Vector3:
    """The product of two vectors, entry by entry."""
    return Vector3(a[0] * b[0], a[1] * b[1], a[2] * b[2])


@func
def magnitudes(a: Vector3) -> Vector3:
    """The magnitude of each entry."""
    return Vector3(wp.abs(a[0]), wp.abs(a[1]), wp.abs(a[2]))


@func
def fourth_power(a: real) -> real:
    """a⁴."""
    return a * a * a * a


@func
def box_sizes(mass: real, moments: Vector3) -> Vector3:
    """Lengths of the sides of the box that has a mass and principal moments of inertia [m]."""
    total = moments[0] + moments[1] + moments[2]
    return Vector3(
        wp.sqrt(6.0 / mass * maximum(_LEAST, total - 2.0 * moments[0])),
        wp.sqrt(6.0 / mass * maximum(_LEAST, total - 2.0 * moments[1])),
        wp.sqrt(6.0 / mass * maximum(_LEAST, total - 2.0 * moments[2])),
    )


@func
def force_on_box(size: Vector3, density: real, viscosity: real, spin: Vector3, flow: Vector3) -> Vector6:
    """Force and torque on a box with an angular velocity and a velocity in the fluid, all in its axes."""
    mean = (size[0] + size[1] + size[2]) / 3.0
    areas = Vector3(size[1] * size[2], size[2] * size[0], size[0] * size[1])
    x, y, z = fourth_power(size[0]), fourth_power(size[1]), fourth_power(size[2])
    swept = Vector3(size[0] * (y + z), size[1] * (z + x), size[2] * (x + y))
    force = -3.0 * _PI * mean * viscosity * flow - 0.5 * density * times(areas, times(magnitudes(flow), flow))
    torque = -_PI * mean * mean * mean * viscosity * spin - _FACE * density * times(
        swept, times(magnitudes(spin), spin)
    )
    return Vector6(force[0], force[1], force[2], torque[0], torque[1], torque[2])


@func
def force_on_ellipsoid(
    shape: Vector8, added: Vector6, density: real, viscosity: real, spin: Vector3, flow: Vector3
) -> Vector6:
    """As `force_on_box`, on an ellipsoid."""
    axes = Vector3(shape[0], shape[1], shape[2])
    blunt, slender, angular, kutta, magnus = shape[3], shape[4], shape[5], shape[6], shape[7]
    greatest, least = greatest_entry(axes), least_entry(axes)
    middle = axes[0] + axes[1] + axes[2] - greatest - least
    mean = 2.0 / 3.0 * (axes[0] + axes[1] + axes[2])
    volume = 4.0 / 3.0 * _PI * axes[0] * axes[1] * axes[2]

    # Added mass, without what accelerations do.
    momentum = density * times(Vector3(added[0], added[1], added[2]), flow)
    turning = density * times(Vector3(added[3], added[4], added[5]), spin)
    force = wp.cross(momentum, spin)
    torque = wp.cross(momentum, flow) + wp.cross(turning, spin)

    # The area that the flow sees, and lift.
    areas = Vector3(axes[1] * axes[2], axes[2] * axes[0], axes[0] * axes[1])
    normal = times(times(areas, areas), flow)
    projected = wp.dot(normal, flow)
    square = maximum(_LEAST * _LEAST, wp.dot(normal, normal))
    speed = wp.length(flow)
    area = _PI * wp.sqrt(square / maximum(_LEAST * _LEAST, projected))
    share = projected / maximum(_LEAST * _LEAST, speed * square)
    force += magnus * density * volume * wp.cross(spin, flow)
    force += kutta * density * share * area * wp.cross(wp.cross(normal, flow), flow)

    # Drag.
    whole = _PI * greatest * middle
    drag = 3.0 * _PI * mean * viscosity + density * speed * (blunt * area + slender * (whole - area))
    force -= drag * flow
    most = _MOMENT * middle * fourth_power(greatest)
    moments = _MOMENT * Vector3(
        axes[0] * fourth_power(maximum(axes[1], axes[2])),
        axes[1] * fourth_power(maximum(axes[2], axes[0])),
        axes[2] * fourth_power(maximum(axes[0], axes[1])),
    )
    resisted = Vector3(
        spin[0] * (angular * moments[0] + slender * (most - moments[0])),
        spin[1] * (angular * moments[1] + slender * (most - moments[1])),
        spin[2] * (angular * moments[2] + slender * (most - moments[2])),
    )
    torque -= (_PI * mean * mean * mean * viscosity + density * wp.length(resisted)) * spin
    return Vector6(force[0], force[1], force[2], torque[0], torque[1], torque[2])


@func
def fluid_wrench(
    model: Model, world: Int32, link: Int32, rotation: Matrix3, mass: real, spin: Vector3, velocity: Vector3
) -> Vector6:
    """Force of the fluid on a link, and torque about its centre of mass, in world axes [N, N m].

    `rotation` is that of the inertial frame, `velocity` that of the centre of mass.
    """
    density, viscosity = model.fluid_density[world, 0] + 0.0, model.fluid_viscosity[world, 0] + 0.0
    back = wp.transpose(rotation)
    flow = back * (velocity - model.fluid_wind[world, 0])
    turn = back * spin
    wrench = Vector6()
    if model.link[link].fluid == IN_FLUID_AS_BOX:
        size = box_sizes(maximum(mass, _LEAST), model.link_inertia[world, link])
        wrench = force_on_box(size, density, viscosity, turn, flow)
        wrench = wp.where(mass < _LEAST, Vector6(), wrench)
    if model.link[link].fluid == IN_FLUID_AS_ELLIPSOID:
        wrench = force_on_ellipsoid(
            model.link_fluid_shape[world, link],
            model.link_fluid_added[world, link],
            density,
            viscosity,
            turn,
            flow,
        )
    wrench = wp.where(density + viscosity > 0.0, wrench, Vector6())
    force = rotation * Vector3(wrench[0], wrench[1], wrench[2])
    torque = rotation * Vector3(wrench[3], wrench[4], wrench[5])
    return Vector6(force[0], force[1], force[2], torque[0], torque[1], torque[2])


@func
def add_fluid_forces(model: Model, scratch: Scratch, world: Int32, tree: Int32):
    """Take the forces of the fluid off those that the links of a tree need; see `link_bias_forces`."""
    base = model.tree[tree].first_link
    for link in range(base, base + model.tree[tree].link_count):
        c = scratch.link[world, link].offset
        spin = scratch.link[world, link].omega
        velocity = scratch.link[world, link].velocity + wp.cross(spin, c)
        wrench = fluid_wrench(
            model,
            world,
            link,
            scratch.link[world, link].rotation,
            model.link_mass[world, link],
            spin,
            velocity,
        )
        force = Vector3(wrench[0], wrench[1], wrench[2])
        torque = Vector3(wrench[3], wrench[4], wrench[5])
        scratch.link[world, link].force -= force
        scratch.link[world, link].moment -= torque + wp.cross(c, force)
