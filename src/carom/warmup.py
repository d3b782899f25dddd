"""Compiling every kernel ahead of its first use."""

from __future__ import annotations

from importlib import import_module

from carom.model.launch import CompilationNotice

KERNEL_MODULES = (
    "carom.physics.kinematics",
    "carom.physics.step",
    "carom.physics.coupled_step",
    "carom.collision.collide",
    "carom.collision.closest",
    "carom.collision.rays",
    "carom.algorithms.kernels",
    "carom.algorithms.reach.search",
    "carom.render.kernels.draw",
)


def warmup(device: str = "cpu") -> None:
    """Compile, or load from the cache, the kernels of every module that has some.

    Args:
        device: Warp device name.
    """
    import warp as wp

    modules = [wp.get_module(import_module(name).__name__) for name in KERNEL_MODULES]
    target = wp.get_device(device)
    # A launch on CPU uses blocks of one thread, and a module is compiled for its block size.
    block_size = 1 if target.is_cpu else None
    with CompilationNotice():
        wp.force_load(target, modules, block_size)
