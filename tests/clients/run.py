"""Runs other people's tests and scripts on PyBullet and on Carom, and says where the outcome differs.

    python -m tests.clients.run --carom PYTHON --oracle PYTHON --work FOLDER [--sources FOLDER] [NAME ...]

`make clients` makes the two environments and calls this. Repositories are cloned from GitHub into the folder
of sources, unless they lie there already; nothing of them becomes part of this project.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
from dataclasses import asdict, dataclass
from pathlib import Path

from tests.clients.catalogue import KNOWN, ROBOVERSE, SCRIPTS, SUITES, TASKS, TRIALS, Scripts, Suite, Task
from tests.clients.outcome import (
    Run,
    Verdict,
    compare_runs,
    compare_tests,
    compare_trials,
    read_tests,
    read_trials,
)
from tests.clients.page import PAGE, note, page, read

WATCH = Path(__file__).with_name("watch.py")
PLAY = Path(__file__).with_name("tasks.py")
STEPS = 240
"""Of each script so many steps are watched: a second of the simulation."""
SECONDS = 60
"""And for no longer than this."""
SUITE_SECONDS = 1800


@dataclass(frozen=True)
class Bench:
    """Where everything is: the two interpreters, scratch and the sources."""

    interpreters: dict[str, Path]
    work: Path
    sources: Path

    def source(self, repository: str) -> Path:
        """The folder of a repository, cloned if it is not there."""
        folder = self.sources / repository.partition("/")[2]
        if not folder.exists():
            address = f"https://github.com/{repository}"
            subprocess.run(["git", "clone", "--quiet", "--depth", "1", address, str(folder)], check=True)
        return folder

    def folder_of(self, module: str) -> Path:
        """The folder of a package of PyBullet's."""
        command = [str(self.interpreters["oracle"]), "-c", f"import {module}; print({module}.__path__[0])"]
        return Path(subprocess.run(command, check=True, capture_output=True, text=True).stdout.split("\n")[0])

    def packages(self) -> Path:
        """A folder with PyBullet's examples in it as a package, which some of them import."""
        folder = self.scratch("packages")
        examples = folder / "pybullet_examples"
        if not examples.exists():
            examples.symlink_to(self.folder_of("pybullet_examples"))
        return folder

    def scratch(self, *parts: str) -> Path:
        """An empty folder for one run."""
        folder = self.work.joinpath(*parts)
        folder.mkdir(parents=True, exist_ok=True)
        return folder


def run_suite(bench: Bench, name: str, suite: Suite) -> Verdict:
    """Runs the tests of a project with both."""
    source = bench.source(suite.repository)
    outcomes = {}
    for which, python in bench.interpreters.items():
        folder = bench.scratch(name, which)
        report = folder / "report.xml"
        report.unlink(missing_ok=True)
        tests = [str(source / test) for test in suite.tests]
        command = [str(python), "-m", "pytest", "-q", "-p", "no:cacheprovider", f"--junitxml={report}"]
        environment = _clean() | {"PYTHONPATH": str(source / suite.path)}
        # Tests may count on being run from the root of their repository.
        _run([*command, *suite.options, *tests], folder, environment, SUITE_SECONDS, source)
        outcomes[which] = read_tests(report)
    return compare_tests(outcomes["oracle"], outcomes["carom"])


def run_scripts(bench: Bench, name: str, scripts: Scripts, wanted: list[str]) -> list[tuple[str, Verdict]]:
    """Watches each script with both, on PyBullet's own assets."""
    root = bench.source(scripts.repository) if scripts.repository else bench.folder_of(str(scripts.module))
    assets = str(bench.folder_of("pybullet_data"))
    watching = {
        "WATCH_DATA": assets,
        "WATCH_WITHOUT_WINDOWS": "1",
        "PYTHONPATH": str(bench.packages()),
    }
    verdicts = []
    for script in sorted((root / scripts.folder).glob("*.py")):
        if script.stem in (*scripts.left_out, "__init__") or (wanted and script.stem not in wanted):
            continue
        runs = {}
        for which, python in bench.interpreters.items():
            folder = bench.scratch(name, which, script.stem)
            record = folder / "record.json"
            record.unlink(missing_ok=True)
            if scripts.repository:
                _lay_out(folder, root, root / scripts.folder)
            environment = _clean() | watching
            command = [str(python), str(WATCH), str(record), str(STEPS), str(SECONDS), str(script)]
            _run(command, folder, environment, 2 * SECONDS)
            runs[which] = Run.read(record, (folder, Path(assets)))
        verdict = compare_runs(runs["oracle"], runs["carom"])
        if not verdict.good and script.stem in KNOWN:
            verdict = Verdict(True, f"{verdict.text}; known: {KNOWN[script.stem]}")
        verdicts.append((script.stem, verdict))
        _say(script.stem, verdicts[-1][1])
    return verdicts


