"""The scripts of `pybullet_robots`, which run until their window is closed, here after the first step."""

from __future__ import annotations

import runpy
import sys
from collections.abc import Iterator
from types import SimpleNamespace
from typing import Any

import pytest

import pybullet as p
import pybullet_data
from pybullet._clients.clients import clients
from pybullet_robots import _sliders
from pybullet_robots._loading import put_in_pose
from pybullet_robots.laikago import laikago
from pybullet_robots.panda import _show
from pybullet_robots.panda.panda_sim_grasp import PandaSimAuto
from pybullet_robots.xarm import loadxarm_sim, xarm
from pybullet_robots.xarm.xarm_sim import XArm6Sim
from pybullet_utils.bullet_client import BulletClient

Poses = list[tuple[tuple[float, ...], tuple[float, ...]]]


def window_sliders(client: int) -> list[Any]:
    """The sliders in the window of a client."""
    window: Any = clients[client].window
    return [*window.sliders.values()]


def poses(client: int) -> Poses:
    """Where the bodies of a world are, in the order in which they were loaded."""
    return [p.getBasePositionAndOrientation(body, client) for body in range(p.getNumBodies(client))]


class Window:
    """The window of a script, without a page; it is closed in the first step.

    Attributes:
        modes: How the script has connected.
        before: Where everything was before the step.
        pauses: How long the script waited [s].
        sliders: Least and greatest value of each of its sliders.
        settings: The engine's parameters then.
    """

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.modes: list[int] = []
        self.pauses: list[float] = []
        self.before: Poses = []
        self.sliders: list[tuple[float, float]] = []
        self.settings: Any = None
        self._connect = p.connect
        monkeypatch.setattr(p, "connect", self._open)
        monkeypatch.setattr(p, "stepSimulation", self._close)
        monkeypatch.setenv("CI", "true")
        for script in (_sliders, loadxarm_sim):
            monkeypatch.setattr(script, "time", SimpleNamespace(sleep=self.pauses.append))

    def _open(self, mode: int, **options: Any) -> int:
        self.modes.append(mode)
        return self._connect(mode, options="--port=0" if mode == p.GUI else options.get("options", ""))

    def _close(self) -> None:
        self.before = poses(0)
        window: Any = clients[0]
        self.settings = window.world.parameters
        self.sliders = [(each.lower, each.upper) for each in window_sliders(0)]
        p.disconnect(0)


@pytest.fixture
def window(monkeypatch: pytest.MonkeyPatch) -> Window:
    return Window(monkeypatch)


@pytest.fixture
def client() -> Iterator[BulletClient]:
    """A world to compare with, made after that of the script has gone."""
    client = BulletClient(p.DIRECT)
    client.setAdditionalSearchPath(pybullet_data.getDataPath())
    yield client
    client.disconnect()


def test_the_laikago_lies_on_its_side(window: Window) -> None:
    laikago.main()
    assert window.modes == [p.GUI]
    assert window.pauses == [pytest.approx(1.0 / 500.0)]
    assert not window.settings.cone_friction
    _floor, (place, turn) = window.before
    other = p.connect(p.DIRECT)
    path = f"{pybullet_data.getDataPath()}/laikago/laikago_toes.urdf"
    robot = p.loadURDF(path, [0, 0, 0.5], [0, 0.5**0.5, 0.5**0.5, 0], physicsClientId=other)
    expected = p.getBasePositionAndOrientation(robot, other)
    p.disconnect(other)
    assert place == pytest.approx(expected[0])
    assert turn == pytest.approx(expected[1])


def test_the_xarm_stands_on_a_table(window: Window) -> None:
    xarm.main()
    assert window.modes == [p.GUI]
    (table, _), _arm = window.before
    # Its six joints go round once, nearly.
    assert window.sliders == [(-4, 4)] * 6
    other = p.connect(p.DIRECT)
    path = f"{pybullet_data.getDataPath()}/table/table.urdf"
    flat = p.loadURDF(path, useFixedBase=True, physicsClientId=other)
    expected, _ = p.getBasePositionAndOrientation(flat, other)
    p.disconnect(other)
    # The top of the table is 0.625 m above its feet, and the arm at the origin.
    assert table == pytest.approx((expected[0], expected[1], expected[2] - 0.625))


@pytest.mark.parametrize(("script", "time_step"), [("loadpanda", 1 / 60), ("loadpanda_grasp", 1 / 240)])
def test_the_panda_is_shown_in_real_time(
    window: Window, monkeypatch: pytest.MonkeyPatch, script: str, time_step: float
) -> None:
    monkeypatch.setattr(_show, "time", SimpleNamespace(sleep=window.pauses.append))
    # Another test may have imported it, of which `runpy` warns.
    monkeypatch.delitem(sys.modules, f"pybullet_robots.panda.{script}", raising=False)
    runpy.run_module(f"pybullet_robots.panda.{script}", run_name="__main__")
    assert window.modes == [p.GUI]
    assert window.pauses == [pytest.approx(time_step)]
    assert window.settings.time_step == pytest.approx(time_step)


def test_the_simulation_of_the_xarm_is_at_the_origin_and_in_real_time(window: Window) -> None:
    loadxarm_sim.main()
    assert window.pauses == [1.0 / 60.0] == [window.settings.time_step]
    other = BulletClient(p.DIRECT)
    other.setAdditionalSearchPath(pybullet_data.getDataPath())
    XArm6Sim(other, [0.0, 0.0, 0.0])
    expected = poses(other._client)
    p.disconnect(other._client)
    assert window.before == expected


def test_an_arm_in_its_pose_is_not_damped(client: BulletClient) -> None:
    robot = client.loadURDF("cartpole.urdf", useFixedBase=True)
    put_in_pose(client, robot, [0.5, 0.25])
    assert [client.getJointState(robot, joint)[0] for joint in (0, 1)] == [0.5, 0.25]
    for joint in (0, 1):
        client.setJointMotorControl2(robot, joint, client.VELOCITY_CONTROL, force=0)
        client.changeDynamics(robot, joint, jointDamping=0)
    client.resetJointState(robot, 0, 0.5, 1.0)
    client.resetJointState(robot, 1, 0.0, 0.0)

    def momentum() -> float:
        masses = [client.getDynamicsInfo(robot, joint)[0] for joint in (0, 1)]
        states = client.getLinkStates(robot, (0, 1), computeLinkVelocity=1)
        return sum(mass * state[6][0] for mass, state in zip(masses, states, strict=True))

    before = momentum()
    for _ in range(100):
        client.stepSimulation()
    assert momentum() == pytest.approx(before, rel=1e-3)


def test_whatever_the_panda_times_it_ends(client: BulletClient, monkeypatch: pytest.MonkeyPatch) -> None:
    panda = PandaSimAuto(client, [0.0, 0.0, 0.0])
    open_ones: list[str] = []

    def submit(name: str | None = None) -> None:
        if name is None:
            open_ones.pop()
        else:
            open_ones.append(name)

    monkeypatch.setattr(client, "submitProfileTiming", submit, raising=False)
    panda.step()
    assert open_ones == []
