"""OBJ files that the native library reads: the same values as in Python, which reads all others."""

from __future__ import annotations

import random
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.each import each

from carom.errors import DescriptionError
from carom.formats.visuals import obj
from carom.formats.visuals.plain_obj import distinct_corners, read_plain_obj
from carom.formats.visuals.render_mesh import RenderMesh

DATA = Path(__file__).parents[3] / "src" / "pybullet_data"

VERTICES = b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"
UVS, NORMALS = b"vt 0 0\nvt 1 0.5\n", b"vn 0 0 1\nvn 0 1 0\n"
ALL = VERTICES + UVS + NORMALS
PLAIN = {
    "positions only": VERTICES + b"f 1 2 3\n",
    "a polygon": VERTICES + b"f 1 2 3 4\nf 4 2 1\n",
    "texture coordinates": ALL + b"f 1/1 2/2 3/1\n",
    "normals": ALL + b"f 1//1 2//2 3//1\n",
    "all entries": ALL + b"f 1/1/1 2/2/2 3/1/2\n",
    "mixed entries": ALL + b"f 1/1/1 2 3//2\nf 1/2 2/1 3/1 4\n",
    "counted back": ALL + b"f -4/-2/-1 -3/-1/-2 -1/1/1\nv 7 7 7\nf -1 1 -2\n",
    "too few corners": VERTICES + b"f 1 2\nf 3\nf \nf 1 2 3\n",
    "indices of what follows": b"f 1 2 3\n" + VERTICES,
    "tabs and spaces": b" \tv\t 0  0\t0 \nv 1 0 0 0.5 0.5 0.5\nv 0 1 0\nvt 0 1 0\n\n \n# v\n\tf 1\t2  3 \t\n",
    "no line feed at the end": VERTICES + b"f 1 2 3",
    "empty": b"",
    "other lines": b"vp 1\nfoo\n" + VERTICES + b"s off\nl 1 2\nvnormal\nfaces 1\nf 1 2 3\n",
    "bytes of other encodings": VERTICES + b"g \xff\xfe\n# \xe9\nf 1 2 3\n",
    "other line ends": (VERTICES + b"f 1 2 3\n").replace(b"\n", b"\r\n"),
    "a mark at the beginning": b"\xef\xbb\xbf" + VERTICES + b"f 1 2 3\n",
    "groups": b"mtllib a.mtl\ng one\nusemtl a\n"
    + VERTICES
    + b"f 1 2 3\ng two\no three\nusemtl b\nf 1 2 4\ng four\n",
}
DETAILED = {
    "a word": VERTICES + b"v 1 x 2\nf 1 2 3\n",
    "two numbers": VERTICES + b"v 1 2\nf 1 2 3\n",
    "no number": VERTICES + b"v\nf 1 2 3\n",
    "no corners": VERTICES + b"f\nf 1 2 3\n",
    "one texture coordinate": VERTICES + b"vt 1\nf 1/1 2/1 3/1\n",
    "many digits": VERTICES + b"v 0.12345678901234567890 1 1\nf 1 2 5\n",
    "a tiny number": VERTICES + b"v 1e-30 1 1\nf 1 2 5\n",
    "a large number": VERTICES + b"v 1e39 1 1\nf 1 2 5\n",
    "not a number": VERTICES + b"v nan 1 1\nf 1 2 5\n",
    "a sign": VERTICES + b"v +1 1 1\nf +1 2 5\n",
    "an underscore": VERTICES + b"v 1_0 1 1\nf 1 2 5\n",
    "half an exponent": VERTICES + b"v 1e 1 1\nf 1 2 5\n",
    "only a point": VERTICES + b"v . 1 1\nf 1 2 5\n",
    "two points": VERTICES + b"v 1.2.3 1 1\nf 1 2 5\n",
    "index 0": VERTICES + b"f 0 1 2\n",
    "no texture coordinate 0": ALL + b"f 1/0 2/0 3/0\n",
    "beyond the last": VERTICES + b"f 1 2 5\n",
    "before the first": VERTICES + b"f 1 2 -5\n",
    "none before the first": ALL + b"f 1/-3 2/-3 3/-3\n",
    "a huge index": VERTICES + b"f 1 2 99999999999999999999999\n",
    "an unknown normal": ALL + b"f 1//1 2//1 3//3\n",
    "a fraction": VERTICES + b"f 1 2 3.0\n",
    "a slash at the end": ALL + b"f 1/ 2/ 3/\n",
    "two slashes at the end": ALL + b"f 1// 2// 3//\n",
    "a slash after a texture coordinate": ALL + b"f 1/1/ 2/2/ 3/1/\n",
    "three slashes": ALL + b"f 1/1//1 2/2//1 3/1//1\n",
    "four entries": ALL + b"f 1/1/1/1 2/2/1/1 3/1/1/1\n",
    "no position": ALL + b"f /1 /2 /1\n",
    "a form feed": VERTICES + b"\x0cf 1 2 3\n",
    "a form feed between": VERTICES + b"v 1\x0c2 3 4\nf 1\x0b2 3\n",
    "a zero byte": VERTICES + b"v 1\x002 3 4\nf 1 2 3\n",
}


