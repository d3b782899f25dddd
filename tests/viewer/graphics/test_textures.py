"""Textures travel as image files, once, and are decoded by the browser."""

import io
import os
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image
from tests.viewer.browser import Page, needs_browser
from tests.viewer.watcher import Watcher

import pybullet as p
from carom import World
from carom.render.images import read_image
from carom.render.texture_files import texture_file
from carom.viewer.viewer import Viewer


def quarters() -> np.ndarray:
    """Red, green, blue and yellow, from the top left to the bottom right, with a little noise."""
    image = np.zeros((128, 128, 3), np.uint8)
    image[:64, :64], image[:64, 64:] = (220, 20, 20), (20, 200, 20)
    image[64:, :64], image[64:, 64:] = (20, 20, 220), (220, 220, 20)
    return image + np.random.default_rng(0).integers(0, 4, image.shape, dtype=np.uint8)


def saved(image: np.ndarray, file: Path, **options: Any) -> Path:
    """A file that was written some time ago: one that is new could still change unnoticed."""
    Image.fromarray(image).save(file, **options)
    os.utime(file, (1e9, 1e9))
    return file


def test_files_are_sent_as_they_are_if_they_can_be(tmp_path: Path):
    image = quarters()
    for name, media_type in (("a.png", "image/png"), ("a.jpg", "image/jpeg")):
        saved(image, tmp_path / name)
        sent = texture_file(read_image(tmp_path / name))
        assert sent == (media_type, (tmp_path / name).read_bytes())
    Image.fromarray(image).save(tmp_path / "a.bmp")
    of_bmp = texture_file(read_image(tmp_path / "a.bmp"))
    assert of_bmp.media_type == "image/png"
    assert (np.array(Image.open(io.BytesIO(of_bmp.data))) == image).all()
    # A file that has gone or changed since is not sent in its place.
    texels = read_image(tmp_path / "a.jpg")
    Image.fromarray(image[::-1]).save(tmp_path / "a.jpg")
    assert (np.array(Image.open(io.BytesIO(texture_file(texels).data))) == texels).all()
    (tmp_path / "a.jpg").unlink()
    assert texture_file(texels).media_type == "image/png"


def test_pictures_that_are_turned_when_shown_are_sent_unturned(tmp_path: Path):
    turned = Image.Exif()
    turned[0x0112] = 6
    saved(quarters(), tmp_path / "turned.jpg", exif=turned)
    sent = texture_file(read_image(tmp_path / "turned.jpg"))
    assert sent.media_type == "image/png"


def textured_box(file: Path) -> int:
    shape = p.createVisualShape(p.GEOM_BOX, halfExtents=[0.5, 0.5, 0.01])
    body = p.createMultiBody(0, -1, shape, [0, 0, 0])
    p.changeVisualShape(body, -1, textureUniqueId=p.loadTexture(str(file)))
    return body


def test_a_texture_is_sent_once_and_short(viewer: Viewer, tmp_path: Path):
    saved(quarters(), tmp_path / "quarters.jpg")
    bodies = [textured_box(tmp_path / "quarters.jpg") for _ in range(3)]
    with Watcher(viewer.address) as page:
        page.wait_for(lambda: all(("body", body) in page.shown for body in bodies))
        page.wait_for(lambda: page.frame)
        payloads = [data for (kind, _), data in page.payloads.items() if kind == "texture"]
    assert payloads == [(tmp_path / "quarters.jpg").read_bytes()]


def colours_of(page: Page) -> list[str]:
    """What is seen left and right above and below the middle."""
    names = {(1, 0, 0): "red", (0, 1, 0): "green", (0, 0, 1): "blue", (1, 1, 0): "yellow"}
    picture = page.picture()
    found = []
    for row, column in ((-1, -1), (-1, 1), (1, -1), (1, 1)):
        pixel = picture[320 + 60 * row, 450 + 60 * column]
        red, green, blue = (int(value > 0.5 * pixel.max()) for value in pixel)
        found.append(names.get((red, green, blue), "none"))
    return found


def sheet(folder: Path, kind: str) -> Path:
    """A robot file: a square of 1 m that shows the whole image, seen from above."""
    saved(quarters(), folder / f"quarters.{kind}")
    (folder / "sheet.obj").write_text(
        "mtllib sheet.mtl\nusemtl m\nv -.5 -.5 0\nv .5 -.5 0\nv .5 .5 0\nv -.5 .5 0\n"
        "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3\nf 1/1 3/3 4/4\n"
    )
    (folder / "sheet.mtl").write_text(f"newmtl m\nKd 1 1 1\nmap_Kd quarters.{kind}\n")
    (folder / "sheet.urdf").write_text(
        '<robot name="sheet"><link name="base"><visual><geometry><mesh filename="sheet.obj"/></geometry>'
        "</visual></link></robot>"
    )
    return folder / "sheet.urdf"


AS_IT_IS = ["red", "green", "blue", "yellow"]


@needs_browser
@pytest.mark.parametrize("kind", ["png", "jpg", "bmp"])
def test_the_browser_shows_the_image(page: Page, tmp_path: Path, kind: str):
    p.loadURDF(str(sheet(tmp_path, kind)), useFixedBase=True)
    p.resetDebugVisualizerCamera(0.8, 0, -89.9, [0, 0, 0])
    page.wait_for_picture(lambda picture: colours_of(page) == AS_IT_IS)
    # An image that is removed while it is decoded does not come back.
    p.resetSimulation()
    page.until("app.scene.textures.size === 0 && app.scene.decoding.size === 0")


@needs_browser
def test_replays_show_the_image(browser, tmp_path: Path):
    world = World()
    world.load_urdf(sheet(tmp_path, "jpg"), fixed_base=True)
    with world.record(tmp_path / "sheet.html") as recorder:
        recorder.look_from(0.8, 0, -89.9, (0, 0, 0))
        world.step(10)
    page = Page(browser, (tmp_path / "sheet.html").as_uri(), 900, 640)
    page.until("window.app?.scene.groups.length > 0 && app.scene.textures.size === 1")
    page.wait_for_picture(lambda picture: colours_of(page) == AS_IT_IS)
    assert page.complaints == []
