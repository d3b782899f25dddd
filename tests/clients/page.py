"""What came of other people's code, as a page: `python -m tests.clients.page` writes it from `record.json`.

`run.py --record` notes there what it has run, when, and with which outcome.
"""

from __future__ import annotations

import json
from datetime import date
from pathlib import Path
from typing import TypedDict

from tests.clients.catalogue import KNOWN, ROBOVERSE, SCRIPTS, SUITES, TASKS, TRIALS

RECORD = Path(__file__).with_name("record.json")
PAGE = Path(__file__).parents[2] / "docs" / "conformance" / "clients.md"

_BEGINNING = """# Other people's code

Tests and scripts of other projects, run on PyBullet 3.2.7 and on Carom, unchanged and with PyBullet's own
files for both. `make clients` runs them; `python -m tests.clients.run --record` notes the outcomes, and
`python -m tests.clients.page` makes this page of them. Of a test suite every test that passes on PyBullet has
to pass here. A script is watched for 240 steps; it has to end in the same way, and bodies and joints may be
1e-3 apart (m, rad) in the first 20 steps, or 5e-3 at most all along.
"""


class Outcome(TypedDict):
    """What came of a suite or a script: when it was run, whether as on PyBullet, and what is to be said."""

    date: str
    same: bool
    text: str


def read(path: Path = RECORD) -> dict[str, dict[str, Outcome]]:
    """The recorded outcomes, by group and name; a suite is the only one of its group."""
    return json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}


def note(group: str, name: str, *, same: bool, text: str, path: Path = RECORD) -> None:
    """Record an outcome of today."""
    record = read(path)
    record.setdefault(group, {})[name] = Outcome(date=date.today().isoformat(), same=same, text=text)
    path.write_text(json.dumps(record, indent=1, sort_keys=True) + "\n", encoding="utf-8")


def page(record: dict[str, dict[str, Outcome]]) -> str:
    """The page of some outcomes."""
    lines = [
        _BEGINNING,
        "## Test suites\n",
        "| project | run | as on PyBullet | outcome |",
        "|---|---|---|---|",
    ]
    for name, suite in SUITES.items():
        project = f"[{name}](https://github.com/{suite.repository})"
        lines.append(_row(project, record.get(name, {}).get(name)))
    runs = record.get("roboverse", {})
    lines += [
        f"\n## Scripted grasps ([roboverse](https://github.com/{ROBOVERSE}))\n",
        f"Its scripted policies, {TRIALS} trials of each, with the seeds from 0 on.\n",
        *_head("task"),
        *(_row(name, runs.get(name)) for name in TASKS),
    ]
    for group, scripts in SCRIPTS.items():
        source = scripts.module or f"{scripts.repository}, {scripts.folder}"
        lines += [f"\n## The {group} (`{source}`)\n"]
        runs = record.get(group, {})
        same = sum(outcome["same"] for outcome in runs.values())
        counted = f"{same} of {len(runs)} recorded scripts come to the same." if runs else "Not recorded."
        lines.append(
            f"{counted} {len(scripts.left_out)} others are left out: they need a headset, a second process "
            "or a person.\n"
        )
        if runs:
            lines += [*_head("script"), *(_row(f"`{name}`", runs[name]) for name in sorted(runs))]
    lines += ["\n## Scripts that come to something else\n", "On purpose, or by chance:\n"]
    lines += [f"- `{name}`: {reason}." for name, reason in sorted(KNOWN.items())]
    return "\n".join(lines) + "\n"


def _head(kind: str) -> list[str]:
    return [f"| {kind} | run | as on PyBullet | outcome |", "|---|---|---|---|"]


def _row(name: str, outcome: Outcome | None) -> str:
    if outcome is None:
        return f"| {name} | not recorded | | |"
    said = outcome["text"].replace("|", "\\|").replace("\n", "; ")
    return f"| {name} | {outcome['date']} | {'yes' if outcome['same'] else 'no'} | {said} |"


if __name__ == "__main__":
    PAGE.write_text(page(read()), encoding="utf-8")
