"""Pictures that a script waits for."""

import threading

from tests.patience import PATIENCE
from tests.viewer.watcher import Watcher

import pybullet as p
from carom.viewer.pictures import Pictures
from carom.viewer.viewer import Viewer


def waiting(pictures: Pictures, pages: set[int]) -> threading.Thread:
    """Somebody who waits for pages, and has asked for the picture."""
    asked = pictures.asked
    thread = threading.Thread(target=pictures.wait, args=(lambda: pages, PATIENCE))
    thread.start()
    while pictures.asked == asked:
        pass
    return thread


def test_all_pages_that_can_be_seen_are_waited_for() -> None:
    pictures = Pictures()
    pictures.show(3, visible=False)
    thread = waiting(pictures, {1, 2, 3})
    pictures.drawn(1, 1)
    pictures.drawn(2, 0)
    thread.join(0.05)
    assert thread.is_alive()
    pictures.drawn(2, 1)
    thread.join(PATIENCE)
    assert not thread.is_alive()


def test_pages_that_go_or_hide_are_not_waited_for() -> None:
    pictures, pages = Pictures(), {1, 2}
    thread = waiting(pictures, pages)
    pictures.show(1, visible=False)
    pages.remove(2)
    pictures.forget(2)
    thread.join(PATIENCE)
    assert not thread.is_alive()


def test_patience_ends() -> None:
    Pictures().wait(lambda: {1}, 0.001)


def test_single_step_rendering_waits_for_the_page(viewer: Viewer) -> None:
    p.configureDebugVisualizer(p.COV_ENABLE_SINGLE_STEP_RENDERING, 1)
    with Watcher(viewer.address) as page:
        page.wait_for(lambda: "picture" in page.frame)
        before = page.frame["picture"]
        p.stepSimulation()
        script = threading.Thread(
            target=p.configureDebugVisualizer, args=(p.COV_ENABLE_SINGLE_STEP_RENDERING, 1)
        )
        script.start()
        page.wait_for(lambda: page.frame["picture"] > before)
        assert page.frame["time"] > 0
        page.tell("drawn", picture=page.frame["picture"])
        script.join(PATIENCE)
        assert not script.is_alive()
