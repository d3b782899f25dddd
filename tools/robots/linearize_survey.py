"""How many public scenes `World.linearize` linearises exactly, and what it refuses, as a table.

    python linearize_survey.py FOLDER... --results RESULTS [--table TABLE] [--integrator NAME]
        [--contact LAW] [--processes N] [--seconds N]

All MJCF files below the folders are loaded, each in a process of its own, and moved to a few states by
random velocities, controls and steps. In each, the exact derivatives by state and controls are compared
with central differences, of fourth order and of other sizes where those of second order and of 1e-6 are not
precise enough; sweeps converge for both. Where velocities are great, rounding of differences is allowed for.
A line of RESULTS has what was found of one file, as JSON; files that are in it already are left out. The
table has one row for each folder, then come the integrators and the reasons of what was refused. With
--integrator, steps are those of that one, whatever files name. Contacts follow the law LAW, "compliant" by
default: MuJoCo's integrators need one whose forces are those of an instant.
"""

from __future__ import annotations

import argparse
import json
import logging
import subprocess
import sys
import xml.etree.ElementTree as ElementTree
from collections import Counter
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np

from carom import World
from carom.linearization import linearized_step
from carom.linearization.linearized_step import LinearizedStep

STATES = 3
EXACT = 1e-6
"""Greatest error of an entry, over the greatest entry, of derivatives that count as exact."""
SPEED, STEPS = 0.3, (5, 20, 60)
"""Greatest of the random velocities [rad/s or m/s], and how many steps come before each state."""
SETTLED = 1e-8
"""Sweeps that change a velocity by no more than this have converged [m/s or rad/s]."""
SIZE = 1e-6
"""Size of the changes of central differences: they are less precise than rounding of states over it."""
OTHER_SIZES = 1e-5, 1e-7, 1e-8
"""Sizes that are tried where those differ: rounding spoils small ones, kinks that are near great ones."""
MOST_DOFS = 120


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folders", type=Path, nargs="*")
    parser.add_argument("--results", type=Path)
    parser.add_argument("--table", type=Path)
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("--seconds", type=float, default=120.0)
    parser.add_argument("--integrator", default="", help="take this one for all files")
    parser.add_argument("--contact", default="compliant", help="law of contacts")
    parser.add_argument("--one", type=Path, help="print what is found of one file, as JSON")
    arguments = parser.parse_args()
    if arguments.one:
        print(json.dumps(surveyed(arguments.one, arguments.contact, arguments.integrator)))
        return
    if arguments.results is None:
        parser.error("--results is missing")
    results: Path = arguments.results
    lines = results.read_text().splitlines() if results.exists() else []
    known = {json.loads(line)["file"] for line in lines}
    todo = [
        (folder, path)
        for folder in arguments.folders
        for path in sorted(folder.rglob("*.xml"))
        if str(path) not in known and is_scene(path)
    ]

    options = ["--contact", arguments.contact, "--integrator", arguments.integrator]

    def found(job: tuple[Path, Path]) -> dict[str, Any]:
        return {"folder": job[0].name, **in_process(job[1], arguments.seconds, options)}

    with ThreadPoolExecutor(arguments.processes) as pool, results.open("a") as out:
        for result in pool.map(found, todo):
            out.write(json.dumps(result) + "\n")
            out.flush()
    text = tabulated([json.loads(line) for line in results.read_text().splitlines()])
    if arguments.table:
        arguments.table.write_text(text)
    print(text)


def is_scene(path: Path) -> bool:
    """Whether it is an MJCF file with a world, no part of one."""
    try:
        root = ElementTree.parse(path).getroot()
    except ElementTree.ParseError:
        return False
    return root.tag == "mujoco" and (root.find("worldbody") is not None or root.find("include") is not None)


def in_process(path: Path, seconds: float, options: list[str]) -> dict[str, Any]:
    """`surveyed` in a process of its own."""
    command = [sys.executable, __file__, "--one", str(path), *options]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=seconds, check=False)
    except subprocess.TimeoutExpired:
        return {"file": str(path), "problem": f"took more than {seconds:g} s"}
    if done.returncode:
        return {"file": str(path), "problem": f"the process ended with {done.returncode}"}
    found: dict[str, Any] = json.loads(done.stdout.splitlines()[-1])
    return found


def surveyed(path: Path, contact: str, integrator: str = "") -> dict[str, Any]:
    """What is found of a file: why it is not loaded, or an answer in each state."""
    logging.disable(logging.WARNING)
    found: dict[str, Any] = {"file": str(path)}
    states: list[dict[str, Any]] = []
    for number in range(STATES):
        try:
            world = in_state(path, number, contact, integrator)
        except Exception as error:
            return found | {"problem": _told(error)}
        dofs = sum(sum(body.velocity_count) + (0 if body.fixed_base else 6) for body in world.bodies.values())
        if not dofs:
            return found | {"problem": "nothing moves"}
        if dofs > MOST_DOFS:
            return found | {"problem": f"more than {MOST_DOFS} degrees of freedom"}
        states.append(linearised(world))
        found["integrator"] = world.parameters.integrator
    return found | {"states": states}


