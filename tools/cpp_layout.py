"""Check that hand-written C++ is laid out as `.clang-format` says; with `--fix`, lay it out.

The package `clang-format` does it (`pip install clang-format`); the check is skipped without it.
"""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[1]
NATIVE = ROOT / "src" / "carom" / "native"


def files() -> list[Path]:
    """The files of hand-written C++ that are checked."""
    return sorted(path for ending in ("*.cpp", "*.h") for path in NATIVE.rglob(ending))


def main() -> int:
    """Return the exit status of the check; 0 if it cannot be made, which is said."""
    beside = Path(sys.executable).with_name("clang-format")
    program = str(beside) if beside.exists() else shutil.which("clang-format")
    if program is None:
        print("The layout of C++ is not checked: that needs clang-format.")
        return 0
    how = ["-i"] if "--fix" in sys.argv[1:] else ["--dry-run", "--Werror"]
    return subprocess.run([program, *how, *files()], cwd=ROOT, check=False).returncode


if __name__ == "__main__":
    raise SystemExit(main())
