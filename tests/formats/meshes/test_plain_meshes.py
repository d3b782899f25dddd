"""OBJ files for collisions that the native library takes apart: the same parts as in Python."""

from __future__ import annotations

import random
from pathlib import Path
from typing import Any

import pytest
from tests.each import each
from tests.formats.visuals.test_plain_obj import DETAILED, PLAIN, VERTICES

from carom.errors import DescriptionError
from carom.meshes import obj, part

DATA = Path(__file__).parents[3] / "src" / "pybullet_data"
FILE = Path("mesh.obj")

GROUPED = {
    "groups": VERTICES
    + b"o one two\nf 1 2 3\ng\nf 1 2 3 4\nf 2 3 4\n\to\x0bno\n\x0c o yes\ts\n f 4 3 2\ng end\n",
    "polygons before a group": VERTICES + b"f 1 2 3 4\nf 1 2\nf 4 3 2 1\ng a\nf 1 2\ng b\nf 2 3 4\n",
    "names of other encodings": VERTICES + b"g \xff\xfe\xc3\xa9\nf 1 2 3\n",
    "words that begin as groups": VERTICES + b"f 1 2 3\ngroup a\noff\ng\x0bx\nf 2 3 4\n",
    "unused positions": b"v 9 9 9\n" * 90 + VERTICES + b"g a\nf -1 -2 -3\ng b\nf -4 -3 -2\n",
    "colours": b"v 1 2 3 0.5 0.5 0.5\nv 4 5 6 1 1 x\nv 7 8 10 1\nf 1 2 3\n",
    "beyond single precision": VERTICES + b"v 1e22 1 1\nv 4e22 1 1\nf 1 5 2\n",
}
EVERY = {**PLAIN, **DETAILED, **GROUPED}


def outcome(data: bytes) -> Any:
    """What reading gives: the parts, or the words of the error."""
    try:
        parts = obj.read_obj(data, FILE)
    except DescriptionError as error:
        return str(error)
    arrays = [(it.name, it.vertices, it.triangles) for it in parts]
    return [(name, *((it.shape, it.dtype, it.tobytes()) for it in both)) for name, *both in arrays]


def assert_same_in_python(data: bytes, monkeypatch: pytest.MonkeyPatch) -> None:
    ours = outcome(data)
    with monkeypatch.context() as patch:
        patch.setattr(obj, "take_apart", lambda data: None)
        assert outcome(data) == ours
        patch.setattr(part, "_MOST_UNUSED", 0)
        assert outcome(data) == ours


@pytest.mark.parametrize("data", list(EVERY.values()), ids=list(EVERY))
def test_files_are_read_as_in_python(data: bytes, monkeypatch: pytest.MonkeyPatch) -> None:
    assert_same_in_python(data, monkeypatch)


@pytest.mark.parametrize("name", [*PLAIN, *GROUPED])
def test_plain_files_are_taken_apart_by_the_library(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(obj, "_read_positions", None)
    monkeypatch.setattr(obj, "_read_corners", None)
    assert outcome(EVERY[name]) is not None


@each("file", sorted(DATA.rglob("*.obj")), ids=lambda file: file.relative_to(DATA).as_posix())
def test_shipped_files_are_read_as_in_python(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert_same_in_python(file.read_bytes(), monkeypatch)


@pytest.mark.parametrize("seed", range(10))
def test_damaged_files_are_read_as_in_python(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    source = random.Random(seed)
    pieces = b"/|//| |\n|-|1|9|f |v |.|e|g|o |\t|0|\x0b|\x0c|\r".split(b"|")
    for _ in range(25):
        data = bytearray(source.choice([*PLAIN.values(), *GROUPED.values()]))
        for _ in range(source.randint(1, 4)):
            at = source.randrange(len(data) + 1)
            data[at : at + source.randint(0, 2)] = source.choice(pieces)
        assert_same_in_python(bytes(data), monkeypatch)
