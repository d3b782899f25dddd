"""Pages see soft bodies in the shapes that they have."""

from __future__ import annotations

from pathlib import Path
from threading import RLock

import numpy as np
import pytest
from tests.soft.test_textures import write_seam
from tests.viewer.browser import Page, needs_browser

import pybullet as p
from carom import Camera, World
from carom.viewer import scene_feed
from carom.viewer.latest_messages import LatestMessages
from carom.viewer.messages import decoded


def meshes(latest: LatestMessages) -> list[np.ndarray]:
    """The vertices of all meshes among the latest messages, in the order they were put there."""
    found = []
    for key, entry in latest._entries.items():
        if isinstance(key, tuple) and key[0] == "mesh" and not entry.gone:
            header, payload = decoded(entry.message)
            count = 3 * header["vertices"]
            found.append(np.frombuffer(payload[: 4 * count], dtype="<f4").reshape(-1, 3))
    return found


def test_a_cloth_that_falls_together_is_shown_so(monkeypatch) -> None:
    monkeypatch.setattr(scene_feed, "_SHAPE_INTERVAL", 0.0)
    world = World()
    world.gravity = (0, 0, -10)
    cloth = world.load_cloth((1.0, 1.0), (4, 4))
    cloth.anchor(12)
    latest = LatestMessages()
    feed = scene_feed.SceneFeed(world, RLock(), latest)
    feed.frame({})
    (flat,) = meshes(latest)
    assert np.ptp(flat[:, 2]) < 1e-6
    world.step(60)
    feed.frame({})
    (fallen,) = meshes(latest)
    assert np.ptp(fallen[:, 2]) > 0.2
    revision = latest.revision
    feed.frame({})
    assert latest.revision == revision, "nothing has moved"


def test_images_are_drawn_while_a_page_looks_on(monkeypatch) -> None:
    """What pages are sent is no matter to the renderer, which has surfaces of its own."""
    monkeypatch.setattr(scene_feed, "_SHAPE_INTERVAL", 0.0)
    world = World()
    world.gravity = (0, 0, -10)
    solid = world.load_soft_solid(0.2, 4)
    feed = scene_feed.SceneFeed(world, RLock(), LatestMessages())
    camera = Camera(32, 32, fx=30.0).look_at((0.0, -1.0, 0.0), (0.0, 0.0, 0.0))
    for _ in range(2):
        world.step(10)
        feed.frame({})
        assert camera.capture(world).mask(solid).any()


@pytest.mark.long
@needs_browser
def test_textures_of_soft_bodies_are_seen(page: Page, tmp_path: Path) -> None:
    p.resetSimulation(p.RESET_USE_DEFORMABLE_WORLD)
    body = p.loadSoftBody(str(write_seam(tmp_path)), [-0.5, -0.5, 0.5], mass=1, useMassSpring=1)
    p.resetDebugVisualizerCamera(2, 0, -60, [0, 0, 0.5])

    def most(picture: np.ndarray) -> tuple[float, float]:
        red, green, blue = (picture[..., channel] for channel in range(3))
        return (red > green + 80).mean(), (blue > red + 40).mean()

    page.wait_for_picture(lambda picture: most(picture)[0] > 0.02)
    p.changeVisualShape(body, -1, textureUniqueId=-1, rgbaColor=[0.1, 0.1, 1, 1])
    page.wait_for_picture(lambda picture: most(picture)[0] < 0.01 and most(picture)[1] > 0.02)
