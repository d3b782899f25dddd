"""Keeping the state of a world by names while its files are loaded again."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from carom.description.keyframe import BodyKeyframe
from carom.description.pose import Pose
from carom.errors import DescriptionError

if TYPE_CHECKING:
    from carom.scene.body import Body
    from carom.world.world import World

Numbers = NDArray[np.float64]


@dataclass(eq=False, slots=True)
class _KeptJoint:
    """Coordinates, rates, and the rows of the motor and the PD drive of a joint."""

    coordinates: Numbers
    rates: Numbers
    motor: Numbers
    pd: Numbers


@dataclass(eq=False, slots=True)
class _KeptBody:
    """The state of a body; the base of one that is fixed is where its file says."""

    base: tuple[Pose, Numbers, Numbers] | None
    joints: dict[str, _KeptJoint] = field(default_factory=dict)
    actuators: dict[str, tuple[float, float]] = field(default_factory=dict)


@dataclass(eq=False, slots=True)
class KeptState:
    """The state of a world: its time [s], and its bodies by names."""

    time: float
    bodies: dict[str, _KeptBody]

    @classmethod
    def of(cls, world: World) -> KeptState:
        """The present state. Of bodies with the same name each has its own, in their order."""
        return cls(float(world.time), {name: _kept(body) for name, body in _named(world)})

    def give(self, world: World) -> None:
        """Give it to bodies, joints and actuators of a world with the same names, and as many dofs."""
        with world.call_lock:
            for name, body in _named(world):
                if name in self.bodies:
                    _give(body, self.bodies[name])
            world.time = self.time


def _named(world: World) -> list[tuple[str, Body]]:
    """The bodies with names of their own: a second `cube` is `cube/2`."""
    counts: dict[str, int] = {}
    found: list[tuple[str, Body]] = []
    for body in world.bodies.values():
        counts[body.name] = number = counts.get(body.name, 0) + 1
        found.append((body.name if number == 1 else f"{body.name}/{number}", body))
    return found


def _kept(body: Body) -> _KeptBody:
    world = body.world
    base = None
    if not body.fixed_base or body.spec.is_mocap:
        position, orientation = body.pose
        (px, py, pz), (x, y, z, w) = position.tolist(), orientation.tolist()
        linear, angular = body.links[-1].velocity
        base = (Pose((px, py, pz), (x, y, z, w)), linear, angular)
    kept = _KeptBody(base)
    for joint in body.joints:
        if joint.degrees_of_freedom:
            row = body.velocity_index[joint.index]
            dofs = slice(row, row + joint.degrees_of_freedom)
            kept.joints[joint.name] = _KeptJoint(
                joint.coordinates, joint.rates, world.motor[dofs].copy(), world.pd[dofs].copy()
            )
    kept.actuators = {it.name: (it.control, it.activation) for it in body.actuators}
    return kept


def _give(body: Body, kept: _KeptBody) -> None:
    world = body.world
    if kept.base is not None and (not body.fixed_base or body.spec.is_mocap):
        pose, linear, angular = kept.base
        body.set_pose(pose)
        if not body.fixed_base:
            body.set_base_velocity(linear.tolist(), angular.tolist())
    for joint in body.joints:
        was = kept.joints.get(joint.name)
        if was is None or len(was.rates) != joint.degrees_of_freedom:
            continue
        if len(was.coordinates) == len(joint.coordinates):
            joint.reset(was.coordinates, was.rates)
            row = body.velocity_index[joint.index]
            dofs = slice(row, row + joint.degrees_of_freedom)
            world.motor[dofs], world.pd[dofs] = was.motor, was.pd
    for actuator in body.actuators:
        if actuator.name in kept.actuators:
            actuator.control, activation = kept.actuators[actuator.name]
            actuator.activation = activation


class OwnKeyframes:
    """The keyframes that the user has saved, which files do not have; bodies are known by their names."""

    def __init__(self) -> None:
        self._kept: dict[str, dict[str, BodyKeyframe]] = {}

    @property
    def names(self) -> list[str]:
        """Their names, the oldest first."""
        return [*self._kept]

    def save(self, world: World, name: str) -> None:
        """Make the present state a keyframe of all bodies.

        Raises:
            DescriptionError: There is one of this name, or it has none.
        """
        if not name.strip():
            raise DescriptionError("a keyframe needs a name")
        bodies = _named(world)
        for _, body in bodies:
            if any(it.name == name for it in body.spec.keyframes):
                raise DescriptionError(f"there is a keyframe {name!r} already")
        for _, body in bodies:
            body.add_keyframe(name)
        self._kept[name] = {key: body.spec.keyframes[-1] for key, body in bodies}

    def forget(self, world: World, name: str) -> None:
        """Drop one; those of files stay."""
        if self._kept.pop(name, None) is not None:
            for body in world.bodies.values():
                others = tuple(it for it in body.spec.keyframes if it.name != name)
                body.spec = replace(body.spec, keyframes=others)

    def give(self, world: World) -> list[str]:
        """Give them to bodies that have been loaded again; the names of those that do not fit any more."""
        lost: list[str] = []
        bodies = dict(_named(world))
        for name, states in [*self._kept.items()]:
            given = 0
            for key, keyframe in states.items():
                if key in bodies:
                    try:
                        bodies[key].add_keyframe(keyframe)
                    except DescriptionError:
                        continue
                    given += 1
            if given < len(states):
                lost.append(name)
            if not given:
                del self._kept[name]
        return lost
