"""Draw mutants from every room, and see which of them the nearest tests of `make test` notice.

    python -m tools.mutants.run [--count 400] [--seed 0] [--rooms vector,C++] [--minutes 20]

Those that nothing could notice are named in `equivalent.json`, each with the reason, and are not tried; names
hold the line that is changed, so that one whose line has another text is tried again.

What has been tried is noted in `build/mutants`, and the next call continues as long as the mutated files, and
the tests near them, are the same. Before the first mutant of a file its tests have to pass without it.
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
import time
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from hashlib import sha256
from pathlib import Path
from queue import Queue
from threading import Lock

from tools.mutants.copies import ROOT, SECONDS_TO_TEST, Copy, copy_cache, copy_checkout
from tools.mutants.drawing import Drawn, draw
from tools.mutants.near import near_files
from tools.mutants.rooms import rooms
from tools.mutants.table import EQUIVALENT, NOTICED, table

MIN_KILLED = 0.9
# Files that are tried by themselves first: most mutants need no more.
LIKELIEST = 3
REASONS = Path(__file__).with_name("equivalent.json")


def equivalent() -> dict[str, str]:
    """Why mutants do what the code does without them, by their names."""
    return json.loads(REASONS.read_text(encoding="utf-8"))


class Results:
    """What became of mutants, kept in a file."""

    def __init__(self, file: Path) -> None:
        self._file = file
        self._lock = Lock()
        self._known: dict[str, list[str]] = json.loads(file.read_text("utf-8")) if file.exists() else {}

    def of(self, drawn: Drawn, tests: Sequence[str]) -> str | None:
        """What became of a mutant when it and its tests were as they are; None if that isn't known.

        A mutant that was noticed once still is.
        """
        result, digest = self._known.get(drawn.name, (None, ""))
        return result if result in NOTICED or digest == self._digest(drawn, tests) else None

    def add(self, drawn: Drawn, tests: Sequence[str], result: str) -> None:
        """Note what became of a mutant."""
        with self._lock:
            self._known[drawn.name] = [result, self._digest(drawn, tests)]
            self._file.parent.mkdir(parents=True, exist_ok=True)
            self._file.write_text(json.dumps(self._known, indent=1) + "\n", encoding="utf-8")

    @staticmethod
    def _digest(drawn: Drawn, tests: Sequence[str]) -> str:
        digest = sha256(drawn.source.encode())
        for test in sorted(tests):
            digest.update((ROOT / test).read_bytes())
        return digest.hexdigest()[:16]


class Trial:
    """Tries mutants in copies of the checkout until the time is over."""

    def __init__(self, results: Results, copies: Sequence[Copy], end: float) -> None:
        self._results = results
        self._end = end
        self._free: Queue[Copy] = Queue()
        for copy in copies:
            self._free.put(copy)
        self._passing: dict[tuple[str, ...], bool] = {}
        self._equivalent = equivalent()

    def outcome(self, drawn: Drawn) -> str | None:
        """What becomes of a mutant; None if there was no time."""
        if drawn.name in self._equivalent:
            return EQUIVALENT
        tests = near_files(drawn)
        known = self._results.of(drawn, tests)
        if known is not None:
            return known
        if time.monotonic() > self._end:
            return None
        copy = self._free.get()
        try:
            start = time.monotonic()
            result = self._tried(copy, drawn, tests)
            self._results.add(drawn, tests, result)
        finally:
            self._free.put(copy)
        print(f"{result:16} {time.monotonic() - start:5.0f} s  {drawn.name}", flush=True)
        return result

    def _tried(self, copy: Copy, drawn: Drawn, tests: list[str]) -> str:
        if not tests:
            return "has no tests"
        mutated = drawn.change.made(drawn.source)
        for some in filter(None, (tests[:LIKELIEST], tests[LIKELIEST:])):
            result = copy.tried(drawn.file, mutated, some)
            if result in NOTICED and not self._passes(copy, some):
                return "fails without it"
            if result != "survived":
                return result
        return "survived"

    def _passes(self, copy: Copy, tests: list[str]) -> bool:
        """Whether tests pass without a mutant, in the time that they have with it."""
        key = tuple(sorted(tests))
        if key not in self._passing:
            self._passing[key] = not (copy.builds() or copy.passes(tests, SECONDS_TO_TEST))
        return self._passing[key]


def main(arguments: Sequence[str] | None = None) -> None:
    """Try mutants and print a table; ends with status 1 if in a room too many survive."""
    parser = argparse.ArgumentParser(description="Draw mutants by chance and see whether the tests notice.")
    parser.add_argument("--count", type=int, default=400, help="how many (%(default)s)")
    parser.add_argument("--seed", type=int, default=0, help="decides which (%(default)s)")
    parser.add_argument("--rooms", help="some of the rooms, separated by commas")
    parser.add_argument("--minutes", type=float, default=1e6, help="stop after so long")
    parser.add_argument("--copies", type=int, default=2, help="how many at a time (%(default)s)")
    parser.add_argument("--list", action="store_true", help="print the mutants, and try none")
    parser.add_argument("--folder", type=Path, default=ROOT / "build" / "mutants", help="of the results")
    options = parser.parse_args(arguments)
    # All rooms are drawn from, so that some of them have the same mutants as all.
    chosen = options.rooms.split(",") if options.rooms else list(rooms())
    if unknown := set(chosen) - rooms().keys():
        parser.error(f"there is no room {', '.join(sorted(unknown))}; there are {', '.join(rooms())}")
    mutants = [drawn for drawn in draw(rooms(), options.count, options.seed) if drawn.room in chosen]
    if options.list:
        print(*(drawn.name for drawn in mutants), sep="\n")
        return
    results = Results(options.folder / f"{options.seed}.json")
    end = time.monotonic() + 60.0 * options.minutes
    with tempfile.TemporaryDirectory(prefix="carom-mutants-", ignore_cleanup_errors=True) as work:
        cache = Path(work) / "cache"
        copy_cache(cache)
        copies = []
        for number in range(options.copies):
            folder = Path(work) / f"copy{number}"
            copy_checkout(folder)
            copies.append(Copy(folder, cache))
        trial = Trial(results, copies, end)
        with ThreadPoolExecutor(options.copies) as pool:
            outcomes = list(pool.map(trial.outcome, mutants))
    rows = [(drawn, outcome) for drawn, outcome in zip(mutants, outcomes, strict=True)]
    text, passed = table(rows, MIN_KILLED)
    print(text)
    sys.exit(not passed)


if __name__ == "__main__":
    main()
