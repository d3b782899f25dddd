"""World-steps per second of `Worlds` beside `mujoco.batch`, with controls that change in each call.

    python benchmarks/batches.py [--mujoco .mujoco/bin/python] [--turns 3] [--page docs/scaling.md]

The engines take turns on the same cores by wall time, and a figure is the median over the turns.
"""

from __future__ import annotations

import argparse
import os
import statistics
import subprocess
import sys
import time
from collections import defaultdict
from pathlib import Path

import mjcf_scenes
import numpy as np
from mjcf_scenes import CONTROLS
from run import put_between_marks
from throughput import HOME, PANDA, ROOT, boxes

from carom import Motor, PositionActuator, World, Worlds
from carom.scene.body import Body

HERE = Path(__file__).resolve().parent
DATA = PANDA.parent.parent
COUNT, STEPS = 256, (1, 20)
STRENGTHS = {"ant": 150.0, "humanoid": 40.0}
"""Torque of a control of 1 [Nm]: gears of the learning tasks with these robots."""
CASES = {
    "panda": "Panda, nine position servos, targets that change",
    "boxes": "9 towers of 3 boxes",
    "ant": "Ant on a floor, random torques",
    "humanoid": "Humanoid on a floor, random torques",
    "hand": "Hand of 15 hulls that closes on a ball",
    "bin": "20 mixed shapes that come to rest in a bin",
    "sensing humanoid": "Humanoid with 33 sensors, random torques",
    "quadruped": "Quadruped with an IMU, 12 servos",
    "arm": "Arm of seven servos",
}
CHECKED_STEPS, CHECKED_CHANGE = 60, 0.1
"""As in `batches_mujoco.py`: after so many steps, with controls so far from the start, sides are compared."""
MOST_APART = {"panda": 0.01, "boxes": 5e-3, "ant": 0.02, "humanoid": 0.02}
MOST_APART.update(dict.fromkeys(mjcf_scenes.SCENES, 0.02))
"""Of coordinates of the arm, and heights of free bodies [rad or m]."""
LAWS = {"compliant": "Newton", "bullet": "sweeps"}
"""Laws of contacts, and how pages name them."""
MARKS = ("<!-- batches -->", "<!-- end of batches -->")


def scene(case: str, law: str = "compliant") -> tuple[World, Body | None]:
    """The world of a case with a law of contacts, and the body that is controlled."""
    if case == "boxes":
        return boxes(law), None
    world = World(contact=law)
    if case in mjcf_scenes.SCENES:
        world.load(mjcf_scenes.SCENES[case]())
        return world, next((body for body in world if len(body.actuators.controls)), None)
    world.gravity = (0.0, 0.0, -9.81)
    if case == "panda":
        # The servos of `batches_mujoco.panda_model`.
        arm = world.load_urdf(PANDA, fixed_base=True)
        arm.joints.reset(HOME)
        for joint in _hinges(arm):
            arm.add_actuator(joint, PositionActuator(joint, kp=400.0, kv=40.0))
        return world, arm
    # With the time step of both sides, not that of the file.
    bodies = world.load_mjcf(DATA / "mjcf" / f"{case}.xml")
    robot = next(body for body in bodies if body.joint_count)
    if len(bodies) == 1:
        # The Humanoid's file has a floor of its own.
        world.add_plane()
    for joint in _hinges(robot):
        robot.add_actuator(joint, Motor(joint, gear=STRENGTHS[case]))
    return world, robot


def _hinges(body: Body) -> list[str]:
    return [joint.name for joint in body.joints if joint.degrees_of_freedom == 1]


def ours(case: str, law: str, threads: int, seconds: float, steps: int) -> float:
    """World-steps per second of `Worlds`, so many steps in a call."""
    world, body = scene(case, law)
    worlds = Worlds(world, COUNT, threads=threads)
    generator = np.random.default_rng(0)
    middle, amount = (np.array(HOME), 0.2) if case == "panda" else CONTROLS.get(case, (0.0, 1.0))
    began, done = 0.0, 0
    for turn in range(1_000_000):
        if turn == 5:
            began, done = time.perf_counter(), 0
        elif turn > 5 and time.perf_counter() - began > seconds:
            break
        if body is not None:
            shape = worlds[body].actuators.controls.shape
            worlds[body].actuators.controls[:] = middle + generator.uniform(-amount, amount, shape)
        worlds.step(steps)
        done += COUNT * steps
    return done / (time.perf_counter() - began)


