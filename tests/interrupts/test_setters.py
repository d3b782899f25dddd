"""Every public setter of the modern API is one change: whoever looks at any line sees before or after it."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any
from weakref import WeakKeyDictionary

import numpy as np
import pytest
from tests.interrupts.faults import Fault
from tests.interrupts.test_prepared_changes import at_lines, seen
from tests.rings import few

from carom import Joint, JointPosition, Link, Motor, World
from carom.description.keyframe import BodyKeyframe
from carom.description.tendon import PathKind, PathPart, TendonSpec
from carom.scene.actuators.actuator import BodyActuator, BodyActuators
from carom.scene.body import Body
from carom.scene.joints import JointGroup, Joints
from carom.scene.named_constraints.named_constraint import NamedConstraint
from carom.scene.soft_body import SoftBody
from carom.scene.tendons.tendon import BodyTendon

# Of the lines of a call, about so many are tried.
_TRIED = 40

_MODEL = """<mujoco><worldbody>
<body name="a" pos="0 0 1"><joint name="i" damping="0.1" frictionloss="0.1" range="-1 1" limited="true"/>
<geom name="g" size="0.1"/>
<body name="b" pos="0 0 .3"><joint name="k" axis="1 0 0"/><geom name="h" size="0.1"/>
<body name="c" pos="0 0 .3"><joint name="l" type="ball"/><geom name="o" size="0.1"/></body></body></body>
<body name="free" pos="1 0 1"><freejoint/><geom name="f" size="0.1"/></body>
</worldbody>
<equality><joint joint1="i" joint2="k"/></equality>
<tendon><fixed name="t" stiffness="1"><joint joint="i" coef="1"/></fixed></tendon>
<actuator><position name="p" joint="i" kp="3"/><general name="q" joint="k" dyntype="integrator"/></actuator>
<sensor><gyro name="s" site="tip"/></sensor>
<keyframe><key name="up" time="3" qpos="0.1 0.2 1 0 0 0 1 0 1 1 0 0 0"/></keyframe></mujoco>"""


_SCENES: WeakKeyDictionary[World, Any] = WeakKeyDictionary()


def _made(folder: Path) -> World:
    """A world with everything that has setters."""
    path = folder / "model.xml"
    if not path.exists():
        path.write_text(
            _MODEL.replace('<geom name="o" size="0.1"/>', '<geom name="o" size="0.1"/><site name="tip"/>')
        )
    world = World()
    _SCENES[world] = world.load(path)
    world.load_urdf("r2d2.urdf", (3.0, 0.0, 0.5), as_pybullet=True)
    world.load_cloth(size=(0.1, 0.1), cells=(1, 1), position=(0.0, 5.0, 1.0))
    _cloth(world).anchor(2)
    world.gravity = (0.0, 0.0, -9.81)
    world.step(3)
    for link in world.bodies[0].links:
        assert link.pose
    return world


def _robot(world: World) -> Body:
    return world.bodies[0]


def _r2d2(world: World) -> Body:
    return world.bodies[2]


def _put(of: Callable[[World], Any], name: str, value: Any) -> Callable[[World], None]:
    return lambda world: setattr(of(world), name, value)


def _joint(world: World) -> Joint:
    return _robot(world).joints["i"]


def _ball(world: World) -> Joint:
    return _robot(world).joints["l"]


def _tendon(world: World) -> BodyTendon:
    return _robot(world).tendons["t"]


def _cloth(world: World) -> SoftBody:
    cloth = list(world.bodies.values())[-1]
    assert isinstance(cloth, SoftBody)
    return cloth


def _all(world: World) -> Any:
    numbers = [(it.armature, it.max_force, it.max_impulse) for it in world.user_constraints.all]
    return seen(world), numbers


def _set_dynamics(body: Body) -> None:
    body.set_dynamics(0, replace(body.dynamics(0), mass=2.0, lateral_friction=0.3, collision_margin=0.02))


SETTERS: dict[str, Callable[[World], Any]] = {
    "BodyActuator.control": _put(lambda world: _robot(world).actuators["p"], "control", 0.4),
    "BodyActuator.activation": _put(lambda world: _robot(world).actuators["q"], "activation", 0.4),
    "BodyActuator.kp": _put(lambda world: _robot(world).actuators["p"], "kp", 5.0),
    "BodyActuator.kv": _put(lambda world: _robot(world).actuators["p"], "kv", 0.5),
    "BodyActuator.gear": _put(lambda world: _robot(world).actuators["p"], "gear", 2.0),
    "BodyActuator.control_range": _put(
        lambda world: _robot(world).actuators["p"], "control_range", (-1.0, 1.0)
    ),
    "BodyActuator.force_range": _put(lambda world: _robot(world).actuators["p"], "force_range", (-1.0, 1.0)),
    "BodyActuator.change": lambda world: _robot(world).actuators["p"].change(kp=5.0, kv=0.5),
    "BodyActuators.controls": _put(lambda world: _robot(world).actuators, "controls", [0.3, 0.4]),
    "BodyActuators.activations": _put(lambda world: _robot(world).actuators, "activations", [0.3, 0.4]),
    "Body.present": _put(_robot, "present", False),
    "Body.add_actuator": lambda world: _robot(world).add_actuator("more", Motor(joint="i")),
    "Body.add_tendon": lambda world: _robot(world).add_tendon(
        TendonSpec("u", (PathPart(PathKind.JOINT, 0, size=0.5),), stiffness=2.0)
    ),
    "Body.add_site": lambda world: _robot(world).add_site("there"),
    "Body.add_sensor": lambda world: _robot(world).add_sensor("where", JointPosition("i", delay=0.1)),
    "Body.add_keyframe": lambda world: _robot(world).add_keyframe(BodyKeyframe("zero")),
    "Body.reset": lambda world: _robot(world).reset("up"),
    "Body.pose": _put(_robot, "pose", ((0.0, 1.0, 2.0), (0.0, 0.0, 0.6, 0.8))),
    "Body.set_pose": lambda world: _robot(world).set_pose(((0, 0, 2), (0, 0, 0.6, 0.8))),
    "Body.velocity": _put(_robot, "velocity", ((1.0, 2.0, 3.0), (4.0, 5.0, 6.0))),
    "Body.set_velocity": lambda world: _robot(world).set_velocity((1, 2, 3), (4, 5, 6)),
    "Body.set_inertial_pose": lambda world: _robot(world).set_inertial_pose((0, 0, 2), (0, 0, 0.6, 0.8)),
    "Body.set_base_velocity": lambda world: _robot(world).set_base_velocity((1, 2, 3), (4, 5, 6)),
    "Body.set_joint_state": lambda world: _robot(world).set_joint_state(2, (0.0, 0.6, 0.0, 0.8), (1, 2, 3)),
    "Body.set_joint_states": lambda world: _robot(world).set_joint_states(
        [(0, [0.2], [0.3]), (2, (0.0, 0.6, 0.0, 0.8), None)]
    ),
    "Body.change_dynamics": lambda world: _robot(world).change_dynamics(
        0, mass=2.0, lateral_friction=0.4, linear_damping=0.2, joint_damping=0.4, joint_lower_limit=-0.3
    ),
    "Body.set_dynamics": lambda world: _set_dynamics(_robot(world)),
    "Body.set_sensor": lambda world: _robot(world).set_sensor(1, True),
    "Joint.position": _put(_joint, "position", 0.3),
    "Joint.velocity": _put(_joint, "velocity", 0.3),
    "Joint.limits": _put(_joint, "limits", (-0.3, 0.3)),
    "Joint.damping": _put(_joint, "damping", 0.3),
    "Joint.armature": _put(_joint, "armature", 0.3),
    "Joint.stiffness": _put(_joint, "stiffness", 0.3),
    "Joint.spring_reference": _put(_ball, "spring_reference", (0.0, 0.6, 0.0, 0.8)),
    "Joint.friction_loss": _put(_joint, "friction_loss", 0.3),
    "Joint.friction_loss of another": _put(lambda world: _robot(world).joints["k"], "friction_loss", 0.3),
    "Joint.reset of a leader": lambda world: _robot(world).joints["k"].reset(0.3, 0.4),
    "Joint.reset": lambda world: _joint(world).reset(0.3, 0.4),
    "Joint.set_position_target": lambda world: _joint(world).set_position_target(0.3, max_force=2.0),
    "Joint.set_velocity_target": lambda world: _joint(world).set_velocity_target(0.3, max_force=2.0),
    "Joint.set_spring": lambda world: _joint(world).set_spring(
        0.3, stiffness=2.0, damping=0.3, max_force=2.0
    ),
    "Joint.set_orientation_target": lambda world: _ball(world).set_orientation_target(
        (0.0, 0.6, 0.0, 0.8), max_force=2.0
    ),
    "Joint.set_torque": lambda world: _ball(world).set_torque((1.0, 2.0, 3.0)),
    "Joint.torque": _put(_joint, "torque", 0.3),
    "Joint.servo": lambda world: _joint(world).servo(0.3, kp=4.0, kd=0.5, max_force=2.0),
    "Joint.velocity_servo": lambda world: _joint(world).velocity_servo(0.3, kd=0.5),
    "Joint.hold": lambda world: _joint(world).hold(max_force=2.0),
    "Joint.free": lambda world: _r2d2(world).joints.movable[0].free(),
    "Joint.enable_sensor": lambda world: _ball(world).enable_sensor(),
    "JointGroup.positions": _put(lambda world: _robot(world).joints[:2], "positions", (0.1, 0.2)),
    "JointGroup.velocities": _put(lambda world: _robot(world).joints[:2], "velocities", (0.1, 0.2)),
    "JointGroup.limits": _put(lambda world: _robot(world).joints[:2], "limits", (-0.3, 0.3)),
    "JointGroup.reset": lambda world: _robot(world).joints.reset((0.1, 0.2, 0.0, 0.6, 0.0, 0.8), 0.5),
    "JointGroup.set_position_targets": lambda world: _r2d2(world).joints.set_position_targets(
        0.3, max_forces=2.0
    ),
    "JointGroup.set_velocity_targets": lambda world: _r2d2(world).joints.set_velocity_targets(
        0.3, max_forces=2.0
    ),
    "JointGroup.set_torques": lambda world: _r2d2(world).joints.set_torques(0.3),
    "JointGroup.torques": _put(lambda world: _r2d2(world).joints, "torques", 0.3),
    "JointGroup.set_springs": lambda world: _r2d2(world).joints.set_springs(0.3, stiffness=2.0, damping=0.3),
    "JointGroup.enable_sensors": lambda world: _robot(world).joints.enable_sensors(),
    "JointGroup.servo": lambda world: _r2d2(world).joints.servo(0.3, kp=4.0, kd=0.5),
    "JointGroup.velocity_servo": lambda world: _r2d2(world).joints.velocity_servo(0.3, kd=0.5),
    "JointGroup.hold": lambda world: _r2d2(world).joints.hold(max_forces=2.0),
    "JointGroup.free": lambda world: _r2d2(world).joints.free(),
    "JointGroup.set_position_targets of some": lambda world: (
        _r2d2(world).joints[[1, 6, 4]].set_position_targets(0.3, max_forces=2.0)
    ),
    "JointGroup.set_torques of some": lambda world: _r2d2(world).joints[[1, 6, 4]].set_torques(0.3),
    "JointGroup.free of some": lambda world: _r2d2(world).joints[[1, 6, 4]].free(),
    "Link.apply_force": lambda world: (
        _robot(world).links[1].apply_force((1, 2, 3), (0.1, 0.2, 0.3), frame="link")
    ),
    "Link.apply_torque": lambda world: _robot(world).links[1].apply_torque((1, 2, 3), frame="link"),
    "NamedConstraint.max_force": _put(lambda world: next(iter(world.constraints)), "max_force", 3.0),
    "NamedConstraint.remove": lambda world: next(iter(world.constraints)).remove(),
    "NamedConstraint.enabled": lambda world: setattr(
        next(iter(_SCENES[world].constraints.values())), "enabled", False
    ),
    "BodyTendon.stiffness": _put(_tendon, "stiffness", 0.3),
    "BodyTendon.damping": _put(_tendon, "damping", 0.3),
    "BodyTendon.armature": _put(_tendon, "armature", 0.3),
    "BodyTendon.spring_range": _put(_tendon, "spring_range", (0.1, 0.2)),
    "BodyTendon.range": _put(_tendon, "range", (-0.1, 0.2)),
    "BodyTendon.friction": _put(_tendon, "friction", 0.3),
    "SoftBody.set_nodes": lambda world: _cloth(world).set_nodes(_cloth(world).nodes + 0.1),
    "SoftBody.set_node_velocities": lambda world: _cloth(world).set_node_velocities(np.ones((4, 3))),
    "SoftBody.set_inertial_pose": lambda world: _cloth(world).set_inertial_pose((0, 0, 3), (0, 0.6, 0, 0.8)),
    "SoftBody.set_base_velocity": lambda world: _cloth(world).set_base_velocity((1, 2, 3), (4, 5, 6)),
    "SoftBody.change_dynamics": lambda world: _cloth(world).change_dynamics(-1, lateral_friction=0.3),
    "SoftBody.anchor": lambda world: _cloth(world).anchor(1),
    "SoftBody.release": lambda world: _cloth(world).release(_cloth(world).anchors[0]),
    "World.time": _put(lambda world: world, "time", 3.0),
    "World.time_step": _put(lambda world: world, "time_step", 0.01),
    "World.contact": _put(lambda world: world, "contact", "rigid"),
    "World.gravity": _put(lambda world: world, "gravity", (1.0, 2.0, 3.0)),
}

# Classes of handles, and what of them is no setter of its own: it reads, or is a part of a change.
_HANDLES = (
    *(
        Body,
        Joint,
        JointGroup,
        Joints,
        Link,
        BodyActuator,
        BodyActuators,
        BodyTendon,
        NamedConstraint,
        SoftBody,
    ),
)
_NO_SETTERS = ("note_", "link_", "has_", "checked_", "update", "relocate", "measure_load", "encoded_names")


def _setters(kind: type) -> set[str]:
    found = set()
    for name, value in vars(kind).items():
        is_setter = isinstance(value, property) and value.fset is not None
        is_method = inspect.isfunction(value) and not name.startswith(_NO_SETTERS)
        if not name.startswith("_") and (is_setter or is_method):
            found.add(f"{kind.__name__}.{name}")
    return found


def test_every_setter_is_tried() -> None:
    tried = {name.partition(" ")[0] for name in SETTERS}
    # Looks are no part of a scene; the others only read.
    left_out = {
        "Link.colour",
        "Body.coordinates",
        "Body.dynamics",
        "SoftBody.corners",
        "JointGroup.motors",
        "JointGroup.springs",
    }
    there = set().union(*map(_setters, _HANDLES)) - left_out
    assert there - tried == set()


@pytest.mark.parametrize("name", few(SETTERS, 10))
def test_whoever_looks_at_any_line_of_a_setter_sees_before_or_after(name: str, tmp_path: Path) -> None:
    call = SETTERS[name]
    world = _made(tmp_path)
    call(world)
    after = _all(world)
    world = _made(tmp_path)
    before = _all(world)
    assert before != after
    found: list[Any] = []

    def look() -> None:
        now = _all(world)
        if not found or found[-1] != now:
            found.append(now)

    at_lines(lambda: call(world), look)
    look()
    assert found == [before, after]


@pytest.mark.parametrize("name", few(SETTERS, 10))
def test_an_exception_at_any_line_of_a_setter_leaves_before_or_after(name: str, tmp_path: Path) -> None:
    call = SETTERS[name]
    world = _made(tmp_path)
    lines = 0

    def count() -> None:
        nonlocal lines
        lines += 1

    at_lines(lambda: call(world), count)
    after = _all(world)
    world = _made(tmp_path)
    before = _all(world)
    for place in range(1, lines + 1, 1 + lines // _TRIED):
        left = place

        def blow() -> None:
            nonlocal left
            left -= 1
            if left == 0:
                raise Fault

        try:
            at_lines(lambda: call(world), blow)  # noqa: B023 (it is called at once)
        except Fault:
            now = _all(world)
            if now == before:
                continue
            assert now == after, place
        assert _all(world) == after
        world = _made(tmp_path)
