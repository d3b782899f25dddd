"""Constants of the library's C++ that Python has as well are the same in both."""

from __future__ import annotations

import ast
import re
from itertools import accumulate
from pathlib import Path

import pytest

import pybullet as p
from carom.layouts import codes, contacts, motor_commands, status
from carom.layouts.model import State
from carom.native import quick_calls
from carom.native.tables import fields_of
from carom.queries import queries
from carom.scene import body, joint_motor
from pybullet._calls import arguments, quick
from pybullet._calls.builtin import exports

SOURCE = Path(quick_calls.__file__).with_name("source")
ENUM = re.compile(r"\benum\s*\{([^}]*)\}")
NUMBERS = re.compile(r"^\s*(?:static )?const(?:expr)? (?:double|int\w*) ([A-Z_]+ = [^;{]*);", re.MULTILINE)

SHARED = {
    "bodies.cpp": {
        "WORLD_FRAME": p.WORLD_FRAME,
        "LINK_FRAME": p.LINK_FRAME,
        "POSE": fields_of(State)["link_pose"].shape[0],
        "SPATIAL": fields_of(State)["link_twist"].shape[0],
        "ROUNDING": body.ROUNDING,
    },
    "boxes.cpp": {"POSE": fields_of(State)["link_pose"].shape[0]},
    "contacts.cpp": {"OVERLAPS": contacts.OVERLAPS},
    "joints.cpp": {"SPATIAL": fields_of(State)["link_reaction"].shape[0]},
    "motors.cpp": {
        "VELOCITY": motor_commands.VELOCITY,
        "TORQUE": motor_commands.TORQUE,
        "POSITION": motor_commands.POSITION,
        "PD": motor_commands.PD,
        "COLUMNS": fields_of(State)["dof_motor"].shape[0],
        "VELOCITY_CLAMP": codes.MOTOR_VELOCITY_CLAMP,
        "LEAST_PD_FORCE": joint_motor._LEAST_PD_FORCE,
    },
    "nearby.cpp": {"PLACED": contacts.PLACED, "PLANE": codes.PLANE, "FAR": queries._FAR},
    "perform.cpp": {
        "STATUS": status.STATUS,
        "STEPS_DONE": status.STEPS_DONE,
        "OVERFLOW": status.OVERFLOW,
    },
    "quick_calls.cpp": {
        "MOST_PARAMETERS": quick_calls.MOST_PARAMETERS,
        "MOST_GROUPS": quick_calls.MOST_GROUPS,
        "GREATEST": arguments.MAX_MAGNITUDE,
        "LEAST_SQUARE": arguments._LEAST_SQUARE,
        "GREATEST_SQUARE": arguments._GREATEST_SQUARE,
    },
    "quick_calls.h": {"RESETS": contacts.RESETS, "RESETS_SEEN": contacts.RESETS_SEEN},
}
"""Values in Python of the constants of a file."""

IN_CPP_ALONE = {
    "bodies.cpp": {"LINK_NUMBERS", "MOST_LINKS"},
    "contacts.cpp": {"MOST_CONTACTS"},
    "gate.h": {"MOST_CLIENTS"},
    "joints.cpp": {"MOST_JOINTS"},
    "nearby.cpp": {"ANY_LINK", "MOST_PAIRS", "MOST_SHAPES"},
    "quick_calls.cpp": {"MOST_CALLS", "MOST_NUMBERS", "MOST_RESULTS", "RECORDS"},
    "turns.cpp": {"GIMBAL_LOCK", "HALF_PI", "NO_AXIS", "UNIT"},
}
"""Names of constants that Python does not have."""

OF_CHANGE_DYNAMICS = {
    "BODY": "bodyUniqueId",
    "LINK": "linkIndex",
    "INERTIA": "localInertiaDiagonal",
    "LOWER_LIMIT": "jointLowerLimit",
    "SLEEP_THRESHOLD": "sleepThreshold",
    "CONNECTION": "physicsClientId",
}
"""Parameters whose indices have other names in `dynamics.cpp`."""
WIDTHS = {"3": 3, "i": 1, "r": 1, "b": 1, "c": 1}


def constants_in(source: str) -> dict[str, str]:
    """Values of the constants of a C++ source as they are written; of enumerators without one their place."""
    lists = [(inside, True) for inside in ENUM.findall(source)]
    lists += [(inside, False) for inside in NUMBERS.findall(source)]
    found = {}
    for inside, counts in lists:
        following = 0
        for constant in filter(str.strip, inside.split(",")):
            name, _, value = map(str.strip, constant.partition("="))
            assert value or counts, f"{name} has no value"
            found[name] = value or str(following)
            if counts and re.fullmatch(r"-?\d+", found[name]):
                following = int(found[name]) + 1
    return found


def constants_of(file: str) -> dict[str, str]:
    return constants_in((SOURCE / file).read_text(encoding="utf-8"))


def test_enumerators_and_numbers_are_found() -> None:
    source = "enum { A = 3, B };\nenum {\n    C,\n    D,\n};\nconst double E = 1e30, F = 2 * A;\n"
    assert constants_in(source) == {"A": "3", "B": "4", "C": "0", "D": "1", "E": "1e30", "F": "2 * A"}


@pytest.mark.parametrize("file", SHARED)
def test_shared_constants_are_the_same(file: str) -> None:
    found = constants_of(file)
    assert {name: ast.literal_eval(found[name]) for name in SHARED[file]} == SHARED[file]


def test_all_constants_of_the_sources_are_compared_or_in_one_language_alone() -> None:
    for path in sorted(SOURCE.iterdir()):
        known = {*SHARED.get(path.name, ()), *IN_CPP_ALONE.get(path.name, ())}
        if path.name != "dynamics.cpp":
            assert set(constants_of(path.name)) == known, path.name


def test_indices_of_arguments_are_those_of_the_quick_call() -> None:
    parameters = exports["changeDynamics"].code.co_varnames
    _, kinds, _ = quick._KERNELS["changeDynamics"]
    firsts = [0, *accumulate(WIDTHS[kind] for kind in kinds)]
    places = dict(zip(parameters, firsts, strict=False))
    found = constants_of("dynamics.cpp")
    words = {name: name.lower().split("_") for name in found}
    named = {
        name: OF_CHANGE_DYNAMICS.get(name, first + "".join(map(str.capitalize, others)))
        for name, (first, *others) in words.items()
    }
    assert {name: int(place) for name, place in found.items()} == {
        name: places[parameter] for name, parameter in named.items()
    }
