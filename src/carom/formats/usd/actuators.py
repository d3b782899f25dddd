"""`MjcActuator` of MuJoCo's schema: actuators of joints, in MuJoCo's units."""

from __future__ import annotations

from math import inf
from typing import Any

from carom.description.actuator import GeneralActuator
from carom.description.joint import ONE_AXIS
from carom.description.pose import Vector3
from carom.formats.usd.scene import Drive
from carom.formats.usd.stage import Stage
from carom.formats.usd.tree import Tree
from carom.layouts.codes import ActivationDynamics

MJC_ACTUATOR = "MjcActuator"
_DYNAMICS = {
    "none": ActivationDynamics.NONE,
    "integrator": ActivationDynamics.INTEGRATOR,
    "filter": ActivationDynamics.FILTER,
    "filterexact": ActivationDynamics.FILTER_EXACT,
}
_GAINS, _BIASES = ("fixed", "affine"), ("none", "affine")
Range = tuple[float, float]


def add_actuators(stage: Stage, trees: list[Tree]) -> None:
    """Give robots the actuators of their joints; those of other things, and of other laws, are reported.

    Where a joint has a drive as well, that counts: programs write both for one motor.

    Raises:
        DescriptionError: A number has no meaning.
    """
    moved = {
        motion.name: (tree, motion.drive is not None)
        for tree in trees
        for joint in tree.hung
        for motion in joint.motions
        if motion.type in ONE_AXIS
    }
    for prim in stage.prims():
        if str(prim.GetTypeName()) != MJC_ACTUATOR:
            continue
        targets = stage.targets(prim, "mjc:target")
        name = stage.name_of(targets[0]) if targets else ""
        if name not in moved or not targets[0].IsA(stage.pxr.UsdPhysics.Joint):
            stage.leave_out(prim, "it is not there", "only actuators of hinges and slides are built")
            continue
        tree, driven = moved[name]
        if driven:
            stage.leave_out(prim, "none: the drive of its joint counts", "both are one motor")
            continue
        actuator = _read(stage, prim, name)
        if actuator is None:
            stage.leave_out(prim, "it is not there", "its gain, bias or dynamics are not built")
            continue
        taken = {drive.name or drive.joint for drive in tree.robot.drives}
        own, number = stage.name_of(prim), 2
        while own in taken:
            own, number = f"{stage.name_of(prim)}@{number}", number + 1
        tree.robot.drives.append(Drive(name, actuator, name=own))


def _read(stage: Stage, prim: Any, joint: str) -> GeneralActuator | None:
    gain_type = str(stage.value(prim, "mjc:gainType", "fixed"))
    bias_type = str(stage.value(prim, "mjc:biasType", "none"))
    dynamics = _DYNAMICS.get(str(stage.value(prim, "mjc:dynType", "none")))
    if gain_type not in _GAINS or bias_type not in _BIASES or dynamics is None:
        return None
    gain, bias = _three(stage, prim, "mjc:gainPrm", 1.0), _three(stage, prim, "mjc:biasPrm", 0.0)
    time = _three(stage, prim, "mjc:dynPrm", 1.0)[0]
    return GeneralActuator(
        joint,
        gain if gain_type == "affine" else (gain[0], 0.0, 0.0),
        bias if bias_type == "affine" else (0.0, 0.0, 0.0),
        _three(stage, prim, "mjc:gear", 1.0)[0],
        _range(stage, prim, "ctrl"),
        _range(stage, prim, "force"),
        dynamics,
        time if time > 0.0 else 1.0,
        _range(stage, prim, "act"),
        acts_early=bool(stage.value(prim, "mjc:actEarly", False)),
    )


def _three(stage: Stage, prim: Any, name: str, first: float) -> Vector3:
    """The first three numbers of an array; without it `first` and zeros."""
    values = [float(it) for it in stage.value(prim, name, (first,))] + [0.0, 0.0, 0.0]
    return (values[0], values[1], values[2])


def _range(stage: Stage, prim: Any, name: str) -> Range:
    """Bounds; `auto` means that there are some if they are stated."""
    limited = str(stage.value(prim, f"mjc:{name}Limited", "auto"))
    low, high = (stage.number(prim, f"mjc:{name}Range:{end}", 0.0) for end in ("min", "max"))
    if limited == "false" or (limited == "auto" and low >= high):
        return (-inf, inf)
    return (low, high)
