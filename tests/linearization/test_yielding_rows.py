"""Linearised steps with limits, friction and constraints that yield, beside central differences."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from numpy.testing import assert_array_equal
from tests.linearization.scenes import ASSETS, assert_exact, excite, motors_off, new_world, statuses, tighten
from tests.physics.robots import random_tree

from carom import World, Worlds
from carom.description import JointType, Pose
from carom.layouts.codes import UserConstraintKind as Kind

PARAMETERS = ["masses", "inertias", "armature", "stiffness", "damping"]
REFERENCE = (0.05, 0.7, 0.4, 3.0)
ENDS = (0.0, 0.0, 0.0), Pose(), Pose()


def of_file(folder: Path, text: str) -> World:
    """The world of an MJCF file."""
    file = folder / "file.xml"
    file.write_text(f"<mujoco>{text}</mujoco>")
    world = World(contact="bullet")
    world.load(file).apply_options()
    tighten(world)
    return world


def impedance(inverse_mass: float, width: float = 0.6) -> tuple[float, float, float, float]:
    """An impedance whose curve rises up to an error."""
    return 0.3, 0.95, width, inverse_mass


def yielding(constraint: Any, inverse_mass: float, width: float = 0.6) -> None:
    """Let a user constraint yield for its own inverse mass, 0, or for another."""
    constraint.reference, constraint.impedance = REFERENCE, impedance(inverse_mass, width)


ARM = """
<option timestep="0.004"/><default><joint solreflimit=".06 .8" solimplimit=".4 .95 .3 .5 2"
 solreffriction=".05 1"/><geom contype="0" conaffinity="0"/></default><worldbody>
