"""Running pieces, several at a time, with progress, a limit of time, and a record of what is done."""

from __future__ import annotations

import time
from collections.abc import Sequence
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from dataclasses import dataclass, field
from pathlib import Path
from threading import Event

from tools.thorough.pieces import Piece, Ran, run_piece
from tools.thorough.record import Record

_LINES_OF_FAILURES = 30


@dataclass
class Summary:
    """What came of a run of the long checks.

    Attributes:
        passed: Pieces that passed.
        failed: Pieces that failed.
        left: Pieces that there was no time for, those that were ended included.
    """

    passed: list[Piece] = field(default_factory=list)
    failed: list[Piece] = field(default_factory=list)
    left: list[Piece] = field(default_factory=list)


def in_order(pieces: Sequence[Piece], record: Record, *, again: bool = False) -> list[Piece]:
    """The pieces to run: those that failed last, then those that never ran, then those that ran longest ago.

    Parts alternate, so that a short time is enough for some of each.

    Args:
        pieces: All pieces.
        record: What is done.
        again: Whether to run those as well that have passed on this checkout.
    """
    sizes: dict[str, int] = {}
    places: dict[str, int] = {}
    for piece in pieces:
        places[piece.key] = sizes.get(piece.part, 0)
        sizes[piece.part] = places[piece.key] + 1

    def urgency(piece: Piece) -> tuple[bool, int, float]:
        last = record.last(piece.key)
        share = places[piece.key] / sizes[piece.part]
        return last is None or last.passed, last.number if last else 0, share

    return sorted((piece for piece in pieces if again or not record.is_done(piece.key)), key=urgency)


class Runner:
    """Runs pieces.

    Args:
        record: Where they are noted.
        root: The folder they run in.
        logs: A folder for what they print.
        jobs: How many at a time.
    """

    def __init__(self, record: Record, root: Path, logs: Path, jobs: int = 1) -> None:
        self._record = record
        self._root = root
        self._logs = logs
        self._jobs = jobs
        self._end = Event()

    def run(self, pieces: Sequence[Piece], seconds: float | None = None) -> Summary:
        """Run pieces, for so many seconds at most; those that run then are ended, and count as not done."""
        give_up = None if seconds is None else time.monotonic() + seconds
        summary = Summary()
        waiting = list(reversed(pieces))
        running: dict[Future[Ran], Piece] = {}
        count = 0
        with ThreadPoolExecutor(self._jobs) as pool:
            try:
                while (waiting or running) and not self._end.is_set():
                    remaining = None if give_up is None else max(0.0, give_up - time.monotonic())
                    while waiting and len(running) < self._jobs and remaining != 0.0:
                        piece = waiting.pop()
                        running[self._start(pool, piece)] = piece
                    ended, _ = wait(running, remaining, FIRST_COMPLETED)
                    if not ended:
                        self._end.set()
                    for future in ended:
                        count += 1
                        self._note(running.pop(future), future.result(), summary, f"{count}/{len(pieces)}")
            finally:
                self._end.set()
        # They were ended; one may have come to its end by itself at the last moment.
        for future, piece in running.items():
            count += 1
            self._note(piece, future.result(), summary, f"{count}/{len(pieces)}")
        summary.left += reversed(waiting)
        return summary

    def _start(self, pool: ThreadPoolExecutor, piece: Piece) -> Future[Ran]:
        return pool.submit(run_piece, piece, self._record.passes(piece.key), self._root, self._end)

    def _note(self, piece: Piece, ran: Ran, summary: Summary, progress: str) -> None:
        if ran.passed is None:
            summary.left.append(piece)
            print(f"[{progress}] {piece.key}: not done, ended after {ran.seconds:.0f} s", flush=True)
            return
        command = piece.command(self._record.passes(piece.key))
        log = self._logs / f"{piece.key.replace(': ', '-').replace('/', '.')}.txt"
        self._logs.mkdir(parents=True, exist_ok=True)
        log.write_text(ran.output, encoding="utf-8")
        self._record.add(piece.key, ran.passed, ran.seconds)
        (summary.passed if ran.passed else summary.failed).append(piece)
        outcome = "passed" if ran.passed else "FAILED"
        print(f"[{progress}] {piece.key}: {outcome}, {ran.seconds:.0f} s", flush=True)
        if not ran.passed:
            settings = "".join(f"{name}={value} " for name, value in piece.environment.items())
            print(*ran.output.splitlines()[-_LINES_OF_FAILURES:], sep="\n")
            print(f"again: {settings}{' '.join(command)}\nall of it: {log}", flush=True)
