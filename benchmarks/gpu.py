"""World-steps per second of many worlds on a GPU, and what of its memory they take: `make gpu`.

    python benchmarks/gpu.py [--device cuda] [--counts 1024 4096 16384] [--seconds 2]

Before that the kernels are compiled for the device, in as many processes as there are cores, and worlds are
compared with those on the processor. `--device warp-cpu` does all of it without a GPU, to try the script.
"""

from __future__ import annotations

import argparse
import os
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from throughput import ROOT, boxes, panda

from carom import World, Worlds
from carom.gpu.array import BLOCK_SIZE
from carom.gpu.engine import DeviceEngine
from carom.gpu.memory import CountingDevice
from carom.native.kernel_modules import CUDA_MODULES

TURNS, BATCH, ALONE_STEPS = 3, 20, 240
ANT = ROOT / "src" / "pybullet_data" / "mjcf" / "ant.xml"
PLANE = ROOT / "src" / "pybullet_data" / "plane.urdf"
# What a process of its own compiles: a module, for a device.
_COMPILE = (
    "import sys, importlib, warp; importlib.import_module(sys.argv[1]); warp.load_module(*sys.argv[1:])"
)


def ant() -> World:
    """A world with the robot of `AntBulletEnv` on a floor, its motors off."""
    # GPUs have no other law yet.
    world = World(contact="bullet")
    world.gravity = (0.0, 0.0, -9.81)
    world.load_urdf(PLANE, as_pybullet=True)
    (robot,) = world.load_mjcf(ANT)
    robot.joints.free()
    world.step(ALONE_STEPS)
    return world


def stir_panda(worlds: Worlds, random: np.random.Generator) -> None:
    """New targets for all arms."""
    (arm,) = worlds
    lower, upper = arm.joints.limits
    arm.joints.set_position_targets(random.uniform(lower, upper), max_forces=87.0)


def stir_ant(worlds: Worlds, random: np.random.Generator) -> None:
    """New torques for all ants."""
    *_, robot = worlds
    robot.joints.set_torques(random.uniform(-1.0, 1.0, (worlds.count, robot.joints.velocities.shape[1])))


def leave(worlds: Worlds, random: np.random.Generator) -> None:
    """Nothing is told to boxes."""


Stir = Callable[[Worlds, np.random.Generator], None]
CASES: dict[str, tuple[str, Callable[[], World], Stir]] = {
    "panda": ("Panda with its motors", panda, stir_panda),
    "ant": ("Ant on a floor", ant, stir_ant),
    "boxes": ("9 towers of 3 boxes", boxes, leave),
}


def compile_for(device: str) -> float:
    """Compile all kernels for a device; how long that took [s]."""
    alias = "cpu" if device == "warp-cpu" else "cuda:0" if device == "cuda" else device
    start = time.perf_counter()
    with ThreadPoolExecutor(os.cpu_count() or 1) as pool:
        list(
            pool.map(
                lambda module: subprocess.run(
                    [sys.executable, "-c", _COMPILE, module, alias, str(BLOCK_SIZE)], check=True
                ),
                CUDA_MODULES,
            )
        )
    return time.perf_counter() - start


def apart(case: str, device: str) -> float:
    """How far worlds are from those on the processor after a second: the greatest coordinate [m or rad]."""
    _, scene, stir = CASES[case]
    there, here = Worlds(scene(), 3, device=device), Worlds(scene(), 3)
    for worlds in (there, here):
        stir(worlds, np.random.default_rng(1))
        worlds.step(ALONE_STEPS)
    pairs = [(a.joints.positions, b.joints.positions) for a, b in zip(there, here, strict=True)]
    pairs += [(a.base_inertial_poses, b.base_inertial_poses) for a, b in zip(there, here, strict=True)]
    return max(float(np.abs(np.asarray(ours) - theirs).max(initial=0.0)) for ours, theirs in pairs)


def rate(case: str, count: int, device: str, seconds: float, batch: int) -> float:
    """World-steps per second, so many steps a call: median of the turns."""
    _, scene, stir = CASES[case]
    worlds, random = Worlds(scene(), count, device=device), np.random.default_rng(2)
    stir(worlds, random)
    # Arrays have grown and launches have been captured before the time is taken.
    worlds.step(2 * BATCH)
    turns = []
    for _ in range(TURNS):
        start, steps = time.perf_counter(), 0
        while time.perf_counter() - start < seconds:
            stir(worlds, random)
            worlds.step(batch)
            steps += batch
        turns.append(count * steps / (time.perf_counter() - start))
    return statistics.median(turns)


def bytes_per_world(case: str, count: int) -> float:
    """What each of so many worlds takes of a device before any array has grown [bytes]."""
    _, scene, _ = CASES[case]
    world, counter = scene(), CountingDevice()
    world.prepare()
    DeviceEngine.made(counter, world.arrays, world.contact_arrays, count).structs()
    return counter.bytes / count


def main() -> None:
    """Compile, compare and measure."""
    parser = argparse.ArgumentParser(description="Measure many worlds on a GPU.")
    parser.add_argument("--device", default="cuda")
    parser.add_argument("--counts", type=int, nargs="+", default=[1024, 4096, 16384])
    parser.add_argument("--seconds", type=float, default=2.0, help=f"for each of {TURNS} turns")
    parser.add_argument("--cases", nargs="+", choices=list(CASES), default=list(CASES))
    asked = parser.parse_args()
    print(f"compiled in {compile_for(asked.device):.0f} s", flush=True)
    for case in asked.cases:
        title = CASES[case][0]
        print(f"{title}: after a second {apart(case, asked.device):.1e} from the processor", flush=True)
        for count in asked.counts:
            print(f"{title}: {count} worlds, {bytes_per_world(case, count) / 1000:.1f} kB each", flush=True)
            for batch in (1, BATCH):
                steps = rate(case, count, asked.device, asked.seconds, batch)
                print(
                    f"{title}: {count} worlds, {batch} steps a call: {steps:,.0f} steps a second", flush=True
                )


if __name__ == "__main__":
    main()
