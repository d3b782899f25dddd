"""Run every scenario in real PyBullet and in Carom, side by side, and compare.

    .venv/bin/python -m tests.conformance.live --oracle .oracle/bin/python [--only NAME ...]

Each engine has an interpreter and a process of its own.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
from pathlib import Path

from . import golden
from .catalogue import select
from .compare import compare


def measure(interpreter: Path, environment: dict[str, str], names: list[str], into: Path) -> None:
    """Record the scenarios with the engine an interpreter finds in an environment."""
    command = [str(interpreter), "-m", f"{__package__}.record", "--into", str(into)]
    if names:
        command += ["--only", *names]
    subprocess.run(command, check=True, env=environment, stdout=subprocess.DEVNULL)


def main() -> None:
    """Compare all scenarios; the exit code tells whether they agree."""
    parser = argparse.ArgumentParser(description="Compare Carom with real PyBullet, both live.")
    parser.add_argument("--oracle", type=Path, default=Path(".oracle/bin/python"))
    parser.add_argument("--only", nargs="+", default=[], metavar="NAME")
    arguments = parser.parse_args()
    chosen = select(arguments.only)
    differing = 0
    with tempfile.TemporaryDirectory() as directory:
        theirs, ours = Path(directory, "pybullet"), Path(directory, "carom")
        environment = dict(os.environ)
        measure(Path(sys.executable), environment, arguments.only, ours)
        # A path to Carom's sources would hide the real module.
        environment.pop("PYTHONPATH", None)
        measure(arguments.oracle, environment, arguments.only, theirs)
        for scenario in chosen:
            expected = golden.read(theirs / f"{scenario.name}.npz").series
            measured = golden.read(ours / f"{scenario.name}.npz").series
            agreements = compare(scenario, expected, measured)
            failures = [agreement for agreement in agreements if not agreement.holds]
            worst = max(agreements, key=lambda agreement: agreement.error)
            verdict = "DIFFERS" if failures else "ok"
            print(f"{scenario.name:40} {verdict:8} worst {worst.error:9.2e}  {worst.series}")
            for failure in failures[:3]:
                print(f"    {failure}")
            differing += bool(failures)
    print(f"{len(chosen) - differing} of {len(chosen)} scenarios agree")
    sys.exit(1 if differing else 0)


if __name__ == "__main__":
    main()
