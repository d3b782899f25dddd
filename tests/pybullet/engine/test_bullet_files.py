"""Files of saveBullet that PyBullet wrote: what restoreState takes from them."""

from __future__ import annotations

import json
import struct
from collections.abc import Iterator, Sequence
from pathlib import Path
from random import Random
from typing import Any

import numpy as np
import pytest
from tests.fuzz.damage import damaged
from tests.pybullet.engine.bullet_scenes import ANSWERS, FILES, SCENES, run, told

import carom
import pybullet as p
from carom.errors import DescriptionError, StateError
from carom.formats.bullet import read_bullet_state

RECORDED = json.loads(ANSWERS.read_text())
CASES = 400


@pytest.fixture(autouse=True)
def _connection() -> Iterator[None]:
    p.connect(p.DIRECT)
    yield
    p.disconnect()


def flat(answers: Any) -> list[float]:
    if isinstance(answers, (list, tuple)):
        return [number for part in answers for number in flat(part)]
    return [answers]


def close(answers: list[Any], wanted: list[Any], tolerance: float) -> None:
    """Poses of link frames, the last two, have single precision in PyBullet."""
    bodies = zip(answers, wanted, strict=True)
    for (*own, links), (*theirs, recorded) in bodies:
        np.testing.assert_allclose(flat(own), flat(theirs), rtol=0, atol=tolerance)
        np.testing.assert_allclose(flat(links), flat(recorded), rtol=0, atol=1e-6)


def without_motors() -> None:
    for serial in range(p.getNumBodies()):
        body = p.getBodyUniqueId(serial)
        for joint in range(p.getNumJoints(body)):
            p.setJointMotorControl2(body, joint, p.VELOCITY_CONTROL, force=0)


@pytest.mark.parametrize("name", SCENES)
def test_bodies_are_where_pybullet_puts_them_and_go_on_alike(name: str) -> None:
    SCENES[name]()
    without_motors()
    p.restoreState(fileName=str(FILES / f"{name}.bullet"))
    close(told(), RECORDED[name]["restored"], 1e-14)
    later, recorded = run(), RECORDED[name]["later"]
    if name == "arms":
        close(later, recorded, 1e-12)
    # Bodies with maximal coordinates, which air does not slow, turn a little differently in PyBullet.
    for own, theirs in zip(later, recorded, strict=True):
        for kind in (0, 1):
            np.testing.assert_allclose(own[kind][0], theirs[kind][0], rtol=0, atol=1e-12)


def test_a_world_of_the_modern_interface_restores_them_too() -> None:
    world = carom.World()
    for position, fixed in (((0, 0, 2), False), ((3, 0, 2), True)):
        world.load_urdf(FILES / "arm.urdf", position, fixed_base=fixed)
    with pytest.raises(StateError, match=r"^the world has 2 bodies with reduced .* the state of 3$"):
        world.restore(FILES / "arms.bullet")
    box = world.load_urdf(FILES / "arm.urdf")
    with pytest.raises(StateError, match=r"^body 0 has 4 joints; it had 0 when PyBullet saved it$"):
        world.restore(FILES / "arms.bullet")
    world.remove(box.id)
    with pytest.raises(DescriptionError, match="of 3 bodies with reduced and of 0 with maximal coord"):
        world.load(FILES / "arms.bullet")


def test_another_number_of_bodies_is_an_error_and_changes_nothing() -> None:
    SCENES["maximal"]()
    before = told()
    with pytest.raises(
        p.error, match="The world has 2 bodies with reduced coordinates; PyBullet saved the state of 3"
    ):
        p.restoreState(fileName=str(FILES / "arms.bullet"))
    p.removeBody(3)
    with pytest.raises(p.error, match=r"^Couldn't restore state\. The world has 1 bodies with maximal"):
        p.restoreState(fileName=str(FILES / "maximal.bullet"))
    p.loadURDF(str(FILES / "arm.urdf"), useMaximalCoordinates=True)
    with pytest.raises(p.error, match="Body 3 has joints and was loaded with maximal coordinates"):
        p.restoreState(fileName=str(FILES / "maximal.bullet"))
    p.removeBody(3)
    assert told() == before[:3]