def run_task(bench: Bench, name: str, task: Task) -> Verdict:
    """Plays the trials of a task with both, on PyBullet's own assets."""
    source, assets = bench.source(ROBOVERSE), bench.folder_of("pybullet_data")
    trials = {}
    for which, python in bench.interpreters.items():
        folder = bench.scratch("roboverse", which, name.replace(" ", "_"))
        command = [str(python), str(PLAY), str(source), str(assets), json.dumps(asdict(task)), str(TRIALS)]
        _run(command, folder, _clean(), TRIALS * SECONDS)
        trials[which] = read_trials(folder / "output.txt")
    return compare_trials(trials["oracle"], trials["carom"])


def _lay_out(folder: Path, root: Path, scripts: Path) -> None:
    """Puts what lies beside the scripts, and the data of the repository, where they look for it."""
    beside = [entry for entry in scripts.iterdir() if entry.suffix != ".py"]
    for link, target in [(folder.parent / "data", root / "data"), *((folder / e.name, e) for e in beside)]:
        if not (link.is_symlink() or link.exists()):
            link.symlink_to(target)


def _clean() -> dict[str, str]:
    """The environment without what would mix up the two modules of one name."""
    return {key: value for key, value in os.environ.items() if key != "PYTHONPATH"}


def _run(
    command: list[str], folder: Path, environment: dict[str, str], seconds: float, place: Path | None = None
) -> None:
    """Runs a command in a place, which is the folder unless given; the folder gets what it prints."""
    with (folder / "output.txt").open("w") as output:
        try:
            subprocess.run(
                command,
                cwd=place or folder,
                env=environment,
                stdout=output,
                stderr=subprocess.STDOUT,
                timeout=seconds,
                check=False,
            )
        except subprocess.TimeoutExpired:
            output.write(f"\nended after {seconds} s\n")


def _say(name: str, verdict: Verdict) -> None:
    print(f"{'same' if verdict.good else 'DIFFERS':8s} {name:40s} {verdict.text}", flush=True)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--carom", type=Path, required=True, help="a Python with Carom")
    parser.add_argument("--oracle", type=Path, required=True, help="a Python with PyBullet")
    parser.add_argument("--work", type=Path, required=True, help="folder for what the runs write")
    parser.add_argument("--sources", type=Path, help="folder of the repositories")
    parser.add_argument("names", nargs="*", help="of suites and scripts; all where none are given")
    parser.add_argument("--record", action="store_true", help="note the outcomes, and make their page anew")
    options = parser.parse_args()
    work = options.work.absolute()
    interpreters = {"oracle": options.oracle.absolute(), "carom": options.carom.absolute()}
    bench = Bench(interpreters, work, (options.sources or work / "sources").absolute())
    bench.sources.mkdir(parents=True, exist_ok=True)
    good = True
    for name, suite in SUITES.items():
        if not options.names or name in options.names:
            verdict = run_suite(bench, name, suite)
            _say(name, verdict)
            good &= verdict.good
            if options.record:
                note(name, name, same=verdict.good, text=verdict.text)
    for name, task in TASKS.items():
        if not options.names or "roboverse" in options.names:
            verdict = run_task(bench, name, task)
            _say(name, verdict)
            good &= verdict.good
            if options.record:
                note("roboverse", name, same=verdict.good, text=verdict.text)
    wanted = [name for name in options.names if name not in (*SUITES, "roboverse")]
    if wanted or not options.names:
        for name, scripts in SCRIPTS.items():
            print(f"\n{name}:")
            verdicts = run_scripts(bench, name, scripts, wanted)
            good &= all(verdict.good for _, verdict in verdicts)
            for script, verdict in verdicts if options.record else ():
                note(name, script, same=verdict.good, text=verdict.text)
    if options.record:
        PAGE.write_text(page(read()), encoding="utf-8")
    return 0 if good else 1


if __name__ == "__main__":
    sys.exit(main())
