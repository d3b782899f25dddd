"""The launches of integrators other than the usual one, and what they cannot do."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from carom.engine.can_collide import has_late_links
from carom.engine.contact_arrays import ContactArrays
from carom.engine.parameters import (
    BULLET,
    CONVERGED,
    DISCRETE,
    EULER,
    EXPLICIT,
    IMPLICIT,
    IMPLICIT_FAST,
    MIDPOINT,
    OF_STEPS,
    RK4,
    EngineParameters,
    integrator_of,
)
from carom.layouts import newton
from carom.model.builder import WorldArrays
from carom.native.kernels import (
    Kernel,
    begin_stages_kernel,
    continued_explicit_kernel,
    continued_midpoint_kernel,
    continued_motion_kernel,
    explicit_motion_kernel,
    free_motion_kernel,
    implicit_integration_kernel,
    integration_kernel,
    midpoint_integration_kernel,
    midpoint_motion_kernel,
    rk4_stage_kernel,
)
from carom.native.launch import KernelStructs, Launch

_KINDS = {
    EXPLICIT: newton.EXPLICIT,
    EULER: newton.EULER,
    IMPLICIT_FAST: newton.IMPLICIT_FAST,
    IMPLICIT: newton.IMPLICIT,
}
_STAGES = 4
INTEGRATING = (integration_kernel, implicit_integration_kernel, midpoint_integration_kernel)
"""The kernels that end a substep of one stage, after its rows are solved."""
# What takes the place of kernels that advance velocities, in lanes and alone.
_MOTION = {free_motion_kernel: explicit_motion_kernel, continued_motion_kernel: continued_explicit_kernel}
_MIDPOINT_MOTION = {
    free_motion_kernel: midpoint_motion_kernel,
    continued_motion_kernel: continued_midpoint_kernel,
}


class Laws:
    """The law of contacts and the integrator of the present plan.

    Attributes:
        contact: The law.
        integrator: Any of `EngineParameters`, or that which follows from the law.
        noslip: `EngineParameters.noslip_iterations`.
    """

    def __init__(self) -> None:
        self.contact: str = BULLET
        self.integrator: str = DISCRETE
        self.noslip: int = 0
        self._asked = self.contact, self.integrator, self.noslip

    def ask(self, parameters: EngineParameters) -> bool:
        """Take those of parameters; returns whether they are others than before."""
        integrator = integrator_of(parameters.integrator, parameters.contact)
        asked = parameters.contact, integrator, parameters.noslip_iterations
        if asked == self._asked:
            return False
        self._asked = self.contact, self.integrator, self.noslip = asked
        return True

    @property
    def needs(self) -> tuple[bool, bool]:
        """Whether constraints converge, and whether steps may have stages: both need memory of their own."""
        return self.contact in CONVERGED, self._asked[1] != DISCRETE

    def settle(self, arrays: WorldArrays, contact_arrays: ContactArrays, *, touching: bool) -> None:
        """Choose the integrator for what is in a world; `touching` is whether shapes can touch.

        Raises:
            NotImplementedError: Something is not built for the integrator.
        """
        self.integrator = self._asked[1]
        if self.integrator == MIDPOINT and (contact_arrays.soft.bodies or has_late_links(arrays)):
            self.integrator = DISCRETE
        fluid = any(bool(np.any(arrays.model.numpy[name])) for name in ("fluid_density", "fluid_viscosity"))
        refuse_unsuited(self.integrator, arrays, contact_arrays, touching=touching, fluid=fluid)


def staged_motion(
    structs: KernelStructs,
    integrator: str,
    motion: Sequence[Kernel],
    detection: Sequence[Launch],
    *,
    by_frame: bool,
    **scalars: int,
) -> list[Launch]:
    """The launches of a substep after its detection of collisions.

    Args:
        structs: The structs of the launches.
        integrator: Any but "discrete".
        motion: The kernels of the usual integrator, one of which integrates, after those of constraints if
            these are among them.
        detection: The launches that detect collisions, which stages after the first repeat.
        by_frame: Whether bases move by the origins of their frames, not by their centres of mass, with
            MuJoCo's integrators; see `kernels.integrators.frames`.
        **scalars: Scalars of the kernel of constraints.
    """
    end = motion.index(integration_kernel)
    moving = _MIDPOINT_MOTION if integrator == MIDPOINT else _MOTION
    kernels = [moving.get(it, it) for it in motion[:end]]
    framed = {"by_frame": int(by_frame)}

    def stage(last: Launch) -> list[Launch]:
        of_kernel = {kernels[-1]: scalars, **dict.fromkeys(_MOTION.values(), framed)}
        solved = [structs.launch(it, first_world=0, **of_kernel.get(it, {})) for it in kernels]
        return [*solved, last, *(structs.launch(it, first_world=0) for it in motion[end + 1 :])]

    if integrator == MIDPOINT:
        return stage(structs.launch(midpoint_integration_kernel, first_world=0))
    launches = [structs.launch(begin_stages_kernel, first_world=0)]
    if integrator != RK4:
        last = structs.launch(implicit_integration_kernel, first_world=0, kind=_KINDS[integrator], **framed)
        return launches + stage(last)
    for number in range(_STAGES):
        if number > 0:
            launches += detection
        launches += stage(structs.launch(rk4_stage_kernel, first_world=0, stage=number, **framed))
    return launches


def refuse_unsuited(
    integrator: str, arrays: WorldArrays, contact_arrays: ContactArrays, *, touching: bool, fluid: bool
) -> None:
    """Raise `NotImplementedError` if something in a world is not built for its integrator.

    Args:
        integrator: As in `EngineParameters`.
        arrays: Model and state.
        contact_arrays: Shapes and soft bodies.
        touching: Whether shapes can touch.
        fluid: Whether there is a fluid.
    """
    if integrator in OF_STEPS:
        return
    what = ""
    if contact_arrays.soft.bodies and integrator == RK4:
        what = "soft bodies"
    elif has_late_links(arrays):
        what = "bodies loaded with URDF_GLOBAL_VELOCITIES_MB"
    elif integrator in (IMPLICIT_FAST, IMPLICIT) and fluid:
        what = "forces of a fluid (fluid_density, fluid_viscosity), whose derivatives are missing"
    elif integrator == RK4 and touching and _can_touch_rigidly(arrays, contact_arrays):
        what = (
            "contacts of shapes that do not yield, whose impulses are those of whole steps: at least one of "
            "two shapes that touch has to be of an MJCF file"
        )
    if what:
        raise NotImplementedError(f"integrator={integrator!r} cannot have {what}; use integrator='discrete'")


def _can_touch_rigidly(arrays: WorldArrays, contact_arrays: ContactArrays) -> bool:
    """Whether two shapes of which none yields could touch, and one of them can move."""
    shapes = contact_arrays.shapes
    count, table = shapes.shape_count, shapes.table.numpy
    is_soft = (table["shape_impedance"][:, :count, 1] > 0.0) & (table["shape_stiffness"][:, :count] < 0.0)
    links = table["shape_link"][:count][~is_soft.all(axis=0)]
    model, used = arrays.model.numpy, arrays.used["tree"]
    trees = np.searchsorted(model["tree_first_link"][:used], links, side="right") - 1
    moves = model["tree_dof_count"][:used][trees] > 0
    return bool(moves.any()) and len(np.unique(trees)) > 1
