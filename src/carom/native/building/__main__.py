"""`python -m carom.native.building`: build the native library and print its path."""

from __future__ import annotations

import argparse
import shutil
import sys
from pathlib import Path

from carom.native.building.cache import MANIFEST
from carom.native.building.library import build
from carom.native.building.zig import BuildError
from carom.native.targets import TARGETS, NoTarget, this_target

_ROOT = Path(__file__).parents[3]


def main(arguments: list[str] | None = None) -> int:
    """Build what the command line, by default that of the process, asks for; returns the exit status."""
    parser = argparse.ArgumentParser(
        prog="python -m carom.native.building", description="Build Carom's native library."
    )
    parser.add_argument("--target", choices=TARGETS, help="the platform; if not given, this one")
    parser.add_argument(
        "--level", action="append", help="a CPU level, more than once for several; if not given, all"
    )
    parser.add_argument("--output", type=Path, help="copy libraries and manifest to this folder")
    parser.add_argument("--quiet", action="store_true", help="do not show progress")
    asked = parser.parse_args(arguments)
    try:
        target = TARGETS[asked.target] if asked.target else this_target()
        for level in asked.level or target.levels:
            if level not in target.levels:
                parser.error(f"{target.name} has the levels {', '.join(target.levels)}")
            library = build(_ROOT, target, level, None if asked.quiet else sys.stderr)
            if asked.output:
                asked.output.mkdir(parents=True, exist_ok=True)
                shutil.copyfile(library.parent / MANIFEST, asked.output / MANIFEST)
                library = Path(shutil.copyfile(library, asked.output / library.name))
            print(library, flush=True)
    except (BuildError, NoTarget) as problem:
        print(f"carom: {problem}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        return 130
    return 0


if __name__ == "__main__":
    sys.exit(main())