def outcome(file: Path) -> Any:
    """What reading a file gives: the arrays, or the words of the error."""
    try:
        mesh = obj.read_obj_visual(file)
    except DescriptionError as error:
        return str(error)
    assert isinstance(mesh, RenderMesh)
    arrays = (mesh.positions, mesh.normals, mesh.uvs, mesh.triangles)
    return [(it.shape, it.dtype, it.tobytes()) for it in arrays], mesh.texture_file, mesh.material_rgba


def assert_same_in_python(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    ours = outcome(file)
    with monkeypatch.context() as patch:
        patch.setattr(obj, "read_plain_obj", lambda data: None)
        assert outcome(file) == ours


def read(data: bytes) -> object:
    """The plain file, prepared as `read_obj_visual` does; None if it needs more detail."""
    return read_plain_obj(data.removeprefix(b"\xef\xbb\xbf").replace(b"\r\n", b"\n") + b"\n")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "a.mtl").write_text("newmtl a\nKd 1 0 0\nmap_Kd a.png\nnewmtl b\nKd 0 1 0\n")
    return tmp_path


@pytest.mark.parametrize("data", list(PLAIN.values()), ids=list(PLAIN))
def test_plain_files_are_read_as_in_python(
    data: bytes, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (folder / "mesh.obj").write_bytes(data)
    assert read(data) is not None
    assert_same_in_python(folder / "mesh.obj", monkeypatch)


@pytest.mark.parametrize("data", list(DETAILED.values()), ids=list(DETAILED))
def test_other_files_are_left_to_python(data: bytes, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (folder / "mesh.obj").write_bytes(data)
    assert read(data) is None
    assert_same_in_python(folder / "mesh.obj", monkeypatch)


@each("file", sorted(DATA.rglob("*.obj")), ids=lambda file: file.relative_to(DATA).as_posix())
def test_shipped_files_are_plain(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert read(file.read_bytes()) is not None
    assert_same_in_python(file, monkeypatch)


def test_numbers_are_those_of_python() -> None:
    source = random.Random(1)
    forms = ("%.6f", "%.3f", "%g", "%.9g", "%.15g", "%.4e", "%.0f", "%d", "%.8f", "%.10E")
    words = [
        source.choice(forms) % (source.uniform(-1, 1) * 10 ** source.uniform(-6, 6)) for _ in range(6000)
    ]
    words += ["-0", "-0.0", ".5", "5.", "-.25", "007", "0.1", "1E+5", "1e22", "1e-22", "100000000000000e8"]
    words += ["900719925474099", "900719925474099e22", "900719925474099e-22", "9007199254740989", "0.3e-1"]
    lines = ["v 1 1 " + word for word in words]
    plain = read_plain_obj(("\n".join(lines) + "\n").encode())
    assert plain is not None
    expected = np.array(list(map(float, words)))
    np.testing.assert_array_equal(plain.positions[:, 2].view(np.int64), expected.view(np.int64))


@pytest.mark.parametrize("seed", range(20))
def test_damaged_files_are_read_as_in_python(
    seed: int, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    source = random.Random(seed)
    file = folder / "mesh.obj"
    for _ in range(25):
        data = bytearray(source.choice(list(PLAIN.values())))
        for _ in range(source.randint(1, 4)):
            at = source.randrange(len(data) + 1)
            data[at : at + source.randint(0, 2)] = source.choice(
                [
                    b"/",
                    b"//",
                    b" ",
                    b"\n",
                    b"-",
                    b"1",
                    b"9",
                    b"f ",
                    b"v ",
                    b".",
                    b"e",
                    b"g",
                    b"\t",
                    b"0",
                    b"\x0b",
                ]
            )
        file.write_bytes(data)
        assert_same_in_python(file, monkeypatch)


@pytest.mark.parametrize("count", [0, 1, 500])
def test_distinct_corners_are_sorted(count: int) -> None:
    corners = np.random.default_rng(1).integers([0, -1, -1], [20, 3, 1], (count, 3))
    first, numbers = distinct_corners(corners, (20, 3, 1))
    distinct, expected = np.unique(corners, axis=0, return_index=True)
    np.testing.assert_array_equal(first, expected)
    np.testing.assert_array_equal(distinct[numbers], corners)
