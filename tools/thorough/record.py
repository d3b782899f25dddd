"""What has been done of the long checks, on which state of the checkout: a JSON file that outlives a run."""

from __future__ import annotations

import json
import os
import subprocess
from dataclasses import asdict, dataclass
from hashlib import sha256
from pathlib import Path

# What a change of lets all pieces run again.
_CHECKED = ("src", "tests", "tools", "pyproject.toml")


@dataclass(frozen=True)
class Done:
    """The last run of a piece, and those before.

    Attributes:
        digest: Of the checkout that it ran on.
        passed: Whether it passed.
        seconds: How long it took.
        passes: How many runs have passed, on whatever checkout: they had other seeds.
        number: Runs are numbered in the order in which they ended.
    """

    digest: str
    passed: bool
    seconds: float
    passes: int
    number: int


class Record:
    """The last runs of all pieces, kept in a file.

    Args:
        file: The file; it may not exist yet.
        digest: Of the checkout.
    """

    def __init__(self, file: Path, digest: str) -> None:
        self.digest = digest
        self._file = file
        entries = json.loads(file.read_text(encoding="utf-8")) if file.exists() else {}
        self._done = {key: Done(**entry) for key, entry in entries.items()}

    def last(self, key: str) -> Done | None:
        """The last run of a piece; None if it never ran to its end."""
        return self._done.get(key)

    def is_done(self, key: str) -> bool:
        """Whether a piece has passed on this checkout."""
        done = self.last(key)
        return done is not None and done.passed and done.digest == self.digest

    def passes(self, key: str) -> int:
        """How many runs of a piece have passed."""
        done = self.last(key)
        return done.passes if done else 0

    def add(self, key: str, passed: bool, seconds: float) -> None:
        """Note a run, and write the file: a run that is broken off afterwards loses nothing."""
        number = 1 + max((done.number for done in self._done.values()), default=0)
        passes = self.passes(key) + passed
        self._done[key] = Done(self.digest, passed, round(seconds, 1), passes, number)
        self._file.parent.mkdir(parents=True, exist_ok=True)
        written = self._file.with_suffix(".new")
        entries = {key: asdict(done) for key, done in self._done.items()}
        written.write_text(json.dumps(entries, indent=1) + "\n", encoding="utf-8")
        os.replace(written, self._file)


def checkout_digest(root: Path) -> str:
    """A digest of all files that git knows or would add, of sources, tests and tools, as they are now."""
    command = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard", *_CHECKED]
    listed = subprocess.run(command, cwd=root, capture_output=True, text=True, check=True).stdout
    digest = sha256()
    for name in sorted(set(filter(None, listed.split("\0")))):
        if (root / name).is_file():
            digest.update(f"{name}\0{sha256((root / name).read_bytes()).hexdigest()}\n".encode())
    return digest.hexdigest()[:16]
