"""Linearised steps of MuJoCo's integrators, beside central differences."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.linearization.scenes import assert_exact, statuses, tighten

from carom import World, Worlds

INTEGRATORS = ["Euler", "explicit", "implicitfast", "implicit", "RK4"]
PARAMETERS = ["masses", "inertias", "damping", "stiffness", "armature"]
GAINS = ["actuator_gains", "actuator_biases"]

ROBOT = """
<body pos="0 0 1">{base}<geom type="box" size=".1 .2 .05" density="900"/>
  <body pos=".1 0 .1">
    <joint name="a" axis="0 1 .2" damping=".3" stiffness="2" armature=".1"/>
    <geom type="capsule" fromto="0 0 0 .3 0 .1" size=".05"/>
    <body pos=".3 0 .1">
      <joint name="s" type="ball" damping=".05" stiffness=".3" armature=".02"/>
      <geom type="capsule" fromto="0 0 0 .2 .1 .1" size=".05"/>
      <body pos=".2 .1 .1">
        <joint name="b" type="slide" axis="1 .1 0" damping=".2" armature=".05"/>
        <geom type="capsule" fromto="0 0 0 .0 .1 .2" size=".04"/>
      </body>
    </body>
  </body>
</body>
"""
ACTUATORS = """
<actuator>
  <position joint="a" kp="2" kv=".3"/><motor joint="b" gear="3"/>
  <general joint="b" dyntype="filter" dynprm=".05" gainprm="2" biastype="affine" biasprm="0 -1 -.03"/>
  <general joint="a" dyntype="filterexact" dynprm=".03" gainprm="2"/>
  <general joint="a" dyntype="integrator" actlimited="true" actrange="-1 1" actearly="true" gainprm="1"/>
  <damper joint="a" kv=".2" ctrlrange="0 3"/>
