"""Records a sample of programs with PyBullet's answers, for `make test`: `python -m tools.differ.record`.

Only programs count that Carom agrees about with its own files, which look otherwise than PyBullet's: those
that differ are what `run.py` is for.
"""

from __future__ import annotations

import argparse
import json
import lzma
import sys
from pathlib import Path
from typing import Any

from tools.differ.causes.known import statement
from tools.differ.compare import compare
from tools.differ.pair import ORACLE, ROOT, Server, data_of
from tools.differ.themes import THEMES, program

SAMPLE = ROOT / "tests" / "differ" / "programs.json.xz"
_EACH, _DIGITS = 6, 13
_LONGEST = 100_000


def rounded(value: Any) -> Any:
    """With as many digits as are compared, and some more."""
    if isinstance(value, float):
        return float(f"{value:.{_DIGITS}g}")
    if isinstance(value, list):
        return [rounded(part) for part in value]
    if isinstance(value, dict):
        return {key: rounded(part) for key, part in value.items()}
    return value


def main() -> None:
    """Write the sample."""
    parser = argparse.ArgumentParser(description="Record programs with PyBullet's answers.")
    parser.add_argument("--oracle", type=Path, default=ORACLE, help="the interpreter with real PyBullet")
    parser.add_argument("--first", type=int, default=0, help="seed (%(default)s)")
    parser.add_argument("--each", type=int, default=_EACH, help="programs of each theme (%(default)s)")
    options = parser.parse_args()
    oracle = Server(options.oracle, data_of(options.oracle))
    carom = Server(sys.executable, data_of(Path(sys.executable)), tree=ROOT)
    kept: list[dict[str, Any]] = []
    for theme in THEMES:
        seed, count = options.first, 0
        while count < options.each:
            calls = program(seed, theme)
            oracle.order(calls)
            carom.order(calls)
            theirs, ours = oracle.answer(), carom.answer()
            theirs["results"] = rounded(theirs["results"])
            unknown = [one for one in compare(calls, theirs, ours) if not statement(calls, one)]
            written = json.dumps(theirs)
            if not unknown and not theirs["died"] and len(written) < _LONGEST:
                kept.append({"theme": theme, "seed": seed, "calls": calls, "theirs": theirs})
                count += 1
            seed += 1
        print(f"{theme}: {count} of {seed - options.first}", flush=True)
    oracle.close()
    carom.close()
    text = json.dumps(kept, separators=(",", ":"), ensure_ascii=False)
    SAMPLE.parent.mkdir(parents=True, exist_ok=True)
    SAMPLE.write_bytes(lzma.compress(text.encode(), preset=9 | lzma.PRESET_EXTREME))
    print(f"{len(kept)} programs, {SAMPLE.stat().st_size} bytes")


if __name__ == "__main__":
    main()
