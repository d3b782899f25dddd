"""Times the cases of one engine in this interpreter; `run.py` starts it.

It reads keys of cases and answers each with a line of JSON: the median time of a call in seconds, or
why it failed, or nothing if the engine has no such case. What engines print goes before the answer.
"""

from __future__ import annotations

import argparse
import importlib
import json
import statistics
import sys
import time
from collections.abc import Callable
from typing import Any

BATCH_SECONDS = 0.01
ANSWER = "answer: "


def time_call(call: Callable[[], Any], budget: float) -> float:
    """Median time of a call over batches long enough for the clock."""
    call()
    count, elapsed = 1, 0.0
    while True:
        elapsed = _batch(call, count)
        if elapsed >= BATCH_SECONDS:
            break
        count = max(2 * count, int(count * BATCH_SECONDS / max(elapsed, 1e-9)))
    times = []
    end = time.perf_counter() + budget
    while not times or time.perf_counter() < end:
        times.append(_batch(call, count) / count)
    return statistics.median(times)


def time_with_cleanup(call: Callable[[], Any], cleanup: Callable[[Any], None], budget: float) -> float:
    """Median time of a call whose result has to be disposed of, untimed, before the next."""
    cleanup(call())
    times = []
    end = time.perf_counter() + budget
    while not times or time.perf_counter() < end:
        start = time.perf_counter()
        result = call()
        times.append(time.perf_counter() - start)
        cleanup(result)
    return statistics.median(times)


def time_case(prepared: Any, budget: float) -> float:
    """Median time of a prepared case: a call, or a call and what disposes of its result."""
    if isinstance(prepared, tuple):
        call, cleanup = prepared
        return time_with_cleanup(call, cleanup, budget)
    return time_call(prepared, budget)


def _batch(call: Callable[[], Any], count: int) -> float:
    repetitions = range(count)
    start = time.perf_counter()
    for _ in repetitions:
        call()
    return time.perf_counter() - start


def main() -> None:
    """Time the cases named on standard input, one a line, until it ends."""
    parser = argparse.ArgumentParser(description="Time the benchmark cases of one engine.")
    parser.add_argument("module", help="module with the engine's cases")
    parser.add_argument("--seconds", type=float, default=0.3, help="time spent on each case")
    parser.add_argument("--original-data", default="", help="directory of the original pybullet_data")
    arguments = parser.parse_args()
    module = importlib.import_module(arguments.module)
    for line in sys.stdin:
        prepare = getattr(module, line.strip(), None)
        result: dict[str, float | str] = {}
        if prepare is not None:
            try:
                result = {"seconds": time_case(prepare(arguments.original_data), arguments.seconds)}
            except Exception as error:
                result = {"failure": f"{type(error).__name__}: {error}"}
        sys.stdout.write(f"{ANSWER}{json.dumps(result)}\n")
        sys.stdout.flush()


if __name__ == "__main__":
    main()
