"""`python -m carom export`: a replay for other programs."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any


def add_export(commands: Any) -> None:
    """Add the command to those of the command line.

    Args:
        commands: What `ArgumentParser.add_subparsers` returned.
    """
    export = commands.add_parser("export", help="write a replay as MCAP, as .rrd of Rerun, or as glTF")
    export.add_argument("replay", type=Path, help="page of `carom record`, `World.record` or of Save")
    export.add_argument("output", type=Path, help="file to write: .mcap, .rrd or .glb")
    export.set_defaults(command=_export)


def _export(options: argparse.Namespace) -> None:
    from carom.replay import export

    try:
        lost = export(options.replay, options.output)
    except ImportError as problem:
        raise ValueError(str(problem)) from problem
    print(f"Wrote {options.output}")
    if lost:
        print(f"It does not hold all that {options.replay} does, which has besides:")
        print("\n".join(f"- {what}" for what in lost))
