"""Derivatives of steps with rigid contacts and those that yield, beside central differences of the steps.

A rigid contact at rest sinks by less than the differences, and its law changes where the gap closes. So
bodies are pressed a little into each other first. Friction remembers the same in all steps compared.
"""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from tests.converged.rigid_worlds import rigid_world
from tests.converged.yielding_scenes import SCENES

import pybullet_data
from carom import Body, World, Worlds
from carom.controllers import LQR
from carom.linearization import linearized_step

_DATA = Path(pybullet_data.getDataPath())
_PRESSED = 1e-4


def _assert_exact(
    world: World,
    monkeypatch: pytest.MonkeyPatch,
    size: float = 1e-6,
    controls: tuple[str, ...] = ("torques",),
    parameters: tuple[str, ...] = (),
) -> linearized_step.LinearizedStep:
    """Compare with central differences of a size, relative to the greatest entry; returns exact ones."""
    exact = world.linearize(controls, parameters=parameters, method="exact")
    monkeypatch.setattr(linearized_step, "_SIZE", size)
    near = world.linearize(controls, parameters=parameters, method="differences")
    for name in ("A", "B", "E"):
        found, wanted = getattr(exact, name), getattr(near, name)
        assert found.shape == wanted.shape
        bound = 1e-6 * max(np.abs(wanted).max(initial=0.0), 1e-2)
        assert np.abs(found - wanted).max(initial=0.0) < bound, name
    return exact


def _status(step: linearized_step.LinearizedStep) -> set[str]:
    return {status for _, status in step.rows}


def _press(*bodies: Body) -> None:
    """Press bodies, from the lowest up, into what is below."""
    for number, body in enumerate(bodies, 1):
        body.world.position[body.first_position + 2] -= number * _PRESSED


def _box(slope: float = 0.0) -> tuple[World, Body]:
    world = rigid_world(slope, 0.4)
    world.add_plane()
    box = world.add_box((0.1, 0.12, 0.1), (0.0, 0.0, 0.1), mass=1.0, name="box")
    world.step(60)
    return world, box


def _ball() -> tuple[World, Body]:
    world = rigid_world()
    world.add_plane()
    ball = world.add_sphere(0.1, (0.0, 0.0, 0.1), mass=1.0, name="ball")
    world.step(20)
    ball.set_base_velocity((1.0, 0.4, 0.0), (0.0, 0.0, 0.3))
    return world, ball


def _resting_box() -> World:
    world, box = _box()
    _press(box)
    return world


def _sticking_box() -> World:
    world, box = _box(slope=0.2)
    _press(box)
    return world


def _sliding_box() -> World:
    world, box = _box()
    box.set_base_velocity((1.0, 0.4, 0.0), (0.0, 0.0, 0.3))
    world.step(5)
    _press(box)
    return world


def _sliding_ball() -> World:
    world, ball = _ball()
    world.step(5)
    _press(ball)
    return world


def _rolling_ball() -> World:
    world, ball = _ball()
    world.step(200)
    _press(ball)
    return world


def _braked_ball() -> World:
    world, ball = _ball()
    ball.shapes[0].rolling_friction, ball.shapes[0].spinning_friction = 0.01, 0.02
    world.step(3)
    _press(ball)
    return world


def _two_boxes() -> World:
    world = rigid_world()
    world.add_plane()
    low = world.add_box((0.2, 0.2, 0.1), (0.0, 0.0, 0.1), mass=3.0, name="low")
    high = world.add_box((0.1, 0.12, 0.1), (0.02, 0.0, 0.3), mass=1.0, name="high")
    world.step(60)
    high.set_base_velocity((0.4, 0.1, 0.0), (0.0, 0.0, 0.5))
    _press(low, high)
    return world


def _two_balls() -> World:
    world = rigid_world()
    world.add_plane()
    low = world.add_sphere(0.1, (0.0, 0.0, 0.1), mass=3.0, name="low")
    high = world.add_sphere(0.1, (0.01, 0.02, 0.299), mass=1.0, name="high")
    world.step(8)
    _press(low, high)
    return world


