"""`make differ`: random programs of calls, performed by real PyBullet and by Carom, and compared.

    python -m tools.differ.run --minutes 20        # continue with the seed after the last one
    python -m tools.differ.run --first 7 --seeds 1 --themes contact   # one program, again

A program is a list of calls (`programs.py`), made from a seed and a theme (`themes.py`, of `kinds/`). Two
interpreters perform it (`pair.py`, `perform.py`), with PyBullet's files for both. `compare.py` says where
results differ: beyond 1e-9 before the first contact, and in the first steps after it as far as rounding
lets one see; contacts of all substeps count (`causes/substeps.py`). What docs/differences states is counted
only (`causes/known.py`), and so is that to which PyBullet has another answer itself, in another process or
from starts 1e-12 m elsewhere (`causes/rounding.py`), or once it has dropped pairs that have parted
(`causes/parted.py`), or links without shapes meet nothing (`causes/placed.py`), or links that fixed joints
tie do not touch (`causes/tied.py`); and so is that to which Carom has, where it loses digits of moments of
inertia (`causes/digits.py`), and images that agree once the near plane is next to the camera
(`causes/cut.py`). Of everything else the first program of each kind is made as short as it can be
(`minimise.py`), printed as a script, and written to build/differ, and the status is 1. All of them are listed
there, in differing.txt.

With `--getters` it is seen instead what every getter says right after every other call (`each_call.py`).
`record.py` keeps a sample of programs with PyBullet's answers for `make test`.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from tools.differ.assets import URDFS
from tools.differ.causes.substeps import with_contacts_of_substeps
from tools.differ.compare import Difference, compare
from tools.differ.each_call import programs_of_getters
from tools.differ.judge import Judge
from tools.differ.minimise import Minimiser
from tools.differ.pair import ORACLE, ROOT, Pair
from tools.differ.programs import Call, script
from tools.differ.themes import THEMES, program

LISTED = "differing.txt"
_SHOWN = 400
_DEFAULT_SEEDS = 100


@dataclass
class Found:
    """What came of a run.

    Attributes:
        programs: How many were compared.
        agreed: How many calls agreed.
        known: How often each statement of docs/differences applied.
        unknown: How often each signature was found that nothing states.
        died: How often PyBullet's process died.
    """

    programs: int = 0
    agreed: int = 0
    known: Counter[str] = field(default_factory=Counter)
    unknown: Counter[str] = field(default_factory=Counter)
    died: int = 0

    def text(self) -> str:
        """A summary for people."""
        lines = [f"{self.programs} programs, {self.agreed} calls agree; PyBullet died {self.died} times"]
        lines += [f"{times:6d} known: {says}" for says, times in self.known.most_common()]
        lines += [f"{times:6d} UNKNOWN: {signature}" for signature, times in self.unknown.most_common()]
        return "\n".join(lines)


class Differ:
    """Compares programs.

    Args:
        pair: Both interpreters.
        folder: Where programs are written that differ.
        minimises: Whether programs are made short.
    """

    def __init__(self, pair: Pair, folder: Path, *, minimises: bool = True) -> None:
        self.found = Found()
        self._pair = pair
        self._folder = folder
        self._minimises = minimises

    def see(self, name: str, calls: list[Call]) -> None:
        """Compare one program, and report what differs."""
        theirs, ours = self._pair.run(calls)
        differences = compare(calls, theirs, ours)
        if differences:
            theirs = with_contacts_of_substeps(self._pair.oracle, calls, theirs)
            differences = compare(calls, theirs, ours)
        self.found.programs += 1
        self.found.died += theirs["died"] is not None
        differing = len({difference.call for difference in differences})
        self.found.agreed += min(len(theirs["results"]), len(ours["results"])) - differing
        says_of = Judge(self._pair, calls, theirs, ours).explanations(differences)
        for difference, says in zip(differences, says_of, strict=True):
            if says:
                self.found.known[says] += 1
                continue
            signature = difference.signature
            self.found.unknown[signature] += 1
            self._list(name, difference)
            if self.found.unknown[signature] == 1:
                self._report(name, calls, difference)

    def _list(self, name: str, difference: Difference) -> None:
        """Add a line to the list of all programs with something that nothing states."""
        self._folder.mkdir(parents=True, exist_ok=True)
        with (self._folder / LISTED).open("a", encoding="utf-8") as listed:
            place = f"{name}, call {difference.call}"
            listed.write(f"{place}: {difference.signature} ({difference.place.error:.1e})\n")

    def _report(self, name: str, calls: list[Call], difference: Difference) -> None:
        if self._minimises:
            calls, again = Minimiser(self._pair, difference.signature).minimise(calls)
            difference = again or difference
        title = f"{name}: {difference.signature} ({difference.place.error:.1e})"
        place = difference.place
        text = (
            f"# {title}\n{script(calls[: difference.call + 1])}"
            f"# PyBullet: {str(place.theirs)[:_SHOWN]}\n# Carom:    {str(place.ours)[:_SHOWN]}\n"
        )
        self._folder.mkdir(parents=True, exist_ok=True)
        kind = difference.function.strip("@")
        (self._folder / f"{name.replace(' ', '-')}-{kind}-{difference.call}.py").write_text(
            text, encoding="utf-8"
        )
        print(text, flush=True)


def random_programs(
    first: int, seeds: int | None, themes: Sequence[str]
) -> Iterator[tuple[int, list[tuple[str, list[Call]]]]]:
    """Seeds from the first on, each with its programs and their names."""
    seed = first
    while seeds is None or seed < first + seeds:
        yield seed, [(f"{theme} {seed}", program(seed, theme)) for theme in themes]
        seed += 1


def main(arguments: Sequence[str] | None = None) -> None:
    """Do what the command line says; ends with status 1 if something differs that nothing states."""
    parser = argparse.ArgumentParser(description="Random programs: real PyBullet beside Carom.")
    parser.add_argument("--oracle", type=Path, default=ORACLE, help="the interpreter with real PyBullet")
    parser.add_argument("--tree", type=Path, default=ROOT, help="the checkout Carom is of (%(default)s)")
    parser.add_argument("--first", type=int, help="seed; that after the last one if left out")
    parser.add_argument(
        "--seeds", type=int, help=f"how many; {_DEFAULT_SEEDS}, or as many as there is time for"
    )
    parser.add_argument("--minutes", type=float, help="stop after so long")
    parser.add_argument("--themes", nargs="+", choices=THEMES, default=list(THEMES), metavar="THEME")
    parser.add_argument("--getters", action="store_true", help="every getter after every other call")
    parser.add_argument("--as-they-are", action="store_true", help="do not make programs short")
    parser.add_argument("--folder", type=Path, default=ROOT / "build" / "differ", help="of what differs")
    options = parser.parse_args(arguments)
    until = None if options.minutes is None else time.monotonic() + 60.0 * options.minutes
    seeds = options.seeds or (None if until else _DEFAULT_SEEDS)
    noted = options.folder / "next.json"
    following = json.loads(noted.read_text(encoding="utf-8")) if noted.exists() else 0
    first = following if options.first is None else options.first
    pair = Pair(options.oracle, URDFS, tree=options.tree)
    differ = Differ(pair, options.folder, minimises=not options.as_they_are)
    try:
        if options.getters:
            for name, calls in programs_of_getters():
                differ.see(name, calls)
        else:
            for seed, programs in random_programs(first, seeds, options.themes):
                for name, calls in programs:
                    differ.see(name, calls)
                if options.first is None:
                    options.folder.mkdir(parents=True, exist_ok=True)
                    noted.write_text(f"{seed + 1}\n", encoding="utf-8")
                if until and time.monotonic() > until:
                    break
    finally:
        pair.close()
        print(differ.found.text(), flush=True)
    sys.exit(bool(differ.found.unknown))


if __name__ == "__main__":
    main()
