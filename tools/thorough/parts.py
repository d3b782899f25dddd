"""The parts of the long checks, and their pieces.

A new part is a function here that gives its pieces, and a line in `PARTS`.
Pieces should take a few minutes at most: what is limited to twenty minutes never ends a longer one.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import pytest
from tests.fuzz.files import SEEDS
from tests.memory import LOOPS
from tests.rings import has_long_tests
from tests.workers.episodes import METHODS
from tools.differ.pair import ORACLE
from tools.nearest_tests import changed_files, touched_tests
from tools.sanitize import FLAGS
from tools.thorough.pieces import SEED, Piece

from carom.native.kernel_modules import CUDA_MODULES

ROOT = Path(__file__).parents[2]
API_PIECES, OPERATIONS = 50, 20_000
"""Of the fuzzer of the API: a million operations."""
FILE_PIECES, FILE_CASES = 10, 10_000
"""Of the fuzzer of files: 100,000 cases of each kind."""
DIFFER_PIECES, DIFFER_SEEDS = 42, 20
"""Of the differential fuzzer: 10,920 programs, one of each theme for each seed."""
FAULT_PIECES = 6
"""Of the faults that the differential fuzzer has to report."""
STORMS, STORM_SECONDS = 10, 120
"""Of random calls by threads and signal handlers, and how long each lasts [s]."""
MUTATION_PIECES, MUTATIONS = 12, 4
"""Samples of the list of mutations, and how many are in one."""
_PYTEST = ("-m", "pytest", "-q", "-p", "no:cacheprovider")
_LONG = {"CAROM_TEST_PROFILE": "thorough"}


def suite() -> list[Piece]:
    """All tests but those marked `thorough`, those that take long included: a piece for each folder."""
    folders: dict[Path, list[str]] = {}
    for file in sorted((ROOT / "tests").rglob("test_*.py")):
        folders.setdefault(file.parent, []).append(file.relative_to(ROOT).as_posix())
    return [
        Piece("suite", folder.relative_to(ROOT).as_posix(), (*_PYTEST, "--long", *files))
        for folder, files in folders.items()
    ]


def changed() -> list[Piece]:
    """The long tests nearest to what the last changes touch: a piece for each file."""
    places = touched_tests(changed_files())
    files = {file for place in places for file in [ROOT / place, *(ROOT / place).rglob("*")]}
    return [
        Piece(
            "changed",
            name.removeprefix("tests/"),
            (*_PYTEST, "--long", "-m", "long", name),
            passing=(pytest.ExitCode.OK, pytest.ExitCode.NO_TESTS_COLLECTED),
        )
        for file in sorted(files)
        if file.match("test_*.py") and has_long_tests(file)
        for name in [file.relative_to(ROOT).as_posix()]
    ]


def properties() -> list[Piece]:
    """Properties with many more cases than in every run: a piece for each file."""
    files = [
        file.relative_to(ROOT).as_posix()
        for file in sorted((ROOT / "tests").rglob("test_*.py"))
        if "from hypothesis import" in file.read_text(encoding="utf-8")
    ]
    return [
        Piece(
            "properties",
            file.removeprefix("tests/"),
            (*_PYTEST, "-m", "hypothesis", f"--hypothesis-seed={SEED}", file),
            environment=_LONG,
        )
        for file in files
    ]


def gpu() -> list[Piece]:
    """Compiling the kernels for GPUs: a piece for each module."""
    test = "tests/gpu/test_compile.py::test_a_module_compiles_for_a_gpu_and_fits_into_its_registers"
    return [
        Piece("gpu", module.removeprefix("carom.kernels."), (*_PYTEST, f"{test}[{module}]"))
        for module in CUDA_MODULES
    ]


def platforms() -> list[Piece]:
    """Building for platforms that take long where Zig's cache is empty."""
    return [Piece("platforms", "build", (*_PYTEST, "-m", "thorough", "tests/native/building"))]


def fuzz() -> list[Piece]:
    """Random calls, and damaged files."""
    calls = ("-m", "tests.fuzz.api", "--operations", str(OPERATIONS), "--seed", SEED)
    files = ("-m", "tests.fuzz.files", "--cases", str(FILE_CASES), "--seed", SEED, "--kinds")
    return [
        *(Piece("fuzz", f"calls {number}", calls, number) for number in range(API_PIECES)),
        *(
            Piece("fuzz", f"{kind} {number}", (*files, kind), number)
            for number in range(FILE_PIECES)
            for kind in SEEDS
        ),
    ]


def differ() -> list[Piece]:
    """Random programs beside real PyBullet, where there is one, and faults that these have to show."""
    if not ORACLE.exists():
        return []
    seeds = ("-m", "tools.differ.run", "--seeds", str(DIFFER_SEEDS), "--first", SEED)
    faults = ("-m", "tools.differ.faults.run", "--part")
    return [
        Piece("differ", "getters", ("-m", "tools.differ.run", "--getters")),
        *(
            Piece("differ", f"programs {number}", seeds, number * DIFFER_SEEDS)
            for number in range(DIFFER_PIECES)
        ),
        *(
            Piece("differ", f"faults {number}", (*faults, str(number), str(FAULT_PIECES)))
            for number in range(FAULT_PIECES)
        ),
    ]


def storms() -> list[Piece]:
    """Random calls from threads and signal handlers at once: twenty minutes of them."""
    storm = ("-m", "tests.interrupts.storm", "--seconds", str(STORM_SECONDS), "--seed", SEED, "--threads")
    return [
        Piece("storms", f"storm {number}", (*storm, str(2 + number % 3)), number) for number in range(STORMS)
    ]


def sanitizers() -> list[Piece]:
    """Calls and threads while the hand-written C++ is checked, where there is GCC."""
    return [Piece("sanitizers", kind, ("-m", "tools.sanitize", kind)) for kind in sorted(FLAGS)]


def soak() -> list[Piece]:
    """Long work, and long lives of workers, whose memory must not grow."""
    work = ("-m", "tests.conformance.soak")
    return [
        Piece("soak", "loads and removals", (*work, "--steps", "0")),
        Piece("soak", "steps", (*work, "--cycles", "0")),
        *(
            Piece("soak", f"workers by {method}", ("-m", "tests.workers.episodes", "--methods", method))
            for method in METHODS
        ),
        *(Piece("soak", f"loop of {loop}", ("-m", "tests.memory.loops", "--loops", loop)) for loop in LOOPS),
    ]


def mutations() -> list[Piece]:
    """Random samples of the changes that the tests have to notice; `make mutate` tries all."""
    sample = ("-m", "tools.mutate", "--copies", "1", "--sample", str(MUTATIONS), "--seed", SEED)
    return [Piece("mutations", f"sample {number}", sample, number) for number in range(MUTATION_PIECES)]


_ALL = (suite, properties, gpu, platforms, fuzz, storms, sanitizers, differ, soak, mutations, changed)
PARTS: dict[str, Callable[[], Sequence[Piece]]] = {part.__name__: part for part in _ALL}
USUAL = [name for name in PARTS if name != "changed"]
"""What runs if nothing is asked for: `changed` is part of `suite`."""


def all_pieces(names: Sequence[str]) -> list[Piece]:
    """The pieces of some parts."""
    return [piece for name in names for piece in PARTS[name]()]
