"""How contacts between shapes of MuJoCo's files yield; see `kernels.dynamics.yielding`.

Each shape has a reference and an impedance. Of two shapes the one of higher rank decides, and of equal ranks
both are mixed by their weights; a shape without any leaves it to the other one. The inverse mass of a contact
is the sum of those of both shapes.
"""

import warp as wp

from carom.kernels.contact.filters import pair_with_contacts
from carom.kernels.dynamics.yielding import impedance_at, spring_and_damper
from carom.kernels.maths.min_max import maximum
from carom.kernels.structs import ContactTerms, Settings, Shapes
from carom.kernels.types import Int32, Vector4, func, real

_LEAST = real(1e-15)


@func
def yields(shapes: Shapes, world: Int32, a: Int32, b: Int32) -> bool:
    """Whether contacts of two shapes yield as MuJoCo's: if one has an impedance, and no spring counts."""
    # Few shapes have an impedance, so this is asked first.
    if shapes.shape_impedance[world, a][1] <= 0.0 and shapes.shape_impedance[world, b][1] <= 0.0:
        return False
    return shapes.shape_stiffness[world, a] < 0.0 and shapes.shape_stiffness[world, b] < 0.0


@func
def combined_restitution(shapes: Shapes, world: Int32, a: Int32, b: Int32) -> real:
    """Combined coefficient of restitution of two shapes."""
    return shapes.shape_restitution[world, a] * shapes.shape_restitution[world, b]


@func
def yields_without_bounce(shapes: Shapes, world: Int32, a: Int32, b: Int32) -> bool:
    """Whether contacts of two shapes yield as MuJoCo's, within their margin only: not if they rebound."""
    return yields(shapes, world, a, b) and combined_restitution(shapes, world, a, b) <= 0.0


@func
def weight_of_first(shapes: Shapes, world: Int32, a: Int32, b: Int32) -> real:
    """How much the parameters of the first of two shapes count, from 0 to 1."""
    if shapes.shape_impedance[world, b][1] <= 0.0:
        return real(1.0)
    if shapes.shape_impedance[world, a][1] <= 0.0:
        return real(0.0)
    rank_a, rank_b = shapes.shape_friction_rank[world, a], shapes.shape_friction_rank[world, b]
    if rank_a != rank_b:
        return wp.where(rank_a > rank_b, real(1.0), real(0.0))
    own, other = shapes.shape_mixing[world, a][0], shapes.shape_mixing[world, b][0]
    if own >= _LEAST and other >= _LEAST:
        return own / (own + other)
    if own < _LEAST and other < _LEAST:
        return real(0.5)
    return wp.where(own >= _LEAST, real(1.0), real(0.0))


@func
def one_decides(shapes: Shapes, world: Int32, a: Int32, b: Int32) -> bool:
    """Whether only one of two shapes says how contacts yield, or has the higher rank."""
    if shapes.shape_impedance[world, a][1] <= 0.0 or shapes.shape_impedance[world, b][1] <= 0.0:
        return True
    return shapes.shape_friction_rank[world, a] != shapes.shape_friction_rank[world, b]


@func
def mixed_reference(shapes: Shapes, world: Int32, a: Int32, b: Int32, share: real) -> Vector4:
    """Reference of the contacts of two shapes; of stiffnesses and dampings, the greater ones of both.

    That goes for those with a weight of 0 as well.
    """
    own, other = shapes.shape_reference[world, a], shapes.shape_reference[world, b]
    if one_decides(shapes, world, a, b):
        return wp.where(share > 0.5, own, other)
    mixed = own * share + other * (1.0 - share)
    if own[0] <= 0.0 or other[0] <= 0.0:
        mixed[0] = wp.min(own[0], other[0])
        mixed[1] = wp.min(own[1], other[1])
    return mixed


@func
def pyramid_share(shapes: Shapes, terms: ContactTerms, world: Int32, a: Int32, b: Int32) -> real:
    """By how much more than along its normal a contact yields whose friction cone is a pyramid.

    Each edge of the pyramid yields, and all share the normal force.
    """
    share = maximum(shapes.shape_mixing[world, a][2], shapes.shape_mixing[world, b][2])
    friction = terms.friction[0]
    if share <= 0.0 or friction <= 0.0:
        return real(1.0)
    edges = real(2.0)
    if terms.friction[2] > 0.0:
        edges = real(3.0)
    if terms.friction[1] > 0.0:
        edges = real(5.0)
    square = friction * friction
    return share * square * (1.0 + square) / edges


@func
def lateral_softness(shapes: Shapes, terms: ContactTerms, world: Int32, a: Int32, b: Int32) -> real:
    """By how much more than along its normal a contact yields sideways while it sticks."""
    share = maximum(shapes.shape_mixing[world, a][2], shapes.shape_mixing[world, b][2])
    if share <= 0.0:
        return real(1.0)
    friction = terms.friction[0]
    return share * (1.0 + friction * friction)


@func
def contact_law(settings: Settings, shapes: Shapes, world: Int32, a: Int32, b: Int32):
    """How contacts of two shapes yield, as these or the pair of their links say.

    Returns:
        Reference and impedance, see `kernels.dynamics.yielding`; the reference of lateral friction; the
        margin [m]; the inverse mass [1/kg]; the row of their pair, or -1.
    """
    share = weight_of_first(shapes, world, a, b)
    reference = mixed_reference(shapes, world, a, b, share)
    own, other = shapes.shape_impedance[world, a], shapes.shape_impedance[world, b]
    impedance = own * share + other * (1.0 - share)
    inverse_mass = own[3] + other[3]
    margin = shapes.shape_mixing[world, a][1] + shapes.shape_mixing[world, b][1]
    lateral = reference
    row = pair_with_contacts(shapes, settings, shapes.shape_link[a], shapes.shape_link[b])
    if row >= 0:
        reference = shapes.filter_reference[row]
        impedance = shapes.filter_impedance[row]
        margin = impedance[3]
        lateral = shapes.filter_lateral[row]
        if lateral[0] == 0.0 and lateral[1] == 0.0:
            lateral = reference
    return reference, impedance, lateral, margin, inverse_mass, row


@func
def let_contact_yield(
    settings: Settings, shapes: Shapes, terms: ContactTerms, world: Int32, a: Int32, b: Int32
) -> ContactTerms:
    """The terms of a contact with what two shapes, or the pair of their links, say about how it yields.

    One that is farther apart than its margin is no contact.
    """
    reference, impedance, lateral, margin, inverse_mass, row = contact_law(settings, shapes, world, a, b)
    if row >= 0:
        terms.friction = shapes.filter_friction[row]
    distance = terms.distance - margin
    if distance >= 0.0 or terms.ignored != 0:
        terms.ignored = Int32(1)
        terms.softness = real(0.0)
        terms.lateral_softness = real(0.0)
        return terms
    d = impedance_at(reference, impedance, distance)
    stiffness, damping = spring_and_damper(settings, reference, impedance)
    terms.yields = Int32(1)
    terms.damping = damping
    _stiffness, lateral_damping = spring_and_damper(settings, lateral, impedance)
    terms.erp = lateral_damping
    terms.pull = stiffness * d * distance
    terms.lateral_softness = lateral_softness(shapes, terms, world, a, b) * inverse_mass * (1.0 - d) / d
    terms.softness = inverse_mass * pyramid_share(shapes, terms, world, a, b) * (1.0 - d) / d
    return terms
