"""Lone calls of `carom.algorithms`, on a Panda, beside Pinocchio's Python bindings.

    python benchmarks/algorithms.py [--pinocchio .pinocchio/bin/python] [--page docs/performance.md]

Both sides answer the same questions first, and their numbers are compared. Then processes of both take turns,
and a figure is the least processor time of a call. Pinocchio returns views of its own memory, which the next
call overwrites; our results are new arrays. Its column has the time of a mere function call beside it.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from algorithms_pinocchio import GRAVITY, LINK, questions, say
from run import put_between_marks, readable

ROOT = Path(__file__).resolve().parents[1]
PANDA = ROOT / "src" / "pybullet_data" / "franka_panda" / "panda.urdf"
MARKS = ("<!-- algorithms -->", "<!-- end of algorithms -->")
LIMIT, APART = 2.0, 1e-9
"""How many times Pinocchio's time a call may take, and by how much numbers may differ."""
TIMED_ONLY = ("joint_torque_regressor",)
"""Links that are fixed to each other are one body there, so that columns differ."""


def cases(path: str) -> dict[str, Callable[[], Any]]:
    """Our side: the answers of `algorithms_pinocchio.cases`, and more rows of the same questions."""
    from carom import World, algorithms

    world = World()
    world.gravity = GRAVITY
    arm = world.load_urdf(path, fixed_base=True)
    link = [spec.name for spec in arm.spec.links].index(LINK)
    q, v, a, tau = questions(len(arm.joints.positions))
    origin = np.zeros(3)
    frames = arm.forward_kinematics
    motions, derivatives = algorithms.link_motions, algorithms.link_motion_derivatives
    return {
        "mass_matrix": lambda: algorithms.mass_matrix(arm, q),
        "inverse_dynamics": lambda: algorithms.inverse_dynamics(arm, q, v, a),
        "forward_dynamics": lambda: algorithms.forward_dynamics(arm, q, v, tau),
        "jacobian": lambda: algorithms.jacobian(arm, link, origin, q),
        "link_frames": lambda: frames(q),
        "center_of_mass": lambda: algorithms.center_of_mass(arm, q),
        "jacobian_center_of_mass": lambda: algorithms.jacobian_center_of_mass(arm, q),
        "centroidal_momentum": lambda: algorithms.centroidal_momentum(arm, q, v),
        "centroidal_map": lambda: algorithms.compute_centroidal_map(arm, q),
        "kinetic_energy": lambda: algorithms.kinetic_energy(arm, q, v),
        "potential_energy": lambda: algorithms.potential_energy(arm, q),
        "coriolis_matrix": lambda: algorithms.compute_coriolis_matrix(arm, q, v),
        "gravity_forces": lambda: algorithms.gravity_forces(arm, q),
        "bias_forces": lambda: algorithms.bias_forces(arm, q, v),
        "inverse_dynamics_derivatives": lambda: algorithms.inverse_dynamics_derivatives(arm, q, v, a),
        "forward_dynamics_derivatives": lambda: algorithms.forward_dynamics_derivatives(arm, q, v, tau),
        "centroidal_derivatives": lambda: algorithms.centroidal_dynamics(arm, q, v, a),
        "joint_torque_regressor": lambda: algorithms.joint_torque_regressor(arm, q, v, a),
        "link_motions": lambda: motions(arm, q, v, a),
        "link_motion_derivatives": lambda: derivatives(arm, link, q, v, a),
        "body.mass_matrix": lambda: arm.mass_matrix(q),
        "body.inverse_dynamics": lambda: arm.inverse_dynamics(a, q, v),
        "body.forward_dynamics": lambda: arm.forward_dynamics(tau, q, v),
        "body.jacobian": lambda: arm.jacobian(link, origin, q),
        "forward_kinematics, to 12 poses": lambda: algorithms.forward_kinematics(arm, q),
    }


