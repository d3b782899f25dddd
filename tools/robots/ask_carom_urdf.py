"""What Carom makes of URDF files beside the answers of `ask_pinocchio.py`.

    python ask_carom_urdf.py ANSWERS

Prints how many files are within each bound, and the others with their errors. Files are read as written, with
fixed bases; couplings of joints, and what rotors add by transmissions, are left out as they are there.
"""

from __future__ import annotations

import json
import logging
import sys
from collections import Counter
from pathlib import Path
from typing import Any

import numpy as np

from carom import World, algorithms
from carom.description.transform import rotation_matrix
from carom.scene.body import Body

BOUNDS = {"joints": 0.5, "links": 0.5, "poses": 1e-6, "mass matrix": 1e-6, "bias": 1e-6}
LEAST = {"poses": 1e-3, "mass matrix": 1e-9, "bias": 1e-3}
"""Greatest values of a file less than these count as these: errors are relative to the greatest value."""
GRAVITY = (0.0, 0.0, -9.81)


def main() -> None:
    logging.disable(logging.WARNING)
    answers = [json.loads(line) for line in Path(sys.argv[1]).read_text().splitlines()]
    loaded = [answer for answer in answers if "error" not in answer]
    print(f"{len(answers)} files, of which Pinocchio loads {len(loaded)}")
    asked, within, good = Counter[str](), Counter[str](), 0
    for answer in loaded:
        try:
            errors = compared(answer)
        except Exception as error:
            print(f"  {answer['file']}: {type(error).__name__}: {error}"[:300])
            continue
        wrong = {name: error for name, error in errors.items() if error > BOUNDS[name]}
        asked.update(errors.keys())
        within.update(errors.keys() - wrong.keys())
        good += not wrong
        if wrong:
            print(f"  {answer['file']}: {', '.join(f'{name} {error:.1e}' for name, error in wrong.items())}")
    for name, bound in BOUNDS.items():
        print(f"| {name} | {asked[name]} | {within[name]} | {bound:g} | {asked[name] - within[name]} |")
    print(f"{good} files are within all bounds")


def compared(answer: dict[str, Any]) -> dict[str, float]:
    """The errors of a file, by question."""
    with World() as world:
        world.gravity = GRAVITY
        scene = world.load(answer["file"], fixed_base=True, missing_meshes="warn")
        (body,) = scene.bodies
        joints = [joint.name for joint in body.joints.movable]
        links = [link.name for link in body.links]
        others, expected = answer["others"], answer["links"]
        if len(others) == 1 and others[0] not in joints and body.links[-1].name != expected[0]:
            # The joint of a free base, and the link that stands for the world.
            others, expected = [], expected[1:]
        errors = {
            "joints": float(sorted(joints) != sorted(answer["joints"] + others)),
            "links": float(not set(expected) <= {*links, body.links[-1].name}),
        }
        if any(errors.values()):
            return errors
        for state in answer.get("states", ()):
            for name, error in in_state(body, answer, state).items():
                errors[name] = max(errors.get(name, 0.0), error)
    return errors


def in_state(body: Body, answer: dict[str, Any], state: dict[str, Any]) -> dict[str, float]:
    """The errors in one state."""
    places = [[joint.name for joint in body.joints.movable].index(name) for name in answer["joints"]]
    positions, rates = np.zeros(len(places)), np.zeros(len(places))
    positions[places], rates[places] = state["values"], state["rates"]
    # A joint takes those along that follow it.
    for follows in (False, True):
        for joint, position in zip(body.joints.movable, positions, strict=True):
            if (joint.spec.mimic is not None) == follows:
                joint.reset(position)
    poses = []
    for name in answer["links"]:
        pose = body.links[-1 if name == body.links[-1].name else name].pose
        poses.append([*pose.position, *np.ravel(rotation_matrix(tuple(pose.orientation)))])
    order = np.ix_(places, places)
    armature = np.diag([joint.armature for joint in body.joints.movable])
    matrix = algorithms.mass_matrix(body, positions) - armature
    bias = np.asarray(algorithms.inverse_dynamics(body, positions, rates, np.zeros_like(rates)))
    return {
        "poses": relative("poses", poses, state["poses"]),
        "mass matrix": relative("mass matrix", matrix[order], state["matrix"]),
        "bias": relative("bias", bias[places], state["bias"]),
    }


def relative(name: str, found: Any, expected: Any) -> float:
    """The greatest error over the greatest value."""
    expected = np.array(expected)
    if expected.size == 0:
        return 0.0
    return float(np.abs(np.array(found) - expected).max() / max(np.abs(expected).max(), LEAST[name]))


if __name__ == "__main__":
    main()
