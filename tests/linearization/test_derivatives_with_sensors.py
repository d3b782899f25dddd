"""Derivatives of steps do not depend on the sensors that robots have, of whatever kind."""

import ast
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_array_equal
from tests.linearization.scenes import ASSETS, assert_exact, excite, new_world, set_velocity
from tests.linearization.test_sensors import add, add_all
from tests.rings import few

import carom
from carom import Body, PositionActuator, World, Worlds
from carom.description.sensor import SensorKind
from carom.layouts.codes import JointCode

KERNELS = Path(carom.__file__).parent / "kernels"
ROBOTS = {
    "cartpole": ("cartpole.urdf", True),
    "panda": ("franka_panda/panda.urdf", True),
    "laikago": ("laikago/laikago.urdf", False),
}
CONTROLS = ["torques", "actuators"]
SINGLE = (JointCode.REVOLUTE, JointCode.PRISMATIC)


def excited(name: str, *, plane: bool = False) -> tuple[World, Body]:
    """A world with a robot in motion, in the air or on a plane, with an actuator."""
    world = new_world(plane=plane)
    file, is_fixed = ROBOTS[name]
    body = world.load_urdf(f"{ASSETS}/{file}", (0.0, 0.0, 0.45 if plane else 2.0), fixed_base=is_fixed)
    excite(body, share=0.3)
    joint = next(it for it, code in enumerate(body.joint_types) if code in SINGLE)
    body.add_actuator("servo", PositionActuator(body.joints[joint].name, kp=10.0))
    if plane:
        set_velocity(body, 0.0, 0.0, 0.0, 0.3, 0.1, -0.2)
        world.step(3)
    return world, body


def attach_all(body: Body) -> None:
    """Attach sensors of every kind, and switch Bullet's sensors of all joints on."""
    add_all(body)
    joint = next(it for it, code in enumerate(body.joint_types) if code in SINGLE)
    name = body.joints[joint].name
    for kind in ("JointLimitForce", "JointActuatorForce"):
        add(body, kind, joint=name)
    for kind in ("ActuatorPosition", "ActuatorVelocity", "ActuatorForce"):
        add(body, kind, actuator="servo")
    for kind in ("Touch", "RangeFinder"):
        add(body, kind, site="tip")
    for link in range(body.joint_count):
        body.add_site(f"of {link}", link)
        for kind in ("Force", "Torque"):
            add(body, kind, f"{kind} at {link}", site=f"of {link}")
    for kind in ("Gyro", "JointVelocity"):
        made: dict[str, Any] = {"site": "tip"} if kind == "Gyro" else {"joint": name}
        add(body, kind, f"late {kind}", delay=0.01, noise=0.1, **made)
    tip = body.spec.links[-1].name
    add(body, "ContactSensor", link=tip)
    for kind in ("Distance", "DistanceNormal", "DistancePoints"):
        add(body, kind, link=tip, other_link=body.spec.base.name)
    for number in range(body.joint_count):
        body.set_sensor(number, enabled=True)


def test_every_kind_of_sensor_is_attached():
    world, body = excited("panda")
    attach_all(body)
    kinds = {spec.kind for spec in body.spec.sensors}
    missing = {kind.value for kind in SensorKind} - {kind.value for kind in kinds}
    # No joint of the robot is a ball, and it has no tendons.
    assert missing == {"ballquat", "ballangvel", "tendonpos", "tendonvel", "tendonactuatorfrc"}
    assert world.linearize(CONTROLS).A.any()


@pytest.mark.parametrize("plane", [False, True])
@pytest.mark.parametrize("name", few(ROBOTS, 2))
def test_derivatives_are_those_without_sensors(name: str, plane: bool):
    parameters: dict[str, Any] = {"parameters": ["masses", "joint_friction", "armature"]}
    world, body = excited(name, plane=plane)
    bare = world.linearize(CONTROLS, **parameters)
    cotangent = np.linspace(-1.0, 1.0, len(bare.states))
    pulled = world.step_vjp(cotangent, CONTROLS, **parameters)
    attach_all(body)
    for _ in range(2):
        found = world.linearize(CONTROLS, **parameters)
        many = Worlds(world, 2).linearize(CONTROLS, **parameters)
        for part in ("A", "B", "E"):
            assert_array_equal(getattr(found, part), getattr(bare, part), part)
            assert_array_equal(getattr(many, part)[1], getattr(bare, part), part)
        for own, wanted in zip(world.step_vjp(cotangent, CONTROLS, **parameters), pulled, strict=True):
            assert_array_equal(own, wanted)
    if not plane:
        assert_exact(world, controls=CONTROLS)


# What the linearisation of a step reads of the intermediate results of the step, and where in the kernels of
# steps it is written: nothing else may, as these are all there is of the step once it has been performed.
WRITERS: dict[str, set[str]] = {
    # Reading sensors writes what the last step of the tree has left.
    "dof.free_acceleration": {"dynamics/dynamics.py", "sensors/last_loads.py"},
    "dof.start_velocity": {"dynamics/quarantine.py"},
    "dof.angular": {"dynamics/kinematics.py", "joints/trees.py"},
    "dof.linear": {"dynamics/kinematics.py", "joints/trees.py"},
    "position_start": set(),  # by `copy_run` in dynamics/quarantine.py
    "actuator_start": {"dynamics/quarantine.py"},
}
# Results of the solver, which its own modules write.
OF_SOLVER = {"entry_delta_velocity"}


def scratch_fields(tree: ast.AST, context: type[ast.expr_context]) -> Iterator[str]:
    """Fields of `Scratch` that a module reads or writes: "dof.force", or "position_start"."""
    for node in ast.walk(tree):
        field, inner = "", node
        if isinstance(node, ast.Attribute) and isinstance(node.ctx, context):
            field, inner = f".{node.attr}", node.value
        if not isinstance(inner, ast.Subscript) or not isinstance(inner.value, ast.Attribute):
            continue
        if not field and not isinstance(inner.ctx, context):
            continue
        array = inner.value
        if isinstance(array.value, ast.Name) and array.value.id == "scratch":
            yield array.attr + field


def test_linearisation_reads_what_only_one_part_of_a_step_writes():
    texts = {str(path.relative_to(KERNELS)): path.read_text() for path in KERNELS.rglob("*.py")}
    modules = {name: ast.parse(text) for name, text in texts.items() if "scratch." in text}
    read: set[str] = set()
    written: dict[str, set[str]] = {}
    for name, tree in modules.items():
        if name.startswith("linearization/"):
            read |= set(scratch_fields(tree, ast.Load))
            assert not set(scratch_fields(tree, ast.Store)), name
        for field in scratch_fields(tree, ast.Store):
            written.setdefault(field, set()).add(name)
    used = {field for field in read if not any(other.startswith(f"{field}.") for other in read)}
    assert used == {*WRITERS, *OF_SOLVER}
    assert {field: written.get(field, set()) for field in WRITERS} == WRITERS