OF_RECORDS: dict[str, Callable[[Any], Any]] = {
    "link_frames": lambda found: found[8][:3],
    "inverse_dynamics_derivatives": lambda found: found.dtau_dq,
    "forward_dynamics_derivatives": lambda found: found.da_dq,
    "centroidal_derivatives": lambda found: found.dh_dq,
    "link_motions": lambda found: found.linear_velocities[8],
    "link_motion_derivatives": lambda found: found.dv_dv,
}
"""What of our answer Pinocchio's function returns, where ours has more."""


def compare(pinocchio: Path) -> None:
    """Stop if the two sides give different numbers."""
    theirs = json.loads(_ask(pinocchio, "algorithms_pinocchio.py", "answers"))
    for name, call in cases(str(PANDA)).items():
        if name not in theirs or name in TIMED_ONLY:
            continue
        answer = OF_RECORDS.get(name, lambda found: found)(call())
        ours = np.concatenate([np.ravel(part) for part in answer]) if name == "jacobian" else np.ravel(answer)
        apart = np.abs(ours - theirs[name]).max()
        # The derivative of the momentum differs by what the frame of the base contributes: nothing here.
        if not apart <= APART * max(1.0, np.abs(ours).max()):
            raise SystemExit(f"{name}: Carom and Pinocchio differ by {apart}: the comparison is wrong")


def main() -> None:
    """Measure and print."""
    parser = argparse.ArgumentParser(description="Time lone calls of algorithms beside Pinocchio.")
    parser.add_argument("--pinocchio", type=Path, default=ROOT / ".pinocchio" / "bin" / "python")
    parser.add_argument("--turns", type=int, default=3)
    parser.add_argument("--page", type=Path, help="put the table into this page, between its marks, as well")
    parser.add_argument("--times", action="store_true", help="print our times alone, as JSON")
    arguments = parser.parse_args()
    if arguments.times:
        say(cases(str(PANDA)), "times")
        return
    pinocchio = arguments.pinocchio.absolute()
    sides = [(Path(sys.executable), Path(__file__).name, "--times")]
    if pinocchio.exists():
        compare(pinocchio)
        sides.append((pinocchio, "algorithms_pinocchio.py", "times"))
    else:
        print(f"no Pinocchio at {pinocchio} (make .pinocchio/pin): our figures alone", file=sys.stderr)
    least: list[dict[str, float]] = [{} for _ in sides]
    for turn in range(arguments.turns):
        print(f"turn {turn + 1} of {arguments.turns}", file=sys.stderr, flush=True)
        for known, side in zip(least, sides, strict=True):
            for name, seconds in json.loads(_ask(*side)).items():
                known[name] = min(seconds, known.get(name, seconds))
    figures = table(least[0], least[1] if len(least) > 1 else {})
    print(figures)
    if arguments.page:
        put_between_marks(arguments.page, figures, MARKS)


def table(ours: dict[str, float], theirs: dict[str, float]) -> str:
    """The figures as a Markdown table."""
    rows = [
        ("function", "Carom", "Pinocchio", "Carom : Pinocchio", ""),
        ("---", "---:", "---:", "---:", "---"),
    ]
    for name, own in ours.items():
        other = theirs.get(name.removeprefix("body."), theirs.get("link_frames") if "poses" in name else None)
        ratio = None if other is None else own / other
        met = "" if ratio is None else "PASS" if ratio <= LIMIT else "FAIL"
        rows.append((name, readable(own), readable(other), "–" if ratio is None else f"{ratio:.2f}", met))
    widths = [max(len(row[column]) for row in rows) for column in range(len(rows[0]))]
    return "\n".join(
        "| " + " | ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)) + " |"
        for row in rows
    )


def _ask(interpreter: Path, script: str, wanted: str) -> str:
    arguments = [wanted] if wanted.startswith("-") else [wanted, str(PANDA)]
    return subprocess.run(
        [str(interpreter), str(Path(__file__).with_name(script)), *arguments],
        capture_output=True,
        text=True,
        check=True,
        env=os.environ | {"PYTHONPATH": str(ROOT / "src")} if wanted.startswith("-") else os.environ,
    ).stdout


if __name__ == "__main__":
    main()
