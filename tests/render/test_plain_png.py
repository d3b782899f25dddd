"""PNG files that are decoded without Pillow: the same texels, and everything else is left to Pillow."""

from __future__ import annotations

import io
import struct
import subprocess
import sys
import zlib
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from tests.each import each

from carom.errors import DescriptionError
from carom.render.images import read_image, sources
from carom.render.plain_png import read_plain_png

DATA = Path(__file__).parents[2] / "src" / "pybullet_data"
WIDTH, HEIGHT = 5, 3


def chunk(name: bytes, content: bytes) -> bytes:
    """A chunk of a PNG file."""
    return struct.pack(">I", len(content)) + name + content + struct.pack(">I", zlib.crc32(name + content))


def png(
    rows: bytes, *, kind: bytes = b"\x08\x02\x00\x00\x00", extra: bytes = b"", size: tuple[int, int] = (5, 3)
) -> bytes:
    """A PNG file with these rows, its data in two chunks."""
    packed = zlib.compress(rows)
    return b"".join(
        [
            b"\x89PNG\r\n\x1a\n",
            chunk(b"IHDR", struct.pack(">II", *size) + kind),
            extra,
            chunk(b"IDAT", packed[:7]),
            chunk(b"IDAT", packed[7:]),
            chunk(b"IEND", b""),
        ]
    )


def rows_of(channels: int, row_filter: int = 0) -> bytes:
    """Rows of random numbers, all with this filter."""
    rows = np.random.default_rng(1).integers(0, 256, (HEIGHT, 1 + WIDTH * channels)).astype(np.uint8)
    rows[:, 0] = row_filter
    return rows.tobytes()


def pillow(data: bytes) -> tuple[np.ndarray, str]:
    """What Pillow makes of a file."""
    with Image.open(io.BytesIO(data)) as image:
        return np.array(image.convert("RGB")), image.mode


def assert_like_pillow(data: bytes) -> None:
    plain = read_plain_png(data)
    assert plain is not None
    texels, mode = pillow(data)
    np.testing.assert_array_equal(plain[0], texels)
    assert (plain[0].dtype, plain[1]) == (texels.dtype, mode)


@pytest.mark.parametrize(("kind", "channels"), [(b"\x08\x02\0\0\0", 3), (b"\x08\x06\0\0\0", 4)])
def test_plain_files_have_the_texels_that_pillow_finds(kind: bytes, channels: int) -> None:
    assert_like_pillow(png(rows_of(channels), kind=kind))


@each("file", sorted(DATA.glob("*.png")), ids=lambda file: file.name)
def test_shipped_files_are_plain(file: Path) -> None:
    assert_like_pillow(file.read_bytes())


@pytest.mark.parametrize(
    "data",
    [
        png(rows_of(3, row_filter=2)),
        png(rows_of(3), extra=chunk(b"tRNS", b"\0\1\0\2\0\3")),
        png(rows_of(3), extra=chunk(b"eXIf", b"MM\0*\0\0\0\x08\0\0")),
        png(rows_of(1), kind=b"\x08\x00\0\0\0"),
    ],
    ids=["filtered", "transparent colour", "metadata", "grey"],
)
def test_pillow_reads_what_is_not_plain(data: bytes, tmp_path: Path) -> None:
    assert read_plain_png(data) is None
    (tmp_path / "image.png").write_bytes(data)
    np.testing.assert_array_equal(read_image(tmp_path / "image.png"), pillow(data)[0])


WHOLE = png(rows_of(3))
BROKEN = {
    "cut off": WHOLE[:-40],
    "a wrong sum": WHOLE[:60] + bytes([WHOLE[60] ^ 1]) + WHOLE[61:],
    "a wrong stream": png(b"")[:33] + chunk(b"IDAT", b"nothing packed") + chunk(b"IEND", b""),
    "too few rows": png(rows_of(3)[:-1]),
    "too many rows": png(rows_of(3) + b"\0"),
    "a second header": png(rows_of(3), extra=WHOLE[8:33]),
    "no columns": png(b"\0\0\0", size=(0, 3)),
    "huge": png(rows_of(3), size=(1 << 30, 1 << 30)),
    "more after the end": WHOLE + b"x",
}


@each("data", list(BROKEN.values()), ids=list(BROKEN))
def test_broken_files_are_left_to_pillow(data: bytes) -> None:
    assert read_plain_png(data) is None


def test_a_broken_file_is_an_error_with_its_name(tmp_path: Path) -> None:
    (tmp_path / "image.png").write_bytes(BROKEN["cut off"])
    with pytest.raises(DescriptionError, match=r"image\.png: the image is broken"):
        read_image(tmp_path / "image.png")


def test_the_form_of_a_plain_file_is_known() -> None:
    assert sources[id(read_image(DATA / "cube.png"))].form == ("PNG", "RGB")


def test_an_image_of_shipped_textures_does_without_pillow() -> None:
    script = f"""
import sys
import pybullet as p

p.connect(p.DIRECT)
p.loadURDF({str(DATA / "plane.urdf")!r})
p.loadURDF({str(DATA / "cube_small.urdf")!r}, [0, 0, 0.5])
p.getCameraImage(8, 8, p.computeViewMatrix([1, 1, 1], [0, 0, 0], [0, 0, 1]),
                 p.computeProjectionMatrixFOV(60, 1, 0.1, 10))
assert "PIL" not in sys.modules
"""
    subprocess.run([sys.executable, "-c", script], check=True)
