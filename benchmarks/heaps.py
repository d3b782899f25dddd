"""Heaps of many bodies: a step of Carom beside those of PyBullet, MuJoCo and Rapier, in processor time.

    python benchmarks/heaps.py [--only balls_1000 mixed_1000] [--page docs/heaps.md]

Each engine has a process of its own, which lets everything fall first: that gives the figures of *falling*.
Then all have to have the same mean height and as many bodies at rest, within bounds, and nothing below the
floor. Then the engines take turns at a few steps, and a figure *at rest* is the median over the turns.
PyBullet is measured by a script of its interface, which `pybullet` of Carom runs, too; MuJoCo and
`carom.World` read the same MJCF file; Rapier is its WebAssembly under Node.js, installed by
`make .rapier/rapier`.
"""

from __future__ import annotations

import argparse
import itertools
import json
import os
import shutil
import statistics
import subprocess
import sys
import tempfile
from collections import defaultdict
from contextlib import ExitStack
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from engines import HERE, ROOT
from heap_scenes import SCENES, bins
from run import put_between_marks, readable

ANSWER = "answer: "
SLOW = 0.05
"""A body that is slower is at rest [m/s]."""
MOST_MOVING = 0.1
"""How many bodies more or less may be at rest than in another engine, as a part of all."""
TURNS, MOST_SECONDS = 5, 1.0
"""Turns of each engine, and about how long the slowest may take for one [s]."""
FLOOR = 0.015
"""Half the least distance of a body's centre from its surface: a lower one has fallen through [m]."""
MARKS = ("<!-- heaps -->", "<!-- end of heaps -->")
DROP_IN, REFERENCE = "Carom's `pybullet`", "PyBullet"
OURS = (DROP_IN, "`World`")
MOST_HIGHER = {(DROP_IN, REFERENCE): 0.01, (OURS[1], "MuJoCo"): 0.04}
"""How much mean heights of the same method may differ, as a part of them."""
MOST_BETWEEN = 0.1
"""And those of different methods: soft contacts of MuJoCo's law at 1/240 s yield by millimetres."""


@dataclass(frozen=True)
class Engine:
    """One column of the table.

    Attributes:
        name: Its title.
        command: What starts it, up to the file of the scene.
        environment: Variables of its process.
    """

    name: str
    command: tuple[str, ...]
    environment: dict[str, str] = field(default_factory=dict)


class Heap:
    """A process that holds one scene."""

    def __init__(self, engine: Engine, process: subprocess.Popen[str]) -> None:
        self.name = engine.name
        self._process = process

    def step(self, count: int) -> dict[str, Any]:
        """Take so many steps; the times, and after the first call where everything is."""
        requests, answers = self._process.stdin, self._process.stdout
        assert requests is not None
        assert answers is not None
        try:
            requests.write(f"{count}\n")
            requests.flush()
        except BrokenPipeError:
            pass
        for line in answers:
            if line.startswith(ANSWER):
                return json.loads(line.removeprefix(ANSWER))
        raise RuntimeError(f"{self.name} ended in a step")


def engines(oracle: Path, mujoco: Path, rapier: Path) -> list[Engine]:
    """Those that are installed; what is missing is said."""
    script = str(HERE / "heaps_engine.py")
    own = {"PYTHONPATH": str(ROOT / "src")}
    found = [Engine(OURS[0], (sys.executable, script, "pybullet"), environment=own)]
    found.append(Engine(OURS[1], (sys.executable, script, "carom"), environment=own))
    if oracle.exists():
        found.append(Engine(REFERENCE, (str(oracle.absolute()), script, "pybullet")))
    else:
        print(f"no PyBullet at {oracle} (make oracle)", file=sys.stderr)
    if mujoco.exists():
        found.append(Engine("MuJoCo", (str(mujoco.absolute()), script, "mujoco")))
    else:
        print(f"no MuJoCo at {mujoco} (make .mujoco/mujoco)", file=sys.stderr)
    node = shutil.which("node")
    if node is None:
        print("no Node.js, version 18 or later, on the path: no column of Rapier", file=sys.stderr)
    elif not (rapier / "node_modules").exists():
        print(f"no Rapier at {rapier} (make .rapier/rapier)", file=sys.stderr)
    else:
        found.append(Engine("Rapier", (node, str(HERE / "heaps_rapier.mjs"), str(rapier.absolute()))))
    return found


