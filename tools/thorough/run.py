"""`make thorough`: the checks that take hours, in pieces; each call continues where the last one stopped.

A piece that has passed is not run again until sources, tests or tools change; one that has failed is the
first of the next call, with the same seed.
"""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Sequence
from pathlib import Path

from tools.thorough.parts import PARTS, ROOT, USUAL, all_pieces
from tools.thorough.pieces import Piece
from tools.thorough.record import Record, checkout_digest
from tools.thorough.runner import Runner, Summary, in_order


def names_of_parts(text: str) -> list[str]:
    """Names of parts, separated by commas.

    Raises:
        argparse.ArgumentTypeError: There is no part of that name.
    """
    names = text.split(",")
    for name in names:
        if name not in PARTS:
            raise argparse.ArgumentTypeError(f"no part is called {name!r}; there are {', '.join(PARTS)}")
    return names


def run(pieces: Sequence[Piece], folder: Path, options: argparse.Namespace) -> Summary:
    """Run what is left of some pieces, and say how it went.

    Args:
        pieces: All pieces.
        folder: Of the record and of what they print.
        options: Of the command line.
    """
    digest = checkout_digest(ROOT)
    record = Record(folder / "record.json", digest)
    chosen = in_order(pieces, record, again=options.again)
    print(f"{len(pieces) - len(chosen)} of {len(pieces)} pieces are done for this checkout ({digest})")
    runner = Runner(record, ROOT, folder / "logs", options.jobs)
    summary = runner.run(chosen, None if options.minutes is None else 60.0 * options.minutes)
    print(f"{len(summary.passed)} passed, {len(summary.failed)} failed, {len(summary.left)} left")
    for piece in summary.failed:
        print(f"FAILED {piece.key}")
    return summary


def main(arguments: Sequence[str] | None = None) -> None:
    """Do what the command line says; ends with status 1 if a piece failed."""
    parser = argparse.ArgumentParser(description="The checks that take hours, in pieces.")
    parser.add_argument("--minutes", type=float, help="stop after so long; all that is left if left out")
    parser.add_argument("--parts", type=names_of_parts, default=USUAL, help=f"some of {','.join(PARTS)}")
    parser.add_argument(
        "--jobs", type=int, default=os.cpu_count() or 1, help="pieces at a time (%(default)s)"
    )
    parser.add_argument("--again", action="store_true", help="also what is done, with other seeds")
    parser.add_argument("--list", action="store_true", help="print the pieces that are left, and run none")
    parser.add_argument("--folder", type=Path, default=ROOT / "build" / "thorough", help="of the record")
    options = parser.parse_args(arguments)
    pieces = all_pieces(options.parts)
    if options.list:
        record = Record(options.folder / "record.json", checkout_digest(ROOT))
        print(*(piece.key for piece in in_order(pieces, record, again=options.again)), sep="\n")
        return
    sys.exit(bool(run(pieces, options.folder, options).failed))


if __name__ == "__main__":
    main()
