"""Run scenarios with the `pybullet` of this interpreter and write what it says.

    .oracle/bin/python -m tests.conformance.record [--only NAME ...] [--into DIRECTORY]

Into the golden directory only real PyBullet may write.
"""

from __future__ import annotations

import argparse
import importlib
import importlib.metadata
import time
from pathlib import Path

from . import golden
from .catalogue import select


def engine_version() -> str:
    """Name and version of the distribution that `import pybullet` gives."""
    if is_real_pybullet():
        return f"pybullet {importlib.metadata.version('pybullet')}"
    carom = importlib.import_module("carom")
    return f"carom {carom.__version__}"


def is_real_pybullet() -> bool:
    """Whether `pybullet` is the compiled module, not the drop-in."""
    return not str(importlib.import_module("pybullet").__file__).endswith(".py")


def main() -> None:
    """Record and say how long each scenario took and how large its file is."""
    parser = argparse.ArgumentParser(description="Run the conformance scenarios and write their series.")
    parser.add_argument("--only", nargs="+", default=[], metavar="NAME", help="record these scenarios only")
    parser.add_argument("--into", type=Path, default=golden.DIRECTORY, help="where to write")
    arguments = parser.parse_args()
    if arguments.into.resolve() == golden.DIRECTORY and not is_real_pybullet():
        raise SystemExit("this interpreter has no real PyBullet: goldens must come from it")
    pybullet = importlib.import_module("pybullet")
    arguments.into.mkdir(parents=True, exist_ok=True)
    chosen = select(arguments.only)
    total, version = 0, engine_version()
    for scenario in chosen:
        start = time.perf_counter()
        series = scenario.series(pybullet)
        seconds = time.perf_counter() - start
        path = arguments.into / f"{scenario.name}.npz"
        golden.write(path, golden.Golden(version, series))
        total += path.stat().st_size
        print(f"{scenario.name:48} {seconds:7.2f} s {path.stat().st_size / 1024:8.1f} KiB", flush=True)
    if not arguments.only:
        for stale in sorted(
            set(arguments.into.glob("*.npz")) - {arguments.into / f"{s.name}.npz" for s in chosen}
        ):
            stale.unlink()
            print(f"{stale.stem:48} removed: no such scenario any more")
    print(f"{len(chosen)} scenarios, {total / 1024:.0f} KiB, {version}")


if __name__ == "__main__":
    main()
