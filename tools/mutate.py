"""Break the code on purpose, one small change at a time, and see whether the tests nearby notice.

`tools/mutations.json` lists the changes. Each is made in a copy of the checkout, with a cache of native
libraries of its own, and its tests run there: a mutant is killed if they fail. All of them have to pass first
without it.

Tools that make every change they can think of know nothing of the native library: each change of a kernel
compiles part of it, which takes from seconds to a minute.
"""

from __future__ import annotations

import argparse
import json
import sys
import tempfile
import time
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from queue import Queue
from random import Random

from tools.mutants.copies import ROOT, Copy, copy_cache, copy_checkout

LIST = Path(__file__).with_name("mutations.json")
MIN_KILLED = 0.95


@dataclass(frozen=True)
class Mutation:
    """One change.

    Attributes:
        file: The file, from the root of the checkout.
        old: A text that is there exactly once.
        new: What stands in its place.
        tests: What should notice, as arguments for pytest.
    """

    file: str
    old: str
    new: str
    tests: tuple[str, ...]

    def mutated(self, source: str) -> str:
        """The source of the file with the change.

        Raises:
            ValueError: The old text is not there, or more than once.
        """
        count = source.count(self.old)
        if count != 1:
            raise ValueError(f"{self.file} has {self.old!r} {count} times")
        return source.replace(self.old, self.new)

    def __str__(self) -> str:
        return f"{self.file}: {_brief(self.old)}  ->  {_brief(self.new)}"


@dataclass(frozen=True)
class Outcome:
    """What became of a mutant: `killed`, `survived`, `timed out` (which kills, too) or `does not build`."""

    mutation: Mutation
    result: str
    seconds: float


def read_mutations(path: Path = LIST) -> list[Mutation]:
    """All changes of a list.

    Args:
        path: A JSON file: for each file of the checkout objects with `old`, `new` and `tests`.
    """
    return [
        Mutation(file, entry["old"], entry["new"], tuple(entry["tests"]))
        for file, entries in json.loads(path.read_text(encoding="utf-8")).items()
        for entry in entries
    ]


def try_all(mutations: Sequence[Mutation], copies: int) -> list[Outcome]:
    """Try mutants in several copies of the checkout at once; prints each outcome.

    Raises:
        SystemExit: The tests fail without any change.
    """
    with tempfile.TemporaryDirectory(prefix="carom-mutants-", ignore_cleanup_errors=True) as work:
        cache = Path(work) / "cache"
        copy_cache(cache)
        free: Queue[Copy] = Queue()
        for i in range(copies):
            folder = Path(work) / f"copy{i}"
            copy_checkout(folder)
            free.put(Copy(folder, cache))
        unchanged = free.get()
        tests = sorted({test for mutation in mutations for test in mutation.tests})
        if unchanged.builds() or unchanged.passes(tests, None, quiet=False):
            sys.exit("without any change the library does not build, or a test fails")
        free.put(unchanged)

        def attempt(mutation: Mutation) -> Outcome:
            copy = free.get()
            try:
                start = time.perf_counter()
                source = (ROOT / mutation.file).read_text(encoding="utf-8")
                result = copy.tried(mutation.file, mutation.mutated(source), mutation.tests)
                outcome = Outcome(mutation, result, time.perf_counter() - start)
            finally:
                free.put(copy)
            print(f"{outcome.result:14} {outcome.seconds:5.0f} s  {mutation}", flush=True)
            return outcome

        with ThreadPoolExecutor(copies) as pool:
            return list(pool.map(attempt, mutations))


def main(arguments: Sequence[str] | None = None) -> None:
    """Try the mutants and print a table; ends with status 1 if too many survive."""
    parser = argparse.ArgumentParser(
        description="Break the code on purpose and see whether the tests notice."
    )
    parser.add_argument("only", nargs="*", help="parts of names of files or of changes; all if left out")
    parser.add_argument("--copies", type=int, default=2, help="how many mutants at a time (%(default)s)")
    parser.add_argument("--sample", type=int, help="only so many of them, chosen at random")
    parser.add_argument("--seed", type=int, default=0, help="decides about the sample (%(default)s)")
    options = parser.parse_args(arguments)
    chosen = [
        mutation
        for mutation in read_mutations()
        if not options.only or any(part in str(mutation) for part in options.only)
    ]
    if options.sample is not None:
        chosen = Random(options.seed).sample(chosen, min(options.sample, len(chosen)))
    if not chosen:
        parser.error("there is no such mutation")
    outcomes = try_all(chosen, max(1, options.copies))
    killed = sum(outcome.result in ("killed", "timed out") for outcome in outcomes)
    print(f"\n{killed} of {len(outcomes)} killed ({killed / len(outcomes):.0%})")
    for outcome in outcomes:
        if outcome.result not in ("killed", "timed out"):
            print(f"{outcome.result}: {outcome.mutation}")
    sys.exit(killed < MIN_KILLED * len(outcomes))


def _brief(text: str) -> str:
    return " ".join(text.split())


if __name__ == "__main__":
    main()
