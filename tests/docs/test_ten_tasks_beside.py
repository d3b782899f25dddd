"""The ten tasks beside other simulators: the table counts right, and MuJoCo and PyBullet run as printed."""

from __future__ import annotations

import ast
import os
import re
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path

import pytest
from tests.docs.blocks import ROOT, blocks

import pybullet_data
from carom.cli.command_line import OK, main
from carom.examples import robot_file

PAGES = [ROOT / "docs" / "tasks" / f"{name}.md" for name in ("arms", "robots", "worlds")]
SCRIPTS = {block.title: block.code for page in PAGES for block in blocks(page) if block.title}
SIMULATORS = {
    "mujoco": Path(os.environ.get("CAROM_MUJOCO", ROOT / ".mujoco" / "bin" / "python")),
    "pybullet": Path(os.environ.get("CAROM_ORACLE", ROOT / ".oracle" / "bin" / "python")),
}
# Those that need nothing but the simulator and NumPy: no images of MuJoCo's, no Gymnasium, no Pillow.
COMES_OUT: dict[str, Callable[[list[float]], bool]] = {
    "hold_arm": lambda it: max(abs(a - b) for a, b in zip(it, HELD, strict=True)) < 0.01,
    "pick_and_place": lambda it: abs(it[0] - 0.5) < 0.02 and abs(it[1] + 0.2) < 0.02,
    "stand_quadruped": lambda it: 0.3 < it[2] < 0.34 and abs(it[0]) < 0.05,
    "hand_contacts": lambda it: abs(it[2] + 0.981) < 0.001,
    "random_friction": lambda it: abs(it[0] - 0.203) < 0.002,
    "follow_trajectory": lambda it: abs(it[0] - 0.000133) < 1e-6,
}
HELD = [0, -0.4, 0, -2.2, 0, 1.9, 0.8]


def lines_of(code: str) -> int:
    """Lines that are neither empty nor part of the docstring."""
    tree = ast.parse(code)
    text = tree.body[0] if ast.get_docstring(tree) is not None else None
    said = set() if text is None else set(range(text.lineno, (text.end_lineno or 0) + 1))
    return sum(bool(line.strip()) for number, line in enumerate(code.splitlines(), 1) if number not in said)


def test_the_table_counts_the_lines_of_the_scripts() -> None:
    table = (ROOT / "docs" / "tasks" / "index.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| \[.*\| `(\w+)` \| (\d+) \| (\d+) \| (\d+) \| (\d+) \|$", table, re.MULTILINE)
    kinds = ("", "_mujoco", "_genesis", "_pybullet")
    assert len(rows) == 10
    wrong = []
    for name, *numbers in rows:
        counted = [lines_of(SCRIPTS[f"{name}{kind}.py"]) for kind in kinds]
        wrong += [(name, counted)] if counted != [int(number) for number in numbers] else []
    assert wrong == []
    sums = [sum(int(row[place]) for row in rows) for place in range(1, 5)]
    assert f"| together | | {' | '.join(map(str, sums))} |" in table
    assert sums[0] < min(sums[1:])
    assert max(len(line) for code in SCRIPTS.values() for line in code.splitlines()) <= 100


@pytest.mark.long
@pytest.mark.parametrize("simulator", SIMULATORS)
def test_other_simulators_run_the_tasks_as_printed(simulator: str, tmp_path: Path) -> None:
    python = SIMULATORS[simulator]
    if not python.exists():
        pytest.skip(f"needs {python}: `make oracle` and `make .mujoco/mujoco` install it")
    shutil.copytree(Path(pybullet_data.getDataPath()) / "franka_panda", tmp_path, dirs_exist_ok=True)
    for name, options in (("quadruped", []), ("hand", ["--model", "palm"])):
        shutil.copy(robot_file(f"{name}.xml"), tmp_path)
        urdf = str(tmp_path / f"{name}.urdf")
        assert main(["convert", str(tmp_path / f"{name}.xml"), urdf, *options]) == OK
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    wrong = []
    for name, is_right in COMES_OUT.items():
        (tmp_path / "task.py").write_text(SCRIPTS[f"{name}_{simulator}.py"], encoding="utf-8")
        done = subprocess.run(
            [python, "task.py"], cwd=tmp_path, env=environment, capture_output=True, text=True, check=False
        )
        told = re.findall(r"[-+]?\d+\.?\d*(?:e[-+]?\d+)?", _last(done.stdout)) if done.returncode == 0 else []
        if not told or not is_right([float(number) for number in told]):
            wrong.append(f"{name}: {done.stdout[-300:]}{done.stderr[-500:]}")
    assert wrong == []


def _last(text: str) -> str:
    """What the last call of `print` has printed, if it is numbers in brackets or one number."""
    found = re.findall(r"(?:^|\n)([\[(][^\n]*(?:\n [^\n]*)*|[-+\d.e]+)(?=\n)", text)
    return found[-1] if found else ""