def test_contacts_are_found_at_the_next_step() -> None:
    SCENES["maximal"]()
    p.resetBasePositionAndOrientation(0, [0, 0, 0], [0, 0, 0, 1])
    p.resetBasePositionAndOrientation(1, [0.1, 0, 0], [0, 0, 0, 1])
    p.stepSimulation()
    assert p.getContactPoints(0, 1)
    p.restoreState(fileName=str(FILES / "maximal.bullet"))
    assert not p.getContactPoints()


def test_load_bullet_says_what_such_files_do_not_contain() -> None:
    message = r"^Couldn't load \.bullet file\. .*PyBullet wrote .* of 2 bodies with reduced and of 2 with"
    with pytest.raises(p.error, match=message):
        p.loadBullet(str(FILES / "maximal.bullet"))
    assert p.getNumBodies() == 0


def harmed(content: bytes, random: Random) -> bytes:
    """The content cut, with bits turned, or with a length or count that is far too large or negative."""
    if random.random() < 0.3:
        return damaged(content, random)
    if random.random() < 0.5:
        # In the first chunks or in the description, where most structure is.
        place = random.choice((random.randrange(600), len(content) - random.randrange(1, 13_000)))
    else:
        place = random.randrange(len(content) - 8)
    place -= place % 4
    huge = random.choice((1 << 31, (1 << 31) - 1, (1 << 32) - 1, 0, 1 << 20, 0x7FFFFFFF00000000))
    width = 8 if huge >> 32 else 4
    return content[:place] + huge.to_bytes(width, "little") + content[place + width :]


@pytest.mark.parametrize("name", SCENES)
def test_damaged_files_do_no_harm(name: str, tmp_path: Path) -> None:
    random = Random(name)
    content = (FILES / f"{name}.bullet").read_bytes()
    file = tmp_path / "damaged.bullet"
    SCENES[name]()
    start = p.saveState()
    before, outcomes = told(), set()
    for _ in range(CASES):
        file.write_bytes(harmed(content, random))
        try:
            p.restoreState(fileName=str(file))
        except p.error as problem:
            assert str(problem).startswith("Couldn't restore state. ")
            assert told() == before
            outcomes.add("refused")
        else:
            # What was damaged is not part of the state, or is a number that is as good as another.
            assert np.isfinite(flat(told())).all()
            p.restoreState(start)
            outcomes.add("restored")
    assert outcomes == {"refused", "restored"}


TYPES = ("int", "float", "double", "Vector", "Matrix", "Transform", "Object", "Rigid", "Link", "Body")


def written(order: str, pointer: int, number: str) -> bytes:
    """A file with one body of each kind and a robot's link, as other builds of Bullet would write it."""
    kind = {"f": "float", "d": "double"}[number]
    structures = {
        "Vector": [(kind, "m_floats[4]")],
        "Matrix": [("Vector", "m_el[3]")],
        "Transform": [("Matrix", "m_basis"), ("Vector", "m_origin")],
        "Object": [("Transform", "m_worldTransform"), ("int", "m_uniqueId")],
        "Rigid": [
            ("Object", "m_collisionObjectData"),
            ("Vector", "m_linearVelocity"),
            ("Vector", "m_angularVelocity"),
        ],
        "Link": [
            ("int", "m_dofCount"),
            ("int", "m_posVarCount"),
            (kind, "m_jointPos[7]"),
            (kind, "m_jointVel[6]"),
        ],
        "Body": [
            ("Vector", "m_baseWorldPosition"),
            ("Vector", "m_baseWorldOrientation"),
            ("Vector", "m_baseLinearVelocity"),
            ("Vector", "m_baseAngularVelocity"),
            ("int", "m_numLinks"),
            ("Link", "*m_links"),
        ],
    }
    names = sorted({name for members in structures.values() for _, name in members})
    sizes = {"int": 4, "float": 4, "double": 8}
    for name, members in structures.items():
        counts = [int(called.partition("[")[2][:-1] or 1) for _, called in members]
        sizes[name] = sum(
            count * (pointer if called.startswith("*") else sizes[of])
            for count, (of, called) in zip(counts, members, strict=True)
        )

    def pack(layout: str, *numbers: float | bytes) -> bytes:
        return struct.pack(order + layout, *numbers)

    def aligned(part: bytes) -> bytes:
        return part + bytes(-len(part) % 4)

    def table(tag: bytes, texts: Sequence[str]) -> bytes:
        return aligned(tag + pack("i", len(texts)) + b"".join(text.encode() + b"\0" for text in texts))

    description = b"SDNA" + table(b"NAME", names) + table(b"TYPE", TYPES)
    description += aligned(b"TLEN" + pack(f"{len(TYPES)}h", *(sizes[name] for name in TYPES)))
    description += b"STRC" + pack("i", len(structures))
    for name, members in structures.items():
        description += pack("hh", TYPES.index(name), len(members))
        for of, called in members:
            description += pack("hh", TYPES.index(of), names.index(called))

    def chunk(code: bytes, address: int, structure: str, data: bytes) -> bytes:
        number_of = list(structures).index(structure) if structure else -1
        size_of = {4: "I", 8: "Q"}[pointer]
        return pack(f"4si{size_of}ii", code, len(data), address, number_of, 1) + data

    vector = f"4{number}"
    body = pack(vector, 1, 2, 3, 0) + pack(vector, 0, 0, 0.6, 0.8)
    body += (
        pack(vector, 4, 5, 6, 0)
        + pack(vector, 7, 8, 9, 0)
        + pack("i", 1)
        + pack({4: "I", 8: "Q"}[pointer], 77)
    )
    link = pack("ii", 1, 1) + pack(f"7{number}", 0.25, *6 * [0]) + pack(f"6{number}", -0.5, *5 * [0])
    turned = pack(vector, 0, -1, 0, 0) + pack(vector, 1, 0, 0, 0) + pack(vector, 0, 0, 1, 0)
    rigid = turned + pack(vector, -1, -2, -3, 0) + pack("i", 5)
    rigid += pack(vector, 1, 0, 0, 0) + pack(vector, 0, 1, 0, 0)
    assert (len(body), len(link), len(rigid)) == (sizes["Body"], sizes["Link"], sizes["Rigid"])
    header = f"BULLET{number}{'_' if pointer == 4 else '-'}{'v' if order == '<' else 'V'}326".encode()
    return header + b"".join(
        (
            chunk(b"MBDY", 66, "Body", body),
            chunk(b"ARAY", 77, "Link", link),
            chunk(b"RBDY", 88, "Rigid", rigid),
            chunk(b"DNA1", 99, "", description),
        )
    )


