"""Constraints between bodies."""

from __future__ import annotations

from tools.differ.assets import FIXED, GEAR, POINT, PRISMATIC, REVOLUTE
from tools.differ.maker import Maker


def constraint(maker: Maker) -> None:
    """Make a constraint, change one, or ask for it."""
    if maker.constraints and maker.chance(0.5):
        _change(maker)
    else:
        _create(maker)


def _change(maker: Maker) -> None:
    chosen = maker.one(maker.constraints)
    kind = maker.random.randrange(8)
    if kind < 4:
        keywords = maker.some(
            jointChildPivot=maker.vector(0.5),
            jointChildFrameOrientation=maker.turn(),
            maxForce=maker.one((0, 1, 100, 1e4)),
            gearRatio=maker.number(-2, 2),
            gearAuxLink=-1,
            relativePositionTarget=maker.number(-1, 1),
            erp=maker.share(),
        )
        maker.call("changeConstraint", chosen, **keywords)
    elif kind == 4:
        maker.call("getConstraintInfo", chosen)
    elif kind == 5:
        maker.call("getConstraintState", chosen)
    elif kind == 6 and maker.chance(0.3):
        maker.call("removeConstraint", chosen)
        maker.call("getNumConstraints")
    else:
        maker.call("getConstraintUniqueId", maker.random.randrange(2))


def _create(maker: Maker) -> None:
    first, second = maker.body(), maker.one((None, maker.body()))
    if second is first and len(first.joints) < 3:
        second = None
    kind = maker.one((PRISMATIC, FIXED, FIXED, POINT, POINT, POINT, GEAR, REVOLUTE))
    parent, child = maker.link(first), maker.link(second) if second else -1
    if kind == GEAR:
        movers = [(body, joint) for body in maker.bodies for joint in body.of_type(REVOLUTE, PRISMATIC)]
        if len(movers) < 2:
            return
        (first, parent), (second, child) = maker.random.sample(movers, 2)
    made = maker.call(
        "createConstraint",
        first.reference,
        parent,
        second.reference if second else -1,
        child,
        kind,
        maker.axis(),
        maker.vector(0.4),
        maker.one((maker.vector(0.4), maker.place())),
        **maker.some(parentFrameOrientation=maker.turn(), childFrameOrientation=maker.turn()),
    )
    maker.constraints.append(made)
    if maker.chance(0.7):
        maker.call("changeConstraint", made, maxForce=maker.one((1, 20, 500)))