def check_equal(case: str, law: str, interpreter: Path) -> None:
    """Raise `AssertionError` unless both sides are in the same place after some steps of the case."""
    world, body = scene(case, law)
    free = [one for one in world if not one.fixed_base]
    arm = None if free else body
    if arm is not None:
        start = np.array(HOME) if case == "panda" else np.zeros(len(arm.actuators.controls))
        arm.actuators.controls = start + CHECKED_CHANGE
    world.step(CHECKED_STEPS)
    ours = arm.joints.positions if arm is not None else np.array([one.pose.position[2] for one in free])
    theirs = np.array(asked_mujoco(case, 1, 0.0, 0, interpreter))
    if case == "boxes":
        # One has settled before; the order of the boxes is another one.
        ours, theirs = np.sort(ours), np.sort(theirs)
    off = float(np.abs(ours - theirs).max())
    assert off < MOST_APART[case], (
        f"{case}, {law}: the engines are {off:.3g} apart after {CHECKED_STEPS} steps"
    )


def mujoco(case: str, threads: int, seconds: float, steps: int, interpreter: Path) -> float:
    """World-steps per second of `mujoco.batch`."""
    return asked_mujoco(case, threads, seconds, steps, interpreter)[-1]


def asked_mujoco(case: str, threads: int, seconds: float, steps: int, interpreter: Path) -> list[float]:
    """The numbers that the other side prints."""
    numbers = [str(number) for number in (seconds, threads, steps, COUNT)]
    command = [
        str(interpreter),
        str(HERE / "batches_mujoco.py"),
        case,
        *numbers,
        str(DATA),
        str(STRENGTHS.get(case, 0.0)),
    ]
    found = subprocess.run(command, cwd=HERE, text=True, check=True, stdout=subprocess.PIPE)
    return [float(number) for number in found.stdout.split()]


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description="Time Worlds against mujoco.batch.")
    parser.add_argument("--mujoco", type=Path, default=ROOT / ".mujoco" / "bin" / "python")
    parser.add_argument("--turns", type=int, default=3)
    parser.add_argument("--seconds", type=float, default=2.0, help="time spent on each figure in each turn")
    parser.add_argument("--only", nargs="*", choices=CASES, default=list(CASES))
    parser.add_argument("--page", type=Path, help="put the table into this page, between its marks, as well")
    arguments = parser.parse_args()
    threads = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    for case in arguments.only:
        for law in LAWS:
            check_equal(case, law, arguments.mujoco.absolute())
    samples: dict[tuple[str, int, str], list[float]] = defaultdict(list)
    for turn in range(arguments.turns):
        print(f"turn {turn + 1} of {arguments.turns}", file=sys.stderr, flush=True)
        for case in arguments.only:
            for steps in STEPS:
                asked = case, threads, arguments.seconds, steps
                for law in LAWS:
                    samples[case, steps, law].append(ours(case, law, *asked[1:]))
                samples[case, steps, "MuJoCo"].append(mujoco(*asked, arguments.mujoco.absolute()))
    figures = table({key: statistics.median(values) for key, values in samples.items()}, threads)
    print(figures)
    if arguments.page:
        put_between_marks(arguments.page, figures, MARKS)


def table(medians: dict[tuple[str, int, str], float], threads: int) -> str:
    """The rates as a Markdown table."""
    lines = [
        f"| world-steps per second, {COUNT} worlds, {threads} threads | steps a call | contacts | Carom "
        "| mujoco.batch | Carom : MuJoCo |",
        "| --- | ---: | --- |" + " ---: |" * 3,
    ]
    for case, steps in {(case, steps): None for case, steps, _ in medians}:
        other = medians[case, steps, "MuJoCo"]
        for law, name in LAWS.items():
            carom = medians[case, steps, law]
            lines.append(
                f"| {CASES[case]} | {steps} | {name} | {carom:,.0f} | {other:,.0f} | {carom / other:.2f}× |"
            )
    return "\n".join(lines)


if __name__ == "__main__":
    main()
