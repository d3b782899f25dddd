"""Elastic forces as displacements, one spring or tetrahedron after the other.

A substep consists of *small steps*. In each, nodes first move freely, and then the force of every spring and
tetrahedron moves its nodes. If the small step is short enough for the stiffness, the force is that at the
positions at the start of the small step: symplectic Euler, which conserves energy and is at rest exactly
where forces balance. Otherwise the force is implicit in time: extended position-based dynamics (XPBD;
Macklin, Müller, Chentanez, 2016) with one sweep for each of many small steps (Macklin et al., "Small Steps in
Physics Simulation", 2019). For an energy k C² / 2 the impulse along grad C is -k C h / (1 + k h² w), where w
is the effective inverse mass of C. This never overshoots; elements too stiff for the step act softer.
"""

import warp as wp

from carom.kernels.maths.rotation import column
from carom.kernels.structs import SoftModel, SoftWork, State
from carom.kernels.types import Index4, Int32, Matrix3, Vector3Rows, func, real

# Shorter springs have no direction [m].
_SHORTEST = real(1.0e-12)
# Ratio of stiffness to inertia of a tetrahedron, k h² w, above which its stress is implicit. Only deformed
# ones get there.
_EXPLICIT = real(0.6)
# Largest phase, in one small step, of the fastest vibration around a spring or tetrahedron at rest for which
# its force is explicit [rad]. Symplectic Euler is stable up to 2; the margin is for deformed ones, which are
# stiffer.
_LONGEST_PHASE = real(1.1)


@func
def relax_springs(soft: SoftModel, state: State, work: SoftWork, world: Int32, body: Int32, h: real):
    """Move the ends of each spring of a body by the effect of its force in a small step of `h` [s]."""
    first = soft.soft[body].first_spring
    for spring in range(first, first + soft.soft[body].spring_count):
        a = soft.spring[spring].a
        b = soft.spring[spring].b
        inverse_a = soft.node_inverse_mass[a]
        inverse_b = soft.node_inverse_mass[b]
        mass = soft.spring[spring].stiffness * h * h  # k h² [kg]
        apart = work.node_before[world, b] - work.node_before[world, a]
        if soft.spring[spring].frequency * h > _LONGEST_PHASE:
            apart = state.node_position[world, b] - state.node_position[world, a]
            mass = mass / (1.0 + mass * (inverse_a + inverse_b))
        length = wp.length(apart)
        if length > _SHORTEST:
            push = apart * (mass * (length - soft.spring[spring].length) / length)
            state.node_position[world, a] += push * inverse_a
            state.node_position[world, b] -= push * inverse_b


@func
def edges(places: Vector3Rows, world: Int32, four: Index4) -> Matrix3:
    """The edges of a tetrahedron from its first node, as columns; or their rates, given velocities."""
    origin = places[world, four[0]]
    p = places[world, four[1]] - origin
    q = places[world, four[2]] - origin
    r = places[world, four[3]] - origin
    return wp.matrix_from_cols(p, q, r)


@func
def cofactors(f: Matrix3) -> Matrix3:
    """Cofactors of a matrix: the derivative of its determinant with respect to its entries."""
    first, second, third = column(f, 0), column(f, 1), column(f, 2)
    a, b, c = wp.cross(second, third), wp.cross(third, first), wp.cross(first, second)
    return wp.matrix_from_cols(a, b, c)


