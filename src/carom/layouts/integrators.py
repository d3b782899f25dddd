"""Workspace of integrators other than the usual one: `StageWork`; see `kernels.integrators`.

As in `layouts.model`, a field's axis is the first word of its name. Velocities here are in *own axes*: the
angular velocity of a base in those of its link, everything else as in `State.dof_velocity`.
"""

from carom.layouts.types import RealRows, struct

# What the last kernel of a substep makes of the accelerations, see `kernels.integrators.implicit`: it counts
# damping of joints, all forces that depend on velocity, or these and what rotations do to velocities.
EULER, IMPLICIT_FAST, IMPLICIT = 1, 2, 3


@struct
class StageWork:
    """What a substep of several stages keeps from one stage to the next."""

    position_first: RealRows  # coordinates at the start of the substep
    dof_first: RealRows  # velocities there
    dof_stage: RealRows  # velocities at the start of the present stage
    dof_rate: RealRows  # weighted sum of the velocities of all stages so far
    dof_change: RealRows  # the same of accelerations, times the duration of the substep
    dof_applied: RealRows  # torques of users at the start of the substep
    actuator_first: RealRows  # activations at the start of the substep
    actuator_rate: RealRows  # weighted sum of their rates
