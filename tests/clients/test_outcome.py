from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

from tests.clients import watch
from tests.clients.outcome import (
    Run,
    compare_runs,
    compare_tests,
    compare_trials,
    drift,
    read_tests,
    read_trials,
)

FALLING = [(1, [[0.0, 0.0, 1.0]]), (20, [[0.0, 0.0, 0.5]]), (30, [[0.0, 0.0, 0.0]])]


def shifted(by: float, since: int) -> list[tuple[int, list[list[float]]]]:
    return [(step, [[x + by * (step >= since) for x in row] for row in state]) for step, state in FALLING]


def test_runs_that_move_alike_are_the_same() -> None:
    real = Run("steps", steps=30, states=FALLING)
    assert compare_runs(real, Run("steps", steps=30, states=shifted(1e-4, 1))).good
    assert compare_runs(real, Run("steps", steps=30, states=shifted(0.5, 30))).good
    assert not compare_runs(real, Run("steps", steps=30, states=shifted(0.5, 20))).good
    assert compare_runs(real, Run("steps", steps=30, states=shifted(4e-3, 1))).good
    assert not compare_runs(real, Run("steps", steps=30, states=shifted(6e-3, 1))).good
    assert drift(FALLING, shifted(0.5, 30)) == (0.0, 0.5)


def test_errors_name_files_without_the_folders_of_this_machine(tmp_path: Path) -> None:
    record = tmp_path / "record.json"
    error = f"error: {tmp_path}/../data/box.urdf:2: 'box.obj' was not found"
    record.write_text(json.dumps({"end": "error", "error": error, "steps": 0, "states": []}))
    assert Run.read(record, (tmp_path,)).error == "error: ../data/box.urdf:2: 'box.obj' was not found"


def test_a_script_that_hardly_gets_to_its_steps_differs() -> None:
    real = Run("steps", steps=240, states=FALLING)
    assert not compare_runs(real, Run("time", steps=0)).good
    assert compare_runs(real, Run("time", steps=30, states=FALLING)).good


def test_trials_succeed_about_as_often(tmp_path: Path) -> None:
    output = tmp_path / "output.txt"
    output.write_text("build time\ntrial [true, 3.0]\ntrial [false, 0.0]\ntrial [true, 2.0]\n")
    real = read_trials(output)
    assert real == [(True, 3.0), (False, 0.0), (True, 2.0)]
    found = compare_trials(real, [(True, 3.0), (False, 0.0), (False, 1.0)])
    assert found.good
    assert found.text == "2 of 3 trials succeed with PyBullet, 1 here, 2 end alike; rewards 5 and 4"
    assert not compare_trials(real, [(False, 0.0)] * 3).good
    assert not compare_trials(real, []).good


def test_runs_with_other_bodies_differ() -> None:
    real = Run("steps", states=FALLING)
    assert not compare_runs(real, Run("steps", states=[(1, [[0.0]])])).good


def test_errors_are_the_same_where_they_begin_alike() -> None:
    real = Run("error", "error: Failed to read parameter.")
    assert compare_runs(real, Run("error", "error: Failed to read parameter. There is no slider 3.")).good
    assert compare_runs(real, Run("steps")).good
    assert not compare_runs(real, Run("error", "error: something else")).good
    assert not compare_runs(Run("steps"), Run("error", "error: something else")).good
    unavailable = Run("error", "error: x is not available in this version of Carom")
    assert compare_runs(Run("steps"), unavailable).good
    assert compare_runs(real, unavailable).good
    assert not compare_runs(Run("steps"), Run("crash")).good


def test_tests_that_pass_with_pybullet_are_to_pass() -> None:
    real = {"a": "passed", "b": "failed", "c": "skipped"}
    assert compare_tests(real, {"a": "passed", "b": "passed", "c": "skipped"}).good
    lost = compare_tests(real, {"a": "failed", "b": "passed"})
    assert not lost.good
    assert "lost: a" in lost.text
    assert not compare_tests({}, {}).good


def test_reports_are_read(tmp_path: Path) -> None:
    report = tmp_path / "report.xml"
    assert read_tests(report) == {}
    report.write_text(
        '<testsuites><testsuite><testcase classname="m" name="a"/><testcase classname="m" name="b"><failure/>'
        '</testcase><testcase classname="m" name="c"><skipped/></testcase></testsuite></testsuites>'
    )
    assert read_tests(report) == {"m::a": "passed", "m::b": "failed", "m::c": "skipped"}


def watched(tmp_path: Path, script: str, steps: int = 30) -> Run:
    path, record = tmp_path / "script.py", tmp_path / "record.json"
    path.write_text(script)
    command = [sys.executable, watch.__file__, str(record), str(steps), "60", str(path)]
    subprocess.run(command, check=True, cwd=tmp_path)
    assert json.loads(record.read_text())["module"].endswith("__init__.py")
    return Run.read(record)


def test_a_script_that_runs_for_ever_in_real_time_is_watched_for_its_steps(tmp_path: Path) -> None:
    script = """
import time
import pybullet as p
from pybullet_utils.bullet_client import BulletClient

client = BulletClient(p.DIRECT)
other = BulletClient(p.DIRECT)
shape = client.createCollisionShape(p.GEOM_SPHERE, radius=0.1)
ball = client.createMultiBody(1, shape, basePosition=[0, 0, 1])
client.setGravity(0, 0, -10)
client.setRealTimeSimulation(1)
assert other.getNumBodies() == 0
while True:
    time.sleep(0.1)
"""
    run = watched(tmp_path, script)
    assert (run.end, run.steps) == ("steps", 30)
    (fallen,) = run.states[-1][1]
    assert abs(fallen[2] - (1.0 - 0.5 * 10.0 * 30 * 31 / 240**2)) < 1e-3


def test_a_script_that_ends_or_fails_says_so(tmp_path: Path) -> None:
    assert watched(tmp_path, "print('done')").end == "last line"
    failed = watched(tmp_path, "import pybullet as p\np.loadURDF('none.urdf')")
    assert failed.end == "error"
    assert failed.error.startswith("error: ")
    assert Run.read(tmp_path / "missing.json").end == "crash"
