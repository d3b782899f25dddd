"""The ten tasks of the first page of the manual do what they say, with public names only."""

from __future__ import annotations

import ast
import importlib.util
import json
import runpy
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import carom
from carom.replay import read
from carom.suggestions import suggestion

ROOT = Path(__file__).parents[2]
TASKS = (
    *("hold_arm", "pick_and_place", "stand_quadruped", "point_cloud", "hand_contacts"),
    *("random_friction", "vector_environment", "follow_trajectory", "save_reset_replay", "look_at_it"),
)


@pytest.fixture
def task(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Any:
    """Runs a task as `python TASK.py --headless` does, in an empty folder; returns its names."""
    monkeypatch.chdir(tmp_path)

    def run(name: str) -> dict[str, Any]:
        file = ROOT / "examples" / f"{name}.py"
        monkeypatch.setattr("sys.argv", [str(file), "--headless"])
        return runpy.run_path(str(file), run_name="__main__")

    return run


def test_the_arm_is_held(task: Any) -> None:
    names = task("hold_arm")
    np.testing.assert_allclose(names["arm"].positions, [0, -0.4, 0, -2.2, 0, 1.9, 0.8], atol=0.01)
    assert np.abs(names["arm"].velocities).max() < 0.02


def test_the_cube_is_put_at_its_goal(task: Any) -> None:
    names = task("pick_and_place")
    np.testing.assert_allclose(names["cube"].pose.position, [0.5, -0.2, 0.02], atol=0.005)
    assert names["world"].contacts("box", "panda") == []
    assert np.abs(names["cube"].velocity.linear).max() < 1e-3


def test_the_quadruped_stands(task: Any) -> None:
    names = task("stand_quadruped")
    pose = names["robot"].pose
    assert pose.position[2] == pytest.approx(0.32, abs=0.02)
    assert pose.apply([0.0, 0.0, 1.0])[2] - pose.position[2] > 0.999
    assert {contact.a.name for contact in names["world"].contacts("trunk", "world")} == {
        f"{end}_{side}_foot" for end in ("front", "rear") for side in ("left", "right")
    }


def test_the_points_are_those_of_the_duck(task: Any) -> None:
    names = task("point_cloud")
    points, bounds = names["points"], names["duck"].bounds
    assert len(points) > 500
    assert (points > bounds.lower - 0.01).all()
    assert (points < bounds.upper + 0.01).all()


def test_the_fingers_hold_the_ball(task: Any) -> None:
    world = task("hand_contacts")["world"]
    pressing = {contact.a.name for contact in world.contacts("palm", "ball") if contact.normal_force > 0.1}
    assert pressing >= {"thumb_tip", "index_tip", "middle_tip"}
    # Together they carry its weight of 0.1 kg.
    np.testing.assert_allclose(world.force_between("ball", "palm"), [0, 0, 0.981], atol=0.01)


def test_each_of_the_bricks_slides_as_far_as_its_friction_lets_it(task: Any) -> None:
    names = task("random_friction")
    slid = names["slid"]
    assert slid.shape == (512,)
    np.testing.assert_allclose(slid, 2**2 / (2 * names["friction"] * 9.81), rtol=0.05)


def test_the_environment_is_one_of_gymnasium(task: Any) -> None:
    pytest.importorskip("gymnasium")
    names = task("vector_environment")
    env, observations = names["env"], names["observations"]
    assert observations.shape == (64, 29)
    assert env.observation_space.contains(observations)
    assert names["truncations"].sum() + names["terminations"].sum() > 0
    # Episodes begin as the keyframe says, and actions are those of the actuators.
    first, _ = env.reset(seed=0)
    np.testing.assert_allclose(first[:, 2], 0.34, atol=1e-6)
    assert env.single_action_space.shape == (8,)
    standing = np.tile(np.array([0.7, -1.4] * 4, np.float32), (64, 1))
    for _ in range(50):
        _, _, terminations, _, _ = env.step(standing)
        assert not terminations.any()


def test_the_path_is_followed(task: Any) -> None:
    names = task("follow_trajectory")
    assert names["largest"] < 0.001
    np.testing.assert_allclose(names["joints"].positions, names["goal"], atol=0.001)


def test_what_is_saved_goes_on_to_the_last_bit(task: Any) -> None:
    names = task("save_reset_replay")
    assert names["world"].time == 0.0
    assert names["cube"].pose.position.tolist() == [0, 0, 1]
    again = names["again"]["box"].pose
    assert np.array_equal(again.array, names["end"].array)
    replay = read("falling.html")
    assert len(replay.times) > 40


def test_the_picture_shows_the_blocks(task: Any) -> None:
    from PIL import Image

    names = task("look_at_it")
    seen = np.asarray(Image.open("blocks.png"))
    image = names["world"].image(names["camera"])
    assert np.array_equal(seen, image.colour)
    assert len(image.names()) == 6


def test_the_tasks_need_no_comment_and_only_public_names() -> None:
    wrong: list[str] = []
    for name in TASKS:
        text = (ROOT / "examples" / f"{name}.py").read_text(encoding="utf-8")
        if "#" in text:
            wrong.append(f"{name}: a comment")
        for node in ast.walk(ast.parse(text)):
            if isinstance(node, ast.Attribute) and node.attr[0] == "_":
                wrong.append(f"{name}: {node.attr}")
            if isinstance(node, ast.ImportFrom) and node.module not in ("carom.examples", "carom.vector"):
                wrong.append(f"{name}: {node.module}")
    assert wrong == []


@pytest.mark.long
@pytest.mark.skipif(importlib.util.find_spec("pyright") is None, reason="needs pyright")
def test_the_tasks_pass_the_strictest_type_checks(tmp_path: Path) -> None:
    for name in TASKS:
        text = (ROOT / "examples" / f"{name}.py").read_text(encoding="utf-8")
        (tmp_path / f"{name}.py").write_text(f"# pyright: strict\n{text}", encoding="utf-8")
    settings = {"include": ["."], "extraPaths": [str(ROOT / "src")], "pythonVersion": "3.10"}
    (tmp_path / "pyrightconfig.json").write_text(json.dumps(settings), encoding="utf-8")
    checked = [sys.executable, "-m", "pyright", "-p", str(tmp_path), "--outputjson"]
    checked += ["--pythonpath", sys.executable]
    found = subprocess.run(checked, capture_output=True, text=True, check=False)
    told = json.loads(found.stdout)
    assert [f"{it['file']}: {it['message']}" for it in told["generalDiagnostics"]] == []
    assert told["summary"]["filesAnalyzed"] == len(TASKS)


def test_what_a_scene_has_not_is_told_to_be_of_its_bodies() -> None:
    scene: Any = carom.World().load("franka_panda/panda.urdf", fixed_base=True)
    with pytest.raises(AttributeError) as told:
        _ = scene.joints
    assert "['panda'] or [0]" in str(suggestion(told.value))


def test_meshes_are_found_as_robots_are() -> None:
    world = carom.World()
    assert world.add_mesh("duck.obj").name == "duck"
    with pytest.raises(carom.errors.DescriptionError, match=r"goose\.obj"):
        world.add_mesh("goose.obj")


def test_a_window_says_where_it_is(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("CI", "1")
    viewer = carom.World().view(speed=None)
    try:
        assert f"The simulation is shown at {viewer.address}" in capsys.readouterr().out
        assert viewer.pause_control.speed is None
    finally:
        viewer.close()
