"""Internal damping of soft bodies: springs and tetrahedra change the velocities of nodes.

A force -D v acts for a small step of length h. It is scaled by a / (a + h b), where a is the dissipated power
v D v, and b the sum of squared forces divided by masses. So it never reverses motion, however large D is.

Nodes whose anchor is undamped move others by damping, but are not moved themselves, nor are their links.
"""

import warp as wp

from carom.kernels.maths.rotation import column
from carom.kernels.soft.elasticity import edges
from carom.kernels.structs import SoftModel, State
from carom.kernels.types import Int32, func, real
from carom.layouts.soft import HELD_UNDAMPED

_SHORTEST = real(1.0e-12)


@func
def mobility(soft: SoftModel, node: Int32) -> real:
    """Inverse mass of a node as damping sees it [1/kg]."""
    if soft.node_anchored[node] == HELD_UNDAMPED:
        return 0.0
    return soft.node_inverse_mass[node]


@func
def damp_springs(soft: SoftModel, state: State, world: Int32, body: Int32, h: real):
    """Damp the relative motion of the ends of each spring of a body."""
    first = soft.soft[body].first_spring
    for spring in range(first, first + soft.soft[body].spring_count):
        damping = soft.spring[spring].damping
        if damping > 0.0:
            a = soft.spring[spring].a
            b = soft.spring[spring].b
            inverse_a = mobility(soft, a)
            inverse_b = mobility(soft, b)
            closing = state.node_velocity[world, b] - state.node_velocity[world, a]
            push = closing * (damping * h / (1.0 + damping * h * (inverse_a + inverse_b)))
            if soft.spring[spring].all_directions == 0:
                apart = state.node_position[world, b] - state.node_position[world, a]
                push = apart * (wp.dot(push, apart) / (wp.dot(apart, apart) + _SHORTEST * _SHORTEST))
            state.node_velocity[world, a] += push * inverse_a
            state.node_velocity[world, b] -= push * inverse_b


@func
def damp_tetras(soft: SoftModel, state: State, world: Int32, body: Int32, h: real):
    """Damp the deformation of each tetrahedron of a body.

    The stress is that of a viscous solid, `damping` (2 mu R + lam tr(R) 1), where R is the rate of the Green
    strain (FᵀF - 1) / 2. Rotation as a whole is no strain and is not damped.
    """
    share = soft.soft[body].damping
    mu, lam = soft.soft[body].mu * share, soft.soft[body].lam * share
    first = soft.soft[body].first_tetra
    if share > 0.0:
        for tetra in range(first, first + soft.soft[body].tetra_count):
            four = soft.tetra[tetra].nodes
            inverse = soft.tetra[tetra].inverse
            f = edges(state.node_position, world, four) * inverse
            rate = wp.transpose(f) * (edges(state.node_velocity, world, four) * inverse)
            strain = (rate + wp.transpose(rate)) * 0.5
            trace = strain[0, 0] + strain[1, 1] + strain[2, 2]
            stress = strain * (2.0 * mu) + wp.identity(3, real) * (lam * trace)
            volume = soft.tetra[tetra].volume
            force = (f * stress * wp.transpose(inverse)) * (-volume)
            force_first = -(column(force, 0) + column(force, 1) + column(force, 2))
            power = volume * wp.ddot(strain, stress)
            response = mobility(soft, four[0]) * wp.dot(force_first, force_first)
            for i in range(3):
                along = column(force, i)
                response += mobility(soft, four[i + 1]) * wp.dot(along, along)
            if power > 0.0:
                scale = h * power / (power + h * response)
                state.node_velocity[world, four[0]] += force_first * (scale * mobility(soft, four[0]))
                for i in range(3):
                    state.node_velocity[world, four[i + 1]] += column(force, i) * (
                        scale * mobility(soft, four[i + 1])
                    )
