"""Contacts that yield, asked for their rows alone: with given impulses, whatever their law says.

`linearization.converged.noslip` asks that of a step whose friction was found a second time.
"""

from carom.kernels.structs import StepBatch, StepSpace, TouchingLinks
from carom.kernels.types import Int32, Vector6, func, real
from carom.layouts.newton import CONE


@func
def take_given(
    space: StepSpace, steps: StepBatch, first: Int32, start: Int32, room: Int32, count: Int32
) -> Vector6:
    """The impulses that are given in the places of the rows of a contact; each row is on its own."""
    found = Vector6()
    for i in range(count):
        found[i] = steps.row_asked[first + i]
        for j in range(count):
            steps.alpha[start + i * room + j] = real(0.0)
        steps.alpha[start + i * room + i] = real(1.0)
    return found


@func
def note_law(
    space: StepSpace,
    steps: StepBatch,
    place: Int32,
    touch: TouchingLinks,
    first: Int32,
    count: Int32,
    rate: Vector6,
    coefficient: Vector6,
    law: Int32,
    softens: real,
    parts: Int32,
):
    """Write of the rows of a contact what its law takes.

    These are its residuals (`row_mass`), coefficients (`row_yield`; of its normal 1 for a cone, 0 for a
    pyramid), and how its softness changes with positions, relative to it (`through` of its normal).
    """
    n = space.dofs
    for i in range(count):
        steps.row_mass[first + i] = rate[i]
        steps.row_yield[first + i] = coefficient[i]
        steps.beta[(first + i) * space.most_rows + first + i - place * space.most_rows] = 0.0
    steps.row_yield[first] = real(0.0)
    if law == CONE:
        steps.row_yield[first] = real(1.0)
    for index in range(touch.reach):
        dof = steps.reach[place * n + index]
        steps.through[first * n + dof] = softens * steps.response[parts + dof]
