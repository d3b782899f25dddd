"""The tests of calls and threads with a library whose hand-written C++ is checked while it runs.

`python -m tools.sanitize address` (with undefined behaviour) or `python -m tools.sanitize thread`; arguments
after that are pytest's, by default the tests of calls, threads and signals. Needs GCC of version 12 or later,
whose runtime libraries are loaded into Python; where there is none it says so and ends well.

Kernels are not checked: they are generated, and their memory is that of NumPy's arrays.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
from pathlib import Path

from carom.native.building.flags import OWN_FLAGS
from carom.native.building.library import build
from carom.native.cpu import cpu_levels
from carom.native.targets import this_target

ROOT = Path(__file__).parents[1]
WORK = ROOT / "build" / "sanitizers"
TESTS = (
    *(
        "tests/interrupts/test_programs.py",
        "tests/interrupts/test_atomic.py",
        "tests/native/test_uninterrupted.py",
    ),
    *("tests/pybullet/calls", "tests/pybullet/connections", "tests/pybullet/joints", "tests/pybullet/bodies"),
)
FLAGS = {
    "address": ("-fsanitize=address", "-fsanitize=undefined", "-fno-sanitize=vptr,function"),
    # Memory is copied by the function that GCC's runtime library looks at; it has no other ones for that.
    "thread": ("-fsanitize=thread", "-mllvm", "-tsan-instrument-memintrinsics=0"),
}
RUNTIMES = {"address": ("libasan.so", "libubsan.so"), "thread": ("libtsan.so",)}
# Python itself frees nothing at its end, and takes its memory for its own; what it does is not checked.
OPTIONS = {
    "ASAN_OPTIONS": "detect_leaks=0:halt_on_error=1:detect_odr_violation=0",
    "UBSAN_OPTIONS": "halt_on_error=1:print_stacktrace=1",
    "TSAN_OPTIONS": "halt_on_error=1:ignore_noninstrumented_modules=1:report_signal_unsafe=0",
}


def runtimes(kind: str) -> list[str]:
    """The runtime libraries of GCC; empty if some are missing."""
    found = []
    for name in RUNTIMES[kind]:
        try:
            answer = subprocess.run(
                ["gcc", f"-print-file-name={name}"], capture_output=True, text=True, check=True
            )
        except (OSError, subprocess.CalledProcessError):
            return []
        path = Path(answer.stdout.strip())
        if not path.is_absolute():
            return []
        found.append(str(path))
    return found


def checked_source(kind: str) -> Path:
    """A copy of the packages, with the library that is checked."""
    target, level = this_target(), this_target().usable_levels(cpu_levels())[0]
    flags = [flag for flag in OWN_FLAGS if flag not in ("-fno-sanitize=all", "-g0")]
    library = build(
        ROOT / "src", target, level, cache=WORK / kind / "cache", own_flags=(*flags, "-g", *FLAGS[kind])
    )
    source = WORK / kind / "src"
    shutil.rmtree(source, ignore_errors=True)
    shutil.copytree(ROOT / "src", source, ignore=shutil.ignore_patterns("libraries", "__pycache__"))
    place = source / "carom" / "native" / "libraries"
    place.mkdir()
    for file in (library, library.with_name("manifest.json")):
        shutil.copy(file, place)
    return source


def main() -> int:
    """Does what the command line says; the exit status is pytest's."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("kind", choices=FLAGS)
    asked, tests = parser.parse_known_args()
    preloaded = runtimes(asked.kind)
    if not preloaded:
        print(f"GCC with {' and '.join(RUNTIMES[asked.kind])} is needed; nothing was run")
        return 0
    environment = {
        **os.environ,
        **OPTIONS,
        "PYTHONPATH": str(checked_source(asked.kind)),
        "LD_PRELOAD": ":".join(preloaded),
        "CAROM_SANITIZED": asked.kind,
    }
    command = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", *(tests or TESTS)]
    return subprocess.run(command, cwd=ROOT, env=environment, check=False).returncode


if __name__ == "__main__":
    sys.exit(main())