@pytest.mark.parametrize("order", ["<", ">"])
@pytest.mark.parametrize("pointer", [4, 8])
@pytest.mark.parametrize("number", ["f", "d"])
def test_files_of_other_builds_of_bullet_can_be_read(order: str, pointer: int, number: str) -> None:
    state = read_bullet_state(written(order, pointer, number), Path("other.bullet"))
    (body,), (rigid,) = state.multi_bodies, state.rigid_bodies
    assert (body.position, body.linear, body.angular) == ((1, 2, 3), (4, 5, 6), (7, 8, 9))
    assert body.orientation == pytest.approx((0, 0, 0.6, 0.8))
    assert [(link.position, link.velocity) for link in body.links] == [((0.25,), (-0.5,))]
    assert (rigid.number, rigid.position) == (5, (-1, -2, -3))
    assert rigid.orientation == pytest.approx((0, 0, 0.5**0.5, 0.5**0.5))
    assert (rigid.linear, rigid.angular) == ((1, 0, 0), (0, 1, 0))


def test_files_say_how_they_are_damaged() -> None:
    good = written("<", 8, "d")
    path = Path("other.bullet")
    for content, reason in (
        (good[:300], "has 112 bytes, but 100 are left"),
        (good[:6] + b"x" + good[7:], "its header .* is not one of Bullet's"),
        (good[:12], "it ends before the description of its structures"),
        (good.replace(b"STRC", b"STRX"), "has b'STRX' where b'STRC' is expected"),
        (
            good.replace(b"m_numLinks", b"m_numLimbs"),
            "Body has no member m_numLinks; .*another version of Bullet",
        ),
        (good.replace(b"m_jointPos[7]", b"m_jointPos[9]"), "says that Link has 112 bytes, but .* have 128"),
        (
            good.replace(struct.pack("<d", 0.8), struct.pack("<d", 0.9)),
            "m_baseWorldOrientation is not a rotation",
        ),
        (
            good.replace(struct.pack("<d", 9), struct.pack("<d", np.inf)),
            "m_baseAngularVelocity has a number that is",
        ),
        (
            good.replace(struct.pack("<Q", 77), struct.pack("<Q", 78), 1),
            "m_links leads to 0 structures instead of 1",
        ),
    ):
        assert content != good
        with pytest.raises(DescriptionError, match=reason):
            read_bullet_state(content, path)
