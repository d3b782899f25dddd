"""Small files that ask for much, or that readers stumble over, by what is wrong with them."""

from __future__ import annotations

import json
import struct
import zlib
from collections.abc import Callable
from pathlib import Path

Files = dict[str, str | bytes]


def png(width: int, height: int, data: bytes | None = None) -> bytes:
    """A grey image, black unless there is other data."""

    def chunk(name: bytes, content: bytes) -> bytes:
        return (
            struct.pack(">I", len(content)) + name + content + struct.pack(">I", zlib.crc32(name + content))
        )

    header = struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0)
    packed = zlib.compress(bytes((width + 1) * height) if data is None else data, 9)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", packed) + chunk(b"IEND", b"")


def hfield(attributes: str) -> str:
    """An MJCF file with a height field."""
    return (
        f'<mujoco><asset><hfield name="h" {attributes} size="1 1 1 1"/></asset>'
        '<worldbody><geom type="hfield" hfield="h"/></worldbody></mujoco>'
    )


def mesh(attributes: str, geom: str = 'type="mesh"', compiler: str = "") -> str:
    """An MJCF file with a mesh."""
    return (
        f'<mujoco>{compiler}<asset><mesh name="m" {attributes}/></asset><worldbody><body><freejoint/>'
        f'<geom {geom} mesh="m"/></body></worldbody></mujoco>'
    )


def urdf(file: str) -> str:
    """A robot whose shape is that of a mesh file."""
    shape = f'<geometry><mesh filename="{file}"/></geometry>'
    return f'<robot name="r"><link name="b"><collision>{shape}</collision></link></robot>'


def xacro(content: str) -> str:
    """A robot with macros."""
    return f'<robot name="r" xmlns:xacro="http://ros.org/wiki/xacro">{content}<link name="a"/></robot>'


def ply(header: str, rows: str = "0 0 0 1 0 0 0 1 0 3 0 1 2") -> str:
    """A PLY file with these further lines in its header."""
    vertices = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
    faces = "element face 1\nproperty list uchar int vertex_indices\n"
    return f"ply\nformat ascii 1.0\n{vertices}{faces}{header}end_header\n{rows}\n"


def gltf(count: int) -> str:
    """A glTF file whose accessor has no buffer view, so that its numbers are zeros."""
    accessor = {"componentType": 5126, "type": "VEC3", "count": count}
    primitive = {"attributes": {"POSITION": 0}}
    return json.dumps(
        {
            "asset": {"version": "2.0"},
            "accessors": [accessor],
            "meshes": [{"primitives": [primitive]}],
            "nodes": [{"mesh": 0}],
        }
    )


def attaching(depth: int, times: int) -> Files:
    """Models that attach the next one several times each; the last has nothing in its world."""
    files: Files = {}
    for level in range(depth):
        models = f'<model name="n" file="m{level + 1}.xml"/>'
        attach = "".join(f'<attach model="n" prefix="{level}{place}_"/>' for place in range(times))
        files[f"m{level}.xml"] = f"<mujoco><asset>{models}</asset><worldbody>{attach}</worldbody></mujoco>"
    files[f"m{depth}.xml"] = "<mujoco><worldbody/></mujoco>"
    return files


def _copies(count: int, inside: str) -> str:
    return f'<replicate count="{count}">{inside}</replicate>'


_CUBE = "0 0 0 2 0 0 2 1 0 1 1 0 1 {} 0 0 2 0 0 0 1 2 0 1 2 1 1 1 1 1 1 2 1 0 2 1"
_FACES = (
    "0 2 1 0 3 2 0 4 3 0 5 4 6 7 8 6 8 9 6 9 10 6 10 11 0 1 7 0 7 6 1 2 8 1 8 7 2 3 9 2 9 8 3 4 10 3 10 9 "
    "4 5 11 4 11 10 5 0 6 5 6 11"
)
_SENSOR = (
    '<mujoco><worldbody><body name=""><joint name="j"/><geom size=".1"/><site name=""/></body></worldbody>'
    "<sensor>{}</sensor></mujoco>"
)