</actuator>
"""


def of_file(folder: Path, integrator: str, bodies: str, rest: str = "", option: str = "") -> World:
    """A world of a file with an integrator, and with contacts that yield."""
    file = folder / "file.xml"
    named = "Euler" if integrator == "explicit" else integrator
    damping = '<flag eulerdamp="disable"/>' if integrator == "explicit" else ""
    file.write_text(
        f'<mujoco><option timestep="0.005" integrator="{named}" gravity=".3 -.2 -9.81" {option}>'
        f"{damping}</option><worldbody>{bodies}</worldbody>{rest}</mujoco>"
    )
    world = World(contact="compliant")
    world.load(file).apply_options()
    tighten(world)
    return world


def stir(world: World, seed: int, share: float = 1.0) -> None:
    """Give a world random velocities and controls, and let it move a little."""
    rng = np.random.default_rng(seed)
    for body in world.bodies.values():
        first = body.first_velocity
        own = slice(first + (6 if body.fixed_base else 0), first + 6 + sum(body.velocity_count))
        world.velocity[own] = share * rng.uniform(-1.0, 1.0, own.stop - own.start)
        for actuator in body.actuators:
            actuator.control = rng.uniform(0.2, 0.8)
    world.step(3)


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("base", ["", "<freejoint/>"])
def test_a_robot_with_actuators_springs_and_damping(tmp_path, integrator, base):
    world = of_file(tmp_path, integrator, ROBOT.format(base=base), ACTUATORS)
    for seed in range(2):
        stir(world, seed)
        step = assert_exact(world, controls=["actuators", "torques"], parameters=[*PARAMETERS, *GAINS])
        assert step.method == "exact"


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_bodies_that_tumble(tmp_path, integrator):
    lone = '<body pos="{} 0 1"><freejoint/><geom type="box" size=".1 .2 .05" density="500"/></body>'
    world = of_file(tmp_path, integrator, lone.format(0) + lone.format(2))
    stir(world, 0, 8.0)
    assert_exact(world, controls=["torques"], parameters=["masses", "inertias"])


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("speed", [0.01, 3.0])
def test_a_ball_that_sticks_or_slides(tmp_path, integrator, speed):
    bodies = (
        '<geom type="plane" size="5 5 1"/><body pos=".01 .02 .0987"><freejoint/>'
        '<geom type="sphere" size=".1" density="900" friction=".5" solref=".05 .7"/></body>'
    )
    world = of_file(tmp_path, integrator, bodies)
    world.velocity[6:12] = 0.0, 0.1, 0.2, speed, 0.5 * speed, -0.02
    step = assert_exact(world, parameters=["masses"])
    sliding = statuses(step)["friction of contact 0 of sphere and plane"]
    assert sliding == (["slides"] * 2 if speed > 1.0 else ["holds"] * 2)


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_a_leg_pushes_on_the_ground_with_limits_and_friction(tmp_path, integrator):
    bodies = (
        '<geom type="plane" size="5 5 1"/><body pos="0 0 .62"><joint type="slide" axis="0 0 1" damping=".1"/>'
        '<geom type="box" size=".1 .1 .05"/><body><joint name="hip" axis="0 1 0" damping=".5" '
        'frictionloss=".2" range="-40 20" limited="true"/><geom type="capsule" fromto="0 0 0 .1 0 -.3" '
        'size=".04"/><body pos=".1 0 -.3"><joint name="knee" axis="0 1 0" damping=".5"/>'
        '<geom type="capsule" fromto="0 0 0 -.1 0 -.3" size=".04"/></body></body></body>'
    )
    servos = '<actuator><position joint="hip" kp="40" kv="1"/><motor joint="knee" gear="5"/></actuator>'
    world = of_file(tmp_path, integrator, bodies, servos)
    stir(world, 3)
    for _ in range(100):
        if any(name.startswith("contact") for name, _ in world.linearize().rows):
            break
        world.step()
    step = assert_exact(world, controls=["actuators"], parameters=["masses", "damping"])
    assert any(name.startswith("contact") for name, _ in step.rows)


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_tendons_over_joints(tmp_path, integrator):
    tendon = (
        '<tendon><fixed name="t" damping=".4" stiffness="3"><joint joint="a" coef="1"/>'
        '<joint joint="b" coef="-2"/></fixed></tendon>'
        '<actuator><position tendon="t" kp="3" kv=".6" gear="2"/></actuator>'
    )
    world = of_file(tmp_path, integrator, ROBOT.format(base=""), tendon)
    stir(world, 1)
    assert_exact(world, controls=["actuators"], parameters=["damping", *GAINS])


PATH = ('<site name="p" pos="0 0 1.5"/>' + ROBOT.format(base="").replace('name="b"', 'name="b" ', 1)).replace(
    "</body>\n    </body>", '<site name="q" pos=".1 .1 .1"/></body>\n    </body>', 1
)
OF_PATH = '<tendon><spatial name="t" stiffness="30" {}><site site="p"/><site site="q"/></spatial></tendon>'
OF_SITE = '<actuator><general site="q" gear="1 0 0 0 .2 0" gainprm="4"/></actuator>'


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_tendons_along_paths_and_forces_at_sites(tmp_path, integrator):
    world = of_file(tmp_path, integrator, PATH, OF_PATH.format("") + OF_SITE)
    stir(world, 2)
    assert_exact(world, controls=["actuators"])


@pytest.mark.parametrize("integrator", ["Euler", "RK4"])
def test_damping_along_a_path_that_is_explicit(tmp_path, integrator):
    world = of_file(tmp_path, integrator, PATH, OF_PATH.format('damping=".7"'))
    stir(world, 2)
    assert_exact(world)


def test_damping_along_a_path_that_is_implicit_has_differences(tmp_path):
    world = of_file(tmp_path, "implicitfast", PATH, OF_PATH.format('damping=".7"'))
    with pytest.raises(NotImplementedError, match="damping along a path"):
        world.linearize(method="exact")
    assert world.linearize().method == "differences"


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_muscles(tmp_path, integrator):
    muscle = '<actuator><muscle joint="a" range=".7 1.1" lengthrange="-1 1" force="5"/></actuator>'
    world = of_file(tmp_path, integrator, ROBOT.format(base=""), muscle)
    stir(world, 0)
    # It has followed the control, and at that rises or falls with other times.
    next(iter(world.bodies.values())).actuators[0].control = 0.3
    if integrator.startswith("implicit"):
        with pytest.raises(NotImplementedError, match="muscles"):
            world.linearize(["actuators"], method="exact")
        return
    assert_exact(world, controls=["actuators"])


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_several_steps_and_their_products_with_a_cotangent(tmp_path, integrator):
    world = of_file(tmp_path, integrator, ROBOT.format(base="<freejoint/>"), ACTUATORS)
    stir(world, 5)
    step = assert_exact(world, controls=["actuators"], parameters=["masses"], steps=3)
    given = np.random.default_rng(0).normal(size=len(step.states))
    pulled = world.step_vjp(given, ["actuators"], parameters=["masses"], steps=3)
    for found, matrix in zip(pulled, (step.A, step.B, step.E), strict=True):
        np.testing.assert_allclose(found, given @ matrix, rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_many_worlds_have_what_a_lone_one_has(tmp_path, integrator):
    world = of_file(tmp_path, integrator, ROBOT.format(base="<freejoint/>"), ACTUATORS)
    stir(world, 6)
    worlds = Worlds(world, 3, threads=2)
    worlds.step(2, where=[1, 2])
    together = worlds.linearize(["actuators"], parameters=["masses"])
    alone = world.linearize(["actuators"], parameters=["masses"])
    for name in ("A", "B", "E"):
        assert (getattr(together, name)[0] == getattr(alone, name)).all()
        assert (getattr(together, name)[1] != getattr(alone, name)).any()
