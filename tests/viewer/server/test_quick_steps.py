"""With a window, the library handles calls as without one, except while the window holds steps up."""

from threading import Thread

import pytest
from tests.patience import PATIENCE

import pybullet as p
import pybullet_data
from carom.scene.core.stepping import Stepping
from carom.viewer.viewer import Viewer
from pybullet._access.body_access import BodyAccess

STEPS = 50


@pytest.fixture
def by_python(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """What was called in Python, and not handled by the native library alone."""
    calls: list[str] = []
    step, state = Stepping.step, BodyAccess.joint_state

    def counted_step(world: Stepping, count: int = 1) -> None:
        calls.append("step")
        step(world, count)

    def counted_state(access: BodyAccess, joint: int) -> object:
        calls.append("state")
        return state(access, joint)

    monkeypatch.setattr(Stepping, "step", counted_step)
    monkeypatch.setattr(BodyAccess, "joint_state", counted_state)
    return calls


def panda() -> int:
    p.setAdditionalSearchPath(pybullet_data.getDataPath())
    return p.loadURDF("franka_panda/panda.urdf", useFixedBase=True)


def walk(body: int) -> None:
    for _ in range(STEPS):
        p.stepSimulation()
        p.getJointState(body, 3)


def test_only_the_first_step_with_a_window_is_made_by_python(viewer: Viewer, by_python: list[str]):
    body = panda()
    # The first step waits for the viewer, which keeps the state before it, and the first state is prepared.
    walk(body)
    assert sorted(by_python) == ["state", "step"]
    by_python.clear()
    walk(body)
    assert by_python == []
    assert viewer.time == pytest.approx(2 * STEPS / 240)


def test_python_makes_the_steps_of_a_window_that_slows_them_down(viewer: Viewer, by_python: list[str]):
    body = panda()
    walk(body)
    by_python.clear()
    viewer.set_speed(1000.0)
    walk(body)
    assert by_python == ["step", "state"] * STEPS
    by_python.clear()
    viewer.set_speed(None)
    walk(body)
    assert by_python == []


def test_a_pause_holds_a_script_that_makes_quick_steps(viewer: Viewer):
    body = panda()
    walk(body)
    viewer.pause(True)
    before = viewer.time
    script = Thread(target=walk, args=[body])
    script.start()
    # While it is paused, the thread can only wait.
    script.join(0.05)
    assert script.is_alive()
    assert viewer.time == before
    viewer.pause(False)
    script.join(PATIENCE)
    assert not script.is_alive()
    assert viewer.time == pytest.approx(before + STEPS / 240)


def test_a_window_that_the_user_has_closed_ends_quick_calls(viewer: Viewer):
    body = panda()
    walk(body)
    viewer._close_by_user()
    with pytest.raises(p.error, match="Not connected"):
        p.getJointState(body, 3)
    assert p.isConnected() == 0
