"""The table of `docs/conformance/robots.md`: python tabulate.py ANSWERS ERRORS WHOLE, of the `ask_*.py`."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

BOUNDS = {
    "structure": 0.5,
    "total mass": 1e-6,
    "masses": 1e-6,
    "reference": 1e-6,
    "poses": 1e-6,
    "mass matrix": 1e-6,
    "bias": 1e-6,
    "acceleration": 1e-6,
    "forces of actuators": 1e-6,
    "sensors": 1e-4,
    "rollout alone": 1e-3,
    "rollout": 1e-3,
}
STEPS = (1e-4, 1e-3, 1e-2, 1e-1)


def main() -> None:
    answers, errors, whole = (
        {each["file"]: each for each in map(json.loads, Path(name).read_text().splitlines())}
        for name in sys.argv[1:4]
    )
    loaded = [file for file, answer in answers.items() if "error" not in answer]
    print(f"{len(answers)} files, of which MuJoCo loads {len(loaded)}; Carom does not load:")
    for file in loaded:
        if "crash" in errors[file]:
            print(f"  {file}: {errors[file]['crash']}")
    found = {file: errors[file] | {name: whole[file].get(name) for name in ("rollout",)} for file in loaded}
    asked = {name: told(found, name) for name in BOUNDS}
    for name, bound in BOUNDS.items():
        within = sum(value <= bound for value in asked[name].values())
        print(f"| {name} | {len(asked[name])} | {within} | {bound:g} | {len(asked[name]) - within} |")
    for name in ("rollout alone", "rollout"):
        print(name, [sum(value <= step for value in asked[name].values()) for step in STEPS])
    wrong: dict[str, list[str]] = {}
    for name, bound in BOUNDS.items():
        for file, value in asked[name].items():
            if value > bound:
                wrong.setdefault(file, []).append(f"{name} {value:.1e}")
    good = sum("crash" not in found[file] and file not in wrong for file in loaded)
    still = sum("crash" not in found[file] and not is_different(wrong.get(file, ())) for file in loaded)
    print(f"{good} files are within all bounds, {still} within all but those of rollouts")
    for file, problems in sorted(wrong.items()):
        print(f"  {file}: {', '.join(problems)}")
    for name, side in (("MuJoCo", answers), ("Carom", errors)):
        seconds = sum(side[file].get("load_seconds", 0.0) for file in loaded if "crash" not in errors[file])
        print(f"{name} loads them in {seconds:.0f} s of processor time")


def told(found: dict[str, dict[str, Any]], name: str) -> dict[str, float]:
    return {file: each[name] for file, each in found.items() if each.get(name) is not None}


def is_different(problems: Any) -> bool:
    return any(not problem.startswith("rollout") for problem in problems)


if __name__ == "__main__":
    main()
