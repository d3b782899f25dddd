"""Checking robot files: what of them is not simulated, `python -m carom check`."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

from carom.errors import CaromError
from carom.world.robot_files import Choices, read_robot_file


def check(files: Sequence[Path], choices: Choices) -> bool:
    """Print for each file what it describes and a table of what of it is not simulated.

    With `choices.strict`, that anything is left out counts as a failure; tables are the same.

    Returns:
        Whether all files can be loaded and, if it is strict, nothing of them is left out.
    """
    fine = True
    for number, file in enumerate(files):
        if number:
            print()
        try:
            source = read_robot_file(file, choices)
        except (CaromError, OSError) as problem:
            sys.stdout.flush()
            print(f"carom: {problem}", file=sys.stderr)
            fine = False
            continue
        joints = sum(link.joint_type.value != "fixed" for spec, _ in source.bodies for link in spec.links)
        bodies = len(source.bodies)
        print(
            f"{file}: {source.kind.value}, {bodies} {'body' if bodies == 1 else 'bodies'}, "
            f"{joints} movable {'joint' if joints == 1 else 'joints'}"
        )
        print(source.ignored)
        fine = fine and not (choices.strict and source.ignored.that_matter)
    return fine
