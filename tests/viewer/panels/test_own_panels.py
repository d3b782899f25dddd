"""People's own controls: values, callbacks, several threads, and what is refused."""

from __future__ import annotations

from collections.abc import Iterator
from io import BytesIO
from threading import Event, Thread, current_thread
from typing import Any

import numpy as np
import pytest
from PIL import Image as Pillow
from tests.patience import until
from tests.viewer.watcher import Watcher

from carom import World
from carom.viewer import Viewer


@pytest.fixture
def viewer(monkeypatch: pytest.MonkeyPatch) -> Iterator[Viewer]:
    monkeypatch.setenv("CI", "true")
    viewer = Viewer(World(), port=0)
    yield viewer
    viewer.close()


@pytest.fixture
def page(viewer: Viewer) -> Iterator[Watcher]:
    with Watcher(viewer.address) as page:
        yield page


def named(page: Watcher, kind: str, name: str) -> dict[str, Any]:
    """The newest message about a part of that name; empty if there is none."""
    return next((it for (found, _), it in page.shown.items() if found == kind and it["name"] == name), {})


def test_controls_call_back_with_what_the_user_has_set(viewer: Viewer, page: Watcher):
    panel = viewer.add_panel("Controller")
    told: list[tuple[str, Any]] = []
    threads: set[str] = set()

    def note(control: Any) -> None:
        told.append((control.name, control.value))
        threads.add(current_thread().name)

    panel.add_button("go", note)
    panel.add_slider("kp", 0, 100, 40, note)
    panel.add_dropdown("gait", ["walk", "trot"], "trot", note)
    panel.add_checkbox("slow", on_change=note)
    panel.add_text("goal", "home", note)
    page.wait_for(lambda: named(page, "field", "goal"))
    number = page.shown["panel", next(k for kind, k in page.shown if kind == "panel")]["panel"]
    assert all(named(page, "slider", name)["panel"] == number for name in ("go", "kp", "gait", "slow"))
    page.tell("press", slider=named(page, "slider", "go")["slider"])
    page.tell("slider", slider=named(page, "slider", "kp")["slider"], value=70)
    page.tell("slider", slider=named(page, "slider", "gait")["slider"], value=0)
    page.tell("slider", slider=named(page, "slider", "slow")["slider"], value=1)
    page.tell("field", field=named(page, "field", "goal")["field"], text="away")
    assert until(lambda: len(told) == 5)
    assert told == [("go", 1), ("kp", 70.0), ("gait", "walk"), ("slow", True), ("goal", "away")]
    assert threads == {"carom callbacks"}


def test_each_click_is_a_call_and_a_slider_that_moves_on_is_called_once_more(viewer: Viewer, page: Watcher):
    begun, go_on = Event(), Event()
    told: list[Any] = []

    def slow(control: Any) -> None:
        begun.set()
        go_on.wait()
        told.append(control.value)

    viewer.add_button("wait", slow)
    clicks: list[int] = []
    viewer.add_button("click", lambda control: clicks.append(control.value))
    moved: list[float] = []
    viewer.add_slider("x", 0, 9, on_change=lambda control: moved.append(control.value))
    page.wait_for(lambda: named(page, "slider", "x"))
    page.tell("press", slider=named(page, "slider", "wait")["slider"])
    assert until(begun.is_set)
    for value in (1, 2, 3):
        page.tell("press", slider=named(page, "slider", "click")["slider"])
        page.tell("slider", slider=named(page, "slider", "x")["slider"], value=value)
    # The page is told of it before the callback runs.
    page.wait_for(lambda: named(page, "slider", "x")["value"] == 3)
    assert clicks == moved == []
    go_on.set()
    assert until(lambda: len(clicks) == 3 and moved)
    assert moved == [3.0]


def test_an_error_in_a_callback_is_logged_and_the_next_is_called(
    viewer: Viewer, page: Watcher, caplog: pytest.LogCaptureFixture
):
    def fail(control: Any) -> None:
        raise RuntimeError("no such gait")

    told: list[int] = []
    viewer.add_button("bad", fail)
    viewer.add_button("good", lambda control: told.append(control.value))
    page.wait_for(lambda: named(page, "slider", "good"))
    page.tell("press", slider=named(page, "slider", "bad")["slider"])
    page.tell("press", slider=named(page, "slider", "good")["slider"])
    assert until(lambda: told == [1])
    assert "no such gait" in caplog.text


