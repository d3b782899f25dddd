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
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path
from queue import Queue
from random import Random

from carom.native.building.cache import alone, cache_folder

ROOT = Path(__file__).parents[1]
LIST = Path(__file__).with_name("mutations.json")
MIN_KILLED = 0.95
# What the native library is compiled from.
_COMPILED = ("src/carom/kernels/", "src/carom/layouts/", "src/carom/native/source/")
_SECONDS_TO_BUILD = 1200.0
# Some mutants never come to an end.
_SECONDS_TO_TEST = 600.0


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

    @property
    def compiles(self) -> bool:
        """Whether the native library has to be built anew."""
        return self.file.startswith(_COMPILED)

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


def copy_checkout(folder: Path) -> None:
    """Copy what git knows of the checkout, and new files it does not ignore, as they are now."""
    command = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    listed = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True).stdout
    for name in filter(None, listed.split("\0")):
        if (ROOT / name).is_file():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(ROOT / name, folder / name)


def copy_cache(folder: Path) -> None:
    """Copy compiled objects and what the compiler keeps, so that mutants drive nothing out of the cache."""
    kept = cache_folder()
    # While nobody builds: files come and go.
    with alone(kept):
        for part in ("libraries", "objects", "zig"):
            if (kept / part).is_dir():
                shutil.copytree(kept / part, folder / part)


class Copy:
    """A copy of the checkout in which one mutant after the other is tried.

    Args:
        folder: Where it is.
        cache: Where native libraries are kept, for all copies.
    """

    def __init__(self, folder: Path, cache: Path) -> None:
        self._folder = folder
        self._environment = {
            **os.environ,
            "PYTHONPATH": str(folder / "src"),
            # Compiled Python is told apart by times in seconds and sizes, which mutants have in common.
            "PYTHONDONTWRITEBYTECODE": "1",
            "CAROM_CACHE_PATH": str(cache),
            # The same random cases each time.
            "CI": "1",
        }

    def passes(
        self, tests: Sequence[str], limit: float | None = _SECONDS_TO_TEST, *, quiet: bool = True
    ) -> str | None:
        """None if tests pass; else `killed`, or `timed out`."""
        options = ("-x", "-q", "-p", "no:cacheprovider")
        return self._runs(("pytest", *options, *tests), limit, "killed", quiet)

    def builds(self) -> str | None:
        """None if the native library can be built; else what is wrong."""
        return self._runs(("carom", "warmup"), _SECONDS_TO_BUILD, "does not build", True)

    def _runs(self, command: Sequence[str], limit: float | None, failed: str, quiet: bool) -> str | None:
        arguments = [sys.executable, "-m", *command]
        output = subprocess.DEVNULL if quiet else None
        try:
            done = subprocess.run(
                arguments,
                cwd=self._folder,
                env=self._environment,
                stdout=output,
                stderr=output,
                timeout=limit,
                check=False,
            )
        except subprocess.TimeoutExpired:
            return "timed out"
        return failed if done.returncode else None

    def outcome(self, mutation: Mutation) -> Outcome:
        """Make a change, run its tests, and take it back."""
        path = self._folder / mutation.file
        source = path.read_bytes()
        start = time.perf_counter()
        path.write_text(mutation.mutated(source.decode()), encoding="utf-8", newline="")
        try:
            result = (self.builds() if mutation.compiles else None) or self.passes(mutation.tests)
        finally:
            path.write_bytes(source)
        return Outcome(mutation, result or "survived", time.perf_counter() - start)


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
                outcome = copy.outcome(mutation)
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
