"""Inverse dynamics with contacts: MuJoCo's own answers, and forces with which steps have a motion."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from tests.converged.record_inverse import ANSWERS
from tests.converged.test_yielding import turn_of
from tests.converged.yielding_scenes import SCENES
from tests.integrators.scenes import file_of

from carom import PositionActuator, World

_RECORDED = json.loads(ANSWERS.read_text()) if ANSWERS.exists() else {}
ARM = """<mujoco><option timestep="0.004" gravity="0 0 -9.81"/>
<default><geom friction="0.3"/></default><worldbody>
<geom type="plane" size="5 5 .1" friction="0.3"/>
<body name="arm" pos="0 0 0.32">
<joint name="shoulder" axis="0 1 0" damping="0.3" stiffness="2" frictionloss="0.4"/>
<geom type="capsule" fromto="0 0 0 0.4 0 -0.1" size="0.03" mass="1"/>
<body pos="0.4 0 -0.1"><joint name="elbow" axis="0 1 0" range="-10 40" limited="true" armature="0.02"/>
<geom type="capsule" fromto="0 0 0 0.2 0 -0.19" size="0.03" mass="0.5"/></body></body>
<body name="ball" pos="0.62 0.02 0.0995"><freejoint/><geom type="sphere" size="0.1" mass="0.7"/></body>
</worldbody></mujoco>"""


def made(text: str, tmp_path: Path, law: str) -> World:
    path = tmp_path / "scene.xml"
    path.write_text(text)
    world = World(contact=law)
    world.load(path).apply_options()
    # As the recorded answers are.
    world.integrator = "discrete"
    return world


def put(world: World, positions: np.ndarray, velocities: np.ndarray) -> list[tuple[slice, np.ndarray | None]]:
    """Set a state in MuJoCo's coordinates; returns rows of velocities, and orientations of free bodies."""
    free = [body for body in world if body.name in ("a", "b", "c") and not body.joints.movable]
    if not free:
        body = next(body for body in world if body.joints.movable)
        body.joints.positions, body.joints.velocities = positions, velocities
        first = body.first_velocity + 6
        return [(slice(first, first + len(velocities)), None)]
    found: list[tuple[slice, np.ndarray | None]] = []
    for number, body in enumerate(free):
        place, rate = positions[7 * number :][:7], velocities[6 * number :][:6]
        turn = turn_of(place[3:])
        body.pose = (place[:3], place[[4, 5, 6, 3]])
        body.set_base_velocity(rate[:3].tolist(), (turn @ rate[3:]).tolist())
        found.append((slice(body.first_velocity, body.first_velocity + 6), turn))
    return found


@pytest.mark.parametrize("name", SCENES)
def test_forces_are_those_of_mujoco(name: str, tmp_path: Path) -> None:
    assert _RECORDED[name], "record_inverse makes the file"
    world = made(SCENES[name], tmp_path, "compliant")
    for step in _RECORDED[name]:
        positions, velocities, accelerations, *expected = map(np.array, step)
        rows = put(world, positions, velocities)
        asked = np.zeros(len(world.velocity))
        for number, (own, turn) in enumerate(rows):
            given = accelerations if turn is None else accelerations[6 * number :][:6]
            asked[own] = given if turn is None else np.concatenate([turn @ given[3:], given[:3]])
        before = world.position.copy(), world.velocity.copy()
        answer = world.inverse_dynamics(asked)
        assert (world.position == before[0]).all()
        assert (world.velocity == before[1]).all()
        for found, wanted in zip(answer, expected, strict=True):
            parts = []
            for own, turn in rows:
                force = found[own]
                parts.append(force if turn is None else np.concatenate([force[3:], turn.T @ force[:3]]))
            size = max(np.abs(wanted).max(), 1.0)
            assert np.concatenate(parts) / size == pytest.approx(wanted / size, abs=2e-6)


@pytest.mark.parametrize(("law", "friction"), [("compliant", 0.3), ("rigid", 0.3), ("rigid", 1.0)])
def test_torques_of_a_step_come_back(law: str, friction: float, tmp_path: Path) -> None:
    """With a friction of 1 the arm jams: bounds of friction then have to be found another way."""
    world = made(ARM.replace('friction="0.3"', f'friction="{friction}"'), tmp_path, law)
    arm = next(body for body in world if body.joints.movable)
    ball = next(body for body in world if body.name == "ball")
    random, touched = np.random.default_rng(0), 0
    for _ in range(60):
        torques = random.uniform(-4.0, 4.0, 2)
        push = random.uniform(-3.0, 3.0, 3)
        arm.joints.set_torques(torques)
        ball.links[-1].apply_force(push, ball.links[-1].pose.position)
        before = world.copy()
        world.step()
        touched += len(world.contacts()) > 0
        # Forces on links act in the copy, too; torques that are set do not.
        answer = before.inverse_dynamics((world.velocity - before.velocity) / 0.004)
        own = slice(arm.first_velocity + 6, arm.first_velocity + 8)
        assert answer.forces[own] == pytest.approx(torques, abs=2e-5)
        assert answer.forces[ball.first_velocity :][:6] == pytest.approx(np.zeros(6), abs=2e-5)
    assert touched > 20