def test_code_sets_values_from_several_threads_without_calls(viewer: Viewer, page: Watcher):
    told: list[Any] = []
    made: list[list[Any]] = []

    def work(number: int) -> None:
        sliders = [viewer.add_slider(f"{number}.{i}", 0, 9, on_change=told.append) for i in range(20)]
        for slider in sliders:
            slider.value = number
        made.append(sliders)

    threads = [Thread(target=work, args=(number,)) for number in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    page.wait_for(lambda: all(named(page, "slider", f"{n}.19").get("value") == n for n in range(4)))
    assert len({slider._number for sliders in made for slider in sliders}) == 80
    assert told == []
    assert sum(kind == "slider" for kind, _ in page.shown) == 80


def test_images_and_texts_are_shown_and_replaced(viewer: Viewer, page: Watcher):
    image = viewer.add_image("eye", np.zeros((3, 5)))
    state = viewer.add_text("state", "idle", editable=False)
    page.wait_for(lambda: named(page, "field", "state"))
    image.value = np.full((2, 4, 4), 255, np.uint8)
    state.value = "running"
    page.wait_for(lambda: named(page, "field", "state")["text"] == "running")
    shown = named(page, "image", "eye")
    assert (shown["width"], shown["height"]) == (4, 2)
    picture = np.array(Pillow.open(BytesIO(page.payloads["image", shown["image"]])))
    assert (picture == 255).all()
    assert picture.shape == (2, 4, 3)
    # What is for reading only is not typed.
    page.tell("field", field=named(page, "field", "state")["field"], text="mine")
    page.tell("pause", paused=True)
    page.wait_for(lambda: page.shown["pause", None]["paused"])
    assert state.value == "running"


def test_what_is_removed_is_gone_from_pages_and_calls_nothing(viewer: Viewer, page: Watcher):
    told: list[Any] = []
    panel = viewer.add_panel("Mine")
    button = panel.add_button("go", told.append)
    panel.add_text("goal")
    panel.add_image("eye", np.zeros((2, 2)))
    page.wait_for(lambda: named(page, "image", "eye"))
    number = named(page, "slider", "go")["slider"]
    panel.remove()
    page.wait_for(lambda: not any(kind in ("panel", "slider", "field", "image") for kind, _ in page.shown))
    page.tell("press", slider=number)
    page.tell("pause", paused=True)
    page.wait_for(lambda: page.shown["pause", None]["paused"])
    assert told == []
    assert button.value == 0


def test_a_frame_that_is_moved_calls_back_and_plots_are_told(viewer: Viewer, page: Watcher):
    told: list[Any] = []
    handle = viewer.add_frame("target", (1, 2, 3), on_change=told.append)
    viewer.add_plot("error").add(0.25)
    page.wait_for(lambda: page.frame.get("values") == {"error": 0.25})
    handle.move_to((0, 0, 0))
    page.tell("handle", handle=0, position=[3, 2, 1], orientation=[0, 0, 0, 1])
    assert until(lambda: told == [handle])
    assert handle.position == (3.0, 2.0, 1.0)


def test_what_a_control_cannot_be_is_refused_and_nothing_is_added(viewer: Viewer):
    with pytest.raises(ValueError, match="slider 'x' needs a lower bound below the upper one"):
        viewer.add_slider("x", 1, 0)
    with pytest.raises(ValueError, match="list 'gait' has 'walk', not 'run'"):
        viewer.add_dropdown("gait", ["walk"], "run")
    with pytest.raises(ValueError, match="choice 'gait' needs a start"):
        viewer.add_dropdown("gait", [])
    for image in (np.zeros((2, 2, 5)), np.zeros((2, 2), np.int64), np.zeros((0, 2)), np.full((2, 2), np.nan)):
        with pytest.raises(ValueError, match="image 'eye'"):
            viewer.add_image("eye", image)
    assert viewer.controls.sliders == {}
    slider = viewer.add_slider("y", 0, 1)
    with pytest.raises(ValueError, match=r"'y' has to be from 0\.0 to 1\.0, not 2"):
        slider.value = 2
    choice = viewer.add_dropdown("gait", ["walk", "trot"])
    with pytest.raises(ValueError, match="'gait' has to be one of 'walk', 'trot', not 'run'"):
        choice.value = "run"
    choice.value = "trot"
    assert (slider.value, choice.value) == (0.0, "trot")