GREEDY: dict[str, Callable[[], Files]] = {
    "PNG of 9,000 x 9,000": lambda: {
        "a.xml": hfield('file="h.png"'), "h.png": png(9_000, 9_000, b"\0" * 1000)
    },
    "heights that no program sets": lambda: {"a.xml": hfield('nrow="40000" ncol="40000"')},
    "cone": lambda: {"a.xml": mesh('builtin="cone" params="1e30 .5"')},
    "plate": lambda: {"a.xml": mesh('builtin="plate" params="1e9 1e9"')},
    "wedge": lambda: {"a.xml": mesh('builtin="wedge" params="1e9 1e9 90 90 0"')},
    "PLY of many rows": lambda: {
        "a.urdf": urdf("m.ply"), "m.ply": ply("element x 4000000000\nproperty float y\n")
    },
    "glTF without a buffer view": lambda: {"a.urdf": urdf("m.gltf"), "m.gltf": gltf(1 << 40)},
    "nested copies of nothing": lambda: {
        "a.xml": f"<mujoco><worldbody>{_copies(99_999, _copies(99_999, ''))}</worldbody></mujoco>"
    },
    "models attached again and again": lambda: {**attaching(12, 4), "a.xml": '<mujoco><asset><model name="n" '
        'file="m0.xml"/></asset><worldbody><attach model="n" prefix="p"/></worldbody></mujoco>'},
    "pattern of files": lambda: {
        "a.xacro": xacro('<xacro:include filename="' + "*/../" * 60 + '*.none"/>'),
        **{f"d{number}/x": "" for number in range(6)},
    },
    "includes within includes": lambda: {
        **{f"{n}.xml": '<mujoco>' + f'<include file="{n + 1}.xml"/>' * 8 + "</mujoco>" for n in range(1, 12)},
        "12.xml": "<mujoco/>", "a.xml": '<mujoco><include file="1.xml"/></mujoco>',
    },
}  # fmt: skip
"""What would take gigabytes or hours."""

STUMBLING: dict[str, Callable[[], Files]] = {
    "broken PNG": lambda: {"a.xml": hfield('file="h.png"'), "h.png": b"\x89PNG\r\n\x1a\nxxxx"},
    "PNG that is cut off": lambda: {"a.xml": hfield('file="h.png"'), "h.png": png(100, 100)[:60]},
    "PNG of one pixel": lambda: {"a.xml": hfield('file="h.png"'), "h.png": png(1, 1)},
    "PNG of one row": lambda: {"a.xml": hfield('file="h.png"'), "h.png": png(5, 1)},
    "priority": lambda: {
        "a.xml": '<mujoco><worldbody><body><freejoint/><geom size=".1" priority="2147483647"/></body>'
        "</worldbody></mujoco>"
    },
    "face": lambda: {
        "a.xml": mesh(f'vertex="{_CUBE.format(2)}" face="{_FACES.replace("11", "4294967296")}"')
    },
    "solid without extent": lambda: {
        "a.xml": mesh(
            f'vertex="{_CUBE.format(4294967296)}" face="{_FACES}"', 'type="capsule"',
            '<compiler fitaabb="false"/>',
        )
    },
    "sensor of no name": lambda: {
        "a.xml": _SENSOR.format('<framepos objtype="body" objname=""/>')
    },
    "sensor of a site of no name": lambda: {"a.xml": _SENSOR.format('<touch site=""/>')},
    "index of infinity": lambda: {
        "a.urdf": urdf("m.ply"), "m.ply": ply("", "0 0 0 1 0 0 0 1 0 3 0 1 inf")
    },
    "name of 5,000 letters": lambda: {
        "a.xacro": xacro(f'<xacro:include filename="{"a" * 5000}"/>')
    },
}  # fmt: skip
"""What made other libraries, or arithmetic, raise exceptions of their own."""


def written(files: Files, folder: Path) -> Path:
    """Writes files; returns that called `a`, which is to be loaded."""
    for name, content in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return next(folder / name for name in files if name.startswith("a."))
