"""Whether a tendon is slack."""

from __future__ import annotations

from math import inf

from carom.scene.user_constraints import UserConstraint


def is_slack(tendon: UserConstraint, length: float) -> bool:
    """Whether a tendon of this length [m] does not pull: neither its spring, nor its limit, nor an actuator.

    A tendon that has none of these is not slack.
    """
    stiffness, _, least, greatest = tendon.spring
    lower, upper, *_ = tendon.range
    forces = _actuator_forces(tendon)
    has_spring, has_limit = stiffness > 0.0 or any(tendon.polynomial), lower > -inf or upper < inf
    if not (has_spring or has_limit or forces):
        return False
    if has_spring and (least == greatest or not least <= length <= greatest):
        return False
    if has_limit and not lower < length < upper:
        return False
    return not any(forces)


def _actuator_forces(tendon: UserConstraint) -> list[float]:
    """Forces of the actuators of a tendon in the last step."""
    body = tendon.parent
    numbers = [number for number, it in enumerate(body.spec.actuators) if it.tendon == tendon.name]
    if not numbers:
        return []
    first = body.rows.first["actuator"]
    force = body.world.arrays.state.numpy["actuator_force"][0]
    return [float(force[first + number]) for number in numbers]
