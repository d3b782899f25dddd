"""Compiling every kernel ahead of its first use."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from importlib import import_module
from pathlib import Path
from typing import Any

import warp as wp

from carom.model.launch import CompilationNotice
from carom.model.warp_start import start_warp
from carom.physics.parallel import BLOCK_SIZE

# Those that take longest to compile come first, so that processes that share them out end together.
KERNEL_MODULES = (
    "carom.physics.coupled_step",
    "carom.collision.collide",
    "carom.physics.step",
    "carom.algorithms.reach.search",
    "carom.collision.closest",
    "carom.physics.kinematics",
    "carom.physics.slumber",
    "carom.physics.step_ends",
    "carom.engine.interpreter",
    "carom.physics.motor_commands",
    "carom.collision.rays",
    "carom.collision.contact_report",
    "carom.algorithms.tree.stable_pd",
    "carom.algorithms.tree.dynamics",
    "carom.algorithms.tree.motion",
    "carom.render.kernels.draw",
)
# Steps on CUDA devices are made of these; `carom.engine.parallel` launches them.
PARALLEL_MODULES = (
    "carom.collision.parallel",
    "carom.physics.parallel.contact_rows",
    "carom.physics.parallel.restless_sweeps",
    "carom.physics.parallel.batches",
    "carom.physics.parallel.sweeps",
    "carom.physics.parallel.trees",
    "carom.physics.parallel.joint_rows",
)
# What takes a world through a whole step, which is for CPUs.
_CPU_MODULES = {
    "carom.physics.coupled_step",
    "carom.collision.collide",
    "carom.physics.step",
    "carom.physics.step_ends",
    "carom.engine.interpreter",
}
CUDA_MODULES = (*PARALLEL_MODULES, *(name for name in KERNEL_MODULES if name not in _CPU_MODULES))
# The stages of `World.profile` are compiled again, each on its own, when someone asks for a profile.
ON_DEMAND = ("carom.collision.stages", "carom.physics.stages")

# A launch on CPU uses blocks of one thread, and a module is compiled for its block size.
_CPU_BLOCK_SIZE = 1


def warmup(device: str = "cpu") -> None:
    """Compile, or load from the cache, the kernels of all modules that steps and questions need.

    Modules for the CPU are compiled in as many processes as there are cores.

    Args:
        device: Warp device name.
    """
    start_warp()
    target = wp.get_device(device)
    with CompilationNotice():
        if not target.is_cpu:
            wp.force_load(target, [_warp_module(name) for name in CUDA_MODULES], BLOCK_SIZE)
            return
        _build_side_by_side([name for name in KERNEL_MODULES if not _is_built(_warp_module(name))])
        wp.force_load(target, [_warp_module(name) for name in KERNEL_MODULES], _CPU_BLOCK_SIZE)


def build(name: str) -> None:
    """Compile the kernels of one module for the CPU, into the cache."""
    start_warp()
    wp.force_load(wp.get_device("cpu"), [_warp_module(name)], _CPU_BLOCK_SIZE)


def _warp_module(name: str) -> Any:
    return wp.get_module(import_module(name).__name__)


def _is_built(module: Any) -> bool:
    return (Path(str(wp.config.kernel_cache_dir)) / module.get_module_identifier(_CPU_BLOCK_SIZE)).is_dir()


def _build_side_by_side(names: Sequence[str]) -> None:
    """Compile modules in processes of their own: within one, Warp compiles them one after the other."""
    workers = min(os.cpu_count() or 1, len(names))
    if workers > 1 and sys.executable:
        with ThreadPoolExecutor(workers) as pool:
            list(pool.map(_build_elsewhere, names))


def _build_elsewhere(name: str) -> None:
    """Compile a module in another process. Should that fail, this process will do it and tell why."""
    subprocess.run(
        [sys.executable, "-c", "import sys; from carom.warmup import build; build(sys.argv[1])", name],
        # Warp adds its version to the path it is given.
        env={**os.environ, "WARP_CACHE_PATH": str(Path(str(wp.config.kernel_cache_dir)).parent)},
        stdin=subprocess.DEVNULL,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        check=False,
    )
