"""Image files: what is read, and what is refused."""

import numpy as np
import pytest
from PIL import Image
from tests.budget.limits import limited

from carom.errors import DescriptionError
from carom.render.images import read_image

PIXELS = np.arange(2 * 3 * 3, dtype=np.uint8).reshape(2, 3, 3) * 10


@pytest.mark.parametrize("suffix", ["png", "bmp", "tga", "ppm"])
def test_lossless_images_come_back_with_the_top_row_first(tmp_path, suffix):
    path = tmp_path / f"image.{suffix}"
    Image.fromarray(PIXELS).save(path)
    assert np.array_equal(read_image(path), PIXELS)


@pytest.mark.parametrize("mode", ["L", "1", "P", "RGBA", "I;16", "CMYK"])
def test_every_kind_of_pixel_becomes_red_green_and_blue(tmp_path, mode):
    path = tmp_path / "image.tif"
    Image.new(mode, (5, 4)).save(path)
    assert read_image(path).shape == (4, 5, 3)


def test_a_jpeg(tmp_path):
    path = tmp_path / "image.jpg"
    Image.new("RGB", (16, 8), (200, 100, 50)).save(path)
    assert np.abs(read_image(path).astype(int) - (200, 100, 50)).max() < 5


def test_a_changed_file_is_read_anew(tmp_path):
    path = tmp_path / "image.png"
    for level in (10, 20):
        Image.new("RGB", (1, 1), (level, 0, 0)).save(path)
        assert read_image(path)[0, 0, 0] == level


@pytest.mark.parametrize("content", [b"", b"no image", b"\x89PNG\r\n\x1a\n" + bytes(40)])
def test_what_is_no_image_is_refused(tmp_path, content):
    path = tmp_path / "image.png"
    path.write_bytes(content)
    with pytest.raises(DescriptionError, match=r"image\.png"):
        read_image(path)


def test_a_truncated_image_is_refused(tmp_path):
    path = tmp_path / "image.png"
    noise = np.random.default_rng(0).integers(0, 255, (64, 64, 3), dtype=np.uint8)
    Image.fromarray(noise).save(path)
    path.write_bytes(path.read_bytes()[:3000])
    with pytest.raises(DescriptionError, match="broken"):
        read_image(path)


def test_an_image_with_too_many_texels_is_refused_before_it_is_unpacked(tmp_path):
    path = tmp_path / "image.png"
    Image.new("L", (100, 100)).save(path)
    with limited(pixels=9999), pytest.raises(DescriptionError, match="10000 pixels are more than the 9999"):
        read_image(path)


def test_a_missing_file_is_refused(tmp_path):
    with pytest.raises(DescriptionError, match="cannot be read"):
        read_image(tmp_path / "nowhere.png")
