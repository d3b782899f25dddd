"""Bias, spread and coverage of `carom.identify` for noisy encoders, over many seeds of the noise.

The arm is that of `examples/identify_arm.py`: ten seconds at 240 Hz, noise of torques 0.1 N m.

    python -m benchmarks.identifying [SEEDS]
"""

from __future__ import annotations

import sys
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from carom import identify

sys.path.insert(0, str(Path(__file__).parent.parent / "examples"))
identify_arm: Any = import_module("identify_arm")

NOISES = (1e-4, 5e-4, 1e-3)
_TORQUE_NOISE = 0.1


class _Silence:
    """What draws the motion of the example's generator, and no noise."""

    def __init__(self, seed: int) -> None:
        self._generator = np.random.Generator(np.random.PCG64(seed))

    def uniform(self, *bounds: Any) -> Any:
        return self._generator.uniform(*bounds)

    def normal(self, _mean: float, _deviation: float, count: int) -> np.ndarray:
        return np.zeros(count)


def clean_log() -> tuple[dict[str, np.ndarray], dict[str, float]]:
    """The log without noise, and the friction and damping that are true."""
    kept = np.random.default_rng
    np.random.default_rng = _Silence  # type: ignore[assignment]
    try:
        world, robot = identify_arm.real_robot()
        log = identify_arm.measure(world, robot, 10.0, window=False)
    finally:
        np.random.default_rng = kept
    true: dict[str, float] = {}
    for joint in robot.joints.movable[: identify_arm.ARM]:
        true[f"panda.{joint.name}.damping"] = joint.damping
        true[f"panda.{joint.name}.joint_friction"] = joint.friction_loss
    return {name: np.array(rows) for name, rows in log.items()}, true


def main(seeds: int = 100) -> None:
    log, true = clean_log()
    arm = slice(identify_arm.ARM)
    for noise in NOISES:
        errors: list[list[float]] = []
        covered = alone = 0
        cutoffs: list[float] = []
        for seed in range(seeds):
            rng = np.random.default_rng(seed)
            noisy = {name: rows.copy() for name, rows in log.items()}
            noisy["positions"] += rng.normal(0.0, noise, noisy["positions"].shape)
            noisy["torques"][:, arm] += rng.normal(0.0, _TORQUE_NOISE, noisy["torques"][:, arm].shape)
            world, _ = identify_arm.load()
            result = identify(noisy, world, identify_arm.PARAMETERS, confidence=0.95)
            own = [result.values[name] - value for name, value in true.items()]
            within = [abs(it) <= result.bounds[name] for it, name in zip(own, true, strict=True)]
            single = [abs(it) <= 1.96 * result.deviations[name] for it, name in zip(own, true, strict=True)]
            errors.append(own)
            covered += all(within)
            alone += sum(single)
            cutoffs.append(result.cutoff or 0.0)
        found = np.array(errors)
        print(
            f"{noise:g} rad: cut-off {np.mean(cutoffs):.1f} Hz; friction and damping: greatest bias "
            f"{np.abs(found.mean(axis=0)).max():.3f}, greatest spread {found.std(axis=0).max():.3f}, "
            f"greatest error of a seed {np.abs(found).max():.3f}; all within their common bounds of 95 % for "
            f"{covered} of {seeds} seeds, single ones within 1.96 deviations in "
            f"{alone / (seeds * len(true)):.0%}",
            flush=True,
        )


if __name__ == "__main__":
    main(*(int(it) for it in sys.argv[1:]))