<body pos="0 0 1"><joint name="a" axis="0 1 .2" range="-30 10" limited="true"/>
<geom type="capsule" fromto="0 0 0 .3 0 -.1" size=".03"/>
<body pos=".3 0 -.1"><joint name="b" axis="1 1 0" range="-12 60" limited="true" {b}/>
<geom type="capsule" fromto="0 0 0 .1 .2 -.27" size=".03"/>
<body pos=".1 .2 -.27"><joint name="c" axis="0 0 1" frictionloss="{friction}"/>
<geom type="box" size=".1 .05 .03" pos=".1 0 0"/></body></body></body></worldbody>
"""


@pytest.mark.parametrize("own", [False, True])
@pytest.mark.parametrize("friction", [0.01, 5.0])
@pytest.mark.parametrize("b", ['margin="0"', 'margin=".2" solreflimit="-300 -20"'])
def test_limits_and_friction_of_joints_yield(tmp_path, own, friction, b):
    world = of_file(tmp_path, ARM.format(friction=friction, b=b))
    (body,) = world.bodies.values()
    if own:
        world.arrays.model.numpy["constraint_impedance"][:, :, 3] = 0.0
    body.joints["a"].reset(0.3, 1.2)
    body.joints["b"].reset(-0.3, -4.0)
    body.joints["c"].reset(0.4, 0.3)
    step = assert_exact(world, parameters=[*PARAMETERS, "joint_friction"])
    found = statuses(step)
    assert found[f"limit of {body.name}.a"] == found[f"limit of {body.name}.b"] == ["holds"]
    assert (found[f"friction of {body.name}.c"] == ["holds"]) is (friction > 1.0)


@pytest.mark.parametrize("friction", [0.01, 2.0, 50.0])
@pytest.mark.parametrize("velocity", [-1.5, 0.2])
def test_a_limit_and_friction_on_one_joint_are_told_apart(tmp_path, friction, velocity):
    world = of_file(tmp_path, ARM.format(friction=0.1, b=f'frictionloss="{friction}"'))
    (body,) = world.bodies.values()
    body.joints["b"].reset(-0.25, velocity)
    found = statuses(assert_exact(world, parameters=["masses", "joint_friction"]))
    assert (found[f"friction of {body.name}.b"] == ["holds"]) is (
        friction > 10.0 or velocity * friction == 0.4
    )
    assert found[f"limit of {body.name}.b"] == ["holds"]


def test_both_limits_may_push_at_once(tmp_path):
    world = of_file(tmp_path, ARM.format(friction=0.1, b='margin="1.2"'))
    (body,) = world.bodies.values()
    body.joints["b"].reset(0.4, 0.3)
    found = statuses(assert_exact(world, parameters=["masses"]))
    assert found[f"limit of {body.name}.b"] == ["holds", "holds"]


@pytest.mark.parametrize("own", [False, True])
@pytest.mark.parametrize("kind", [Kind.POINT_TO_POINT, Kind.FIXED, Kind.PRISMATIC])
def test_compliant_constraints_between_bodies_are_exact(kind, own):
    world = new_world()
    cube = world.load_urdf(f"{ASSETS}/cube.urdf", (0.9, 0.0, 0.8))
    arm = world.load_urdf(f"{ASSETS}/kuka_iiwa/model.urdf", fixed_base=True)
    excite(cube)
    excite(arm, share=0.3)
    motors_off(arm)
    tie = world.user_constraints.new(
        kind, arm, 6, cube, -1, (0.0, 0.6, 0.8), Pose((0.0, 0.0, 0.05)), Pose((0.1, 0.2, 0.2))
    )
    yielding(tie, 0.0 if own else 0.7, width=3.0)
    tie.inverse_inertia = 0.0 if own else 2.0
    tie.max_impulse = 1e9
    world.add_constraint(tie)
    step = assert_exact(world, parameters=PARAMETERS)
    rows = [status for name, status in step.rows if "constraint" in name]
    assert rows == ["holds"] * {Kind.POINT_TO_POINT: 3, Kind.FIXED: 6, Kind.PRISMATIC: 5}[kind]


@pytest.mark.parametrize("bound", [1e-4, 1e9])
def test_constraints_with_the_world_and_between_links_of_one_body_are_exact(bound):
    world = new_world()
    body = world.load(random_tree(3, 6, fixed_base=False, joint_types=[JointType.REVOLUTE]))
    excite(body, 3)
    motors_off(body)
    for kind, link, other in ((Kind.POINT_TO_POINT, 4, None), (Kind.POINT_TO_POINT, 2, body)):
        tie = world.user_constraints.new(
            kind,
            body,
            link,
            other,
            0 if other else -1,
            (0.0, 0.0, 1.0),
            Pose((0.1, 0.0, 0.0)),
            Pose((0.1, 0.2, 0.5)),
        )
        tie.max_impulse = bound
        world.add_constraint(tie)
    step = assert_exact(world, parameters=["masses"])
    held = {status for name, status in step.rows if name.startswith("point to point")}
    assert (held == {"holds"}) is (bound > 1.0)


@pytest.mark.parametrize("own", [False, True])
@pytest.mark.parametrize("follower", [3, -1])
def test_compliant_couplings_are_exact(follower, own):
    world = new_world()
    body = world.load(random_tree(2, 6, fixed_base=False, joint_types=[JointType.REVOLUTE]))
    excite(body, 2)
    motors_off(body)
    leader = (body, 3) if follower >= 0 else (None, -1)
    curve = world.user_constraints.new(Kind.COUPLING, body, 1, *leader, *ENDS)
    curve.polynomial, curve.erp, curve.max_impulse = (0.5, 0.8, -0.4, 0.3), 1.0, 1e9
    yielding(curve, 0.0 if own else 3.0, width=2.0)
    world.add_constraint(curve)
    step = assert_exact(world, parameters=PARAMETERS)
    assert any(name.startswith("coupling") and status == "holds" for name, status in step.rows)


def test_a_gear_between_two_bodies_is_exact():
    world = new_world()
    bodies = [
        world.load(random_tree(seed, 5, fixed_base=True, joint_types=[JointType.REVOLUTE])) for seed in (2, 5)
    ]
    for body in bodies:
        excite(body, 2)
        motors_off(body)
    gear = world.user_constraints.new(Kind.GEAR, bodies[0], 0, bodies[1], 2, *ENDS)
    gear.gear_ratio, gear.erp, gear.max_impulse = -0.7, 0.3, 1e9
    world.add_constraint(gear)
    step = assert_exact(world, parameters=["masses"])
    assert ("gear constraint 0", "holds") in step.rows


@pytest.mark.parametrize("loss", [0.4, 4000.0])
def test_friction_of_a_free_body_is_exact(tmp_path, loss):
    world = of_file(
        tmp_path,
        f'<worldbody><body pos="0 0 1"><joint type="free" frictionloss="{loss}"/>'
        '<geom type="box" size=".1 .15 .2"/><body pos="0 .2 0"><joint axis="1 0 0"/>'
        '<geom type="capsule" fromto="0 0 0 0 .3 .1" size=".03" contype="0" conaffinity="0"/></body></body>'
        "</worldbody>",
    )
    world.velocity[:] = np.linspace(-0.4, 0.5, len(world.velocity))
    found = statuses(assert_exact(world, parameters=["masses"]))
    (rows,) = (own for name, own in found.items() if name.startswith("friction of free body"))
    assert len(rows) == 6
    assert (rows == ["holds"] * 6) is (loss > 1.0)


@pytest.mark.parametrize("equality", ["connect", "weld", "joint"])
def test_equalities_of_files_are_exact(tmp_path, equality):
    bodies = (
        '<body name="one" pos="0 0 1"><joint name="a" axis="0 1 0"/><geom type="capsule" size=".03" '
        'fromto="0 0 0 .3 0 0"/></body><body name="other" pos="0 .4 1"><joint name="b" axis=".6 .8 0"/>'
        '<geom type="box" size=".1 .02 .03" pos=".1 0 0"/></body>'
    )
    equalities = {
        "connect": '<connect body1="one" body2="other" anchor=".2 .2 0"/>',
        "weld": '<weld body1="one" body2="other" torquescale="1"/>',
        "joint": '<joint joint1="a" joint2="b" polycoef="0 1.2 .3 0 0"/>',
    }
    world = of_file(
        tmp_path,
        f"<default><equality solref='.05 1' solimp='.3 .95 .5'/></default><worldbody>{bodies}</worldbody>"
        f"<equality>{equalities[equality]}</equality>",
    )
    world.position[-2:] = 0.2, -0.1
    world.velocity[-2:] = 0.3, 0.5
    step = assert_exact(world, parameters=["masses"])
    assert any("constraint" in name for name, _ in step.rows)


def test_worlds_with_constraints_are_linearised_as_lone_ones():
    world = new_world()
    human = world.load_urdf(f"{ASSETS}/humanoid/humanoid.urdf", (0.0, 0.0, 4.0))
    excite(human)
    motors_off(human)
    human.joints["chest"].set_orientation_target((0.1, 0.2, 0.3, 0.9), gain=0.4, damping=0.8, max_force=1e5)
    tie = world.user_constraints.new(
        Kind.FIXED, human, 4, None, -1, (0.0, 0.0, 1.0), Pose(), Pose((0.1, 0.2, 4.5))
    )
    yielding(tie, 0.0)
    tie.max_impulse = 1e9
    world.add_constraint(tie)
    worlds = Worlds(world, 3)
    velocity = worlds._engine.arrays.state.numpy["dof_velocity"]
    velocity += np.random.default_rng(5).uniform(-0.1, 0.1, velocity.shape) * (velocity != 0.0)
    found = worlds.linearize(parameters=["masses"])
    assert np.abs(found.A[1:] - found.A[0]).max() > 1e-3
    for number in range(worlds.count):
        lone = worlds.extract(number).linearize(parameters=["masses"])
        assert lone.rows == found.rows[number]
        for name in ("A", "B", "E"):
            assert_array_equal(getattr(found, name)[number], getattr(lone, name))


def test_what_has_no_derivatives_is_named():
    world = new_world()
    cube = world.load_urdf(f"{ASSETS}/cube.urdf", (0.0, 0.0, 1.5))
    half = float(np.sqrt(0.5))
    turned = Pose((0.0, 0.0, 1.5), (0.0, half, 0.0, half))
    world.constrain_links(Kind.FIXED, cube, -1, None, -1, child_frame=turned)
    with pytest.raises(NotImplementedError, match="user constraint 0 is a quarter turn off"):
        world.linearize(method="exact")
