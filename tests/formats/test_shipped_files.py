"""Every robot file that ships, converted to URDF, and in a scene that is saved as a script."""

from __future__ import annotations

from pathlib import Path

import pytest
from pybullet_view import dynamics_infos, joint_infos, with_plain_capsules
from test_scenes_against_oracle import differences
from tests.each import each

import pybullet as p
import pybullet_data
from carom.errors import DescriptionError
from carom.formats.any_file import read_robots
from carom.formats.urdf import read_urdf
from carom.formats.urdf_writer import urdf_text
from carom.layouts.flags import LoadFlags
from carom.model.assemble import assemble

DATA = Path(pybullet_data.getDataPath())
FILES = sorted(file for pattern in ("**/*.urdf", "**/*.sdf", "mjcf/*.xml") for file in DATA.glob(pattern))
RIGID = [file for file in FILES if b"deformable" not in file.read_bytes()]
LOADERS = {".urdf": "loadURDF", ".sdf": "loadSDF", ".xml": "loadMJCF"}


@each("file", FILES, ids=lambda file: str(file.relative_to(DATA)))
def test_as_urdf_it_is_the_same_robot(file: Path, tmp_path: Path) -> None:
    for placed in read_robots(file)[1]:
        target = tmp_path / "robot.urdf"
        try:
            target.write_text(urdf_text(placed.robot, tmp_path), encoding="utf-8")
        except DescriptionError as problem:
            # Shapes that URDF has no word for; the error names them.
            assert "URDF cannot say" in str(problem) or placed.robot.deformable is not None
            continue
        again = read_urdf(target)
        for flags in (LoadFlags.NONE, LoadFlags.USE_INERTIA_FROM_FILE):
            robots = (with_plain_capsules(placed.robot), again)
            before, after = (assemble(robot, flags=flags) for robot in robots)
            assert differences(joint_infos(after), joint_infos(before)) == []
            assert differences(dynamics_infos(after), dynamics_infos(before)) == []


def saved_again(file: Path, folder: Path) -> None:
    first, second = p.connect(p.DIRECT), p.connect(p.DIRECT)
    try:
        getattr(p, LOADERS[file.suffix])(str(file), physicsClientId=first)
        p.setGravity(0, 0, -10, first)
        script = folder / "scene.py"
        p.saveWorld(str(script), first)
        _, _, calls = script.read_text().partition("bodies = {}")
        exec(calls, {"p": _Bound(second), "bodies": {}})
        assert told(second) == told(first)
    finally:
        p.disconnect(first)
        p.disconnect(second)


@each("file", RIGID[::10], ids=lambda file: str(file.relative_to(DATA)))
def test_a_saved_scene_has_it_again(file: Path, tmp_path: Path) -> None:
    saved_again(file, tmp_path)


@pytest.mark.long
@each("file", RIGID, ids=lambda file: str(file.relative_to(DATA)))
def test_every_saved_scene_has_it_again(file: Path, tmp_path: Path) -> None:
    saved_again(file, tmp_path)


class _Bound:
    """The module with another client than 0 where none is named."""

    def __init__(self, client: int) -> None:
        self._client = client

    def __getattr__(self, name: str) -> object:
        found = getattr(p, name)
        if not callable(found):
            return found
        return lambda *given, **named: found(*given, **{"physicsClientId": self._client, **named})


def told(client: int) -> list[tuple[object, ...]]:
    """What can be read of all bodies."""
    bodies = [p.getBodyUniqueId(index, client) for index in range(p.getNumBodies(client))]
    return [
        (
            p.getBodyInfo(body, client),
            p.getBasePositionAndOrientation(body, client),
            [p.getJointInfo(body, joint, client) for joint in range(p.getNumJoints(body, client))],
            [p.getDynamicsInfo(body, link, client) for link in range(-1, p.getNumJoints(body, client))],
            [
                p.getJointStateMultiDof(body, joint, client)[:2]
                for joint in range(p.getNumJoints(body, client))
            ],
        )
        for body in bodies
    ]