def check_equal(scene: str, found: dict[str, dict[str, Any]]) -> str:
    """Raise `AssertionError` unless all engines have the same heap; returns what it is like."""
    count = len(next(iter(found.values()))["heights"])
    means = {name: statistics.fmean(answer["heights"]) for name, answer in found.items()}
    resting = {name: sum(speed < SLOW for speed in answer["speeds"]) for name, answer in found.items()}
    for name, answer in found.items():
        lowest = min(answer["heights"])
        assert lowest > FLOOR, f"{scene}: a body of {name} lies {lowest:.3f} m high"
    for one, other in itertools.permutations(found, 2):
        off, most = means[one] / means[other] - 1.0, MOST_HIGHER.get((one, other), MOST_BETWEEN)
        assert abs(off) <= most, f"{scene}: bodies of {one} lie {off:.1%} higher than those of {other}"
        more = resting[one] - resting[other]
        assert more <= MOST_MOVING * count, f"{scene}: {more} more bodies rest in {one} than in {other}"
    return ", ".join(f"{name} {1e3 * means[name]:.1f} mm, {resting[name]} at rest" for name in found)


def measure(scene: str, columns: list[Engine]) -> tuple[dict[str, float], dict[str, float]]:
    """Seconds of processor time of a step by engine: while everything falls, and at rest."""
    _, count, kinds, settling = SCENES[scene]
    samples: dict[str, list[float]] = defaultdict(list)
    with tempfile.TemporaryDirectory() as folder, ExitStack() as stack:
        file = Path(folder) / "scene.json"
        file.write_text(json.dumps(bins(count, kinds).plain()), encoding="utf-8")
        heaps, first = [], {}
        for engine in columns:
            left = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
            process = subprocess.Popen(
                [*engine.command, str(file)],
                env=left | engine.environment,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                text=True,
            )
            stack.callback(process.wait)
            heap = Heap(engine, process)
            stack.callback(process.kill)
            first[heap.name] = heap.step(settling)
            heaps.append(heap)
        print(f"{scene}: {check_equal(scene, first)}", file=sys.stderr, flush=True)
        slowest = max(answer["processor"] for answer in first.values()) / settling
        steps = max(2, min(50, int(MOST_SECONDS / slowest)))
        for _ in range(TURNS):
            for heap in heaps:
                answer = heap.step(steps)
                samples[heap.name].append(answer["processor"] / steps)
    falling = {name: answer["processor"] / settling for name, answer in first.items()}
    return falling, {name: statistics.median(times) for name, times in samples.items()}


def table(rows: dict[str, dict[str, float]], columns: list[Engine]) -> str:
    """The figures as a Markdown table; those of a row are seconds by engine."""
    names = [engine.name for engine in columns]
    others = [name for name in names if name not in OURS]
    ratios = [(REFERENCE, DROP_IN), *((name, OURS[1]) for name in others if name != REFERENCE)]
    ratios = [pair for pair in ratios if pair[0] in others]
    header = ["a step of", *names, *(f"{theirs} : {ours}" for theirs, ours in ratios)]
    lines = ["| " + " | ".join(header) + " |", "| --- |" + " ---: |" * (len(header) - 1)]
    for title, times in rows.items():
        cells = [readable(times.get(name)) for name in names]
        cells += [f"{times[theirs] / times[ours]:.2f}" for theirs, ours in ratios]
        lines.append("| " + " | ".join([title, *cells]) + " |")
    return "\n".join(lines)


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description="Time heaps of many bodies in several engines.")
    parser.add_argument("--oracle", type=Path, default=ROOT / ".oracle" / "bin" / "python")
    parser.add_argument("--mujoco", type=Path, default=ROOT / ".mujoco" / "bin" / "python")
    parser.add_argument("--rapier", type=Path, default=ROOT / ".rapier")
    parser.add_argument("--only", nargs="+", default=list(SCENES), choices=SCENES, metavar="SCENE")
    parser.add_argument("--page", type=Path, help="put the table into this page, between its marks, as well")
    arguments = parser.parse_args()
    columns = engines(arguments.oracle, arguments.mujoco, arguments.rapier)
    rows: dict[str, dict[str, float]] = {}
    for scene in arguments.only:
        title = SCENES[scene][0]
        rows[f"{title}, falling"], rows[f"{title}, at rest"] = measure(scene, columns)
        print(table(rows, columns).splitlines()[-1], file=sys.stderr, flush=True)
    figures = table(rows, columns)
    print(figures)
    if arguments.page:
        put_between_marks(arguments.page, figures, MARKS)


if __name__ == "__main__":
    main()