@func
def relax_tetra(
    soft: SoftModel,
    state: State,
    places: Vector3Rows,
    world: Int32,
    tetra: Int32,
    shear_gain: real,
    bulk_gain: real,
    implicit: bool,
) -> bool:
    """Move the corners of a tetrahedron by the effect of its stress in a small step.

    The stress is computed from the positions `places`, and that at the end of the small step if `implicit`.
    The gains are mu and lam, times the tetrahedron's volume and the square of the small step. Returns false
    if it is too stiff for explicit stress; nothing has moved then.
    """
    four = soft.tetra[tetra].nodes
    inverse = soft.tetra[tetra].inverse
    f = edges(places, world, four) * inverse
    cofactor = cofactors(f)
    determinant = wp.dot(column(f, 0), column(cofactor, 0))
    squares = wp.ddot(f, f)
    shear = wp.sqrt(squares - wp.log(squares + 1.0))
    shear_scale = (1.0 - 1.0 / (squares + 1.0)) / shear
    # The columns are gradients with respect to nodes 1 to 3. All four gradients add up to zero.
    to_edges = wp.transpose(inverse)
    shear_gradient = (f * to_edges) * shear_scale
    bulk_gradient = cofactor * to_edges
    shear_first = -(column(shear_gradient, 0) + column(shear_gradient, 1) + column(shear_gradient, 2))
    bulk_first = -(column(bulk_gradient, 0) + column(bulk_gradient, 1) + column(bulk_gradient, 2))
    inverse_mass = soft.node_inverse_mass[four[0]]
    shear_mass = inverse_mass * wp.dot(shear_first, shear_first)
    bulk_mass = inverse_mass * wp.dot(bulk_first, bulk_first)
    both_mass = inverse_mass * wp.dot(shear_first, bulk_first)
    for i in range(3):
        inverse_mass = soft.node_inverse_mass[four[i + 1]]
        shear_column, bulk_column = column(shear_gradient, i), column(bulk_gradient, i)
        shear_mass += inverse_mass * wp.dot(shear_column, shear_column)
        bulk_mass += inverse_mass * wp.dot(bulk_column, bulk_column)
        both_mass += inverse_mass * wp.dot(shear_column, bulk_column)
    along_shear = -shear_gain * shear
    along_bulk = -(bulk_gain * (determinant - 1.0) - 0.75 * shear_gain)
    if implicit:
        # (1 + K h² W) displacement = -K h² C, with K = volume (mu, lam).
        a = 1.0 + shear_gain * shear_mass
        b, c = shear_gain * both_mass, bulk_gain * both_mass
        d = 1.0 + bulk_gain * bulk_mass
        scale = 1.0 / (a * d - b * c)
        wanted = along_shear
        along_shear = (d * wanted - b * along_bulk) * scale
        along_bulk = (a * along_bulk - c * wanted) * scale
    elif shear_gain * shear_mass + bulk_gain * bulk_mass > _EXPLICIT:
        return False
    state.node_position[world, four[0]] += (
        shear_first * along_shear + bulk_first * along_bulk
    ) * soft.node_inverse_mass[four[0]]
    for i in range(3):
        state.node_position[world, four[i + 1]] += (
            column(shear_gradient, i) * along_shear + column(bulk_gradient, i) * along_bulk
        ) * soft.node_inverse_mass[four[i + 1]]
    return True


@func
def relax_tetras(soft: SoftModel, state: State, work: SoftWork, world: Int32, body: Int32, h: real):
    """Move the corners of each tetrahedron of a body by the effect of its stress in a small step of `h` [s].

    The energy is the stable Neo-Hookean one of Smith, de Goes and Kim (2018), as in Bullet: with the
    deformation gradient F, J = det F and I = tr FᵀF,

        mu/2 (I - 3) - mu/2 log(I + 1) + lam/2 (J - 1 - 3/4 mu/lam)².

    Its two parts are the squares of sqrt(I - log(I + 1)) and of the rest. At rest they are in balance, so
    they have to be relaxed together, as in Macklin and Müller (2021): two equations for each tetrahedron.

    With implicit stress, one sweep over stiff tetrahedra comes to rest far from where forces balance. So if a
    small step is too long for the vibrations around a tetrahedron at rest, its stiffness is reduced until the
    step is short enough; only deformed tetrahedra are implicit.
    """
    first = soft.soft[body].first_tetra
    for tetra in range(first, first + soft.soft[body].tetra_count):
        phase = soft.tetra[tetra].frequency * h
        volume = soft.tetra[tetra].volume * (h * h)
        if phase > _LONGEST_PHASE:
            volume = volume * (_LONGEST_PHASE * _LONGEST_PHASE / (phase * phase))
        shear_gain, bulk_gain = soft.soft[body].mu * volume, soft.soft[body].lam * volume
        done = relax_tetra(soft, state, work.node_before, world, tetra, shear_gain, bulk_gain, False)
        if not done:
            done = relax_tetra(soft, state, state.node_position, world, tetra, shear_gain, bulk_gain, True)