def in_state(path: Path, number: int, contact: str, integrator: str = "") -> World:
    """The world of a file in one of the states, with the integrator of the file or with another one."""
    rng = np.random.default_rng(number)
    world = World(contact=contact)
    scene = world.load(path)
    scene.apply_options()
    if integrator:
        world.parameters.integrator = integrator
    world.parameters.contact_warm_starting = 0.0
    world.apply_parameters()
    if keys := scene.keyframes:
        scene.reset(next(iter(keys)))
    for actuator in scene.actuators.values():
        actuator.control = within(rng, *actuator.spec.control_range)
    for body in world.bodies.values():
        first = body.first_velocity
        count = 6 + sum(body.velocity_count)
        own = slice(first + (6 if body.fixed_base else 0), first + count)
        world.velocity[own] += rng.uniform(-SPEED, SPEED, own.stop - own.start)
    world.step(STEPS[number])
    return world


def within(rng: np.random.Generator, least: float, most: float) -> float:
    """A random control between -1 and 1 that is not at an end of its range."""
    lower, upper = max(-1.0, least), min(1.0, most)
    if lower >= upper:
        lower, upper = least, most
    return (
        rng.uniform(lower, upper) if np.isfinite([lower, upper]).all() else float(np.clip(0.0, least, most))
    )


def linearised(world: World) -> dict[str, Any]:
    """The error of the derivatives in the present state, or why there are none."""
    try:
        exact = world.linearize(["actuators"], tight=True, method="exact")
    except NotImplementedError as error:
        return {"refused": _told(error)}
    except Exception as error:
        return {"failed": _told(error)}
    near = _by_differences(world, SIZE)
    errors = _errors(exact, near)
    for size in (SIZE, *OTHER_SIZES):
        if max(errors) > EXACT:
            # Of fourth order: what remains of the second falls with the square of the size.
            both = _by_differences(world, size), _by_differences(world, 0.5 * size)
            finest = [(4.0 * finer - coarse) / 3.0 for coarse, finer in zip(*both, strict=True)]
            others = _errors(exact, finest)
            if max(others) < max(errors):
                near, errors = finest, others
    found: dict[str, Any] = {"error": max(errors), "residual": exact.residual}
    greatest = max(1.0, *(float(np.abs(it).max(initial=0.0)) for it in (world.position, world.velocity)))
    found["rounding"] = float(np.spacing(greatest)) / SIZE
    found["measured"] = len(exact.measured)
    found["at_switch"] = list(exact.at_switch[:5])
    if max(errors) > EXACT:
        numbers = np.abs(exact.A - near[0])
        row, column = np.unravel_index(int(np.argmax(numbers)), numbers.shape)
        found["worst"] = f"{exact.states[row]} by {exact.states[column]}"
    return found


def _by_differences(world: World, size: float) -> list[np.ndarray]:
    """A and B by central differences of changes of this size."""
    linearized_step._SIZE = size
    near = world.linearize(["actuators"], tight=True, method="differences")
    return [near.A, near.B]


def _errors(exact: LinearizedStep, near: list[np.ndarray]) -> list[float]:
    """Greatest errors of A and B, over their greatest entries or 1."""
    return [
        float(np.abs(mine - its).max(initial=0.0)) / max(1.0, float(np.abs(its).max(initial=0.0)))
        for mine, its in zip((exact.A, exact.B), near, strict=True)
    ]


def _told(error: Exception) -> str:
    text = str(error).splitlines()
    return f"{type(error).__name__}: {text[0] if text else ''}"[:300]


def tabulated(results: list[dict[str, Any]]) -> str:
    """The table, and reasons of what was refused, in Markdown."""
    lines = [
        "| folder | scenes | states | linearised | exact | of these, with measured contacts "
        "| at a switch | sweeps do not converge | refused |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    groups: dict[str, list[dict[str, Any]]] = {}
    for result in results:
        if "states" in result:
            groups.setdefault(result["folder"], []).extend(result["states"])
    total = Counter[str]()
    for folder, states in groups.items():
        counts = Counter(scenes=len(states) // STATES, states=len(states))
        counts.update(kind for state in states for kind in kinds_of(state))
        total.update(counts)
        lines.append(_line(folder, counts))
    lines.append(_line("all", total))
    used = Counter(it["integrator"] for it in results if "states" in it)
    lines += ["", "Integrators: " + ", ".join(f"{name} {count}" for name, count in used.most_common())]
    for title, reasons in (("Refused", _refused(results)), ("Not surveyed", _left_out(results))):
        lines += ["", f"{title}, and of how many files:", ""]
        lines += [f"- {count}: {reason}" for reason, count in reasons]
    return "\n".join(lines) + "\n"


def kinds_of(state: dict[str, Any]) -> Iterator[str]:
    """In which columns of the table a state counts."""
    if "error" not in state:
        yield "refused"
        return
    yield "linearised"
    if state["error"] <= EXACT + state["rounding"]:
        yield "exact"
        if state["measured"]:
            yield "measured"
    elif state["at_switch"]:
        yield "switch"
    elif state["residual"] > SETTLED:
        yield "unsettled"


def _line(name: str, counts: Counter[str]) -> str:
    columns = ("scenes", "states", "linearised", "exact", "measured", "switch", "unsettled", "refused")
    return f"| {name} | " + " | ".join(str(counts[it]) for it in columns) + " |"


def _refused(results: list[dict[str, Any]]) -> list[tuple[str, int]]:
    reasons = Counter[str]()
    for result in results:
        states = result.get("states", ())
        reasons.update({_without_names(s.get("refused") or s["failed"]) for s in states if "error" not in s})
    return reasons.most_common()


def _left_out(results: list[dict[str, Any]]) -> list[tuple[str, int]]:
    return Counter(it["problem"].split(":")[0] for it in results if "problem" in it).most_common()


def _without_names(reason: str) -> str:
    return " ".join(word for word in reason.split() if "." not in word and not word.isdigit())


if __name__ == "__main__":
    main()
