"""Arguments, tables, shared numbers, world files and saved weights."""

from __future__ import annotations

import json
import runpy
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import pybullet as p
from pybullet_envs.deep_mimic.env.motion_capture_data import MotionCaptureData
from pybullet_envs.kerasrl_utils import get_fields, get_latest_save
from pybullet_utils import gazebo_world_parser, mpi_util
from pybullet_utils.arg_parser import ArgParser
from pybullet_utils.logger import Logger


def test_arguments(tmp_path: Path) -> None:
    arguments = ArgParser()
    words = ["lost", "--name", "walk.txt", "--bodies", "1", "2", "#3", "3", "--rate", "0.5"]
    words += ["--on", "T", "--flags", "1", "no", "true"]
    assert arguments.load_args(words)
    assert arguments.parse_string("name") == "walk.txt"
    assert arguments.parse_ints("bodies") == [1, 2, 3]
    assert arguments.parse_float("rate") == 0.5
    assert arguments.parse_bool("on")
    assert arguments.parse_bools("flags") == [True, False, True]
    assert (arguments.parse_int("none", 7), arguments.parse_strings("none")) == (7, [])
    file = tmp_path / "arguments.txt"
    file.write_text("# a comment --name other\n--name later\n--more 4\n", encoding="utf-8")
    assert arguments.load_file(str(file))
    # What came first stays.
    assert (arguments.parse_string("name"), arguments.parse_int("more")) == ("walk.txt", 4)
    arguments.clear()
    assert not arguments.has_key("name")


def test_tables(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "deep" / "log.txt"
    logger = Logger()
    logger.configure_output_file(str(file))
    for number in range(2):
        logger.log_tabular("Iteration", number)
        logger.log_tabular("Return", 0.123456 * number)
        logger.print_tabular()
        logger.dump_tabular()
    assert logger.get_num_keys() == 2
    table = np.genfromtxt(file, names=True)
    assert table["Return"] == pytest.approx([0.0, 0.123456])
    assert file.read_text(encoding="utf-8").splitlines()[1] == f"{'0':<25}{'0.0':<25}"
    assert f"| {'Return':>15} | {'   0.123':>15} |" in capsys.readouterr().out
    with pytest.raises(AssertionError, match="new column"):
        logger.log_tabular("Late", 1)


def test_a_process_alone_is_its_own_root() -> None:
    assert (mpi_util.get_num_procs(), mpi_util.is_root_proc()) == (1, True)
    numbers = np.array([1.0, 2.0])
    assert mpi_util.reduce_avg(numbers) == pytest.approx(numbers)
    assert mpi_util.reduce_sum(numbers) is not numbers
    assert mpi_util.reduce_max(3) == 3
    assert mpi_util.gather_all(4) == [4]


def test_world_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "models" / "ball").mkdir(parents=True)
    inertia = "<inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia>"
    (tmp_path / "models" / "ball" / "model.sdf").write_text(
        f"<sdf version='1.6'><model name='m'><link name='a'><inertial><mass>1</mass>{inertia}</inertial>"
        "<collision name='c'><geometry><sphere><radius>0.1</radius></sphere></geometry></collision></link>"
        "</model></sdf>",
        encoding="utf-8",
    )
    (tmp_path / "my.world").write_text(
        "<sdf version='1.6'><world name='w'><model name='one'><include><uri>model://ball</uri></include>"
        "<pose>1 2 3 0 0 0.5</pose></model><model name='empty'/></world></sdf>",
        encoding="utf-8",
    )
    client = p.connect(p.DIRECT)
    models = gazebo_world_parser.parseWorld(p, "my.world")
    assert set(models) == {"one", "empty"}
    assert models["one"]["pose_xyz"] == [1.0, 2.0, 3.0]
    position, turn = p.getBasePositionAndOrientation(0)
    assert position == (1, 2, 3)
    assert p.getEulerFromQuaternion(turn) == pytest.approx((0, 0, 0.5))
    assert p.getDynamicsInfo(0, -1)[0] == 0
    p.disconnect(client)


def test_saved_weights(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "saves").mkdir()
    for number in (5, 12, 7):
        (tmp_path / "saves" / f"DDPG-v0-Ant-v1-{number}_actor.h5").touch()
    assert get_latest_save("saves/", "DDPG-v0", "Ant-v1", 0) == ("DDPG-v0", "Ant-v1", 12)
    assert get_latest_save("saves/", "DDPG-v0", "Hopper-v1", 0) == []
    with pytest.raises(ValueError, match="does not match"):
        get_fields("saves/weights.h5")


def test_recorded_motions(tmp_path: Path) -> None:
    file = tmp_path / "motion.txt"
    file.write_text(json.dumps({"Frames": [[0.5, 0, 1, 2, 9], [0.5, 1, 1, 5, 9], [0.5, 2, 1, 8, 9]]}))
    motion = MotionCaptureData()
    motion.Load(str(file))
    assert (motion.NumFrames(), motion.KeyFrameDuraction(), motion.getCycleTime()) == (3, 0.5, 1.0)
    assert motion.calcCycleCount(2.7, 1.0) == 2
    assert motion.computeCycleOffset() == [2, 0, 6]
    file.write_text("[]")
    with pytest.raises(ValueError, match="Frames"):
        motion.Load(str(file))


@pytest.mark.parametrize(
    ("module", "arguments"),
    [
        ("pybullet_utils.examples.testlog", []),
        ("pybullet_utils.examples.testargs", ["--bodies", "1"]),
        ("pybullet_utils.examples.multipleScenes", []),
        ("pybullet_utils.examples.combineUrdf", []),
        ("pybullet_utils.examples.mjcf2urdf", ["--mjcf", "mjcf/ant.xml"]),
        ("pybullet_utils.readwriteurdf", ["--urdf_in", "r2d2.urdf"]),
        ("pybullet_envs.examples.testEnv", ["--env", "InvertedPendulumBulletEnv-v0", "--steps", "20"]),
    ],
)
def test_scripts_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, module: str, arguments: list[Any]
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "argv", [module, *arguments])
    monkeypatch.delitem(sys.modules, module, raising=False)
    runpy.run_module(module, run_name="__main__")
    for written in tmp_path.glob("*.urdf"):
        client = p.connect(p.DIRECT)
        assert p.loadURDF(str(written), physicsClientId=client) == 0
        p.disconnect(client)
