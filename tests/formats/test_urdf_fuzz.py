"""Damaged robot and mesh files: each either loads, with finite numbers, or is refused by name."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from load_cases import DATA
from tests.thorough.profiles import cases

from carom.errors import DescriptionError
from carom.formats.search import AssetSearch
from carom.formats.urdf.reader import parse_urdf
from carom.layouts.flags import LoadFlags
from carom.meshes.collada import read_collada
from carom.meshes.obj import read_obj
from carom.meshes.stl import read_stl
from carom.model.assemble import assemble
from carom.model.body_spec import BASE, BodySpec

SHIPPED = Path(__file__).parents[2] / "src" / "pybullet_data"
LARGEST = 15_000
"""Larger files hold more of the same and cost time."""

ROBOTS = [
    file for file in sorted([*DATA.glob("*.urdf"), *SHIPPED.rglob("*.urdf")]) if file.stat().st_size < LARGEST
]
CONTENTS = [file.read_bytes() for file in ROBOTS]

NASTY = [
    *(b"", b"0", b"-1", b"1e308", b"-1e400", b"nan", b"inf", b"-inf", b"1e-320", b"0x10", b"1_0", b"9" * 400),
    *(b"1 2", b"1 2 3", b"0 0 0", b"1e30 1e30 1e30", b"nan 0 0", b"${x}", b"abc", b"\xff\xfe", b"\0"),
    *(b"<", b">", b"/", b"/>", b"</", b"<!--", b"-->", b"<![CDATA[", b"]]>", b"<?xml?>", b"&", b"&#0;"),
    *(b'"', b"'", b"=", b"\n", b'<!DOCTYPE x [<!ENTITY y "z">]>', b"&y;", b"<robot>", b"</robot>"),
    *(b"<link/>", b'<link name="a"/>', b"</link>", b"<joint/>", b"<inertial>", b"<limit/>", b"<origin/>"),
    *(b"base", b"world", b"fixed", b"floating", b"spherical", b"planar", b"prismatic", b"revolute"),
    *(b"../../../../etc/passwd", b"/dev/zero", b"meshes/", b"package://", b".obj", b"x" * 5000),
]

ELEMENT = re.compile(rb"<(\w+)[^<>]*?(?:/>|>[^<]*</\1>)")
VALUE = re.compile(rb'"[^"]*"')

# A mutation: what is done, where and how far (as fractions of the length), and with what.
TEXT = st.sampled_from(["delete", "double", "insert", "replace", "swap", "cut", "flip"])
STRUCTURE = st.sampled_from(["value", "drop element", "double element", "move element"])
MUTATIONS = st.one_of(
    [
        st.lists(
            st.tuples(
                kinds, st.floats(0.0, 1.0, exclude_max=True), st.floats(0.0, 0.1), st.sampled_from(NASTY)
            ),
            min_size=1,
            max_size=most,
        )
        for kinds, most in ((TEXT, 2), (STRUCTURE, 6), (STRUCTURE, 2))
    ]
)
FLAGS = st.sampled_from(
    [
        LoadFlags.NONE,
        LoadFlags.USE_INERTIA_FROM_FILE,
        LoadFlags.MERGE_FIXED_LINKS,
        LoadFlags.MERGE_FIXED_LINKS | LoadFlags.USE_INERTIA_FROM_FILE | LoadFlags.MAINTAIN_LINK_ORDER,
    ]
)
PATIENT = {"deadline": None, "suppress_health_check": [HealthCheck.too_slow]}


def mutated(data: bytes, mutations: list[tuple[str, float, float, bytes]]) -> bytes:
    for kind, where, share, token in mutations:
        start = int(where * len(data))
        end = start + max(1, int(share * len(data)))
        piece = data[start:end]
        if kind == "delete":
            data = data[:start] + data[end:]
        elif kind == "double":
            data = data[:end] + data[start:]
        elif kind == "insert":
            data = data[:start] + token + data[start:]
        elif kind == "replace":
            data = data[:start] + token + data[end:]
        elif kind == "swap":
            other = data[end : end + len(piece)]
            data = data[:start] + other + piece + data[end + len(piece) :]
        elif kind == "cut":
            data = data[:start]
        elif kind == "flip" and piece:
            data = data[:start] + bytes([piece[0] ^ 1 << len(token) % 8]) + data[start + 1 :]
        elif kind == "value" and (found := VALUE.search(data, start)):
            data = data[: found.start() + 1] + token + data[found.end() - 1 :]
        elif kind.endswith("element") and (found := ELEMENT.search(data, start)):
            rest = data[: found.start()] + data[found.end() :]
            there = rest.find(b"<", int(share * 10 * len(rest)))
            if kind == "drop element":
                data = rest
            elif kind == "double element":
                data = data[: found.end()] + found.group() + data[found.end() :]
            elif there >= 0:
                data = rest[:there] + found.group() + rest[there:]
    return data


def numbers(body: BodySpec) -> Iterator[float]:
    for link in (body.base, *body.links):
        yield from (
            link.mass,
            link.damping,
            link.friction,
            link.lower,
            link.upper,
            link.effort,
            link.velocity,
        )
        for values in (link.inertia, link.joint_axis):
            yield from values
        for pose in (link.inertial_frame, link.joint_frame):
            yield from (*pose.position, *pose.orientation)


@pytest.mark.parametrize("part", range(4))
@settings(max_examples=cases(200), **PATIENT)
@given(st.integers(0, len(ROBOTS) - 1), MUTATIONS, FLAGS, st.booleans())
def test_damaged_robots_load_or_are_refused(
    part: int,
    index: int,
    mutations: list[tuple[str, float, float, bytes]],
    flags: LoadFlags,
    fixed_base: bool,
) -> None:
    file = ROBOTS[index]
    try:
        robot, _ = parse_urdf(mutated(CONTENTS[index], mutations), file, scale=1.5, search=AssetSearch())
        body = assemble(robot, flags=flags, fixed_base=fixed_base)
    except DescriptionError as error:
        assert error.file is not None
        assert error.reason
        return
    assert all(map(math.isfinite, numbers(body)))
    assert all(BASE <= link.parent < index for index, link in enumerate(body.links))
    assert len({link.name for link in (body.base, *body.links)}) == len(body.links) + 1


@pytest.mark.parametrize(
    ("name", "reader"), [("two_boxes.obj", read_obj), ("wedge.stl", read_stl), ("wedge.dae", read_collada)]
)
@settings(max_examples=cases(60), **PATIENT)
@given(mutations=MUTATIONS)
def test_damaged_meshes_are_read_or_refused(name: str, reader, mutations) -> None:  # type: ignore[no-untyped-def]
    file = DATA / "meshes" / name
    try:
        parts = reader(mutated(file.read_bytes(), mutations), file)
    except DescriptionError as error:
        assert error.file == file
        return
    for part in parts:
        assert part.vertices.shape[1:] == part.triangles.shape[1:] == (3,)
        assert 0 <= part.triangles.min() <= part.triangles.max() < len(part.vertices)
