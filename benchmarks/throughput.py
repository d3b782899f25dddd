"""World-steps per second of many worlds: `Worlds`, and PyBullet in a process per core.

    python benchmarks/throughput.py [--oracle .oracle/bin/python] [--turns 3]

The engines take turns on the same cores, and a figure is the median over the turns; `batches.py` has MuJoCo.
Memory is what a process that holds so many worlds, stepped for a while, has more than before it made them.
"""

from __future__ import annotations

import argparse
import os
import statistics
import subprocess
import sys
import time
from collections import defaultdict
from collections.abc import Sequence
from pathlib import Path

from run import put_between_marks

from carom import World, Worlds
from carom.description import Box, Plane
from carom.description.link import Collision
from carom.model.body_spec import BodySpec, LinkSpec

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent
PANDA = ROOT / "src" / "pybullet_data" / "franka_panda" / "panda.urdf"
HOME = [0.0, -0.4, 0.0, -2.0, 0.0, 1.6, 0.8, 0.02, 0.02]
EDGE, SETTLING_STEPS = 0.2, 60
MOST_OFF = 5e-3
"""How far a box may have moved while its tower came to rest [m]."""
COUNT, BATCH, CALLS = 1024, 20, 500
CASES = {"panda": "Panda with its motors", "boxes": "9 towers of 3 boxes"}
MARKS = ("<!-- throughput -->", "<!-- end of throughput -->")


def panda() -> World:
    """A world with the arm, held by position motors."""
    world = World(contact="bullet")
    world.gravity = (0.0, 0.0, -9.81)
    arm = world.load_urdf(PANDA, fixed_base=True, as_pybullet=True)
    arm.joints.reset(HOME)
    arm.joints.set_position_targets(HOME, max_forces=87.0)
    return world


def boxes(contact: str = "bullet") -> World:
    """A world with nine towers of three boxes."""
    world = World(contact=contact)
    world.gravity = (0.0, 0.0, -9.81)
    floor = LinkSpec(name="floor", collisions=(Collision(Plane()),))
    world.load(BodySpec("floor", floor, fixed_base=True))
    moment = EDGE**2 / 6.0
    box = LinkSpec(
        name="box",
        mass=1.0,
        inertia=(moment, moment, moment),
        collisions=(Collision(Box((EDGE / 2.0, EDGE / 2.0, EDGE / 2.0))),),
    )
    for place in range(27):
        x, y, z = place % 3, place // 3 % 3, place // 9
        world.load(BodySpec("box", box), (1.05 * EDGE * x, 1.05 * EDGE * y, EDGE * (z + 0.5)))
    world.step(SETTLING_STEPS)
    check_towers([body.pose.position.tolist() for body in list(world)[1:]])
    return world


def check_towers(places: Sequence[Sequence[float]]) -> None:
    """Raise `AssertionError` unless boxes stand where they were put."""
    for number, place in enumerate(places):
        x, y, z = number % 3, number // 3 % 3, number // 9
        wanted = 1.05 * EDGE * x, 1.05 * EDGE * y, EDGE * (z + 0.5)
        off = max(abs(a - b) for a, b in zip(place, wanted, strict=True))
        assert off < MOST_OFF, f"box {number} is {off:.3g} m from its place: the towers have fallen"


SCENES = {"panda": panda, "boxes": boxes}


def ours(case: str, threads: int, seconds: float, batch: int = BATCH) -> float:
    """World-steps per second of `Worlds`, so many steps at a time."""
    worlds = Worlds(SCENES[case](), COUNT, threads=threads)
    worlds.step(batch)
    start, steps = time.perf_counter(), 0
    while time.perf_counter() - start < seconds:
        worlds.step(batch)
        steps += batch
    return COUNT * steps / (time.perf_counter() - start)


def call(case: str, threads: int) -> float:
    """Seconds of a call that steps one world on each thread: nearly all of it goes to starting and ending."""
    worlds = Worlds(SCENES[case](), threads, threads=threads)
    worlds.step(BATCH)
    samples = []
    for _ in range(CALLS):
        start = time.perf_counter()
        worlds.step()
        samples.append(time.perf_counter() - start)
    return statistics.median(samples)