def _capsule() -> World:
    world = rigid_world()
    world.add_plane()
    lying = (0.0, np.sqrt(0.5), 0.0, np.sqrt(0.5))
    capsule = world.add_capsule(0.1, 0.4, (0.0, 0.0, 0.1), lying, mass=3.0, name="capsule")
    world.step(8)
    _press(capsule)
    capsule.set_base_velocity((0.3, 0.1, 0.0), (0.2, 0.1, 0.5))
    return world


def _on_a_spring() -> World:
    world, box = _box()
    box.change_dynamics(-1, contact_stiffness=5e3, contact_damping=30.0)
    world.step(10)
    box.set_base_velocity((0.5, 0.1, 0.0), (0.1, 0.0, 0.5))
    world.step(2)
    return world


@pytest.mark.parametrize(
    ("scene", "slides"),
    [
        (_resting_box, False),
        (_sticking_box, False),
        (_sliding_box, True),
        (_sliding_ball, True),
        (_rolling_ball, False),
        (_braked_ball, True),
        (_two_boxes, True),
        (_two_balls, False),
        (_capsule, True),
        (_on_a_spring, True),
    ],
)
def test_rigid_contacts(scene: Callable[[], World], slides: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    found = _assert_exact(scene(), monkeypatch)
    assert found.method == "exact" and found.rows
    assert ("slides" in _status(found)) == slides


def test_a_tumbling_body_keeps_its_energy_and_has_derivatives(monkeypatch: pytest.MonkeyPatch) -> None:
    world, box = _box()
    world.position[box.first_position + 2] += 1.0
    box.set_base_velocity((0.0, 0.0, 0.0), (2.0, 15.0, 1.0))
    found = _assert_exact(world, monkeypatch, size=1e-5)
    assert not found.rows


def _laikago() -> tuple[World, Body]:
    world = rigid_world()
    world.add_plane()
    robot = world.load(_DATA / "laikago" / "laikago_toes.urdf", (0.0, 0.0, 0.48), (0.0, 0.5, 0.5, 0.0))[0]
    return world, robot


def _walker() -> tuple[World, Body]:
    world, robot = _laikago()
    robot.joints.hold()
    world.step(240)
    return world, robot


def test_a_standing_robot_under_motors(monkeypatch: pytest.MonkeyPatch) -> None:
    world, robot = _walker()
    _press(robot)
    standing = _assert_exact(world, monkeypatch, controls=("target_positions",))
    assert _status(standing) == {"holds"}
    world.velocity[robot.first_velocity + 3] += 1.0
    robot.joints.hold(max_forces=6.0)
    world.step(3)
    pushed = _assert_exact(world, monkeypatch, controls=("target_positions",))
    assert "at its lower bound" in _status(pushed)
    robot.joints.servo(robot.joints.positions, kp=200.0, kd=4.0)
    world.step(30)
    _press(robot)
    _assert_exact(world, monkeypatch, controls=("target_positions",))


def test_a_regulator_holds_a_standing_robot_that_is_pushed() -> None:
    world, robot = _laikago()
    robot.joints.servo(robot.joints.positions, kp=150.0, kd=2.0)
    world.step(1200)
    standing, start = world.snapshot(), np.array(robot.pose.position)
    regulator = LQR(world, ("target_positions",), state_cost=1.0, control_cost=1e-4, discount=0.999)
    assert regulator.step.method == "exact"
    away: list[float] = []
    for regulated in (False, True):
        world.restore(standing)
        world.velocity[robot.first_velocity + 3] += 0.02
        total = 0.0
        for _ in range(240):
            if regulated:
                regulator.apply()
            world.step()
            total += float(np.linalg.norm(np.array(robot.pose.position) - start))
        away.append(total)
    # Servos alone leave it where friction has let it go.
    assert away[1] < 0.25 * away[0]


def test_a_robot_at_its_limits(monkeypatch: pytest.MonkeyPatch) -> None:
    world = rigid_world()
    panda = world.load(_DATA / "franka_panda" / "panda.urdf", fixed_base=True)[0]
    panda.joints.free()
    world.step(300)
    found = _assert_exact(world, monkeypatch)
    assert any(name.startswith("limit") for name, _ in found.rows)


@pytest.mark.parametrize("name", sorted(SCENES))
def test_contacts_of_files_that_yield(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "scene.xml"
    path.write_text(SCENES[name])
    world = World(contact="compliant")
    bodies = world.load(path)
    bodies.apply_options()
    moving = np.concatenate([np.arange(6) + it.first_velocity for it in bodies if not it.fixed_base] or [[]])
    rng = np.random.default_rng(1)
    if len(moving):
        world.velocity[moving.astype(int)] = 0.5 * rng.uniform(-1.0, 1.0, len(moving))
    else:
        limb = bodies[-1]
        for joint in limb.joints.movable:
            world.velocity[limb.velocity_index[joint.index]] = 0.5 * rng.uniform(-1.0, 1.0)
    for _ in range(60):
        world.step()
        if world.linearize().rows:
            break
    found = _assert_exact(world, monkeypatch, size=1e-6)
    assert any(name.startswith("contact") for name, _ in found.rows)


def test_products_with_cotangents_and_many_worlds_are_the_same() -> None:
    world = _two_boxes()
    exact = world.linearize(controls=("torques",))
    cotangent = np.random.default_rng(0).normal(size=len(exact.A))
    pulled = world.step_vjp(cotangent, controls=("torques",))
    assert np.allclose(pulled[0], cotangent @ exact.A, rtol=1e-9, atol=1e-9)
    many = Worlds(world, 2).linearize(controls=("torques",))
    assert np.allclose(many.A, exact.A, rtol=1e-9, atol=1e-9)


def test_surfaces_that_have_changed_count_in_the_next_call(monkeypatch: pytest.MonkeyPatch) -> None:
    world = _sliding_box()
    before = world.linearize(method="exact").A
    world["box"].shapes[0].friction = 0.9
    found = _assert_exact(world, monkeypatch)
    assert np.abs(found.A - before).max() > 1e-3


def test_sliding_depends_on_friction(monkeypatch: pytest.MonkeyPatch) -> None:
    found = _assert_exact(_sliding_box(), monkeypatch, size=1e-5, parameters=("friction",))
    assert np.abs(found.E).max() > 1e-3


@pytest.mark.parametrize("scene", [_sticking_box, _sliding_box, _braked_ball, _two_boxes, _on_a_spring])
def test_parameters_of_inertia(scene: Callable[[], World], monkeypatch: pytest.MonkeyPatch) -> None:
    found = _assert_exact(scene(), monkeypatch, size=1e-5, parameters=("masses",))
    assert np.abs(found.E).max() > 1e-6


def test_masses_and_armature_of_a_standing_robot(monkeypatch: pytest.MonkeyPatch) -> None:
    world, robot = _walker()
    _press(robot)
    _assert_exact(world, monkeypatch, parameters=("masses", "inertias", "armature"))


def test_what_is_not_exact_is_named_and_taken_by_differences(tmp_path: Path) -> None:
    world = _resting_box()
    with pytest.raises(NotImplementedError, match=r"inertias of bodies of one link.*method=\"differences\""):
        world.linearize(method="exact", parameters=("inertias",))
    assert world.linearize(parameters=("inertias",)).method == "differences"
    path = tmp_path / "scene.xml"
    path.write_text(SCENES["box, elliptic, condim 3, impratio 1.0"])
    world = World(contact="compliant")
    world.load(path).apply_options()
    world.step(10)
    with pytest.raises(NotImplementedError, match=r"friction of contacts that yield.*method=\"differences\""):
        world.linearize(method="exact", parameters=("friction",))
    world, box = _box()
    box.shapes[0].restitution = 1.0
    world[0].shapes[0].restitution = 1.0
    box.set_base_velocity((0.0, 0.0, -1.0), (0.0, 0.0, 0.0))
    with pytest.raises(NotImplementedError, match="a bounce has no exact derivatives"):
        world.linearize(method="exact")
