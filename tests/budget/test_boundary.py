"""Exceptions of other libraries leave readers as ours, with the file and the element."""

from __future__ import annotations

import struct
import zlib
from pathlib import Path

import pytest
from tests.budget.hostile import STUMBLING, Files, hfield, ply, png, urdf, written

import carom
import pybullet as p
from carom.description import Heightfield
from carom.errors import DescriptionError
from carom.files.boundary import WrongArgument, reading


@pytest.mark.parametrize("name", STUMBLING)
def test_what_readers_stumble_over_is_an_error_of_the_file(name: str, tmp_path: Path) -> None:
    file = written(STUMBLING[name](), tmp_path)
    world = carom.World()
    with pytest.raises(DescriptionError) as caught:
        world.load(file)
    assert caught.value.file is not None
    assert caught.value.file.parent == tmp_path
    assert not world.bodies


@pytest.mark.parametrize(
    "foreign",
    [
        OSError(36, "File name too long"), OverflowError("x"), ZeroDivisionError(), KeyError("x"),
        UnicodeDecodeError("utf-8", b"", 0, 1, "x"), RecursionError(), struct.error("x"), zlib.error("x"),
        ValueError("x"), EOFError(), IndexError(),
    ],
    ids=lambda it: type(it).__name__,
)  # fmt: skip
def test_foreign_exceptions_become_ours(foreign: Exception) -> None:
    with pytest.raises(DescriptionError) as caught, reading(Path("f.xml")):
        raise foreign
    assert caught.value.__cause__ is foreign
    assert caught.value.file == Path("f.xml")


@pytest.mark.parametrize("kind", [MemoryError, TypeError, WrongArgument, TimeoutError, KeyboardInterrupt])
def test_others_stay_what_they_are(kind: type[BaseException]) -> None:
    with pytest.raises(kind) as caught, reading(Path("f.xml")):
        raise kind
    assert type(caught.value) is kind


def test_the_element_is_named(tmp_path: Path) -> None:
    files = STUMBLING["solid without extent"]()
    with pytest.raises(DescriptionError) as caught:
        carom.World().load(written(files, tmp_path))
    assert caught.value.line == 1
    assert caught.value.element == "<mujoco> > <worldbody> > <body> > <geom>"


def test_the_drop_in_raises_its_own_error(tmp_path: Path) -> None:
    broken: Files = {"a.urdf": urdf("m.ply"), "m.ply": ply("", "0 0 0 1 0 0 0 1 0 3 0 1 inf")}
    image = tmp_path / "h.png"
    image.write_bytes(png(100, 100)[:60])
    many = tmp_path / "h.txt"
    many.write_bytes(b"\xff1,2\n3,4\n")
    client = p.connect(p.DIRECT)
    try:
        with pytest.raises(p.error, match="PLY"):
            p.createCollisionShape(p.GEOM_MESH, fileName=str(written(broken, tmp_path).with_name("m.ply")))
        for name in (image, many):
            with pytest.raises(p.error, match=name.name):
                p.createCollisionShape(p.GEOM_HEIGHTFIELD, fileName=str(name))
        with pytest.raises(p.error, match=r"h\.png"):
            p.loadTexture(str(image))
        (tmp_path / "big.xml").write_text(
            '<mujoco><asset><mesh name="m" file="m.gltf"/></asset><worldbody><body>'
            '<geom type="mesh" mesh="m"/></body></worldbody></mujoco>'
        )
        (tmp_path / "m.gltf").write_text("[" * 100_000)
        with pytest.raises(p.error):
            p.loadMJCF(str(tmp_path / "big.xml"))
        assert p.getNumBodies() == 0
    finally:
        p.disconnect(client)


def test_height_fields_of_images_have_the_first_row_at_the_greatest_y(tmp_path: Path) -> None:
    pixels = b"".join(b"\0" + bytes(row) for row in ((10, 20, 30), (40, 50, 60)))
    file = written({"a.xml": hfield('file="h.png"'), "h.png": png(3, 2, pixels)}, tmp_path)
    [shape] = carom.World().load(file).bodies[0].spec.base.collisions
    assert isinstance(shape.geometry, Heightfield)
    assert (shape.geometry.heights * 50.0 + 10.0).round().tolist() == [[40, 50, 60], [10, 20, 30]]
