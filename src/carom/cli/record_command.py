"""The words of `python -m carom record`: options of the command anywhere, and arguments of the script."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import Any

from carom.cli.arguments import positive

_USAGE = "%(prog)s [-h] [--seconds TIME] [--fps RATE] [--keep-sleep] script output [arguments ...]"
_EPILOG = """\
--seconds, --fps and --keep-sleep are options of the command wherever they stand, also after the output. All
other words after the output are arguments of the script, and so is everything after "--":
carom record script.py out.html --seconds 10 -- --seconds 3
"""


def add_record(commands: Any) -> None:
    """Add the command to those of the command line.

    Args:
        commands: What `ArgumentParser.add_subparsers` returned.
    """
    own = argparse.ArgumentParser(add_help=False, allow_abbrev=False)
    own.add_argument(
        "--seconds", type=positive, metavar="TIME", help="end the script after this much simulated time [s]"
    )
    own.add_argument(
        "--fps",
        type=positive,
        default=60.0,
        metavar="RATE",
        help="frames for each second of simulated time (default 60)",
    )
    own.add_argument(
        "--keep-sleep",
        action="store_true",
        help="let the script sleep after its steps as well, which is skipped otherwise to be done sooner",
    )
    record = commands.add_parser(
        "record",
        parents=[own],
        allow_abbrev=False,
        help="run a script and write a page that replays its world",
        usage=_USAGE,
        epilog=_EPILOG,
    )
    record.add_argument("script", type=Path, help="Python script, unchanged")
    record.add_argument("output", type=Path, help="HTML file to write")
    record.add_argument("arguments", nargs=argparse.REMAINDER, help="arguments of the script")
    # For the messages about wrong options behind the output.
    own.prog, own.usage = record.prog, _USAGE

    def run(options: argparse.Namespace) -> None:
        _record(options, _divided(own, options))

    record.set_defaults(command=run)


def _divided(own: argparse.ArgumentParser, options: argparse.Namespace) -> list[str]:
    """Takes the command's own options out of what follows the output; returns what is the script's."""
    words: list[str] = options.arguments
    end = words.index("--") if "--" in words else len(words)
    _, rest = own.parse_known_args(words[:end], options)
    return [*rest, *words[end + 1 :]]


def _record(options: argparse.Namespace, arguments: list[str]) -> None:
    from carom.cli.record import Take, record

    take = Take(options.script, options.output, arguments, options.seconds, options.fps, options.keep_sleep)
    if not take.script.is_file():
        raise FileNotFoundError(f"{take.script}: no such script")
    files = record(take)
    for file in files:
        print(f"Wrote {file}")
    if not files:
        print(f"{take.script} made no world, so there is nothing to replay.", file=sys.stderr)