def test_what_actuators_and_motors_do_does_not_count(tmp_path: Path) -> None:
    world = made(ARM, tmp_path, "compliant")
    arm = next(body for body in world if body.joints.movable)
    asked = np.linspace(-1.0, 1.0, len(world.velocity))
    plain = world.inverse_dynamics(asked)
    arm.add_actuator("servo", PositionActuator("elbow", kp=50.0))
    arm.actuators["servo"].control = 0.3
    arm.joints["shoulder"].set_velocity_target(2.0, max_force=40.0)
    for found, wanted in zip(world.inverse_dynamics(asked), plain, strict=True):
        assert found == pytest.approx(wanted, abs=1e-9)


def test_states_may_be_given(tmp_path: Path) -> None:
    world = made(ARM, tmp_path, "compliant")
    later = world.copy()
    later.step(30)
    asked = np.linspace(-1.0, 1.0, len(world.velocity))
    given = world.inverse_dynamics(asked, positions=later.position, velocities=later.velocity)
    assert given.forces == pytest.approx(later.inverse_dynamics(asked).forces, abs=1e-6)
    assert np.abs(given.forces - world.inverse_dynamics(asked).forces).max() > 0.1


def test_what_has_no_answer_is_refused(tmp_path: Path) -> None:
    world = made(ARM, tmp_path, "bullet")
    with pytest.raises(ValueError, match=r"world\.contact = 'compliant'"):
        world.inverse_dynamics(0.0 * world.velocity)
    world.contact = "rigid"
    with pytest.raises(ValueError, match="accelerations must have shape"):
        world.inverse_dynamics([1.0])
    with pytest.raises(ValueError, match="accelerations must be finite"):
        world.inverse_dynamics(np.nan * world.velocity)
    assert World(contact="rigid").inverse_dynamics([]).forces.shape == (0,)


def test_bodies_that_rebound_are_refused() -> None:
    world = World(contact="rigid")
    world.gravity = (0.0, 0.0, -9.81)
    world.load_urdf("plane.urdf").change_dynamics(-1, restitution=1.0)
    ball = world.add_sphere(0.1, mass=1.0, position=(0.0, 0.0, 0.1))
    ball.change_dynamics(-1, restitution=1.0)
    ball.set_base_velocity((0.0, 0.0, -2.0), (0.0, 0.0, 0.0))
    with pytest.raises(ValueError, match="bodies rebound"):
        world.inverse_dynamics(0.0 * world.velocity)


@pytest.mark.parametrize("integrator", ["euler", "explicit", "implicitfast", "rk4"])
def test_forces_at_an_instant_give_the_motion_again(integrator: str, tmp_path: Path) -> None:
    name = "limb, elliptic, condim 3, impratio 1.0"
    world = made(SCENES[name], tmp_path, "compliant")
    world.integrator = integrator
    put(world, *map(np.array, _RECORDED[name][0][:2]))
    body = next(body for body in world if body.joints.movable)
    rng = np.random.default_rng(3)
    wanted = np.zeros(len(world.velocity))
    own = slice(body.first_velocity + 6, body.first_velocity + 11)
    wanted[own] = rng.normal(size=5)
    forces = world.inverse_dynamics(wanted)
    # Without damping Euler's step is v + h a.
    world.integrator = "explicit"
    before = world.velocity.copy()
    world.joint_torque[own] = forces.forces[own]
    world.step()
    found = (world.velocity - before)[own] / world.time_step
    np.testing.assert_allclose(found, wanted[own], rtol=0.0, atol=1e-6)
    assert np.abs(forces.constraint_forces).max() > 1e-3


@pytest.mark.parametrize("integrator", ["explicit", "discrete"])
def test_a_base_that_moves_by_its_frame(integrator: str, tmp_path: Path) -> None:
    world = made(file_of("falling off its frame", "Euler"), tmp_path, "compliant")
    world.integrator = integrator
    body = next(body for body in world if body.joints.movable)
    body.set_base_velocity((0.4, -0.3, 0.2), (3.0, 2.0, -4.0))
    random, touched = np.random.default_rng(1), 0.0
    own = slice(body.first_velocity, body.first_velocity + 8)
    for _ in range(200):
        torques = random.uniform(-0.5, 0.5, 2)
        body.joints.set_torques(torques)
        before = world.copy()
        world.step()
        answer = before.inverse_dynamics((world.velocity - before.velocity) / world.time_step)
        assert answer.forces[own] == pytest.approx([0.0] * 6 + torques.tolist(), abs=2e-5)
        touched = max(touched, np.abs(answer.constraint_forces[own]).max())
    assert touched > 0.5
