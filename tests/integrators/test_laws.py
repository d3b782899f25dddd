"""What the integrators keep, and which worlds they refuse."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from tests.integrators.scenes import INTEGRATORS, SCENES
from tests.integrators.test_beside_mujoco import loaded

from carom import World, Worlds
from carom.description.transform import rotation_matrix

_ALL = ("discrete", "midpoint", "euler", "explicit", "implicitfast", "implicit", "rk4")


def _inertia(world: World) -> np.ndarray:
    """Moments of inertia of the only body, in the axes of the world."""
    turn = _axes(world)
    return turn @ np.diag(next(iter(world)).links[-1].inertia) @ turn.T


def _axes(world: World) -> np.ndarray:
    return _turn(world.position[3:7])


@pytest.mark.parametrize(
    ("contact", "integrator"), [("rigid", None), ("compliant", None), ("bullet", "midpoint")]
)
def test_a_body_about_its_middle_axis_keeps_energy_and_momentum(contact: str, integrator: str | None) -> None:
    world = World(1 / 240, contact=contact, integrator=integrator)
    box = world.add_box((0.1, 0.2, 0.4), mass=1.0)
    box.set_base_velocity([0.0, 0.0, 0.0], [0.01, 6.0, 0.01])
    start, momentum = [], []
    flipped = False
    for _ in range(20 * 240):
        inertia, omega = _inertia(world), world.velocity[:3].copy()
        start.append(0.5 * omega @ inertia @ omega)
        momentum.append(inertia @ omega)
        flipped = flipped or _axes(world)[1, 1] < -0.9
        world.step()
    assert flipped
    assert np.ptp(start) < 1e-3 * start[0]
    assert np.ptp(momentum, axis=0).max() < 1e-9


@pytest.mark.parametrize("contact", ["compliant", "bullet"])
def test_energy_of_three_pendulums_is_kept_by_runge_kutta(contact: str, tmp_path: Path) -> None:
    lost = {}
    for integrator in ("Euler", "RK4"):
        world = loaded(f"three pendulums, {integrator}", tmp_path, contact)
        first = _energy(world)
        world.step(5000)
        lost[integrator] = abs(_energy(world) - first) / abs(first)
    assert lost["RK4"] < 1e-4 < 1e-3 < lost["Euler"]


@pytest.mark.parametrize("contact", ["compliant", "bullet"])
def test_a_free_chain_with_inner_torques_keeps_its_momentum(contact: str, tmp_path: Path) -> None:
    world = loaded("free chain, RK4", tmp_path, contact)
    world.gravity = (0.0, 0.0, 0.0)
    first = _momentum(world)
    lost, flowing = 0.0, 0.0
    for _ in range(2000):
        world.step()
        lost = max(lost, np.abs(_momentum(world) - first).max())
        flowing = max(flowing, np.abs(_momenta(world)).max())
    assert lost < 1e-4 * flowing


def _momenta(world: World) -> list[np.ndarray]:
    links = [link for body in world for link in body.links if link.mass > 0.0]
    return [link.mass * np.array(link.velocity.linear) for link in links]


def _momentum(world: World) -> np.ndarray:
    return np.sum(_momenta(world), axis=0)


def _energy(world: World) -> float:
    links = [link for body in world for link in body.links if link.mass > 0.0]
    total = 0.0
    for link in links:
        turn = _turn(link.inertial_pose.orientation)
        inertia = turn @ np.diag(link.inertia) @ turn.T
        omega, velocity = np.array(link.velocity.angular), np.array(link.velocity.linear)
        total += 0.5 * link.mass * velocity @ velocity + 0.5 * omega @ inertia @ omega
        total += 9.81 * link.mass * link.inertial_pose.position[2]
    return total


def _turn(quaternion: np.ndarray) -> np.ndarray:
    x, y, z, w = quaternion.tolist()
    return np.array(rotation_matrix((x, y, z, w)))


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_many_worlds_move_as_one(integrator: str, tmp_path: Path) -> None:
    world = loaded(f"servos, {integrator}", tmp_path, "compliant")
    worlds = Worlds(world, 3)
    assert np.ptp(worlds.bodies[[*world][-1].name].actuators.controls, axis=0).max() == 0.0
    worlds.step(50)
    world.step(50)
    found = worlds.bodies[[*world][-1].name].joints.positions
    assert np.abs(found - [*world][-1].joints.positions).max() == 0.0


@pytest.mark.parametrize("integrator", _ALL)
def test_copies_and_files_keep_the_integrator(integrator: str, tmp_path: Path) -> None:
    world = World(integrator=integrator)
    world.add_box((1.0, 2.0, 3.0), mass=1.0)
    world.save(tmp_path / "world.carom")
    other = World()
    other.load(tmp_path / "world.carom")
    assert [it.integrator for it in (world.copy(), other)] == [integrator] * 2
    world.clear()
    assert world.integrator == integrator


def test_unknown_integrators_are_refused() -> None:
    with pytest.raises(ValueError, match="'rk4', not 'RK5'"):
        World(integrator="RK5")
    world = World()
    with pytest.raises(ValueError, match="'rk4', not 'verlet'"):
        world.integrator = "verlet"
    assert world.integrator == "midpoint"


@pytest.mark.parametrize("integrator", _ALL[2:])
def test_rigid_contacts_are_refused(integrator: str) -> None:
    with pytest.raises(ValueError, match="contact='rigid'"):
        World(contact="rigid", integrator=integrator)
    world = World(integrator=integrator)
    with pytest.raises(ValueError, match="contact='rigid'"):
        world.contact = "rigid"
    assert world.contact == "compliant"


def test_shapes_that_do_not_yield_are_refused_with_runge_kutta() -> None:
    world = World()
    world.add_box((1.0, 1.0, 1.0), mass=1.0)
    world.add_box((1.0, 1.0, 1.0), mass=1.0)
    with pytest.raises(NotImplementedError, match="do not yield"):
        world.integrator = "rk4"
    assert world.integrator == "midpoint"
    world.step()


def test_a_file_whose_integrator_cannot_be_had_is_loaded_with_a_warning(
    tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    file = tmp_path / "scene.xml"
    file.write_text(f'<mujoco><option integrator="implicit" density="1.2"/>{SCENES["pendulum"]}</mujoco>')
    world = World()
    world.load(file)
    assert world.integrator == "discrete"
    assert "forces of a fluid" in caplog.text
    file.write_text(f'<mujoco><option integrator="RK4"/>{SCENES["pendulum"]}</mujoco>')
    rigid = World(contact="rigid")
    rigid.load(file)
    assert rigid.integrator == "midpoint"
    assert "integrator 'rk4'" in caplog.text
