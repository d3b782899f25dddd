"""Says after how many programs the fuzzer reports each of many faults: `python -m tools.differ.faults.run`.

PyBullet and Carom perform the programs once, without a fault. Then Carom performs them with one fault after
the other (`table.py`), as a wrapper around its module has it, until a difference is reported that was not
there without. What has no call that the fault spoils is counted, but not performed again.

A fault that is not found within all programs is an error, unless the table says why the fuzzer is blind to
it; so is one that is found although it says so. The status is 1 then.
"""

from __future__ import annotations

import argparse
import gzip
import json
import sys
from collections.abc import Iterable, Sequence
from itertools import islice
from pathlib import Path
from typing import NamedTuple

from tools.differ.assets import URDFS
from tools.differ.causes.substeps import with_contacts_of_substeps
from tools.differ.compare import Difference, compare
from tools.differ.faults.spoiling import Fault
from tools.differ.faults.table import FAULTS
from tools.differ.judge import Judge
from tools.differ.pair import ORACLE, ROOT, Outcome, Pair, Server
from tools.differ.programs import Call
from tools.differ.run import random_programs
from tools.differ.themes import THEMES

PROGRAMS = 200
_FIRST = 780_000
# What the calls of `perform.py` call themselves.
_WITHIN = {
    "@probe": {
        "getBasePositionAndOrientation",
        "getBaseVelocity",
        "getBodyUniqueId",
        "getContactPoints",
        "getJointState",
        "getJointStateMultiDof",
        "getNumBodies",
        "getNumJoints",
    },
    "@reach": {"getJointInfo", "getJointState", "getLinkState", "getNumJoints", "resetJointState"},
}


class Recorded(NamedTuple):
    """A program, and what came of it in both without a fault."""

    name: str
    calls: list[Call]
    theirs: Outcome
    ours: Outcome


class Faulty:
    """Carom with a fault.

    Args:
        carom: Performs programs.
        fault: What is spoiled.
    """

    def __init__(self, carom: Server, fault: str) -> None:
        self._carom = carom
        self._fault = fault

    def order(self, calls: Sequence[Call]) -> None:
        """Let a program be performed."""
        self._carom.order(calls, fault=self._fault)

    def answer(self) -> Outcome:
        """What came of it."""
        return self._carom.answer()


def recorded(pair: Pair, first: int, count: int) -> list[Recorded]:
    """The programs of the seeds from the first on, one of each theme, performed."""
    made: list[Recorded] = []
    programs = (one for _, several in random_programs(first, None, list(THEMES)) for one in several)
    for name, calls in islice(programs, count):
        theirs, ours = pair.run(calls)
        if compare(calls, theirs, ours):
            theirs = with_contacts_of_substeps(pair.oracle, calls, theirs)
        made.append(Recorded(name, calls, theirs, ours))
    return made


def kept(path: Path | None, pair: Pair, first: int, count: int) -> list[Recorded]:
    """The programs from a file, or else performed and written to it."""
    if path and path.exists():
        with gzip.open(path, "rt", encoding="utf-8") as file:
            return [Recorded(*one) for one in json.load(file)][:count]
    made = recorded(pair, first, count)
    if path:
        path.parent.mkdir(parents=True, exist_ok=True)
        with gzip.open(path, "wt", encoding="utf-8") as file:
            json.dump(made, file)
    return made


def is_touched(calls: Sequence[Call], fault: Fault) -> bool:
    """Whether a program calls something that a fault spoils."""
    return any(not fault.functions.isdisjoint({call["f"], *_WITHIN.get(call["f"], ())}) for call in calls)


def found_after(pair: Pair, fault: Fault, programs: Iterable[Recorded]) -> tuple[int, Difference] | None:
    """After how many programs a fault is reported, and what is; None if it is not."""
    carom = Faulty(pair.carom, fault.name)
    for number, (_, calls, theirs, clean) in enumerate(programs, 1):
        if not is_touched(calls, fault):
            continue
        carom.order(calls)
        ours = carom.answer()
        if ours["results"] == clean["results"]:
            continue
        before = {(one.call, one.signature) for one in compare(calls, theirs, clean)}
        found = [one for one in compare(calls, theirs, ours) if (one.call, one.signature) not in before]
        says_of = Judge(pair, calls, theirs, ours, carom).explanations(found)
        for difference, says in zip(found, says_of, strict=True):
            if not says:
                return number, difference
    return None


def main(arguments: Sequence[str] | None = None) -> None:
    """Do what the command line says; ends with status 1 if a fault is not found that should be."""
    parser = argparse.ArgumentParser(description="After how many programs the fuzzer reports faults.")
    parser.add_argument("--oracle", type=Path, default=ORACLE, help="the interpreter with real PyBullet")
    parser.add_argument("--tree", type=Path, default=ROOT, help="the checkout Carom is of (%(default)s)")
    parser.add_argument("--first", type=int, default=_FIRST, help="seed (%(default)s)")
    parser.add_argument("--programs", type=int, default=PROGRAMS, help="at most (%(default)s)")
    parser.add_argument("--answers", type=Path, help="where answers without faults are kept, or read from")
    parser.add_argument("--faults", nargs="+", choices=FAULTS, default=list(FAULTS), metavar="FAULT")
    parser.add_argument("--part", type=int, nargs=2, default=(0, 1), metavar=("NUMBER", "OF"))
    options = parser.parse_args(arguments)
    number, of = options.part
    pair = Pair(options.oracle, URDFS, tree=options.tree, spoils=True)
    wrong = 0
    try:
        programs = kept(options.answers, pair, options.first, options.programs)
        for name in options.faults[number::of]:
            fault = FAULTS[name]
            found = found_after(pair, fault, programs)
            wrong += bool(found) == bool(fault.blind)
            told = (
                f"{found[0]:4d} programs: {found[1].signature}"
                if found
                else "NOT FOUND" + (f", as {fault.blind}" if fault.blind else "")
            )
            print(f"{name:44s} {told}", flush=True)
    finally:
        pair.close()
    sys.exit(bool(wrong))


if __name__ == "__main__":
    main()
