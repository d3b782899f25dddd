"""Sliders, drawings and the camera, with and without a window."""

import json
from math import atan, degrees

import numpy as np
import pytest

import pybullet as p
from carom.viewer.items import DebugLine, DebugPoints, DebugText
from pybullet._clients.clients import clients
from pybullet._window.page_window import PageWindow


@pytest.fixture
def window() -> PageWindow:
    window = clients[p.connect(p.GUI)].window
    assert isinstance(window, PageWindow)
    return window


def test_sliders_read_back_their_start_values(window: PageWindow) -> None:
    force = p.addUserDebugParameter("force", -5, 5, 1.5)
    button = p.addUserDebugParameter("button", 1, 0, 3)
    default = p.addUserDebugParameter("default")
    assert [force, button, default] == [0, 1, 2]
    assert [p.readUserDebugParameter(item) for item in (force, button, default)] == [1.5, 3.0, 0.0]
    p.removeUserDebugItem(force)
    with pytest.raises(p.error, match=r"^Failed to read parameter\."):
        p.readUserDebugParameter(force)
    p.removeAllUserParameters()
    assert not window.sliders


def test_drawings_get_ids_and_can_be_replaced(window: PageWindow) -> None:
    line = p.addUserDebugLine([0, 0, 0], (1, 0, 0), lineColorRGB=np.array([1, 0, 0]), lineWidth=3)
    text = p.addUserDebugText("here", [0, 0, 1], textSize=2, textOrientation=[0, 0, 0, 1])
    points = p.addUserDebugPoints([[0, 0, 0], [1, 1, 1]], [[1, 0, 0]] * 2, 4)
    assert [line, text, points] == [0, 1, 2]
    assert window.items[line] == DebugLine(end=(1.0, 0.0, 0.0), colour=(1.0, 0.0, 0.0), width=3.0)
    assert window.items[text] == DebugText(
        text="here", position=(0.0, 0.0, 1.0), size=2.0, orientation=(0.0, 0.0, 0.0, 1.0)
    )
    assert isinstance(window.items[points], DebugPoints)
    assert p.addUserDebugLine([0, 0, 0], [0, 2, 0], replaceItemUniqueId=line) == line
    assert window.items[line] == DebugLine(end=(0.0, 2.0, 0.0))
    p.removeUserDebugItem(text)
    assert set(window.items) == {line, points}


def test_removing_all_drawings_keeps_sliders(window: PageWindow) -> None:
    p.addUserDebugLine([0, 0, 0], [1, 0, 0])
    slider = p.addUserDebugParameter("slider")
    p.addUserDebugLine([0, 0, 0], [1, 0, 0])
    p.removeAllUserDebugItems()
    assert not window.items
    assert p.readUserDebugParameter(slider) == 0.0
    assert p.addUserDebugLine([0, 0, 0], [1, 0, 0]) == slider + 1


def test_resetting_the_simulation_removes_drawings(window: PageWindow) -> None:
    p.addUserDebugLine([0, 0, 0], [1, 0, 0])
    p.resetSimulation()
    assert not window.items


def test_wireframe_colours(window: PageWindow) -> None:
    p.setDebugObjectColor(3, -1, [1, 0, 0])
    assert window.colours == {(3, -1): (1.0, 0.0, 0.0)}
    p.setDebugObjectColor(3, -1)
    assert not window.colours


def test_the_camera_goes_where_it_is_sent(window: PageWindow) -> None:
    p.resetDebugVisualizerCamera(2.5, 30, -20, [1, 2, 3])
    info = p.getDebugVisualizerCamera()
    assert len(info) == 12
    assert info[:2] == (1024, 768)
    assert info[8:] == (30.0, -20.0, 2.5, (1.0, 2.0, 3.0))
    assert info[2] == pytest.approx(
        p.computeViewMatrixFromYawPitchRoll([1, 2, 3], 2.5, 30, -20, 0, 2), abs=1e-12
    )
    assert info[3] == pytest.approx(
        p.computeProjectionMatrixFOV(degrees(2.0 * atan(1.0)), 1024 / 768, 0.01, 1000), abs=1e-12
    )
    assert info[4] == (0.0, 0.0, 1.0)
    forward, right, upward = (np.array(info[field]) for field in (5, 6, 7))
    assert np.linalg.norm(forward) == pytest.approx(1.0)
    assert forward @ right == pytest.approx(0.0, abs=1e-9)
    assert np.linalg.norm(upward) == pytest.approx(20000.0)
    assert np.linalg.norm(right) == pytest.approx(20000.0 * 1024 / 768)
    p.resetDebugVisualizerCamera(-1, 0, 0, [0, 0, 0])
    assert p.getDebugVisualizerCamera() == info