def pybullet(case: str, processes: int, seconds: float, oracle: Path) -> float:
    """Steps per second of PyBullet in so many processes, all of them together."""
    command = [str(oracle), str(HERE / "throughput_pybullet.py"), case, str(seconds)]
    environment = {name: value for name, value in os.environ.items() if name != "PYTHONPATH"}
    running = [
        subprocess.Popen(
            command, cwd=HERE, env=environment, text=True, stdin=subprocess.PIPE, stdout=subprocess.PIPE
        )
        for _ in range(processes)
    ]
    for process in running:
        while process.stdout is not None and process.stdout.readline().strip() != "ready":
            pass
    for process in running:
        if process.stdin is not None:
            process.stdin.write("\n")
            process.stdin.flush()
    return sum(float(process.communicate()[0].split()[-1]) for process in running)


def memory_per_world(case: str, count: int) -> float:
    """Bytes that each of so many worlds takes, in a process of its own; 0 where the system does not say."""
    code = "import sys, throughput; print(throughput.measure_memory(sys.argv[1], int(sys.argv[2])))"
    command = [sys.executable, "-c", code, case, str(count)]
    found = subprocess.run(command, cwd=HERE, text=True, check=True, stdout=subprocess.PIPE)
    return float(found.stdout.split()[-1])


def measure_memory(case: str, count: int) -> float:
    """Bytes per world in this process, after some steps."""
    scene = SCENES[case]()
    Worlds(scene, 2).step(BATCH)
    before = _resident()
    worlds = Worlds(scene, count)
    worlds.step(BATCH)
    return (_resident() - before) / worlds.count


def _resident() -> int:
    statm = Path("/proc/self/statm")
    return int(statm.read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE") if statm.is_file() else 0


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description="Time many worlds against PyBullet.")
    parser.add_argument("--oracle", type=Path, default=ROOT / ".oracle" / "bin" / "python")
    parser.add_argument("--turns", type=int, default=3)
    parser.add_argument("--seconds", type=float, default=2.0, help="time spent on each figure in each turn")
    parser.add_argument("--memory", type=int, nargs="*", default=[100, 1000, 10000], metavar="WORLDS")
    parser.add_argument("--page", type=Path, help="put the tables into this page, between its marks, as well")
    arguments = parser.parse_args()
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1

    samples: dict[tuple[str, str], list[float]] = defaultdict(list)
    for turn in range(arguments.turns):
        print(f"turn {turn + 1} of {arguments.turns}", file=sys.stderr, flush=True)
        for case in CASES:
            seconds = arguments.seconds
            samples[case, "one thread"].append(ours(case, 1, seconds))
            samples[case, "all threads"].append(ours(case, cores, seconds))
            samples[case, "step by step"].append(ours(case, cores, seconds, batch=1))
            samples[case, "call"].append(call(case, cores))
            if arguments.oracle.exists():
                samples[case, "PyBullet"].append(pybullet(case, cores, seconds, arguments.oracle.absolute()))
    medians = {key: statistics.median(values) for key, values in samples.items()}
    figures = table(medians, cores)
    if arguments.memory:
        figures += "\n\n" + memory_table(arguments.memory)
    print(figures)
    if arguments.page:
        put_between_marks(arguments.page, figures, MARKS)


def table(medians: dict[tuple[str, str], float], cores: int) -> str:
    """World-steps per second as a Markdown table."""
    lines = [
        f"| world-steps per second, {COUNT} worlds | Carom, 1 thread | {cores} threads | one step a call | "
        "threads pay | Python's share | PyBullet, a process per core | Carom : PyBullet |",
        "| --- |" + " ---: |" * 7,
    ]
    for case, title in CASES.items():
        one, all_, single = (medians[case, name] for name in ("one thread", "all threads", "step by step"))
        cells = [
            f"{one:,.0f}",
            f"{all_:,.0f}",
            f"{single:,.0f}",
            f"{all_ / one:.2f}×",
            # Of a call for one world on each thread, what is not that world's step.
            f"{(medians[case, 'call'] - 1.0 / one) / (COUNT / single):.1%}",
        ]
        theirs = medians.get((case, "PyBullet"))
        cells += (
            ["–", "–"]
            if theirs is None
            else [f"{theirs:,.0f}", f"{all_ / theirs:.2f}× ({single / theirs:.2f}×)"]
        )
        lines.append("| " + " | ".join([title, *cells]) + " |")
    return "\n".join(lines)


def memory_table(counts: list[int]) -> str:
    """Memory per world as a Markdown table."""
    header = "| memory per world | " + " | ".join(f"{count:,} worlds" for count in counts) + " |"
    lines = [header, "| --- |" + " ---: |" * len(counts)]
    for case, title in CASES.items():
        cells = [f"{memory_per_world(case, count) / 1000:.1f} kB" for count in counts]
        lines.append("| " + " | ".join([title, *cells]) + " |")
    return "\n".join(lines)


if __name__ == "__main__":
    main()
