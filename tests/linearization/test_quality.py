"""What tells whether the derivatives of a step can be trusted, and steps that converge."""

import logging

import numpy as np
import pytest
from tests.linearization.scenes import ASSETS, new_world, set_velocity, tighten

from carom import World


def stack() -> World:
    """Balls of very different masses above each other, which a few sweeps do not solve."""
    world = World(contact="bullet")
    world.gravity = (0.0, 0.0, -9.81)
    world.load_urdf(f"{ASSETS}/plane.urdf")
    for number, mass in enumerate((0.1, 1.0, 20.0)):
        world.add_sphere(0.1, (0.0, 0.0, 0.0999 + 0.1998 * number), mass=mass)
    world.parameters.solver_iterations = 5
    world.apply_parameters()
    return world


def test_sweeps_that_do_not_settle_are_said_once(caplog: pytest.LogCaptureFixture):
    world = stack()
    with caplog.at_level(logging.WARNING, "carom.linearization"):
        step = world.linearize()
        world.linearize()
    assert step.residual > 1e-3
    said = [it for it in caplog.messages if "did not settle" in it]
    assert len(said) == 1
    assert "linearize(tight=True)" in said[0]


def test_a_tight_step_is_the_one_that_is_linearised():
    world = stack()
    before = world.parameters.solver_iterations, world.position.copy()
    tight = world.linearize(tight=True)
    assert (world.parameters.solver_iterations, world.position.tolist()) == (before[0], before[1].tolist())
    assert tight.residual < 1e-9
    tighten(world)
    near = world.linearize(method="differences")
    assert np.abs(tight.A - near.A).max() < 1e-4 * np.abs(near.A).max()


def test_redundant_rows_are_named():
    world = new_world(plane=True)
    world.load_urdf(f"{ASSETS}/cube.urdf", (0.0, 0.0, 0.499))
    step = world.linearize()
    assert len(step.redundant) >= 4
    assert all("contact" in name for name in step.redundant)
    assert step.residual < 1e-9


def test_the_distance_to_a_switch_is_the_share_of_force_that_is_left(caplog: pytest.LogCaptureFixture):
    world = new_world()
    body = world.load_urdf(f"{ASSETS}/cartpole.urdf", (0.0, 0.0, 3.0), fixed_base=True)
    body.joints.free()
    motor = body.joints.movable[0]
    motor.set_velocity_target(0.1, max_force=100.0)
    step = world.linearize()
    taken = world.copy()
    taken.step()
    force = taken.bodies[body.id].joints.movable[0].motor_torque
    assert step.rows[0][1] == "holds"
    assert step.distances[0] == pytest.approx(1.0 - abs(force) / 100.0, abs=1e-6)
    with caplog.at_level(logging.WARNING, "carom.linearization"):
        motor.set_velocity_target(0.1, max_force=abs(force) * (1.0 + 1e-8))
        world.linearize()
    assert ["at a switch" in it for it in caplog.messages] == [True]


def test_a_contact_whose_gap_is_0_is_at_a_switch(caplog: pytest.LogCaptureFixture):
    world = new_world(plane=True)
    world.gravity = (0.0, 0.0, -9.81)
    world.add_sphere(0.5, (0.0, 0.0, 0.5), mass=1.0)
    with caplog.at_level(logging.WARNING, "carom.linearization"):
        step = world.linearize()
    assert step.distances[0] < 1e-6
    assert ["at a switch" in it for it in caplog.messages] == [True]


CART = """<mujoco><worldbody><body pos="0 0 1"><joint name="x" type="slide" axis="1 0 0"/>
<geom size=".1"/></body></worldbody><actuator><motor name="push" joint="x" gear="2" ctrlrange="{range}"/>
</actuator></mujoco>"""


@pytest.mark.parametrize(
    ("limits", "control", "at_end"), [("-1 1", 1.0, True), ("-1 1", 0.5, False), ("-1 1", 1.5, False)]
)
def test_a_control_at_an_end_of_its_range_is_at_a_switch(limits, control, at_end):
    world = World()
    scene = world.load(CART.format(range=limits))
    scene.actuators["push"].control = control
    step = world.linearize(["actuators"])
    near = world.linearize(["actuators"], method="differences")
    assert bool(step.at_switch) is at_end
    assert step.at_switch == tuple(name for name, _ in step.rows if at_end)
    # Of one side, where differences are the mean of both.
    assert np.allclose(step.B, (2.0 if at_end else 1.0) * near.B, atol=1e-9)
    assert step.B.any() is np.bool_(control <= 1.0)


BALL = """<mujoco><option timestep=".002"/><worldbody><geom type="plane" size="1 1 .1"/>
<body name="ball" pos="0 0 {height}"><freejoint/><geom size=".125"/></body></worldbody></mujoco>"""


@pytest.mark.parametrize(
    ("height", "speed", "near"),
    [("0.125", 0.0, True), ("0.125001", 0.0, False), ("0.125", 5.0, False), ("0.126", 0.0, False)],
)
def test_a_yielding_contact_that_does_not_push_yet_is_at_a_switch(height, speed, near, caplog):
    world = World(contact="compliant")
    scene = world.load(BALL.format(height=height))
    scene.apply_options()
    set_velocity(scene["ball"], 0.0, 0.0, 0.0, 0.0, 0.0, speed)
    with caplog.at_level(logging.WARNING, "carom.linearization"):
        step = world.linearize(method="exact")
    assert step.at_switch == (("contact 0 of sphere and plane",) if near else ())
    assert ["at a switch" in it for it in caplog.messages] == [True] * near
    # Differences to one side are those without the contact.
    assert not step.rows


def test_a_yielding_contact_that_begins_to_push_is_at_a_switch():
    world = World(contact="compliant")
    world.load(BALL.format(height="0.1249995")).apply_options()
    step = world.linearize(method="exact")
    assert step.distances[0] == pytest.approx(5e-7, abs=1e-9)
    assert step.at_switch == ("contact 0 of sphere and plane",)


PULLED = """<mujoco><worldbody><body pos="0 0 1"><joint name="x" axis="0 1 0" range="-1 1"/><geom size=".1"
pos=".2 0 0"/></body></worldbody><actuator><muscle name="biceps" joint="x" {smooth}/></actuator></mujoco>"""


@pytest.mark.parametrize("integrator", ["euler", "discrete", "rk4"])
@pytest.mark.parametrize(
    ("smooth", "activation", "near"),
    [("", 0.4, True), ("", 0.41, False), ('tausmooth=".1"', 0.4, False), ("", 0.4 + 1e-7, True)],
)
def test_a_muscle_whose_activation_is_its_control_is_at_a_switch(smooth, activation, near, integrator):
    world = World(contact="compliant")
    scene = world.load(PULLED.format(smooth=smooth))
    scene.apply_options()
    world.integrator = integrator
    scene.actuators["biceps"].control = 0.4
    step = world.linearize(["actuators"], method="exact", activations=[activation])
    name = next(it for it in step.states if it.endswith(".activation")).removesuffix(".activation")
    assert step.at_switch == ((f"muscle {name}",) if near else ())