@pytest.mark.parametrize("pitch", [-90, 90])
def test_a_camera_that_looks_straight_down_or_up(window: PageWindow, pitch: float) -> None:
    p.resetDebugVisualizerCamera(1, 0, pitch, [0, 0, 0])
    assert np.isfinite(np.concatenate([np.atleast_1d(field) for field in p.getDebugVisualizerCamera()])).all()


def test_options_are_kept(window: PageWindow) -> None:
    p.configureDebugVisualizer(p.COV_ENABLE_GUI, 0)
    p.configureDebugVisualizer(
        lightPosition=[1, 2, 3], rgbBackground=[0, 0, 1], shadowMapResolution=512, shadowMapIntensity=0.5
    )
    p.configureDebugVisualizer(p.COV_ENABLE_Y_AXIS_UP, 1)
    assert window.options.flags == {p.COV_ENABLE_GUI: False, p.COV_ENABLE_Y_AXIS_UP: True}
    assert window.options.light_position == (1.0, 2.0, 3.0)
    assert window.options.shadow_map_resolution == 512
    assert window.options.shadow_map_world_size is None
    assert p.getDebugVisualizerCamera()[4] == (0.0, 1.0, 0.0)


def test_nobody_presses_a_key(window: PageWindow) -> None:
    assert p.getKeyboardEvents() == {}
    assert p.getMouseEvents() == ()
    assert p.getVREvents() == ()


def test_the_window_has_the_size_asked_for() -> None:
    p.connect(p.GUI, options="--width=640 --height=480 --width=nonsense")
    assert p.getDebugVisualizerCamera()[:2] == (640, 480)


@pytest.mark.parametrize("method", [p.GUI, p.GUI_SERVER, p.GUI_MAIN_THREAD])
def test_there_is_one_window_at_most(window: PageWindow, method: int) -> None:
    with pytest.raises(p.error, match=r"^Only one local in-process GUI/GUI_SERVER connection allowed"):
        p.connect(method)
    assert p.connect(p.DIRECT) == 1


def test_a_closed_window_disconnects(window: PageWindow) -> None:
    assert p.isConnected() == 1
    window.close()
    assert p.isConnected() == 0
    assert p.getConnectionInfo() == {"isConnected": 0, "connectionMethod": 0}
    with pytest.raises(p.error, match=r"^Not connected to physics server\."):
        p.getNumBodies()
    assert p.connect(p.GUI) == 0


def test_without_a_window_nothing_is_shown(client: int) -> None:
    assert p.addUserDebugParameter("slider", 0, 1, 0.5) == -1
    assert p.addUserDebugLine([0, 0, 0], [1, 0, 0]) == -1
    assert p.addUserDebugText("text", [0, 0, 0]) == -1
    assert p.addUserDebugPoints([[0, 0, 0]], [[1, 1, 1]]) == -1
    with pytest.raises(p.error, match=r"^Failed to read parameter\."):
        p.readUserDebugParameter(-1)
    p.removeUserDebugItem(0)
    p.removeAllUserDebugItems()
    p.removeAllUserParameters()
    p.setDebugObjectColor(0, 0, [1, 0, 0])
    p.configureDebugVisualizer(p.COV_ENABLE_GUI, 0)
    p.resetDebugVisualizerCamera(1, 2, 3, [0, 0, 0])
    assert p.getKeyboardEvents() == {}
    assert p.getMouseEvents() == ()
    info = p.getDebugVisualizerCamera()
    assert json.dumps(info).replace("0", "").strip("[], .").replace(",", "").replace(".", "").split() == []
    assert [len(field) if isinstance(field, tuple) else 1 for field in info] == [
        1,
        1,
        16,
        16,
        3,
        3,
        3,
        3,
        1,
        1,
        1,
        3,
    ]


def test_points_need_colours(window: PageWindow) -> None:
    with pytest.raises(p.error, match=r"^numColors must match numPositions\."):
        p.addUserDebugPoints([[0, 0, 0]], [])
    with pytest.raises(p.error, match="at least one point"):
        p.addUserDebugPoints([], [])
